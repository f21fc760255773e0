// GPL v2 or later, see LICENSE.
// The bond in ESyS-Particle's convention against two-particle runs of ESyS-Particle 2.3.5 itself
// (tests/data/esys/README.md), and how it differs from ours.
#include "bond_samples.hpp"
#include "reference_table.hpp"

#include <gtest/gtest.h>

namespace {

using namespace bond_samples;

struct TwoParticles {
	Bond        bond;
	MohrCoulomb::Strength<double> strength;
	Vector      branch;
	Quaternion  q1, q2;

	/// A row of a reference file; its units mm, N, MPa hold throughout, since the law has no constants with units.
	explicit TwoParticles(std::map<std::string, double> row)
	        : strength { row["C"], row["tanphi"], row["C"] / row["tanphi"] }
	        , branch(row["x2x"] - row["x1x"], row["x2y"] - row["x1y"], row["x2z"] - row["x1z"])
	        , q1(row["q1w"], row["q1x"], row["q1y"], row["q1z"])
	        , q2(row["q2w"], row["q2x"], row["q2y"], row["q2z"])
	{
		const Vector        first(row["D_x"], row["D_y"], row["D_z"]);
		const BondStiffness stiffness
		        = bondStiffness({ row["E"], row["nu"] }, BondSection(first.norm() / 2), first.norm());
		bond = makeBond(
		        stiffness, row["r1"], row["r2"], spaceVector(first), rotation(Quaternion::Identity()),
		        rotation(Quaternion::Identity()));
	}
	Loads loads(BondConvention convention = BondConvention::Esys) const
	{
		return loadsOf(bond, branch, q1, q2, convention);
	}
};

class EsysBondAgainstEsys : public testing::TestWithParam<const char*> { };

TEST_P(EsysBondAgainstEsys, givesTheSameForcesMomentsAndFailure)
{
	for (auto row : referenceTable(std::string("esys/bond_") + GetParam() + ".csv")) {
		const TwoParticles pair(row);
		const Loads        l         = pair.loads();
		const auto reference = [&row](const std::string& name) {
			return Vector(row["esys_" + name + "x"], row["esys_" + name + "y"], row["esys_" + name + "z"]);
		};
		// ESyS takes γ and θ from acos, whose values near zero are 0, 1.5e-8 and 2.1e-8 rad (cosines
		// 1, 1 - 2^-53, 1 - 2^-52): Fs = ks r0 (γ t - θ/2 e) has that noise.
		const double r0 = row["r1"] + row["r2"], noise = 1.5 * 2.2e-8 * pair.bond.stiffness.shear * r0;
		for (const auto& [name, value, level] :
		     { std::make_tuple("F1", l.force, noise), std::make_tuple("F2", Vector(-l.force), noise),
		       std::make_tuple("M1", l.moment1, noise * r0), std::make_tuple("M2", l.moment2, noise * r0) })
			EXPECT_LE((value - reference(name)).norm(), 1e-6 * reference(name).norm() + level)
			        << name << " of case " << row["case"];
		const BondStress stress = bondStress(BondSection(pair.bond.length / 2), l.section);
		const double over = MohrCoulomb::overload(pair.strength, stress);
		if (std::abs(over) > 2e-6 * pair.strength.cohesion) { // nearer to the limit the noise decides
			EXPECT_EQ(over > 0, row["esys_removed"] != 0) << "case " << row["case"];
		}
	}
}

INSTANTIATE_TEST_SUITE_P(
        Modes, EsysBondAgainstEsys,
        testing::Values("tension", "compression", "shear", "twist", "bend_sym", "bend_p2", "comp_shear"),
        [](const auto& i) { return std::string(i.param); });

// R = 1 mm, L = 2 mm, 0.004 rad: 78.54 N·mm in ESyS-Particle, E I/d0 · 0.004 = 157.08 N·mm in beam theory
TEST(EsysBond, bendsWithHalfOfOurs)
{
	const BondStiffness stiffness = bondStiffness({ 1e5, 0.25 }, BondSection(1), 2);
	const Bond          bond      = join(stiffness, { 2, 0, 0 }, Quaternion::Identity(), Quaternion::Identity());
	const auto          turned = [](double angle) { return Quaternion(Eigen::AngleAxisd(angle, Vector::UnitZ())); };
	EXPECT_NEAR(
	        loadsOf(bond, { 2, 0, 0 }, turned(-0.002), turned(0.002), BondConvention::Esys).moment1.z(), 78.54,
	        0.005);
	EXPECT_NEAR(
	        loadsOf(bond, { 2, 0, 0 }, turned(-0.002), turned(0.002), BondConvention::Consistent).moment1.z(),
	        157.08, 0.005);
}

TEST(EsysBond, isUnderTensionAcrossAGap) // σ = E g/d0
{
	const double        gap = 1e-3, d0 = 2 + gap;
	const BondStiffness stiffness = bondStiffness({ 1e5, 0.25 }, BondSection(d0 / 2), d0);
	const Bond          bond      = makeBond(stiffness, 1, 1, { d0, 0, 0 }, { 1, 0, 0, 0 }, { 1, 0, 0, 0 });
	const auto stress = [&](BondConvention c) {
		return bondStress(
		               BondSection(d0 / 2),
		               bondLoads(c, bond, { d0, 0, 0 }, { 1, 0, 0, 0 }, { 1, 0, 0, 0 }).section)
		        .normal;
	};
	EXPECT_NEAR(stress(BondConvention::Esys), 1e5 * gap / d0, 1e-9);
	EXPECT_EQ(stress(BondConvention::Consistent), 0);
}

// unequal radii that touch; small displacements and one small rotation of both
TEST(EsysBond, agreesWithOursToFirstOrderButForBending)
{
	const double        r1 = 0.7, r2 = 1.3;
	const BondStiffness stiffness = bondStiffness({ 1e5, 0.25 }, BondSection(1), 2);
	const Bond          bond = join(stiffness, { 2, 0, 0 }, Quaternion::Identity(), Quaternion::Identity(), r1);
	const Quaternion    same(Eigen::AngleAxisd(1e-6, Vector(1, 2, 3).normalized()));
	const Loads esys = loadsOf(bond, Vector(2, 0, 0) + 1e-6 * Vector(3, -1, 2), same, same, BondConvention::Esys);
	const Loads         ours = loadsOf(bond, Vector(2, 0, 0) + 1e-6 * Vector(3, -1, 2), same, same);
	EXPECT_LT((esys.force - ours.force).norm(), 1e-5 * ours.force.norm());
	// arms r1, r2 instead of d0/2 = 1
	EXPECT_LT((esys.moment1 / r1 - ours.moment1).norm(), 1e-5 * ours.moment1.norm());
	EXPECT_LT((esys.moment2 / r2 - ours.moment2).norm(), 1e-5 * ours.moment2.norm());
}

/// Work of both particles on a closed path, over the work that went in and out.
double workOnClosedPath(double radius1, BondConvention convention)
{
	const int           steps     = 400;
	const BondStiffness stiffness = bondStiffness({ 1e5, 0.25 }, BondSection(1), 2);
	const Bond bond = join(stiffness, { 2, 0, 0 }, Quaternion::Identity(), Quaternion::Identity(), radius1);
	const auto          at        = [](double t) {
                const Vector     branch = Vector(2, 0, 0) + 2e-3 * Vector(0, std::sin(t), std::cos(2 * t));
		const Quaternion q1(Eigen::AngleAxisd(2e-3 * std::cos(t), Vector::UnitZ())),
		        q2(Eigen::AngleAxisd(2e-3 * std::sin(2 * t + 1), Vector::UnitY()));
		return std::make_tuple(branch, q1, q2);
	};
	const auto spin = [](const Quaternion& from, const Quaternion& to) {
		return Vector(2 * (to * from.conjugate()).vec());
	};
	double     work = 0, gross = 0;
	for (int i = 0; i < steps; i++) {
		const double t             = 2 * M_PI * i / steps, h = 1e-3 * 2 * M_PI / steps;
		const auto [x, q1, q2]     = at(t);
		const auto [xm, q1m, q2m]  = at(t - h);
		const auto [xp, q1p, q2p]  = at(t + h);
		const Loads  l             = loadsOf(bond, x, q1, q2, convention);
		const double power
		        = -l.force.dot(xp - xm) + l.moment1.dot(spin(q1m, q1p)) + l.moment2.dot(spin(q2m, q2p));
		work += power;
		gross += std::abs(power);
	}
	return std::abs(work) / gross;
}

TEST(EsysBond, isConservativeForEqualRadiiOnly)
{
	EXPECT_LT(workOnClosedPath(1, BondConvention::Esys), 1e-3); // up to the second order of the rotations, 2e-3
	EXPECT_GT(workOnClosedPath(0.5, BondConvention::Esys), 0.005);
	EXPECT_LT(workOnClosedPath(0.5, BondConvention::Consistent), 1e-7);
}

} // namespace
