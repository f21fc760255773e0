// GPL v2 or later, see LICENSE.
// Element loops: SIMD against scalar, tails, and results that depend neither on threads nor on any order.
#include "../TriangleSamples.hpp"


#include <gtest/gtest.h>

#include <omp.h>

#include <numeric>

namespace {

using namespace yade::ddem;
using namespace yade::ddem::samples;

/// Independent elements in random finite deformation, with the arrays that a loop needs.
struct LooseElements {
	static constexpr double untouched = -777;

	std::vector<std::int32_t> vertex[3];
	std::vector<double>       arm[4], nodePosition, corePosition, coreAngle, cornerForce, coreForce, coreMoment;
	Material                  material;

	explicit LooseElements(std::size_t n)
	        : cornerForce(6 * n, untouched)
	        , coreForce(2 * n, untouched)
	        , coreMoment(n, untouched)
	{
		Random random(51);
		std::vector<std::int32_t> places(3 * n); // nodes in random order in memory
		std::iota(places.begin(), places.end(), 0);
		random.shuffle(places);
		nodePosition.resize(6 * n);
		for (std::size_t i = 0; i < n; i++) {
			const Vertices v         = random.skewedTriangle();
			const auto     reference = makeReference(v);
			const double   size = std::sqrt(reference.area()), angle = random.uniform(-10, 10);
			const Point    centre = random.point(10);
			for (std::size_t e = 0; e < 3; e++) {
				const std::int32_t node = places[3 * i + e];
				const Point        x    = centre
				        + PlaneRotation<double> { std::cos(angle), std::sin(angle) }
				                * (reference.arm[e] + random.point(0.1 * size));
				vertex[e].push_back(node);
				nodePosition[2 * std::size_t(node)]     = x.x;
				nodePosition[2 * std::size_t(node) + 1] = x.y;
			}
			for (std::size_t e = 0; e < 2; e++) {
				arm[2 * e].push_back(reference.arm[e].x);
				arm[2 * e + 1].push_back(reference.arm[e].y);
			}
			const Point core = centre + random.point(0.05 * size);
			corePosition.push_back(core.x);
			corePosition.push_back(core.y);
			coreAngle.push_back(angle + random.uniform(-0.2, 0.2));
		}
	}
	std::size_t size() const { return coreAngle.size(); }

