// GPL v2 or later, see LICENSE.
// Steps in which a law is not evaluated, since nothing moves; and the energy book over all kinds of held steps.
#include "../LooseTriangles.hpp"

#include <gtest/gtest.h>

#include <limits>

namespace {

using namespace yade::ddem;
using namespace yade::ddem::samples;

double last(const std::vector<double>& v) { return v.back(); }

/// Share of sub-elements whose law is evaluated in a step, seen by its strain being kept.
double evaluatedShare(TriangleSystem& system, const StepSettings& settings, int steps)
{
	const LawGroup&     g = *system.group[0];
	const StateField&   f = *g.field("strain");
	std::vector<double> before, now;
	double              evaluated = 0;
	for (int i = 0; i <= steps; i++) {
		if (i > 0) system.step(settings);
		now.clear();
		for (std::size_t j = 0; j < system.triangles(); j++)
			for (std::size_t k = 0; k < 3; k++) {
				double strain[3];
				g.get(f, j, k, strain);
				now.insert(now.end(), strain, strain + 3);
			}
		for (std::size_t j = 0; i > 0 && j < now.size(); j += 3)
			evaluated += !std::equal(&now[j], &now[j] + 3, &before[j]);
		before.swap(now);
	}
	return evaluated / (3. * double(system.triangles()) * steps);
}

class HeldAtRest : public testing::TestWithParam<RotationTreatment> { };
INSTANTIATE_TEST_SUITE_P(, HeldAtRest, testing::ValuesIn(allTreatments), [](const auto& test) {
	return name(test.param);
});

TEST_P(HeldAtRest, aBlockThatOnlyRoundOffMovesSkipsItsLaw)
{
	for (const double from : { 0., 30. }) { // farther from the origin positions are coarser
		Mesh mesh = rectangle(10, 20, 0.1, 0.2, 0.1);
		for (Point& x : mesh.node)
			x = x + Point { from, -from };
		const StepSettings settings = stepOf(0.5 * criticalStep(mesh, Material(), GetParam()));
		TriangleSystem     system   = makeSystem(mesh, Material(), GetParam());
		makeConcrete(system, ConcreteParameters(), everything);
		agitate(system, 1e-20, 1e-20, 71);
		TriangleSystem without = system;
		without.group[0]->rest = -1;
		run(system, settings, 50);
		run(without, settings, 50);
		EXPECT_LT(evaluatedShare(system, settings, 100), 1e-3);
		EXPECT_GT(evaluatedShare(without, settings, 100), 0.9); // round-off does move it
		agitate(system, 1e-3, 1, 72);
		EXPECT_GT(evaluatedShare(system, settings, 100), 0.9);
	}
}

TEST(HeldSteps, restEndsAtItsBoundAndLosesNoStrain)
{
	// the bound as LawLoops.hpp states it, for this triangle
	const auto boundOf = [](const Loose& sample, std::size_t i) {
		const auto reference = sample.system.topology.reference(i);
		double     arms      = 0;
		for (const Point& r : reference.arm)
			arms += std::abs(r.x) + std::abs(r.y);
		const Point c = centroid(sample.mesh.corners(i));
		return 4 * std::numeric_limits<double>::epsilon() * (std::abs(c.x) + std::abs(c.y) + arms) * arms
		        / reference.twiceSubArea();
	};
	const double dt     = 1e-7;
	Loose        sample = Loose::concrete(23), always = sample;
	always.group().rest = -1;
	const auto at       = [&](double factor) { return [=](std::size_t i) { return crushing(2e-4 + factor, i); }; };
	for (int i = 1; i <= 100; i++) {
		const auto way = [&](std::size_t j) { return crushing(2e-6 * i, j); };
		sample.step(way, dt);
		always.step(way, dt);
	}
	for (std::size_t i = 0; i < 23; i++)
		EXPECT_EQ(sample.outputs(i), always.outputs(i)); // nothing rested
	const double bound = boundOf(sample, 0);
	EXPECT_LT(bound, 1e-11);
	EXPECT_GT(bound, 1e-14);
	const std::vector<double> before  = sample.values("strain", 0, 0),
	                          plastic = sample.values("plasticStrain", 0, 0);
	sample.step(at(0), dt); // where it is
	sample.step(at(0.2 * bound), dt);
	EXPECT_EQ(sample.values("strain", 0, 0), before);
	EXPECT_EQ(sample.values("plasticStrain", 0, 0), plastic);
	EXPECT_NEAR(sample.meanStress(0).yy, always.meanStress(0).yy, 10 * Material().bulk * bound);
	// many steps that are small each: the strain of all of them arrives in the law
	for (int i = 1; i <= 1000; i++)
		sample.step(at(0.2 * bound * i), dt);
	always.step(at(200 * bound), dt);
	const double reached = last(sample.values("strain", 0, 0)), wanted = last(always.values("strain", 0, 0));
	EXPECT_NEAR(reached, wanted, 1.5 * bound);
	EXPECT_GT(std::abs(wanted - last(before)), 10 * bound);
	for (std::size_t c = 0; c < 4; c++)
		EXPECT_NEAR(
		        sample.values("plasticStrain", 0, 0)[c], always.values("plasticStrain", 0, 0)[c], 100 * bound);
}

TEST(HeldSteps, aLongRestDoesNotMakeAnImpactSlow) // the rate is that of the step that leaves the rest
{
	const double dt     = 1e-7;
	Loose        rested = Loose::concrete(5), fresh = rested;
	const auto   still = [](std::size_t) { return PlaneTensor { 0, 0, 0, 0 }; };
	const auto   hit   = [](std::size_t i) { return crushing(1e-4, i); };
	for (int i = 0; i < 1000; i++)
		rested.step(still, 1e-3); // a second
	rested.step(hit, dt);
	fresh.step(hit, dt);
	for (std::size_t i = 0; i < 5; i++)
		EXPECT_EQ(rested.outputs(i), fresh.outputs(i));
}

TEST(HeldSteps, placeDoesNotMatterBitByBit) // neighbours that move, rest, are damaged or wait in the same batch or tile
{
	const auto path = [](int step, std::size_t i) {
		const double t = (i % 3 == 0 && step > 30) ? 30 : step; // every third stops
		return crushing((i % 5 == 0 ? 2e-5 : 2e-6) * t, i) + PlaneTensor { 0, (i % 7) * 1e-16 * step, 0, 0 };
	};
	for (const unsigned interval : { 1u, 3u })
		for (const unsigned mask : { everything, unsigned(ConcreteEffects::Flow) })
			for (const bool energy : { false, true }) {
				constexpr std::size_t count     = 21;
				Loose                 reference = Loose::concrete(count, mask);
				reference.group().flowInterval  = interval;
				for (int s = 1; s <= 61; s++)
					reference.step([&](std::size_t i) { return path(s, i); }, 1e-7, energy);
				for (const std::size_t shift : { 1u, 2u, 3u, 250u }) {
					Loose shifted                = Loose::concrete(count, mask, shift);
					shifted.group().flowInterval = interval;
					for (int s = 1; s <= 61; s++)
						shifted.step(
						        [&](std::size_t i) {
							        return i < shift ? path(s, 1) : path(s, i - shift);
						        },
						        1e-7,
						        energy);
					for (std::size_t i = 0; i < count; i++)
						ASSERT_EQ(reference.outputs(i), shifted.outputs(i + shift))
						        << "interval " << interval << ", mask " << mask << ", triangle "
						        << i << ", moved by " << shift;
				}
			}
}

TEST(HeldSteps, energyBookClosesInEveryStep) // ½(σ_old + σ_new):Δε = Δ(stored + plastic + damage), held or not
{
	const auto path = [](int step, std::size_t i) {
		const double t = (i % 3 == 0 && step > 60 && step < 90) ? 60 : step;
		const double rate = i % 5 == 0 ? 1e-5 : i % 5 == 1 ? -3e-5 : 2e-6; // crushed, torn, and what may wait
		return crushing(rate * (t < 120 ? t : 240 - t), i);
	};
	for (const unsigned interval : { 1u, 4u })
		for (const int opened : { 1, 50, 75, 78 }) { // before, in motion, at rest, while flow waits
			Loose sample                = Loose::concrete(13);
			sample.group().flowInterval = interval;
			const auto energies         = [&](std::size_t i, std::size_t k) {
                                const auto elastic
                                        = sample.tensor("lastStrain", i, k) - sample.tensor("plasticStrain", i, k);
                                return 0.5 * doubleDot(sample.tensor("lastStress", i, k), elastic)
                                        + last(sample.values("stiffeningEnergy", i, k))
                                        + last(sample.values("plasticDissipation", i, k))
                                        + last(sample.values("damageDissipation", i, k));
			};
			double      work[13][3] = {}, first[13][3] = {}, dissipated = 0, damaged = 0;
			PlaneTensor strain[13][3], stress[13][3];
			for (int s = 1; s <= 200; s++) {
				const StepEnergy e
				        = sample.step([&](std::size_t i) { return path(s, i); }, 1e-7, s >= opened);
				double total = 0;
				for (std::size_t i = 0; s >= opened && i < 13; i++)
					for (std::size_t k = 0; k < 3; k++) {
						const PlaneTensor newStrain = sample.tensor("lastStrain", i, k),
						                  newStress = sample.tensor("lastStress", i, k);
						ASSERT_LT(norm(newStrain - path(s, i)), 1e-12) << "step " << s;
						const double now = energies(i, k);
						total += now * sample.system.topology.reference(i).area() / 3;
						if (s > opened) {
							work[i][k] += 0.5
							        * doubleDot(stress[i][k] + newStress,
							                    newStrain - strain[i][k]);
							ASSERT_NEAR(
							        now - first[i][k],
							        work[i][k],
							        1e-9 * (1 + std::abs(now)))
							        << "opened " << opened << ", interval " << interval
							        << ", step " << s << ", triangle " << i;
						} else
							first[i][k] = now;
						strain[i][k] = newStrain;
						stress[i][k] = newStress;
						dissipated   = std::max(
                                                        dissipated, last(sample.values("plasticDissipation", i, k)));
						damaged = std::max(damaged, sample.group().damage(i)[k]);
					}
				if (s >= opened) {
					EXPECT_NEAR(e.elastic + e.plastic + e.damage, total, 1e-10 * total)
					        << "step " << s;
				}
			}
			EXPECT_GT(dissipated, 100); // [J/m³]
			EXPECT_GT(damaged, 0.02);   // so that some lanes of a batch never wait
		}
}

} // namespace
