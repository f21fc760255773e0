// GPL v2 or later, see LICENSE.
// What the triangle system refuses, and how it notices a state that is not finite.
#include "../TriangleSamples.hpp"

#include <gtest/gtest.h>

#include <functional>
#include <limits>

namespace {

using namespace yade::ddem;
using namespace yade::ddem::samples;

constexpr double nan = std::numeric_limits<double>::quiet_NaN(), infinity = std::numeric_limits<double>::infinity();

class NotFinite : public testing::TestWithParam<RotationTreatment> {
protected:
	const Mesh mesh = rectangle(20, 15, 0.2, 0.15, 0.25, 13);

	/// The state after a good step, spoilt, and one more step that must throw.
	Motion::Place
	placeAfter(const std::function<void(TriangleSystem&, StepSettings&)>& spoil, unsigned effects) const
	{
		TriangleSystem system = makeSystem(mesh, Material(), GetParam());
		for (Points* points : { &system.motion.node, &system.motion.core })
			points->external.assign(2 * points->size(), 0.);
		system.motion.spin.external.assign(system.motion.spin.size(), 0.);
		agitate(system, 1, 10, 61);
		system.motion.node.inverseMass[2 * 30] = 0;
		system.motion.collectConstraints();
		StepSettings settings = stepOf(1e-7, effects & 1);
		settings.damping      = effects & 2 ? 0.1 : 0;
		settings.gravity      = { 0, effects & 4 ? -9.81 : 0 };
		settings.external     = true;
		EXPECT_NO_THROW(system.step(settings));
		EXPECT_FALSE(system.motion.firstNotFinite().found);
		spoil(system, settings);
		EXPECT_THROW(system.step(settings), std::domain_error);
		return system.motion.firstNotFinite();
	}
};
INSTANTIATE_TEST_SUITE_P(, NotFinite, testing::ValuesIn(allTreatments), [](const auto& test) {
	return name(test.param);
});

TEST_P(NotFinite, isCaughtInTheStepItAppearsAndNamed)
{
	using Spoil            = std::function<void(TriangleSystem&, StepSettings&)>;
	const std::size_t node = 37, triangle = 411;
	for (const double bad : { nan, infinity, -infinity })
		for (unsigned effects = 0; effects < 8; effects++) {
			const Spoil nodeForce
			        = [&](TriangleSystem& s, StepSettings&) { s.motion.node.external[2 * node + 1] = bad; };
			const Spoil coreForce
			        = [&](TriangleSystem& s, StepSettings&) { s.motion.core.external[2 * triangle] = bad; };
			const Spoil nodeVelocity
			        = [&](TriangleSystem& s, StepSettings&) { s.motion.node.velocity[2 * node] = bad; };
			const Spoil prescribed
			        = [&](TriangleSystem& s, StepSettings&) { s.motion.node.velocity[2 * 30] = bad; };
			for (const Spoil& spoil : { nodeForce, nodeVelocity }) {
				const auto place = placeAfter(spoil, effects);
				EXPECT_TRUE(place.found && place.isNode);
				EXPECT_EQ(place.index, node);
			}
			auto place = placeAfter(coreForce, effects);
			EXPECT_TRUE(place.found && !place.isNode);
			EXPECT_EQ(place.index, triangle);
			place = placeAfter(prescribed, effects);
			EXPECT_TRUE(place.found && place.isNode);
			EXPECT_EQ(place.index, 30u);
			// a bad position spoils the forces of its triangles at once
			const auto& corners = mesh.triangle[triangle];
			place = placeAfter(
			        [&](TriangleSystem& s, StepSettings&) { s.motion.core.position[2 * triangle] = bad; },
			        effects);
			EXPECT_TRUE(place.found && place.isNode);
			EXPECT_EQ(place.index, std::size_t(*std::min_element(corners.begin(), corners.end())));
			if (GetParam() != RotationTreatment::Cosserat) continue;
			place = placeAfter(
			        [&](TriangleSystem& s, StepSettings&) { s.motion.spin.external[triangle] = bad; },
			        effects);
			EXPECT_TRUE(place.found && !place.isNode);
			EXPECT_EQ(place.index, triangle);
			EXPECT_TRUE(
			        placeAfter(
			                [&](TriangleSystem& s, StepSettings&) { s.motion.spin.angle[triangle] = bad; },
			                effects)
			                .found);
		}
}

// an inverted or collapsed element pushes back, it does not divide by zero
TEST_P(NotFinite, triangleTurnedInsideOutIsFiniteStill)
{
	const Vertices v      = { { { 0, 0 }, { 2, 0.3 }, { 0.4, 1.1 } } };
	TriangleSystem system = makeSystem(single(v), Material(), GetParam());
	for (std::size_t e = 0; e < 3; e++)
		system.motion.node.position[2 * e + 1] = -0.8 * v[e].y;
	EXPECT_NO_THROW(system.step(stepOf(1e-9)));
	for (std::size_t e = 0; e < 3; e++)
		system.motion.node.position[2 * e + 1] = 0;
	EXPECT_NO_THROW(system.step(stepOf(1e-9)));
}

class Build : public testing::Test {
protected:
	const Mesh     mesh   = rectangle(2, 2, 0.2, 0.2);
	TriangleSystem system = makeSystem(mesh, Material(), RotationTreatment::Cosserat);

