// GPL v2 or later, see LICENSE.
// Equation of state of concrete: the solve for a general exponent.
#include <pkg/ddem/kernel/laws/concrete/ConcretePressure.hpp>

namespace yade::ddem {

double solveStiffening(double n, double a)
{
	if (!(a > 0)) return 0;
	// in terms of l = ln s: l = n ln((1 + s) a); the difference has a slope 1 − n s/(1+s) between 1 − n and 1, so
	// Newton's method converges from anywhere
	double l = n * std::log(a);
	for (int iteration = 0; iteration < 100; ++iteration) {
		const double s      = std::exp(l);
		const double change = (n * (std::log1p(s) + std::log(a)) - l) / (1 - n * s / (1 + s));
		l += change;
		if (std::abs(change) <= 1e-15 * (1 + std::abs(l))) break;
	}
	return std::exp(l);
}

} // namespace yade::ddem
