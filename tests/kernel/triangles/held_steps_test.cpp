// GPL v2 or later, see LICENSE.
// Steps in which a law is not evaluated: at rest, while flow waits, and below a threshold.
#include "../TriangleSamples.hpp"

#include <pkg/ddem/kernel/triangles/PointOf.hpp>
#include <laws/AllLaws.hpp>

#include <gtest/gtest.h>

#include <functional>
#include <limits>

namespace {

using namespace yade::ddem;
using namespace yade::ddem::samples;

constexpr unsigned everything = ConcreteEffects::All & ~unsigned(ConcreteEffects::Energy);

/// Loose triangles about 5 mm wide within 0.3 m of the origin, whose strains are prescribed.
struct Loose {
	using Strain = std::function<PlaneTensor(std::size_t triangle)>;

	Mesh           mesh;
	TriangleSystem system;
	double         largestStep = 0; ///< largest change of a strain component in a step so far [-]

	template <class Law> static Loose of(std::size_t count, unsigned mask, std::size_t first = 0)
	{
		Loose  sample;
		Random random(31);
		for (std::size_t i = 0; i < first + count; i++) {
			const Vertices v { { { 0, 0 }, { 5e-3, 1e-3 }, { 2e-3, 4e-3 } } };
			const Point    place { i < first ? 0.2 : random.uniform(-0.3, 0.3),
                                            i < first ? 0.1 : random.uniform(-0.3, 0.3) };
			for (const Point& corner : v)
				sample.mesh.node.push_back(place + corner);
			const auto n = std::int32_t(3 * i);
			sample.mesh.triangle.push_back({ n, n + 1, n + 2 });
		}
		sample.system = makeSystem(sample.mesh, Material(), RotationTreatment::Cosserat);
		setGroups<Law>(sample.system, Material(), typename Law::Parameters(), mask, { first + count });
		for (Points* points : { &sample.system.motion.node, &sample.system.motion.core })
			std::fill(points->inverseMass.begin(), points->inverseMass.end(), 0.);
		std::fill(
		        sample.system.motion.spin.inverseInertia.begin(),
		        sample.system.motion.spin.inverseInertia.end(),
		        0.);
		sample.system.motion.collectConstraints();
		return sample;
	}
	static Loose concrete(std::size_t count, unsigned mask = everything, std::size_t first = 0)
	{
		return of<ConcreteDamage>(count, mask, first);
	}
	LawGroup& group() { return *system.group[0]; }