	void expectRefusal(const char* word)
	{
		try {
			system.build();
			ADD_FAILURE() << "accepted; expected a word on " << word;
		} catch (const std::logic_error& e) {
			EXPECT_NE(std::string(e.what()).find(word), std::string::npos) << e.what();
		}
	}
};

TEST_F(Build, acceptsWhatIsComplete)
{
	EXPECT_NO_THROW(system.build());
	makeConcrete(system, ConcreteParameters(), 0);
	EXPECT_NO_THROW(system.build());
}
TEST_F(Build, needsACoreForEachTriangle)
{
	system.motion.core.resize(7);
	expectRefusal("core");
}
TEST_F(Build, needsASpinForEachTriangleWhereCoresRotate)
{
	system.motion.spin.resize(7);
	expectRefusal("core");
}
TEST_F(Build, needsGroupsWithoutGap)
{
	system.group[0]->begin = 1;
	expectRefusal("group");
}
TEST_F(Build, needsGroupsThatCoverAll)
{
	system.group[0]->end = 7;
	expectRefusal("cover");
}
TEST_F(Build, needsGroupsThatEndWithTheTriangles)
{
	system.group[0]->end = 9;
	expectRefusal("cover");
}
TEST_F(Build, needsGroups)
{
	system.group.clear();
	expectRefusal("cover");
}
TEST_F(Build, needsNodesThatExist)
{
	system.topology.vertex[2][5] = 9;
	expectRefusal("node");
	system.topology.vertex[2][5] = -1;
	expectRefusal("node");
}
TEST_F(Build, needsGroupsThatHaveStarted)
{
	auto group = makeGroup<ConcreteDamage>(ConcreteParameters(), ConcreteEffects::All);
	group->end = system.triangles();
	EXPECT_THROW(group->start(std::vector<TriangleProperties>(system.triangles() - 1)), std::logic_error);
	system.group = { GroupPointer(std::move(group)) };
	expectRefusal("start");
}
TEST_F(Build, needsAnArmForEachTriangle)
{
	system.topology.arm[3].pop_back();
	expectRefusal("arm");
}
TEST_F(Build, needsThreeCornersForEachTriangle)
{
	system.topology.vertex[1].pop_back();
	expectRefusal("corner");
}
TEST_F(Build, needsPointsWithAllTheirNumbers)
{
	system.motion.node.velocity.resize(17); // of 9 nodes
	expectRefusal("position, velocity, mass");
	system.motion.node.velocity.resize(18);
	system.motion.core.external.resize(3); // neither empty nor two for each
	expectRefusal("external");
}

} // namespace
