// GPL v2 or later, see LICENSE.
// Flow that is solved every so many steps.
#include "../LooseTriangles.hpp"

#include <gtest/gtest.h>

#include <functional>

namespace {

using namespace yade::ddem;
using namespace yade::ddem::samples;

double largestModulus() { return Material().lambda() + 2 * Material().shear; }

/// Largest difference of stress [Pa] that an interval makes on a path of strain, against M m Δε [Pa].
struct IntervalError {
	double difference = 0, bound = 0, stress = 0;
};
IntervalError
intervalError(unsigned interval, int steps, double dt, const std::function<PlaneTensor(int, std::size_t)>& path)
{
	IntervalError     error;
	const std::size_t count = 17;
	Loose             every = Loose::concrete(count), some = every;
	some.group().flowInterval = interval;
	for (int s = 1; s <= steps; s++) {
		const auto strain = [&](std::size_t i) { return path(s, i); };
		every.step(strain, dt);
		some.step(strain, dt);
		for (std::size_t i = 0; i < count; i++) {
			error.bound = std::max(
			        error.bound, largestModulus() * interval * norm(path(s, i) - path(s - 1, i)));
			error.difference = std::max(error.difference, norm(every.meanStress(i) - some.meanStress(i)));
			error.stress     = std::max(error.stress, norm(every.meanStress(i)));
		}
	}
	return error;
}

TEST(FlowInterval, errorStaysBelowItsBoundInThreeScenes)
{
	struct Scene {
		const char*                                  name;
		double                                       dt, reversals;
		int                                          steps;
		std::function<PlaneTensor(int, std::size_t)> path;
	};
	const Scene scenes[] = {
		{ "monotone compression", 1e-6, 0, 1500, [](int s, std::size_t i) { return crushing(1e-6 * s, i); } },
		{ "cyclic",
		  1e-6,
		  1,
		  1500,
		  [](int s, std::size_t i) { return crushing(4e-4 * (1 - std::cos(0.0125 * s)), i); } },
		{ "impact",
		  1e-7,
		  0,
		  200,
		  [](int s, std::size_t i) { return crushing(1e-5 * s * std::min(1., s / 40.), i); } },
	};
	for (const Scene& scene : scenes)
		for (const unsigned interval : { 2u, 4u, 8u }) {
			const IntervalError e     = intervalError(interval, scene.steps, scene.dt, scene.path);
			const double        bound = (1 + scene.reversals) * e.bound;
			EXPECT_LT(e.difference, bound) << scene.name << ", interval " << interval;
			EXPECT_GT(e.difference, 1e-3 * bound) << scene.name; // it does wait
			EXPECT_LT(bound, 0.3 * e.stress) << scene.name;
		}
}

TEST(FlowInterval, solvesEveryStepInDamagedSubElements)
{
	const std::size_t count = 9;
	const auto        path  = [](int s, std::size_t i) { return crushing((i < 4 ? -1e-5 : 1e-6) * s, i); };
	Loose             some = Loose::concrete(count), every = some;
	some.group().flowInterval = 5;
	int waited = 0, seen = 0;
	for (int s = 1; s <= 303; s++) {
		const double                       patient = 0.01; // patientDamage
		std::vector<std::array<double, 3>> before;
		for (std::size_t i = 0; i < count; i++)
			before.push_back(some.group().damage(i));
		some.step([&](std::size_t i) { return path(s, i); }, 1e-6);
		every.step([&](std::size_t i) { return path(s, i); }, 1e-6);
		for (std::size_t i = 0; i < count; i++)
			for (std::size_t k = 0; k < 3; k++) {
				const bool evaluated = norm(some.tensor("strain", i, k) - path(s, i)) < 1e-12;
				const bool damaged   = before[i][k] > patient;
				EXPECT_EQ(evaluated, damaged || s % 5 == 0) << "step " << s << ", triangle " << i;
				waited += !evaluated;
				seen += damaged;
			}
	}
	EXPECT_GT(waited, 1000);
	EXPECT_GT(seen, 1000);
	for (std::size_t i = 0; i < count; i++)
		EXPECT_NEAR(some.group().damage(i)[0], every.group().damage(i)[0], 0.02) << i;
}

TEST(FlowInterval, timeOfAllItsStepsCounts) // one step of many times the strain and the time; steps may change
{
	Loose some = Loose::concrete(7), whole = some;
	some.group().flowInterval = 3;
	const auto at             = [](double t) { return [=](std::size_t i) { return crushing(t, i); }; };
	some.step(at(1e-5), 1e-7);
	some.step(at(5e-5), 4e-7);
	some.step(at(1e-4), 5e-7);
	whole.step(at(1e-4), 1e-6);
	for (std::size_t i = 0; i < 7; i++) {
		const auto a = some.outputs(i), b = whole.outputs(i);
		for (std::size_t c = 0; c < a.size(); c++)
			EXPECT_NEAR(a[c], b[c], 1e-14 * std::abs(b[c])) << i; // 1e-7 + 4e-7 + 5e-7 rounds
	}
	EXPECT_THROW(
	        {
		        some.group().flowInterval = 0;
		        some.step(at(1e-4), 1e-7);
	        },
	        std::invalid_argument);
}

TEST(FlowInterval, stressOfTheMomentKnowsTheTimeThatWaited)
{
	const double dt           = 1e-7;
	Loose        some         = Loose::concrete(7, everything);
	some.group().flowInterval = 3;
	for (int s = 1; s <= 50; s++) {
		some.step([&](std::size_t i) { return crushing(5e-6 * s, i); }, dt);
		// the positions of the next step, which solves flow two times of three
		const auto next = [&](std::size_t i) { return crushing(5e-6 * (s + 1), i); };
		if ((s + 1) % 3) continue;
		Loose solved = some;
		solved.place(next);
		const auto told = solved.system.stress(4, dt);
		solved.step(next, dt, true); // the book keeps the stress
		for (std::size_t k = 0; k < 3; k++)
			EXPECT_LT(norm(told[k] - solved.tensor("lastStress", 4, k)), 1e-9 * norm(told[k]))
			        << "step " << s;
	}
}

TEST(FlowInterval, goesOnWithTheSameBitsFromItsClock)
{
	const auto path  = [](int s) { return [=](std::size_t i) { return crushing(5e-6 * s, i); }; };
	Loose      whole = Loose::concrete(9), loaded = whole;
	whole.group().flowInterval = loaded.group().flowInterval = 4;
	for (int s = 1; s <= 30; s++)
		whole.step(path(s), 1e-7 * (1 + s % 3));
	for (const StateField& f : whole.group().fields())
		for (std::size_t i = 0; i < 9; i++)
			for (std::size_t k = 0; k < 3; k++)
				loaded.group().set(
				        *loaded.group().field(f.name), i, k, whole.values(f.name, i, k).data());
	loaded.group().fillUp();
	loaded.group().flowClock = whole.group().flowClock;
	EXPECT_EQ(whole.group().flowClock.steps, 2u);
	for (int s = 31; s <= 60; s++) {
		whole.step(path(s), 1e-7);
		loaded.step(path(s), 1e-7);
	}
	for (std::size_t i = 0; i < 9; i++)
		EXPECT_EQ(whole.outputs(i), loaded.outputs(i));
}

} // namespace
