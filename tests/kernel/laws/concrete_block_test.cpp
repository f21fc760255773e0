// GPL v2 or later, see LICENSE.
// The block update against the single one, for every mask of effects; independence of neighbours and place.
#include "../ConcreteSamples.hpp"

#include <pkg/ddem/kernel/laws/ConcreteBlock.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>
#include <vector>

namespace {

using namespace yade::ddem;
using namespace yade::ddem::test;

struct Sample {
	std::vector<RandomPath>    paths;
	std::vector<double>        energies, bands;
	std::vector<ConcreteState> states;

	Sample(Random& random, std::size_t count)
	        : states(count, ConcreteState {})
	{
		for (std::size_t i = 0; i < count; ++i) {
			paths.emplace_back(random, i % 7 == 0 ? 0 : 3e-3, i % 2 == 0);
			energies.push_back(random.number(16e3, 200e3));
			bands.push_back(random.number(0.2, 5) * energies.back());
			if (i % 3 == 0) states[i].damage = random.damage(2);
		}
	}
	std::vector<PlaneTensor> strains(double t) const
	{
		std::vector<PlaneTensor> result;
		for (const RandomPath& path : paths)
			result.push_back(path.at(t));
		return result;
	}
};

void expectBlockEqualsSingle(const PreparedConcrete& concrete, unsigned effects, ConcreteBlockUpdate block)
{
	Random                     random(22);
	Sample                     sample(random, 23); // not a multiple of any width
	std::vector<ConcreteState> single = sample.states;
	for (int k = 1; k <= 150; ++k) {
		const auto strains = sample.strains(k / 150.);
		block(concrete, { sample.energies.data(), sample.bands.data() }, strains.data(), 2e-6, sample.states.data(), strains.size());
		for (std::size_t i = 0; i < single.size(); ++i)
			concreteUpdate(effects)(concrete, { sample.energies[i], sample.bands[i] }, strains[i], 2e-6, single[i]);
	}
	for (std::size_t i = 0; i < single.size(); ++i) {
		const ConcreteState &a = sample.states[i], &b = single[i];
		EXPECT_LE(norm(a.stress - b.stress), 1e-8 * norm(b.stress) + 1e-3) << "effects " << effects << ", element " << i;
		EXPECT_LE(norm(a.plasticStrain - b.plasticStrain), 1e-8 * norm(b.plasticStrain) + 1e-16);
		EXPECT_LE(norm(a.damage - b.damage), 1e-8 * norm(b.damage));
		EXPECT_NEAR(a.stiffening, b.stiffening, 1e-8);
		EXPECT_NEAR(a.closure, b.closure, 1e-8);
		EXPECT_NEAR(a.plasticDissipation, b.plasticDissipation, 1e-7 * std::abs(b.plasticDissipation) + 1e-6);
		EXPECT_NEAR(a.damageDissipation, b.damageDissipation, 1e-7 * std::abs(b.plasticDissipation) + 1e-6);
		EXPECT_NEAR(a.stiffeningEnergy, b.stiffeningEnergy, 1e-7 * std::abs(b.plasticDissipation) + 1e-6);
	}
}

TEST(ConcreteBlock, equalsTheSingleUpdateForEveryMask)
{
	for (unsigned effects = 0; effects <= ConcreteEffects::All; ++effects) {
		expectBlockEqualsSingle(PreparedConcrete(), effects, concreteBlockUpdate(effects));
		expectBlockEqualsSingle(PreparedConcrete(), effects, concreteBlockUpdateBaseline(effects));
	}
}

TEST(ConcreteBlock, equalsTheSingleUpdateForGeneralExponents)
{
	ConcreteParameters general;
	general.flowExponent             = 1.7;
	general.eosExponent              = 0.4;
	general.damageExponent           = 0.8;
	general.frictionPressureExponent = 0.3;
	expectBlockEqualsSingle(PreparedConcrete(general), ConcreteEffects::All, concreteBlockUpdate(ConcreteEffects::All));
}

TEST(ConcreteBlock, neighboursAndPlaceDoNotMatterBitwise)
{
	const PreparedConcrete    concrete;
	const ConcreteBlockUpdate block = concreteBlockUpdate(ConcreteEffects::All);
	Random                    random(23);
	Sample                    forward(random, 23);
	Sample                    backward = forward;
	std::reverse(backward.paths.begin(), backward.paths.end());
	std::reverse(backward.energies.begin(), backward.energies.end());
	std::reverse(backward.bands.begin(), backward.bands.end());
	std::reverse(backward.states.begin(), backward.states.end());
	for (int k = 1; k <= 150; ++k) {
		const auto a = forward.strains(k / 150.), b = backward.strains(k / 150.);
		block(concrete, { forward.energies.data(), forward.bands.data() }, a.data(), 2e-6, forward.states.data(), a.size());
		for (std::size_t i = 0; i < b.size(); ++i) // one at a time
			block(concrete, { &backward.energies[i], &backward.bands[i] }, &b[i], 2e-6, &backward.states[i], 1);
	}
	std::reverse(backward.states.begin(), backward.states.end());
	EXPECT_EQ(std::memcmp(forward.states.data(), backward.states.data(), forward.states.size() * sizeof(ConcreteState)), 0);
}

TEST(ConcreteBlock, unknownEffectIsRefused) { EXPECT_THROW(concreteBlockUpdate(32), std::invalid_argument); }

} // namespace
