// GPL v2 or later, see LICENSE.
// Principal stresses of plane strain with the eigentensors of the largest and the smallest, shared smoothly where they coincide.
#pragma once

#include <pkg/ddem/kernel/PlaneTensor.hpp>

#include <algorithm>
#include <cmath>

namespace yade {
namespace ddem {

	/*! σ1 ≥ σ2 ≥ σ3 [Pa] and the eigentensors N1, N3 (unit trace; N1:σ = σ1 and N3:σ = σ3 within the sharing tolerance). */
	struct PrincipalStresses {
		double      s1, s2, s3;
		PlaneTensor n1, n3;
	};

	/*! Weight of a principal direction whose stress lies `distance` ≥ 0 (in tolerances) from the extreme one: 1 at coincidence, 0 beyond the tolerance.
	Its slope vanishes at both ends, so the hand-over from one direction to two is continuously differentiable in the stress. */
	inline double sharingWeight(double distance)
	{
		const double d = std::min(distance, 1.);
		return 1 - d * d * (3 - 2 * d);
	}

	/*! Closed form: σ_zz is a principal stress of plane strain, the other two follow from Mohr's circle.
	Where principal stresses lie closer than `tolerance` times the largest magnitude, N1 (or N3) goes over into the mean of their eigentensors, ½(N1+N2),
	and into a third of the unit tensor at hydrostatic stress: without that the direction of flow jumps when a stress path crosses such a state. */
	inline PrincipalStresses principalStresses(const PlaneTensor& stress, double tolerance)
	{
		const double mean = 0.5 * (stress.xx + stress.yy), deviator = 0.5 * (stress.xx - stress.yy);
		const double radius = std::sqrt(deviator * deviator + stress.xy * stress.xy);
		const double upper = mean + radius, lower = mean - radius, out = stress.zz; // in-plane maximum and minimum, out of plane

		PrincipalStresses p;
		p.s1 = std::max(upper, out);
		p.s3 = std::min(lower, out);
		p.s2 = std::max(lower, std::min(upper, out));

		const double largest = std::max(std::abs(p.s1), std::abs(p.s3));
		const double scale   = largest > 0 ? 1 / (tolerance * largest) : 0; // stress-free: all three share
		const double inverse = radius > 0 ? 0.5 / radius : 0;
		const double cosine = deviator * inverse, sine = stress.xy * inverse; // half the cosine and sine of twice the principal angle

		const auto eigentensor = [&](double atUpper, double atLower, double atOut) {
			const double share = 1 / (atUpper + atLower + atOut);
			const double half = 0.5 * share * (atUpper + atLower), difference = share * (atUpper - atLower);
			return PlaneTensor { half + difference * cosine, half - difference * cosine, share * atOut, difference * sine };
		};
		p.n1 = eigentensor(sharingWeight((p.s1 - upper) * scale), sharingWeight((p.s1 - lower) * scale), sharingWeight((p.s1 - out) * scale));
		p.n3 = eigentensor(sharingWeight((upper - p.s3) * scale), sharingWeight((lower - p.s3) * scale), sharingWeight((out - p.s3) * scale));
		return p;
	}

} // namespace ddem
} // namespace yade
