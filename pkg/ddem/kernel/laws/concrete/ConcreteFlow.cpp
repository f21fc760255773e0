// GPL v2 or later, see LICENSE.
// Flow of concrete: the implicit solve for a general exponent.
#include <pkg/ddem/kernel/laws/concrete/ConcreteFlow.hpp>

namespace yade::ddem {

FlowSolution<double> solveFlowByNewton(double n, double trial, double relaxation, double strength)
{
	if (!(trial > 0)) return { 0, 0 };
	// y = x/trial in [0, 1] solves y + k y^n = 1; for n < 1 in terms of z = y^n, z^(1/n) + k z = 1, so that the
	// power is above 1 and the function convex: Newton's method from the right of the root then
	// descends to it monotonically.
	const double full = std::pow(trial / strength, n), k = relaxation / trial * full;
	const bool   below = n < 1;
	const double power = below ? 1 / n : n;
	const double onZ = below ? k : 1, onPower = below ? 1 : k; // onZ z + onPower z^power = 1
	double       z = std::min({ 1., 1 / onZ, std::pow(onPower, -1 / power) });
	for (int iteration = 0; iteration < 200; ++iteration) {
		const double raised = onPower * std::pow(z, power - 1);
		const double next   = z - (onZ * z + raised * z - 1) / (onZ + power * raised);
		if (!(next < z)) break; // round-off reached
		z = next;
	}
	return below ? FlowSolution<double> { trial * std::pow(z, power), full * z }
	             : FlowSolution<double> { trial * z, full * std::pow(z, n) };
}

} // namespace yade::ddem
