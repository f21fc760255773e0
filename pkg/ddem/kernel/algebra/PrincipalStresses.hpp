// GPL v2 or later, see LICENSE.
// Principal stresses of plane strain with the eigentensors of the largest and the smallest,
// shared smoothly where they coincide.
#pragma once

#include <pkg/ddem/kernel/algebra/PlaneTensor.hpp>

#include <algorithm>
#include <cmath>

namespace yade::ddem {

/// σ1 ≥ σ2 ≥ σ3 [Pa] and the eigentensors N1, N3 (unit trace; N1:σ = σ1 and N3:σ = σ3 within the sharing tolerance).
template <class Number> struct PrincipalStresses {
	Number                s1, s2, s3;
	PlaneTensorOf<Number> n1, n3;
};

/// Weight of a principal direction whose stress lies `distance` ≥ 0 (in tolerances) from the extreme one:
/// 1 at coincidence, 0 beyond the tolerance. Its slope vanishes at both ends, so the hand-over from one direction to
/// two is continuously differentiable in the stress.
template <class Number> inline Number sharingWeight(const Number& distance)
{
	using std::min;
	const Number d = min(distance, Number(1));
	return 1 - d * d * (3 - 2 * d);
}

/// Closed form: σ_zz is a principal stress of plane strain, the other two follow from Mohr's circle.
/// Where principal stresses lie closer than `tolerance` times the largest magnitude, N1 (or N3) goes over into the mean
/// of their eigentensors, ½(N1+N2), and into a third of the unit tensor at hydrostatic stress: without that the
/// direction of flow jumps when a stress path crosses such a state.
template <class Number>
inline PrincipalStresses<Number> principalStresses(const PlaneTensorOf<Number>& stress, double tolerance)
{
	using std::abs;
	using std::max;
	using std::min;
	using std::sqrt;
	const Number mean = 0.5 * (stress.xx + stress.yy), deviator = 0.5 * (stress.xx - stress.yy), out = stress.zz;
	const Number radius = sqrt(deviator * deviator + stress.xy * stress.xy);
	const Number upper = mean + radius, lower = mean - radius; // in-plane maximum and minimum

	PrincipalStresses<Number> p;
	p.s1 = max(upper, out);
	p.s3 = min(lower, out);
	p.s2 = max(lower, min(upper, out));

	const Number largest = tolerance * max(abs(p.s1), abs(p.s3));
	const Number scale   = select(largest > 0, 1 / largest, Number(0)); // stress-free: all three share
	const Number inverse = select(radius > 0, 0.5 / radius, Number(0));
	// half the cosine and sine of twice the principal angle
	const Number cosine = deviator * inverse, sine = stress.xy * inverse;

	const auto eigentensor = [&](const Number& atUpper, const Number& atLower, const Number& atOut) {
		const Number share = 1 / (atUpper + atLower + atOut);
		const Number half = 0.5 * share * (atUpper + atLower), difference = share * (atUpper - atLower);
		return PlaneTensorOf<Number> {
			half + difference * cosine, half - difference * cosine, share * atOut, difference * sine
		};
	};
	p.n1 = eigentensor(
	        sharingWeight((p.s1 - upper) * scale), sharingWeight((p.s1 - lower) * scale),
	        sharingWeight((p.s1 - out) * scale));
	p.n3 = eigentensor(
	        sharingWeight((upper - p.s3) * scale), sharingWeight((lower - p.s3) * scale),
	        sharingWeight((out - p.s3) * scale));
	return p;
}

} // namespace yade::ddem