	ElementArrays arrays()
	{
		ElementArrays a {};
		for (std::size_t e = 0; e < 3; e++) {
			a.vertex[e]      = vertex[e].data();
			a.cornerForce[e] = cornerForce.data() + 2 * e * size();
		}
		for (std::size_t c = 0; c < 4; c++)
			a.arm[c] = arm[c].data();
		a.nodePosition = nodePosition.data();
		a.corePosition = corePosition.data();
		a.coreAngle    = coreAngle.data();
		a.coreForce    = coreForce.data();
		a.coreMoment   = coreMoment.data();
		return a;
	}
	/// Forces of an elastic group [begin, end).
	StepEnergy apply(RotationTreatment rotation, bool widest, bool energy, std::size_t begin, std::size_t end)
	{
		ElasticParameters parameters;
		parameters.bulk                  = material.bulk;
		parameters.shear                 = material.shear;
		const auto group                 = makeGroup<Elastic>(parameters, 0);
		group->begin                     = begin;
		group->end                       = end;
		group->constants.thickness       = material.thickness;
		group->constants.rotationModulus = material.shear * material.rotationStiffness;
		group->start(std::vector<TriangleProperties>(end - begin));
		group->keepBook(energy, [](std::size_t) { return std::array<PlaneTensor, 3> {}; });
		group->prepare(rotation, widest);
		StepEnergy sum;
		for (std::size_t t = 0; t < group->tiles(); t++)
			group->advance(t, arrays(), 1e-6, sum);
		return sum;
	}
	/// All outputs of element i: three corner forces, core force, moment.
	std::array<double, 9> outputs(std::size_t i) const
	{
		std::array<double, 9> result;
		for (std::size_t c = 0; c < 6; c++)
			result[c] = cornerForce[2 * (c / 2 * size() + i) + c % 2];
		result[6] = coreForce[2 * i];
		result[7] = coreForce[2 * i + 1];
		result[8] = coreMoment[i];
		return result;
	}
};

/// The same element by the scalar functions that the other tests check.
template <class Frame>
std::array<double, 9> byFunctions(const LooseElements& all, std::size_t i, double& elastic, double& rotational)
{
	const TriangleReference<double> reference({ all.arm[0][i], all.arm[1][i] }, { all.arm[2][i], all.arm[3][i] });
	RelativeDisplacements<double>   fromCentre, du;
	for (std::size_t e = 0; e < 3; e++) {
		const auto v  = std::size_t(all.vertex[e][i]);
		fromCentre[e] = { all.nodePosition[2 * v] - all.corePosition[2 * i],
			          all.nodePosition[2 * v + 1] - all.corePosition[2 * i + 1] };
	}
	const auto frame = Frame::rotation(reference, fromCentre, all.coreAngle[i]);
	for (std::size_t e = 0; e < 3; e++)
		du[e] = relativeDisplacement(frame, fromCentre[e], reference.arm[e]);
	const auto                strain = subElementStrains(reference, du);
	SubElementTensors<double> stress;
	for (std::size_t k = 0; k < 3; k++) {
		stress[k] = elasticStress(strain[k], all.material.lambda(), all.material.shear);
		elastic += all.material.thickness * reference.area() / 3 * energyDensity(stress[k], strain[k]);
	}
	auto q = stressForces(reference, stress, all.material.thickness);
	if (Frame::coreRotates) {
		const double turn = rotationStrain(reference, du);
		addRotationForces(
		        reference, (all.material.shear * all.material.rotationStiffness) * turn, all.material.thickness,
		        q);
		rotational += 0.5 * all.material.thickness * reference.area()
		        * (all.material.shear * all.material.rotationStiffness) * turn * turn;
	}
	const auto f = Frame::distribute(reference, fromCentre, frame, du, q);
	return { f.vertex[0].x, f.vertex[0].y, f.vertex[1].x,
		 f.vertex[1].y, f.vertex[2].x, f.vertex[2].y,
		 f.core.x,      f.core.y,      Frame::coreRotates ? f.moment : LooseElements::untouched };
}

class ElementLoops : public testing::TestWithParam<RotationTreatment> {
protected:
	std::array<double, 9>
	expected(const LooseElements& all, std::size_t i, double& elastic, double& rotational) const
	{
		switch (GetParam()) {
			case RotationTreatment::None: return byFunctions<FrameNone>(all, i, elastic, rotational);
			case RotationTreatment::Corotational:
				return byFunctions<FrameCorotational>(all, i, elastic, rotational);
			default: return byFunctions<FrameCosserat>(all, i, elastic, rotational);
		}
	}
};
INSTANTIATE_TEST_SUITE_P(, ElementLoops, testing::ValuesIn(allTreatments), [](const auto& test) {
	return name(test.param);
});

// SIMD width 4: every length and every start of a tail
TEST_P(ElementLoops, agreeWithTheElementFunctionsInAnyPartOfAGroup)
{
	for (const bool energy : { false, true })
		for (const bool widest : { false, true })
			for (std::size_t begin = 0; begin < 5; begin++)
				for (std::size_t end = begin; end < begin + 14; end++) {
					LooseElements    elements(20);
					const StepEnergy sum = elements.apply(GetParam(), widest, energy, begin, end);
					double           elastic = 0, rotational = 0;
					for (std::size_t i = 0; i < elements.size(); i++) {
						const auto got = elements.outputs(i);
						if (i < begin || i >= end) {
							for (const double value : got)
								EXPECT_EQ(value, LooseElements::untouched)
								        << "element " << i << " of [" << begin << ", "
								        << end << ")";
							continue;
						}
						const auto   wanted = expected(elements, i, elastic, rotational);
						const double scale = *std::max_element(
						        wanted.begin(), wanted.end(),
						        [](double a, double b) { return std::abs(a) < std::abs(b); });
						for (std::size_t c = 0; c < 9; c++)
							EXPECT_NEAR(got[c], wanted[c], 1e-12 * std::abs(scale))
							        << "element " << i << " of [" << begin << ", " << end
							        << ")";
					}
					EXPECT_NEAR(sum.elastic, energy ? elastic : 0, 1e-12 * elastic);
					EXPECT_NEAR(sum.rotation, energy ? rotational : 0, 1e-12 * rotational);
				}
}

template <class Frame> void expectWidest(RotationTreatment rotation)
{
	for (const unsigned effects : { 0u, unsigned(LawEffects::Energy) }) {
		const auto wide     = LawLoops<Elastic, Frame, Avx2>::select(effects).law;
		const auto baseline = LawLoops<Elastic, Frame, Baseline>::select(effects).law;
		EXPECT_EQ(
		        selectTileLoops<Elastic>(effects, rotation).law, processorHasAvx2() && wide ? wide : baseline);
		EXPECT_EQ(selectTileLoops<Elastic>(effects, rotation, false).law, baseline);
		EXPECT_NE(wide, baseline);
	}
}

TEST(ElementLoopChoice, takesTheWidestThatTheProcessorHas)
{
	expectWidest<FrameNone>(RotationTreatment::None);
	expectWidest<FrameCorotational>(RotationTreatment::Corotational);
	expectWidest<FrameCosserat>(RotationTreatment::Cosserat);
}

/// Everything that a step changes.
std::vector<double> stateOf(const TriangleSystem& s)
{
	std::vector<double> all;
	for (const auto* part : { &s.motion.node.position,
	                          &s.motion.node.velocity,
	                          &s.motion.node.force,
	                          &s.motion.core.position,
	                          &s.motion.core.velocity,
	                          &s.motion.core.force,
	                          &s.motion.spin.angle,
	                          &s.motion.spin.velocity,
	                          &s.motion.spin.moment })
		all.insert(all.end(), part->begin(), part->end());
	return all;
}

class TriangleOrder : public testing::TestWithParam<RotationTreatment> { };
INSTANTIATE_TEST_SUITE_P(, TriangleOrder, testing::ValuesIn(allTreatments), [](const auto& test) {
	return name(test.param);
});

TEST_P(TriangleOrder, threadsDoNotMatterBitByBit) // 2640 triangles and 1394 nodes: several pieces for each thread
{
	const Mesh   mesh     = rectangle(40, 33, 0.40, 0.33, 0.25, 10);
	StepSettings settings = stepOf(0.5 * criticalStep(mesh, Material(), GetParam()), true);
	settings.gravity      = { 0, -9.81 };
	settings.damping      = 0.1;
	const auto result     = [&](int threads) {
                const int before = omp_get_max_threads();
                omp_set_num_threads(threads);
                TriangleSystem system = makeSystem(mesh, Material(), GetParam());
                agitate(system, 5, 500, 52);
                const StepEnergy e = run(system, settings, 20);
                omp_set_num_threads(before);
                auto state = stateOf(system);
                state.insert(state.end(), { e.kinetic, e.elastic, e.rotation, e.gravityWork, e.dampingLoss });
                return state;
	};
	const auto one = result(1);
	EXPECT_EQ(one, result(2));
	EXPECT_EQ(one, result(4));
	EXPECT_EQ(one, result(1));
}

/// Runs a mesh whose nodes have velocities of their own and returns node positions and triangles' frame angles,
/// in the mesh's order.
struct Outcome {
	std::vector<Point>  node;
	std::vector<double> angle;
};
Outcome motionOf(const Mesh& mesh, const std::vector<Point>& nodeVelocity, RotationTreatment rotation)
{
	TriangleSystem system = makeSystem(mesh, Material(), rotation);
	for (std::size_t v = 0; v < mesh.node.size(); v++) {
		system.motion.node.velocity[2 * v]     = nodeVelocity[v].x;
		system.motion.node.velocity[2 * v + 1] = nodeVelocity[v].y;
	}
	run(system, stepOf(1e-7), 300);
	Outcome result;
	for (std::size_t v = 0; v < mesh.node.size(); v++)
		result.node.push_back({ system.motion.node.position[2 * v], system.motion.node.position[2 * v + 1] });
	for (std::size_t i = 0; i < mesh.triangle.size(); i++)
		result.angle.push_back(system.frameAngle(i));
	return result;
}

struct Scene {
	// 234 triangles: not a multiple of a SIMD width
	Mesh               mesh = rectangle(9, 13, 0.09, 0.13, 0.25, 11);
	std::vector<Point> velocity;
	Scene()
	{
		Random random(53);
		for (std::size_t v = 0; v < mesh.node.size(); v++)
			velocity.push_back(random.point(20)); // strains of 1e-2
	}
};

TEST_P(TriangleOrder, ofTrianglesAndNodesDoesNotMatter)
{
	const Scene               scene;
	const Outcome             plain = motionOf(scene.mesh, scene.velocity, GetParam());
	Random                    random(54);
	std::vector<std::int32_t> nodePlace(scene.mesh.node.size());
	std::vector<std::size_t>  order(scene.mesh.triangle.size());
	std::iota(nodePlace.begin(), nodePlace.end(), 0);
	std::iota(order.begin(), order.end(), std::size_t(0));
	random.shuffle(nodePlace);
	random.shuffle(order);
	Scene other;
	for (std::size_t v = 0; v < nodePlace.size(); v++) {
		other.mesh.node[std::size_t(nodePlace[v])] = scene.mesh.node[v];
		other.velocity[std::size_t(nodePlace[v])]  = scene.velocity[v];
	}
	for (std::size_t i = 0; i < order.size(); i++)
		for (std::size_t e = 0; e < 3; e++) // the first corner is arbitrary as well
			other.mesh.triangle[i][e] = nodePlace[std::size_t(scene.mesh.triangle[order[i]][(e + i) % 3])];
	const Outcome mixed = motionOf(other.mesh, other.velocity, GetParam());
	for (std::size_t v = 0; v < nodePlace.size(); v++) {
		EXPECT_NEAR(mixed.node[std::size_t(nodePlace[v])].x, plain.node[v].x, 1e-14);
		EXPECT_NEAR(mixed.node[std::size_t(nodePlace[v])].y, plain.node[v].y, 1e-14);
	}
	for (std::size_t i = 0; i < order.size(); i++)
		EXPECT_NEAR(mixed.angle[i], plain.angle[order[i]], 1e-12);
}

TEST_P(TriangleOrder, mirroredSceneMovesAsTheMirrorImage)
{
	const Scene   scene;
	const Outcome plain = motionOf(scene.mesh, scene.velocity, GetParam());
	Scene         other = scene;
	for (std::size_t v = 0; v < scene.velocity.size(); v++) {
		other.mesh.node[v].x = -scene.mesh.node[v].x;
		other.velocity[v].x  = -scene.velocity[v].x;
	}
	for (auto& t : other.mesh.triangle)
		std::swap(t[1], t[2]);
	const Outcome mirrored = motionOf(other.mesh, other.velocity, GetParam());
	for (std::size_t v = 0; v < scene.velocity.size(); v++) {
		EXPECT_NEAR(mirrored.node[v].x, -plain.node[v].x, 1e-14);
		EXPECT_NEAR(mirrored.node[v].y, plain.node[v].y, 1e-14);
	}
	for (std::size_t i = 0; i < plain.angle.size(); i++)
		EXPECT_NEAR(mirrored.angle[i], -plain.angle[i], 1e-12);
}

TEST_P(TriangleOrder, turnedSceneMovesAsTheTurnedImage) // no direction of space is special
{
	const Scene            scene;
	const PlaneRotation<double> turn { std::cos(2.), std::sin(2.) };
	const Outcome          plain = motionOf(scene.mesh, scene.velocity, GetParam());
	Scene                  other = scene;
	for (std::size_t v = 0; v < scene.velocity.size(); v++) {
		other.mesh.node[v] = turn * scene.mesh.node[v];
		other.velocity[v]  = turn * scene.velocity[v];
	}
	const Outcome turned = motionOf(other.mesh, other.velocity, GetParam());
	for (std::size_t v = 0; v < scene.velocity.size(); v++) {
		const Point wanted = turn * plain.node[v];
		EXPECT_NEAR(turned.node[v].x, wanted.x, 1e-14);
		EXPECT_NEAR(turned.node[v].y, wanted.y, 1e-14);
	}
	for (std::size_t i = 0; i < plain.angle.size(); i++)
		EXPECT_NEAR(turned.angle[i], plain.angle[i], 1e-12);
}

TEST_P(TriangleOrder, groupsMayBeCutAnywhereAndMixLaws) // the concrete law without effects is elasticity
{
	const Mesh     mesh  = rectangle(20, 15, 0.2, 0.15, 0.25, 12); // 600 triangles
	TriangleSystem whole = makeSystem(mesh, Material(), GetParam());
	agitate(whole, 20, 1000, 55);
	// a group of one, one longer than a tile, an empty one, odd lengths
	const std::size_t ends[] = { 1, 258, 258, 590, 600 };
	TriangleSystem cut = whole, concrete = whole;
	setGroups<Elastic>(cut, Material(), ElasticParameters(), 0, { std::begin(ends), std::end(ends) });
	setGroups<ConcreteDamage>(concrete, Material(), ConcreteParameters(), 0, { std::begin(ends), std::end(ends) });
	for (std::size_t g = 1; g < cut.group.size(); g += 2)
		cut.group[g] = concrete.group[g];
	cut.build();
	const StepSettings settings = stepOf(0.5 * criticalStep(mesh, Material(), GetParam()), true);
	for (int i = 0; i < 50; i++) {
		const StepEnergy a = whole.step(settings), b = cut.step(settings);
		EXPECT_NEAR(a.elastic, b.elastic, 1e-11 * a.kinetic);
		EXPECT_NEAR(a.rotation, b.rotation, 1e-11 * a.kinetic);
		EXPECT_NEAR(a.kinetic, b.kinetic, 1e-11 * a.kinetic);
	}
	// where groups are cut does not change a bit
	EXPECT_EQ(stateOf(whole), stateOf(cut));
	for (const std::size_t i : { std::size_t(0), std::size_t(1), std::size_t(257), std::size_t(258),
	                             std::size_t(589), std::size_t(590), std::size_t(599) }) {
		EXPECT_EQ(&cut.groupOf(i), &*cut.group[i < 1 ? 0 : i < 258 ? 1 : i < 590 ? 3 : 4]);
		const auto   wanted = whole.stress(i), got = cut.stress(i);
		const double roundOff = 0.1; // [Pa] of 1e8
		for (std::size_t k = 0; k < 3; k++) {
			EXPECT_NEAR(got[k].xx, wanted[k].xx, roundOff);
			EXPECT_NEAR(got[k].yy, wanted[k].yy, roundOff);
			EXPECT_NEAR(got[k].zz, wanted[k].zz, roundOff);
			EXPECT_NEAR(got[k].xy, wanted[k].xy, roundOff);
		}
	}
}

// with flow, rate, damage, equation of state and energies
TEST_P(TriangleOrder, concreteElementsFollowTheLawOfOneSubElement)
{
	const Mesh     mesh   = rectangle(10, 15, 0.1, 0.15, 0.25, 14); // 300 triangles
	TriangleSystem system = makeSystem(mesh, Material(), GetParam());
	// an odd start of the second
	setGroups<ConcreteDamage>(system, Material(), ConcreteParameters(), ConcreteEffects::All, { 7, 300 });
	Random              random(56);
	std::vector<double> fractureEnergy;
	for (auto& g : system.group) {
		std::vector<TriangleProperties> all(g->triangles());
		for (auto& properties : all) {
			properties.fractureEnergy = random.uniform(0.2, 2) * ConcreteParameters().fractureEnergy;
			fractureEnergy.push_back(properties.fractureEnergy);
		}
		g->start(all);
	}
	agitate(system, 20, 1000, 57);
	system.build();
	const StepSettings settings = stepOf(0.4 * criticalStep(mesh, Material(), GetParam()), true);
	using State                 = ConcreteState;
	const auto stateIn          = [](const TriangleSystem& s, std::size_t i, std::size_t k) {
                const LawGroup& g = s.groupOf(i);
                State           state {};
                const auto      read = [&](const char* name, double* to) {
                        const StateField* f = g.field(name);
                        if (f) g.get(*f, i - g.begin, k, to);
                };
                double strain[3] = {};
                read("strain", strain);
                state.strain = { strain[0], strain[1], 0, strain[2] };
                read("lastStrain", strain);
                state.lastStrain = { strain[0], strain[1], 0, strain[2] };
                read("plasticStrain", &state.plasticStrain.xx);
                read("damageTensor", &state.damage.xx);
                read("lastStress", &state.stress.xx);
                read("closure", &state.closure);
                read("stiffening", &state.stiffening);
                read("plasticDissipation", &state.plasticDissipation);
                read("damageDissipation", &state.damageDissipation);
                read("stiffeningEnergy", &state.stiffeningEnergy);
                return state;
	};
	const PreparedConcrete law;
	const double           volume  = 0.1 * 0.15;
	double                 plastic = 0, damage = 0;
	for (int step = 0; step < 100; step++) {
		const TriangleSystem before = system;
		const StepEnergy     e      = system.step(settings);
		double               stored = 0;
		plastic = damage = 0;
		for (std::size_t i = 0; i < system.triangles(); i++) {
			const auto strain = before.strain(i);
			for (std::size_t k = 0; k < 3; k++) {
				State       wanted = stateIn(before, i, k);
				const State got    = stateIn(system, i, k);
				advanceConcrete<ConcreteEffects::All>(
				        law, FractureEnergyOf<double>(fractureEnergy[i]), strain[k], settings.dt,
				        wanted);
				const auto close = [&](const PlaneTensor& a, const PlaneTensor& b, double unit) {
					return std::max({ std::abs(a.xx - b.xx), std::abs(a.yy - b.yy),
					                  std::abs(a.zz - b.zz), std::abs(a.xy - b.xy) })
					        < 1e-7 * unit;
				};
				ASSERT_TRUE(close(got.stress, wanted.stress, 1e7))
				        << "step " << step << ", triangle " << i << ", sub-element " << k;
				ASSERT_TRUE(close(got.plasticStrain, wanted.plasticStrain, 1e-3))
				        << "step " << step << ", triangle " << i << ", sub-element " << k;
				ASSERT_TRUE(close(got.damage, wanted.damage, 1))
				        << "step " << step << ", triangle " << i << ", sub-element " << k;
				const double share = system.topology.reference(i).area() / 3;
				stored += share * storedEnergy(got);
				plastic += share * got.plasticDissipation;
				damage += share * got.damageDissipation;
			}
		}
		EXPECT_NEAR(e.elastic, stored, 1e-12 * stored + 1e-12);
		EXPECT_NEAR(e.plastic, plastic, 1e-12 * plastic + 1e-12);
		EXPECT_NEAR(e.damage, damage, 1e-12 * damage + 1e-12);
	}
	EXPECT_GT(plastic / volume, 1); // [J/m³]: all of it has been at work
	EXPECT_GT(damage / volume, 1);
}

} // namespace
