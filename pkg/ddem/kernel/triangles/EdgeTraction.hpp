// GPL v2 or later, see LICENSE.
// Tractions on a straight edge of the border, as forces on its two nodes.
#pragma once

#include <pkg/ddem/kernel/algebra/PlaneVector.hpp>

namespace yade::ddem {

/// Traction on an edge [Pa]; the material lies on the left of the way from its start to its end.
struct EdgeStress {
	double              pressure = 0;   ///< against the outward normal
	double              shear    = 0;   ///< along the edge, from start to end
	PlaneVector<double> fixed { 0, 0 }; ///< in axes of space
};

/// Share of the traction [-] at the ends of an edge, linear in between.
struct EdgeProfile {
	double start = 1, end = 1;
};

struct EdgeForces {
	PlaneVector<double> start, end; ///< [N]
};

/** Forces on the ends of an edge that do the work of its traction.
 *
 * Displacements are linear along an edge, u = (1 − s) u₁ + s u₂, and so is the traction's share f, so the forces are
 * ∫(1 − s) f ds = (2 f₁ + f₂)/6 and (f₁ + 2 f₂)/6 of traction × length × thickness. The inward normal times the length
 * is e_z × d, so that pressure needs no square root and sums up to zero around a closed line.
 * \param along from start to end, d [m]: that of now for a load that follows, else that of the beginning */
inline EdgeForces edgeForces(
        const EdgeStress& stress, const EdgeProfile& profile, const PlaneVector<double>& along, double length,
        double thickness)
{
	const PlaneVector<double> whole
	        = thickness * (stress.pressure * turned(along) + stress.shear * along + length * stress.fixed);
	return { (2 * profile.start + profile.end) / 6 * whole, (profile.start + 2 * profile.end) / 6 * whole };
}

/** Damper at each end of an absorbing edge [N·s/m]: half of ρ c_p n⊗n + ρ c_s s⊗s over its length × thickness
 * (Lysmer & Kuhlemeyer 1969).
 * \param along from start to end [m]; \param impedance ρ c_p and ρ c_s [Pa·s/m]. */
struct WaveImpedance {
	double pressure, shear;
};
inline InPlaneTensor<double>
edgeDamper(const WaveImpedance& impedance, const PlaneVector<double>& along, double length, double thickness)
{
	const double half = 0.5 * thickness / length, p = half * impedance.pressure, s = half * impedance.shear;
	return { p * along.y * along.y + s * along.x * along.x, p * along.x * along.x + s * along.y * along.y,
		 (s - p) * along.x * along.y };
}

} // namespace yade::ddem
