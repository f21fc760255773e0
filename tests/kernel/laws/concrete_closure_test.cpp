// GPL v2 or later, see LICENSE.
// Closing cracks: the stored energy does not rise, and no cycle of opening and closing creates energy.
#include "../ConcreteSamples.hpp"

#include <gtest/gtest.h>

namespace {

using namespace yade::ddem;
using namespace yade::ddem::test;

const PreparedConcrete concrete;

TEST(CrackClosure, neverRaisesTheStoredEnergy)
{
	Random random(12);
	for (int i = 0; i < 500; ++i) {
		const DamageMeasure<double> damage = measureDamage(concrete, random.damage(5));
		const double                before = random.number(0, 1), now = random.number(0, 1);
		const PlaneTensor           strain = random.tensor(1e-3);
		const double                kept   = keptElasticShare(concrete, damage, before, now, strain);
		const auto                  energy = [&](double effect, const PlaneTensor& e) {
                        return doubleDot(degradedStress(concrete.lambda, concrete.twoShear, effect, damage.loss, e), e);
		};
		EXPECT_LE(energy(now, kept * strain), energy(before, strain) * (1 + 1e-12));
		if (energy(now, strain) <= energy(before, strain))
			EXPECT_EQ(kept, 1) << "an energy that falls is left to fall: that dissipates";
		else
			EXPECT_NEAR(energy(now, kept * strain), energy(before, strain), 1e-12 * energy(before, strain));
	}
}

// a stiffness that comes back at fixed strain would: then about a third of these cycles yields work
TEST(CrackClosure, cyclesCreateNoEnergy)
{
	// no flow that could hide what closing creates
	const ConcreteUpdate update = concreteUpdate(ConcreteEffects::Damage);
	Random               random(13);
	int                  dissipating = 0;
	for (int cycle = 0; cycle < 200; ++cycle) {
		ConcreteState state {};
		state.damage = random.damage(5);
		PlaneTensor from { 0, 0, 0, 0 };
		double      work = 0, through = 0;
		for (int corner = 0; corner < 6; ++corner) {
			const PlaneTensor to    = corner < 5 ? random.tensor(1e-3) : PlaneTensor { 0, 0, 0, 0 };
			constexpr int     steps = 4000;
			for (int i = 1; i <= steps; ++i) {
				const ConcreteState old = state;
				update(concrete, 80e3, from + (double(i) / steps) * (to - from), 1e-6, state);
				const double increment
				        = 0.5 * doubleDot(old.stress + state.stress, state.strain - old.strain);
				work += increment;
				through += std::abs(increment);
			}
			from = to;
		}
		// the trapezoidal rule over the stress drop of opening
		EXPECT_GE(work, -1e-3 * through) << "cycle " << cycle;
		dissipating += work > 1e-2 * through;
	}
	EXPECT_GT(dissipating, 50) << "cracks have opened and closed";
}

} // namespace
