// GPL v2 or later, see LICENSE.
// How a triangle's mass is shared between its vertices and its core.
#pragma once

#include <pkg/ddem/kernel/triangles/ElementFrame.hpp>

namespace yade::ddem {

/** Masses of one triangle. Each vertex receives α m/3; the core keeps the rest and the inertia that makes the rigid
 * triangle's moment of inertia exact:
 * J_M = J − (α m/3) Σ|r_e|² with J = m Σ|r_e|²/12. Mass, centroid and inertia are then those of the solid triangle,
 * and rotation and translation are decoupled because Σ r_e = 0, as the report demands in words below eq. 4.
 *
 * Cores that do not rotate have no use for J_M: the vertices alone carry the moment of inertia, which is exact for
 * α = 1/4 and too small by the factor 4α below. That share also allows a larger time step than 1/6.
 */
struct LumpedMass {
	double vertex;  ///< share of each vertex [kg]
	double core;    ///< mass at the centre [kg]
	double inertia; ///< moment of inertia of the core about z [kg·m²]
};

/** \param vertexShare α, between 0 and 1, and below 1/4 where cores rotate (at 1/4 no inertia is left for the core).
 * \throws std::invalid_argument if density, thickness or α is out of range.
 */
LumpedMass lumpMass(
        const TriangleReference<double>& reference, double density, double thickness, double vertexShare,
        RotationTreatment rotation);

} // namespace yade::ddem
