// GPL v2 or later, see LICENSE.
// Stiffness matrix of one triangle and the bound it sets on the time step.
#pragma once

#include <pkg/ddem/kernel/triangles/LumpedMass.hpp>

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

/** Tangent stiffness in the element's frame [N/m, N, N·m]; unknowns: displacement of vertex 1, 2, 3, of the core,
 * rotation of the core (zero row where cores do not rotate).
 * \param du relative displacements Δu_e of the shape it has now [m]: the arms r_e + Δu_e by which a rotation moves the
 * vertices grow with the element. The stiffness that stress adds (the geometric part,
 * of the order of stress over modulus) is left out.
 */
ElementMatrix elementStiffness(
        const TriangleReference<double>&     reference,
        const TriangleStiffness&             stiffness,
        double                               thickness,
        RotationTreatment                    rotation,
        const RelativeDisplacements<double>& du = {});

/// The diagonal of the mass matrix of the same unknowns [kg, kg·m²].
ElementVector elementMass(const LumpedMass& mass);

/** Largest circular frequency of the free element [rad/s].
 * A node's mass is the sum of the shares of its triangles, so no mesh of such triangles has a higher one (Irons and
 * Treharne 1971): 2/ω is a rigorous bound on a constant time step of leapfrog, without an eigenproblem of the whole
 * mesh, about a state without stress. Stress σ adds a geometric stiffness: nothing with the default masses, about σ/(μ
 * β_φ) of the frequency where the core's rotation is the fastest motion (vertex shares from about 0.2).
 * \param du relative displacements of the shape it has now [m]
 */
double highestFrequency(
        const TriangleReference<double>&     reference,
        const TriangleStiffness&             stiffness,
        double                               thickness,
        const LumpedMass&                    mass,
        RotationTreatment                    rotation,
        const RelativeDisplacements<double>& du = {});

/** By how much the element's highest frequency can have grown since rest at most [rad/s]; no eigenproblem.
 *
 * A rotation by φ turns the vertices of the deformed element by φ e_z × (r_e + Δu_e). The first part is rigid;
 * the second is a strain of its own, which adds at most √(2U/J)|φ|√J to the norm √(xᵀKx) ≤ ω_rest √(xᵀMx), U being the
 * energy of the displacements e_z × Δu_e. So ω ≤ ω_rest + √(2U/J). With the corotational frame the angle follows the
 * vertices, φ = Σ a_e·u_e, and Σ|a_e|²/m_e takes the place of 1/J.
 */
double frequencyGrowth(
        const TriangleReference<double>&     reference,
        const TriangleStiffness&             stiffness,
        double                               thickness,
        const LumpedMass&                    mass,
        RotationTreatment                    rotation,
        const RelativeDisplacements<double>& du);

} // namespace yade::ddem