	void place(const Strain& strainOf)
	{
		for (std::size_t i = 0; i < mesh.triangle.size(); i++) {
			const PlaneTensor s      = strainOf(i);
			const Point       centre = centroid(mesh.corners(i));
			const auto        moved  = [&](const Point& x) {
                                const Point r = x - centre;
                                return centre + Point { s.xx * r.x + s.xy * r.y, s.xy * r.x + s.yy * r.y } + r;
			};
			for (const std::int32_t v : mesh.triangle[i]) {
				const Point x                                       = moved(mesh.node[std::size_t(v)]);
				system.motion.node.position[2 * std::size_t(v)]     = x.x;
				system.motion.node.position[2 * std::size_t(v) + 1] = x.y;
			}
			system.motion.core.position[2 * i]     = centre.x;
			system.motion.core.position[2 * i + 1] = centre.y;
		}
	}
	StepEnergy step(const Strain& strainOf, double dt, bool energy = false)
	{
		place(strainOf);
		return system.step(stepOf(dt, energy));
	}
	std::vector<double> values(const std::string& name, std::size_t triangle, std::size_t k) const
	{
		const LawGroup&     g = *system.group[0];
		const StateField*   f = g.field(name);
		std::vector<double> v(f->components());
		g.get(*f, triangle, k, v.data());
		return v;
	}
	PlaneTensor tensor(const std::string& name, std::size_t triangle, std::size_t k) const
	{
		const auto v = values(name, triangle, k);
		return v.size() == 3 ? PlaneTensor { v[0], v[1], 0, v[2] } : PlaneTensor { v[0], v[1], v[2], v[3] };
	}
	/// All forces on the corners and the core of a triangle, and its state.
	std::vector<double> outputs(std::size_t row) const
	{
		std::vector<double> all;
		const Motion&       m = system.motion;
		for (std::size_t c = 0; c < 6; c++)
			all.push_back(m.node.force[6 * row + c]);
		all.insert(all.end(), { m.core.force[2 * row], m.core.force[2 * row + 1], m.spin.moment[row] });
		for (const StateField& f : system.group[0]->fields())
			for (std::size_t k = 0; k < 3; k++)
				for (const double v : values(f.name, row, k))
					all.push_back(v);
		return all;
	}
	/// Stress in the triangle as its forces tell [Pa]: Σ x ⊗ f over the corners, without the rotation part.
	PlaneTensor meanStress(std::size_t i) const
	{
		double      xx = 0, yy = 0, xy = 0;
		const auto& m      = system.motion;
		const Point centre = { m.core.position[2 * i], m.core.position[2 * i + 1] };
		for (std::size_t v = 3 * i; v < 3 * i + 3; v++) {
			const Point r { m.node.position[2 * v] - centre.x, m.node.position[2 * v + 1] - centre.y };
			xx -= r.x * m.node.force[2 * v];
			yy -= r.y * m.node.force[2 * v + 1];
			xy -= 0.5 * (r.x * m.node.force[2 * v + 1] + r.y * m.node.force[2 * v]);
		}
		const double volume = system.topology.reference(i).area();
		return { xx / volume, yy / volume, 0, xy / volume };
	}
};

/// Compression with shear that differs from triangle to triangle.
PlaneTensor crushing(double t, std::size_t i)
{
	const double share = double(i % 17) / 17;
	return { 0.3 * t * share, -t, 0, 0.3 * t * (1 - share) };
}

double last(const std::vector<double>& v) { return v.back(); }

// --- rest

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

// --- flow that waits

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

// --- thresholds

template <class Law> class Threshold : public testing::Test {
};
template <class... Laws> struct TypesOf {
	using Type = testing::Types<Laws...>;
};
TYPED_TEST_SUITE(Threshold, AllLaws<TypesOf>::Type);

TYPED_TEST(Threshold, isCrossedWithTheBitsOfTheLaw)
{
	if constexpr (!TypeParam::hasThreshold(0)) GTEST_SKIP() << "this law has none";
	else {
		// Two samples of two tiles. In one of them every tile has a triangle beyond the threshold, so it runs
		// the law.
		const auto amplitude
		        = [](std::size_t i) { return i % 256 == 7 ? 5e-2 : 2e-2 * (1 + double(i % 13)) / 13; };
		const auto path = [](double t, double size, std::size_t i) {
			const double phase = 0.3 * double(i);
			return (size * t) * PlaneTensor { std::sin(phase), std::cos(phase), 0, std::sin(2 * phase) };
		};
		Loose      below = Loose::of<TypeParam>(300, 0), law = below;
		const auto go = [&](double t) {
			below.step([&](std::size_t i) { return path(t, i % 256 == 7 ? 1e-6 : amplitude(i), i); }, 1e-7);
			law.step([&](std::size_t i) { return path(t, amplitude(i), i); }, 1e-7);
		};
		law.step([&](std::size_t i) { return path(i % 256 == 7 ? 1 : 1e-9, amplitude(i), i); }, 1e-7);
		const auto reached = [&](const Loose& sample) {
			// a state that has changed
			std::size_t count = 0;
			for (std::size_t i = 0; i < 300; i++) {
				const Loose virgin = Loose::of<TypeParam>(1, 0);
				for (const StateField& f : virgin.system.group[0]->fields())
					if (sample.values(f.name, i, 1) != virgin.values(f.name, 0, 1)) {
						count++;
						break;
					}
			}
			return count;
		};
		EXPECT_EQ(reached(below), 0u);
		EXPECT_EQ(reached(law), 2u);
		for (int s = 1; s <= 100; s++) {
			go(s == 1 ? 1e-3 : 0.01 * s);
			for (std::size_t i = 0; i < 300; i++)
				if (i % 256 != 7) {
					ASSERT_EQ(below.outputs(i), law.outputs(i))
					        << "step " << s << ", triangle " << i;
				}
			if (s == 1) {
				EXPECT_EQ(reached(below), 0u);
			}
		}
		EXPECT_GT(reached(below), 100u);
	}
}

TYPED_TEST(
        Threshold, leavesTheStateAloneBelow) // what the loop for virgin tiles relies on: the law itself says the same
{
	if constexpr (!TypeParam::hasThreshold(0)) GTEST_SKIP() << "this law has none";
	else {
		typename TypeParam::Parameters     parameters;
		const typename TypeParam::Prepared law(parameters);
		const TriangleProperties           properties(1e-6, -1, 1, { 0, 0, 0, 0 });
		const auto                         own    = TypeParam::propertiesOf(law, properties);
		const auto                         virgin = TypeParam::virgin(law, properties);
		Random                             random(77);
		int                                below = 0, beyond = 0;
		for (int i = 0; i < 20000; i++) {
			const double      size = std::pow(10., random.uniform(-6, -2));
			const PlaneTensor strain {
				random.uniform(-size, size), random.uniform(-size, size), 0, random.uniform(-size, size)
			};
			auto                state  = virgin;
			const PlaneTensor   stress = TypeParam::template advance<0>(law, own, strain, 1e-7, state);
			const bool          maybe  = TypeParam::template beyondThreshold<0>(law, own, strain);
			std::vector<double> was(100), is(100);
			auto                copy = virgin;
			TypeParam::template fields<0>(copy, StoreFields<double> { was.data(), 1 });
			TypeParam::template fields<0>(state, StoreFields<double> { is.data(), 1 });
			const bool changed = was != is;
			(maybe ? beyond : below)++;
			EXPECT_FALSE(changed && !maybe)
			        << "strain " << strain.xx << ", " << strain.yy << ", " << strain.xy;
			EXPECT_FALSE(maybe && !changed) << "strain " << strain.xx << ", " << strain.yy << ", "
			                                << strain.xy; // not early, but for rounding
			if (!maybe) {
				EXPECT_EQ(norm(stress - elasticStress(law.lambda, law.twoShear, strain)), 0);
			}
		}
		EXPECT_GT(below, 2000);
		EXPECT_GT(beyond, 2000);
	}
}

TYPED_TEST(Threshold, isFoundAgainAfterTheBookWasClosedAndAfterLoading)
{
	if constexpr (!TypeParam::hasThreshold(0)) GTEST_SKIP() << "this law has none";
	else {
		const auto path = [](int s) {
			return [=](std::size_t i) {
				return (1e-5 * s * (1 + double(i % 7))) * PlaneTensor { 1, -0.3, 0, 0.5 };
			};
		};
		Loose booked = Loose::of<TypeParam>(20, 0), plain = booked;
		for (int s = 1; s <= 150; s++) {
			booked.step(path(s), 1e-7, s < 2 || (s > 40 && s < 90));
			plain.step(path(s), 1e-7);
			if (s == 60) { // loaded in the middle
				Loose loaded = Loose::of<TypeParam>(20, 0);
				for (const StateField& f : plain.group().fields())
					for (std::size_t i = 0; i < 20; i++)
						for (std::size_t k = 0; k < 3; k++)
							loaded.group().set(
							        *loaded.group().field(f.name),
							        i,
							        k,
							        plain.values(f.name, i, k).data());
				loaded.group().fillUp();
				plain = loaded;
			}
		}
		for (const StateField& f : plain.group().fields()) // without the book's
			for (std::size_t i = 0; i < 20; i++)
				for (std::size_t c = 0; c < f.components();
				     c++) // the book's loop may round in another way
					EXPECT_NEAR(
					        plain.values(f.name, i, 0)[c], booked.values(f.name, i, 0)[c], 1e-13)
					        << f.name;
	}
}

} // namespace
