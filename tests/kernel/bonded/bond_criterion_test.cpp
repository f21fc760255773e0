// GPL v2 or later, see LICENSE.
// What every criterion of bonds owes, whatever it says.
#include "bond_samples.hpp"

#include <criteria/AllBondCriteria.hpp>
#include <pkg/bonded/kernel/SphereMotion.hpp>

#include <gtest/gtest.h>

#include <random>

namespace {

using namespace bond_samples;

template <class Criterion> class EveryBondCriterion : public testing::Test {
protected:
	using Face = BondCriterionOf<Criterion>;
	const BondCriterion&               criterion = bondCriterion<Criterion>();
	const typename Face::Values standard  = Face::valuesOf(typename Criterion::Parameters());
	const BondMaking                   making { { 30e9, 0.25 }, 2e-3, 1e-3, 1e-3 };
};

template <class... Criteria> using Types = testing::Types<Criteria...>;
TYPED_TEST_SUITE(EveryBondCriterion, AllBondCriteria<Types>);

TYPED_TEST(EveryBondCriterion, isFoundByItsName)
{
	EXPECT_EQ(&bondCriterion(this->criterion.name()), &this->criterion);
}

TYPED_TEST(EveryBondCriterion, refusesParametersOutOfBoundsByName)
{
	this->criterion.check(this->standard, "rock");
	for (std::size_t i = 0; i < this->standard.size(); i++) {
		auto values = this->standard;
		values[i]   = -1;
		try {
			this->criterion.check(values, "rock");
			ADD_FAILURE() << this->criterion.entries()[i].name;
		} catch (const std::invalid_argument& error) {
			EXPECT_EQ(
			        std::string(error.what())
			                .find("rock: " + std::string(this->criterion.entries()[i].name)),
			        0u);
		}
	}
}

/// Loads that are `part` of some that break the bond, and whether they break it with a strength times `factor`.
TYPED_TEST(EveryBondCriterion, twiceTheStrengthBreaksAtTwiceTheLoad)
{
	const auto first = [&](double factor) { // load [N] at which it first leaves what is elastic, or breaks
		const BondStrength strength
		        = this->criterion.strengthOf(this->criterion.scaled(this->standard, factor), this->making);
		const BondSection   section(this->criterion.radius(this->standard, this->making));
		const BondStiffness stiffness = bondStiffness(this->making.elasticity, section, this->making.length);
		for (double load = 1; load < 1e5; load *= 1.0005) {
			BondMemory     memory {};
			BondResultants loads { { load, 0.5 * load, 0 }, { 0, 1e-4 * load, 0 } };
			const auto     answer
			        = this->criterion.advance(strength, memory, section, stiffness, loads);
			if (answer.overload > 0 || loads.force.x < load) return load;
		}
		return 0.;
	};
	EXPECT_GT(first(1), 1);
	EXPECT_NEAR(first(2) / first(1), 2, 2e-3);
}

TYPED_TEST(EveryBondCriterion, theWeakerOfTwoIsAtMostAsStrongAsEach)
{
	const auto weaker
	        = this->criterion.weaker(this->standard, this->criterion.scaled(this->standard, 0.5));
	EXPECT_EQ(weaker, this->criterion.weaker(this->criterion.scaled(this->standard, 0.5), this->standard));
	EXPECT_EQ(weaker, this->criterion.scaled(this->standard, 0.5));
}

TYPED_TEST(EveryBondCriterion, lanesGiveWhatOneBondGives) // the loops against the face, over a few steps of a chain
{
	std::mt19937_64                        engine(2);
	std::uniform_real_distribution<double> unit(-1, 1);
	constexpr int                          count = 11; // bonds: not a whole number of batches
	BondSystem                             system;
	std::vector<BreakableBond>             alone;
	const BondSection   section(this->criterion.radius(this->standard, this->making));
	const BondStiffness stiffness = bondStiffness(this->making.elasticity, section, this->making.length);
	for (int i = 0; i < count; i++) {
		BreakableBond bond { join(stiffness, { 2e-3, 0, 0 }, Quaternion::Identity(), Quaternion::Identity()),
			             &this->criterion, this->criterion.strengthOf(this->standard, this->making), {} };
		bond.bond.sectionRadius = section.radius;
		alone.push_back(bond);
		EXPECT_EQ(system.add(i, i + 1, bond), std::size_t(i));
	}
	system.assemble(count + 1);
	std::vector<double>       pose(std::size_t(sphereRow) * (count + 1)), load(pose.size());
	std::vector<Vector>       x(count + 1);
	std::vector<std::int32_t> overloaded;
	int                       breaks = 0;
	for (const double amplitude : { 1e-7, 1e-6, 3e-6, 3e-5 }) {
		for (int i = 0; i <= count; i++) {
			x[std::size_t(i)] = Vector(2e-3 * i, 0, 0)
			        + amplitude * Vector(unit(engine), unit(engine), unit(engine));
			const double row[8] = { x[std::size_t(i)].x(), x[std::size_t(i)].y(), x[std::size_t(i)].z(), 0,
				                1, 0, 0, 0 };
			std::copy_n(row, 8, pose.begin() + 8 * i);
		}
		const auto energies
		        = system.step(BondConvention::Consistent, true, pose.data(), load.data(), overloaded);
		std::vector<std::int32_t> expected;
		double                    lost = 0, stored = 0;
		for (int i = 0; i < count; i++) {
			BreakableBond& bond = alone[std::size_t(i)];
			BondAnswer     answer {};
			const Vector   branch = x[std::size_t(i) + 1] - x[std::size_t(i)];
			const auto     l      = bondLoads(
                                BondConvention::Consistent, bond.bond, spaceVector(branch),
                                rotation(Quaternion::Identity()), rotation(Quaternion::Identity()),
                                [&](BondResultants& loads) {
                                        answer = this->criterion.advance(
                                                bond.strength, bond.memory, section, stiffness, loads);
                                });
			if (answer.overload > 0) expected.push_back(i);
			lost += answer.lost;
			stored += l.energy;
			EXPECT_NEAR(system.row(std::size_t(i)).force.x, l.force.x, 1e-9 * std::abs(l.force.x) + 1e-9);
			EXPECT_NEAR(system.row(std::size_t(i)).normalStress, answer.stress.normal, 1.);
			for (std::size_t k = 0; k < this->criterion.memoryNames().size(); k++)
				EXPECT_NEAR(system.memoryOf(std::size_t(i))[k], bond.memory[k],
				            1e-8 * std::abs(bond.memory[k]));
		}
		EXPECT_EQ(overloaded, expected);
		EXPECT_NEAR(energies.stored, stored, 1e-8 * stored);
		EXPECT_NEAR(energies.lost, lost, 1e-8 * lost);
		breaks += int(expected.size());
	}
	EXPECT_GT(breaks, 0);
}

TEST(BondSystem, keepsCriteriaApartAndCollectsThemTogether)
{
	// a star: one particle in the middle, bonds of two criteria to others around it, in numbers that fill no batch
	BondSystem                system;
	const BondMaking          making { { 30e9, 0.25 }, 2e-3, 1e-3, 1e-3 };
	const BondSection         section(1e-3);
	const BondStiffness       stiffness = bondStiffness(making.elasticity, section, making.length);
	std::vector<std::size_t>  places;
	std::vector<double>       pose(std::size_t(sphereRow) * 9), load(pose.size());
	const auto                put = [&](int i, const Vector& x) {
                const double row[8] = { x.x(), x.y(), x.z(), 0, 1, 0, 0, 0 };
                std::copy_n(row, 8, pose.begin() + 8 * i);
	};
	put(0, Vector::Zero());
	Vector expected = Vector::Zero();
	for (int i = 1; i <= 8; i++) {
		const std::string    name      = i <= 3 ? "MohrCoulomb" : "SofteningBond";
		const BondCriterion& criterion = bondCriterion(name);
		BondCriterion::Values values;
		for (const ParameterEntry& entry : criterion.entries())
			values.push_back(entry.standard);
		const Vector branch = 2e-3 * Vector(std::cos(i), std::sin(i), 0);
		places.push_back(system.add(
		        0, i,
		        { join(stiffness, branch, Quaternion::Identity(), Quaternion::Identity()), &criterion,
		          criterion.strengthOf(values, making), {} }));
		put(i, branch * (1 + 1e-5));
		expected += stiffness.normal * 1e-5 * branch;
	}
	system.assemble(9);
	EXPECT_EQ(places, (std::vector<std::size_t> { 0, 1, 2, 4, 5, 6, 7, 8 })); // batches of four
	std::vector<std::int32_t> overloaded;
	system.step(BondConvention::Consistent, false, pose.data(), load.data(), overloaded);
	for (int axis = 0; axis < 3; axis++)
		EXPECT_NEAR(load[std::size_t(axis)], expected[axis], 1e-6 * expected.norm());
	EXPECT_THROW(
	        system.step(BondConvention::Esys, false, pose.data(), load.data(), overloaded), std::invalid_argument);
}

TEST(BondCriterion, unknownNamesAreToldWhatThereIs)
{
	try {
		bondCriterion("Tresca");
		FAIL();
	} catch (const std::invalid_argument& error) {
		EXPECT_NE(std::string(error.what()).find("MohrCoulomb"), std::string::npos);
	}
}

} // namespace
