// GPL v2 or later, see LICENSE.
// Friction and walls against runs of ESyS-Particle 2.3.5 (tests/data/esys/README.md).
#include "reference_table.hpp"

#include <pkg/bonded/kernel/BondWall.hpp>
#include <pkg/bonded/kernel/EsysContact.hpp>

#include <gtest/gtest.h>

namespace {

using namespace yade::ddem;
using Eigen::Vector3d;

// two spheres of 1 mm, 1.998 mm apart; one moves round the other without turning, 1e-5 mm a step; units mm, N, ms
TEST(EsysContact, slipsInTheSawToothOfEsys)
{
	const double           distance = 1.998, dt = 1e-5, speed = 1;
	const ContactStiffness stiffness = contactStiffness({ 1e5, 0.25 }, 2);
	ContactMemory          memory;
	double                 angle = 0;
	int                    slips = 0;
	for (auto row : referenceTable("esys/contact_friction.csv")) {
		const Vector3d     n(std::cos(angle), std::sin(angle), 0), t(-n.y(), n.x(), 0);
		const ContactLoads l = esysContactLoads(
		        stiffness, { 0.6, 0.4 }, { n, distance, 1, 1, speed * t, Vector3d::Zero(), Vector3d::Zero() },
		        dt, memory);
		EXPECT_NEAR(l.force.dot(n), row["F1_normal_N"], 1e-6 * 314.16) << row["step"];
		EXPECT_NEAR(l.force.dot(t), row["F1_tangential_N"], 1e-6 * 188.5) << row["step"];
		EXPECT_NEAR(l.moment1.z(), row["M1z_Nmm"], 1e-6 * 188.5) << row["step"];
		EXPECT_NEAR(l.moment2.z(), row["M2z_Nmm"], 1e-6 * 188.5) << row["step"];
		slips += memory.sliding;
		angle += speed * dt / distance;
	}
	EXPECT_EQ(slips, 4); // at steps 301, 401, 501, 601: it sticks again after every slip
}

TEST(EsysContact, booksWhatSlidingTakes)
{
	const ContactStiffness stiffness = contactStiffness({ 1e5, 0.25 }, 2);
	ContactMemory          memory;
	double                 work = 0, lost = 0, before = 0, stored = 0;
	for (int i = 0; i < 1000; i++) {
		const ContactLoads l = esysContactLoads(
		        stiffness, { 0.6, 0.4 },
		        { Vector3d::UnitX(), 1.998, 1, 1, Vector3d::UnitY(), Vector3d::Zero(), Vector3d::Zero() }, 1e-5,
		        memory);
		work += 0.5 * (before + l.force.y()) * 1e-5;
		lost += l.dissipated;
		before = l.force.y();
		stored = memory.energy;
	}
	EXPECT_NEAR(lost + stored, work, 1e-12 * work);
	EXPECT_GT(lost, 0.5 * work);
}

// sphere of 0.7 mm, wall stiffness 1e5 N/mm² (the file's own run; ESyS takes π to ten digits)
TEST(WallRepulsion, isThatOfEsys)
{
	for (auto row : referenceTable("esys/contact_wall.csv"))
		EXPECT_NEAR(
		        wallRepulsion(0.7, 1e5, 0.7 - row["overlap_mm"]), row["F_wall_on_particle_N"],
		        1e-8 * row["F_wall_on_particle_N"]);
}

} // namespace
