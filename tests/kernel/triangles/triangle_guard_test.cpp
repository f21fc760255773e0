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
	TriangleSystem::Place placeAfter(const std::function<void(TriangleSystem&, StepSettings&)>& spoil, unsigned effects) const
	{
		TriangleSystem system = makeSystem(mesh, Material(), GetParam());
		for (Points* points : { &system.node, &system.core })
			points->external.assign(2 * points->size(), 0.);
		system.spin.external.assign(system.spin.size(), 0.);
		agitate(system, 1, 10, 61);
		system.node.inverseMass[2 * 30] = 0;
		system.collectConstraints();
		StepSettings settings = stepOf(1e-7, effects & 1);
		settings.damping      = effects & 2 ? 0.1 : 0;
		settings.gravity      = { 0, effects & 4 ? -9.81 : 0 };
		settings.external     = true;
		EXPECT_NO_THROW(system.step(settings));
		EXPECT_FALSE(system.firstNotFinite().found);
		spoil(system, settings);
		EXPECT_THROW(system.step(settings), std::domain_error);
		return system.firstNotFinite();
	}
};
INSTANTIATE_TEST_SUITE_P(, NotFinite, testing::ValuesIn(allTreatments), [](const auto& test) { return name(test.param); });

TEST_P(NotFinite, isCaughtInTheStepItAppearsAndNamed)
{
	using Spoil            = std::function<void(TriangleSystem&, StepSettings&)>;
	const std::size_t node = 37, triangle = 411;
	for (const double bad : { nan, infinity, -infinity })
		for (unsigned effects = 0; effects < 8; effects++) {
			const Spoil nodeForce    = [&](TriangleSystem& s, StepSettings&) { s.node.external[2 * node + 1] = bad; };
			const Spoil coreForce    = [&](TriangleSystem& s, StepSettings&) { s.core.external[2 * triangle] = bad; };
			const Spoil nodeVelocity = [&](TriangleSystem& s, StepSettings&) { s.node.velocity[2 * node] = bad; };
			const Spoil prescribed   = [&](TriangleSystem& s, StepSettings&) { s.node.velocity[2 * 30] = bad; };
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
			place               = placeAfter([&](TriangleSystem& s, StepSettings&) { s.core.position[2 * triangle] = bad; }, effects);
			EXPECT_TRUE(place.found && place.isNode);
			EXPECT_EQ(place.index, std::size_t(*std::min_element(corners.begin(), corners.end())));
			if (GetParam() != RotationTreatment::Cosserat) continue;
			place = placeAfter([&](TriangleSystem& s, StepSettings&) { s.spin.external[triangle] = bad; }, effects);
			EXPECT_TRUE(place.found && !place.isNode);
			EXPECT_EQ(place.index, triangle);
			EXPECT_TRUE(placeAfter([&](TriangleSystem& s, StepSettings&) { s.spin.angle[triangle] = bad; }, effects).found);
		}
}

TEST_P(NotFinite, triangleTurnedInsideOutIsFiniteStill) // an inverted or collapsed element pushes back, it does not divide by zero
{
	const Vertices v      = { { { 0, 0 }, { 2, 0.3 }, { 0.4, 1.1 } } };
	TriangleSystem system = makeSystem(single(v), Material(), GetParam());
	for (std::size_t e = 0; e < 3; e++)
		system.node.position[2 * e + 1] = -0.8 * v[e].y;
	EXPECT_NO_THROW(system.step(stepOf(1e-9)));
	for (std::size_t e = 0; e < 3; e++)
		system.node.position[2 * e + 1] = 0;
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
	void makeConcrete()
	{
		system.concrete     = { ConcreteGroupLaw { PreparedConcrete(), 0 } };
		system.group[0].law = TriangleGroup::Law::Concrete;
		system.concreteState.resize(3 * system.triangles());
		system.fractureEnergy.assign(system.triangles(), 80e3);
	}
};

TEST_F(Build, acceptsWhatIsComplete)
{
	EXPECT_NO_THROW(system.build());
	system.fractureEnergy.clear(); // elastic groups need none
	EXPECT_NO_THROW(system.build());
	makeConcrete();
	EXPECT_NO_THROW(system.build());
}
TEST_F(Build, needsACoreForEachTriangle)
{
	system.core.resize(7);
	expectRefusal("core");
}
TEST_F(Build, needsASpinForEachTriangleWhereCoresRotate)
{
	system.spin.resize(7);
	expectRefusal("core");
}
TEST_F(Build, needsGroupsWithoutGap)
{
	system.group[0].begin = 1;
	expectRefusal("group");
}
TEST_F(Build, needsGroupsThatCoverAll)
{
	system.group[0].end = 7;
	expectRefusal("cover");
}
TEST_F(Build, needsGroupsThatEndWithTheTriangles)
{
	system.group[0].end = 9;
	expectRefusal("cover");
}
TEST_F(Build, needsGroups)
{
	system.group.clear();
	expectRefusal("cover");
}
TEST_F(Build, needsNodesThatExist)
{
	system.vertex[2][5] = 9;
	expectRefusal("node");
	system.vertex[2][5] = -1;
	expectRefusal("node");
}
TEST_F(Build, needsTheConcreteMaterial)
{
	makeConcrete();
	system.group[0].concrete = 1;
	expectRefusal("material");
}
TEST_F(Build, needsConcreteStates)
{
	makeConcrete();
	system.concreteState.pop_back();
	expectRefusal("states");
}
TEST_F(Build, needsFractureEnergiesOfConcrete)
{
	makeConcrete();
	system.fractureEnergy.pop_back();
	expectRefusal("fracture energies");
}
TEST_F(Build, needsAnArmForEachTriangle)
{
	system.arm[3].pop_back();
	expectRefusal("arm");
}
TEST_F(Build, needsThreeCornersForEachTriangle)
{
	system.vertex[1].pop_back();
	expectRefusal("corner");
}
TEST_F(Build, needsPointsWithAllTheirNumbers)
{
	system.node.velocity.pop_back();
	expectRefusal("position, velocity, mass");
	system.node.velocity.push_back(0);
	system.core.external.resize(3); // neither empty nor two for each
	expectRefusal("external");
}

} // namespace
