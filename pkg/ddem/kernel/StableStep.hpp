// GPL v2 or later, see LICENSE.
// Stiffness matrix of one triangle and the bound it sets on the time step.
#pragma once

#include <pkg/ddem/kernel/LumpedMass.hpp>

#include <Eigen/Core>

namespace yade::ddem {

/// Moduli of a triangle at its stiffest.
struct TriangleStiffness {
	double bulk;             ///< B [Pa]
	double shear;            ///< μ [Pa]
	double rotationStiffness; ///< β_φ [-]; only cores that rotate feel it
};

using ElementMatrix = Eigen::Matrix<double, 9, 9>;
using ElementVector = Eigen::Matrix<double, 9, 1>;

/// Tangent stiffness at rest [N/m, N, N·m]; unknowns: displacement of vertex 1, 2, 3, of the core, rotation of the core (zero row where cores do not rotate).
ElementMatrix elementStiffness(const TriangleReference<double>& reference, const TriangleStiffness& stiffness, double thickness, RotationTreatment rotation);

/// The diagonal of the mass matrix of the same unknowns [kg, kg·m²].
ElementVector elementMass(const LumpedMass& mass);

/** Largest circular frequency of the free element [rad/s].
 * A node's mass is the sum of the shares of its triangles, so no mesh of such triangles has a higher one (Irons and Treharne 1971): 2/ω is a rigorous bound on
 * the time step of leapfrog, without an eigenproblem of the whole mesh. The bound holds about the unstressed state; stress σ shifts it by about σ/(2E).
 */
double highestFrequency(const TriangleReference<double>& reference, const TriangleStiffness& stiffness, double thickness, const LumpedMass& mass, RotationTreatment rotation);

} // namespace yade::ddem
