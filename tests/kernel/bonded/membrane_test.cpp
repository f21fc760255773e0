// GPL v2 or later, see LICENSE.
// Pressure of a membrane: no resultant on a closed surface, p dV, and p times the area on a flat face.
#include <pkg/bonded/kernel/Membrane.hpp>

#include <gtest/gtest.h>

#include <omp.h>

namespace {

using namespace yade::ddem;
using Vector = Membrane::Vector;

constexpr double pressure = 3;

/// Nodes on one particle each.
std::vector<Membrane::Support> alone(const std::vector<std::int32_t>& particles)
{
	std::vector<Membrane::Support> supports;
	for (std::size_t i = 0; i < particles.size(); i++)
		supports.push_back({ std::int32_t(i), particles[i], 1 });
	return supports;
}

/// A tetrahedron with its normals outwards, a particle beside each corner.
const std::vector<Membrane::Face> sides { { 0, 2, 1 }, { 0, 1, 3 }, { 1, 2, 3 }, { 0, 3, 2 } };
const std::vector<Vector>         centres { { 0, 0, 0 }, { 2, 0, 0 }, { 0.3, 1.5, 0 }, { 0.2, 0.4, 1.1 } };
const std::vector<Vector>         offsets { { -0.1, 0, 0 }, { 0.1, 0.2, 0 }, { 0, 0, -0.1 }, { 0, 0.1, 0.1 } };

Membrane tetrahedron() { return { sides, {}, alone({ 0, 1, 2, 3 }), offsets }; }

std::vector<Vector> nodes()
{
	std::vector<Vector> places = centres;
	for (std::size_t i = 0; i < 4; i++)
		places[i] += offsets[i];
	return places;
}

/// A flat square of side 1 m in the plane z = 0, n by n nodes on as many particles.
Membrane square(int n, std::vector<Vector>& places)
{
	std::vector<Membrane::Face> faces;
	std::vector<std::int32_t>   carriers;
	for (int j = 0; j < n; j++)
		for (int i = 0; i < n; i++) {
			places.push_back({ double(i) / (n - 1), double(j) / (n - 1), 0 });
			carriers.push_back(n * j + i);
			const int a = n * j + i;
			if (i + 1 == n || j + 1 == n) continue;
			faces.push_back({ a, a + 1, a + n });
			faces.push_back({ a + 1, a + n + 1, a + n });
		}
	return { faces, {}, alone(carriers), std::vector<Vector>(places.size(), Vector::Zero()) };
}

TEST(Membrane, leavesAClosedSurfaceWithoutForceAndMoment)
{
	std::vector<Vector> forces;
	tetrahedron().forces(centres, pressure, forces);
	Vector force = Vector::Zero(), moment = Vector::Zero();
	for (std::size_t i = 0; i < 4; i++) {
		force += forces[i];
		moment += nodes()[i].cross(forces[i]);
	}
	EXPECT_LT(force.norm(), 1e-14);
	EXPECT_LT(moment.norm(), 1e-14);
}

TEST(Membrane, doesTheWorkOfPressureOnVolume) // force = -∂(pV)/∂x, by central differences
{
	Membrane            membrane = tetrahedron();
	std::vector<Vector> forces;
	membrane.forces(centres, pressure, forces);
	for (std::size_t i = 0; i < 4; i++)
		for (int axis = 0; axis < 3; axis++) {
			auto more = centres, less = centres;
			more[i][axis] += 1e-5;
			less[i][axis] -= 1e-5;
			const double slope = (membrane.volume(more) - membrane.volume(less)) / 2e-5;
			EXPECT_NEAR(forces[i][axis], -pressure * slope, 1e-9);
		}
}

TEST(Membrane, enclosesTheVolumeOfATetrahedron) // the triple product over 6, wherever it is
{
	const auto   x        = nodes();
	const double expected = (x[1] - x[0]).cross(x[2] - x[0]).dot(x[3] - x[0]) / 6;
	auto         far      = centres;
	for (Vector& place : far)
		place += Vector(1e3, -2e3, 500);
	EXPECT_NEAR(tetrahedron().volume(centres), expected, 1e-15);
	EXPECT_NEAR(tetrahedron().volume(far), expected, 1e-11);
}

TEST(Membrane, keepsThePressureFromItsEnds)
{
	Membrane whole = tetrahedron();
	Membrane open { { sides[1], sides[2], sides[3] }, { sides[0] }, alone({ 0, 1, 2, 3 }), offsets };
	std::vector<Vector> all, some;
	whole.forces(centres, pressure, all);
	open.forces(centres, pressure, some);
	const auto   x    = nodes();
	const Vector area = 0.5 * (x[2] - x[0]).cross(x[1] - x[0]);
	for (std::size_t i = 0; i < 4; i++)
		EXPECT_LT((all[i] - some[i] - (i < 3 ? -pressure / 3 : 0.) * area).norm(), 1e-14);
	EXPECT_NEAR(open.volume(centres), whole.volume(centres), 1e-15);
}

TEST(Membrane, pressesOnAFlatFaceByPressureTimesArea)
{
	std::vector<Vector> places, forces;
	Membrane            flat = square(5, places);
	flat.forces(places, pressure, forces);
	Vector sum = Vector::Zero();
	for (const Vector& force : forces)
		sum += force;
	EXPECT_LT((sum - Vector(0, 0, -pressure)).norm(), 1e-14);
	EXPECT_NEAR(flat.area(places), 1, 1e-14);
	// a node within bears the cell around it, 1/4 by 1/4 m
	EXPECT_NEAR(forces[6].z(), -pressure / 16, 1e-15);
}

TEST(Membrane, sumsUpOnParticlesThatCarryManyNodes)
{
	std::vector<Vector>         forces;
	std::vector<Vector>         corners { { 0, 0, 0 }, { 1, 0, 0 }, { 1, 1, 0 }, { 0, 1, 0 } };
	Membrane                    one { { { 0, 1, 2 }, { 0, 2, 3 } }, {}, alone({ 0, 0, 0, 0 }), corners };
	one.forces({ { 7, 8, 9 } }, pressure, forces);
	ASSERT_EQ(forces.size(), 1u);
	EXPECT_LT((forces[0] - Vector(0, 0, -pressure)).norm(), 1e-14);
}

TEST(Membrane, doesItsWorkOnSharedNodes) // force = -∂(pV)/∂x, as above, with nodes between particles
{
	Membrane membrane { sides,
		            {},
		            { { 3, 0, 0.2 }, { 0, 0, 1 }, { 3, 2, 0.8 }, { 1, 1, 0.5 }, { 2, 2, 1 }, { 1, 2, 0.5 } },
		            offsets };
	const std::vector<Vector> three(centres.begin(), centres.begin() + 3);
	std::vector<Vector>       forces;
	membrane.forces(three, pressure, forces);
	ASSERT_EQ(forces.size(), 3u);
	for (std::size_t i = 0; i < 3; i++)
		for (int axis = 0; axis < 3; axis++) {
			auto more = three, less = three;
			more[i][axis] += 1e-5;
			less[i][axis] -= 1e-5;
			const double slope = (membrane.volume(more) - membrane.volume(less)) / 2e-5;
			EXPECT_NEAR(forces[i][axis], -pressure * slope, 1e-9);
		}
	EXPECT_LT((forces[0] + forces[1] + forces[2]).norm(), 1e-14);
}

TEST(Membrane, doesNotTwistWhatItEncloses)
{
	std::vector<Vector> forces;
	tetrahedron().forces(centres, pressure, forces); // at centres beside the nodes they have a moment
	const auto   before = forces;
	const Vector axis   = Vector(1, 2, 2) / 3;
	const auto   moment = [&](const Vector& about) {
		double sum = 0;
		for (std::size_t i = 0; i < 4; i++)
			sum += about.dot(centres[i].cross(forces[i]));
		return sum;
	};
	ASSERT_GT(std::abs(moment(axis)), 0.01);
	Membrane::takeMoment(centres, axis, forces);
	EXPECT_NEAR(moment(axis), 0, 1e-14);
	Vector force = Vector::Zero(), middle = Vector::Zero();
	for (std::size_t i = 0; i < 4; i++) {
		force += forces[i];
		middle += 0.25 * centres[i];
	}
	EXPECT_LT(force.norm(), 1e-14);
	// the change is a rotation field: it does no work where nothing turns, as in expansion across the axis
	double work = 0;
	for (std::size_t i = 0; i < 4; i++) {
		const Vector lever = centres[i] - middle;
		work += (forces[i] - before[i]).dot(lever - axis.dot(lever) * axis);
	}
	EXPECT_NEAR(work, 0, 1e-14);
}

TEST(Membrane, givesTheSameBitsOnAnyNumberOfThreads)
{
	std::vector<Vector> places, one, four;
	Membrane            membrane = square(40, places);
	for (std::size_t i = 0; i < places.size(); i++)
		places[i].z() = 0.01 * std::sin(double(i));
	const int before = omp_get_max_threads();
	omp_set_num_threads(1);
	membrane.forces(places, pressure, one);
	omp_set_num_threads(4);
	membrane.forces(places, pressure, four);
	omp_set_num_threads(before);
	for (std::size_t i = 0; i < one.size(); i++)
		EXPECT_TRUE((one[i].array() == four[i].array()).all());
}

TEST(Membrane, knowsHowMuchOfItHasTurned)
{
	std::vector<Vector> places;
	Membrane            flat = square(2, places);
	const std::vector<Vector> normals { { 0, 0, 1 }, { 0, 0, 1 } };
	EXPECT_EQ(flat.turned(places, normals), 0);
	places[0] = { 2, 2, 0 }; // beyond its opposite side, so that its face of now 1.5 m² is inside out
	EXPECT_NEAR(flat.turned(places, normals), 1.5 / 2, 1e-14);
}

TEST(Membrane, refusesNodesThatAreNotThere)
{
	using Faces = std::vector<Membrane::Face>;
	const std::vector<Vector> two(2, Vector::Zero());
	EXPECT_THROW(Membrane(Faces { { 0, 1, 2 } }, {}, alone({ 0, 0 }), two), std::invalid_argument);
	EXPECT_THROW(Membrane({}, Faces { { 0, 1, -1 } }, alone({ 0, 0 }), two), std::invalid_argument);
	EXPECT_THROW(Membrane({}, {}, alone({ 0, 0, 0 }), two), std::invalid_argument);
	EXPECT_THROW(Membrane({}, {}, alone({ 0, -1 }), two), std::invalid_argument);
}

TEST(Membrane, refusesWeightsThatLosePressure)
{
	const std::vector<Vector> one(1, Vector::Zero());
	EXPECT_NO_THROW(Membrane({}, {}, { { 0, 0, 0.25 }, { 0, 1, 0.75 } }, one));
	EXPECT_THROW(Membrane({}, {}, { { 0, 0, 0.25 }, { 0, 1, 0.7 } }, one), std::invalid_argument);
	EXPECT_THROW(Membrane({}, {}, {}, one), std::invalid_argument);
}

} // namespace
