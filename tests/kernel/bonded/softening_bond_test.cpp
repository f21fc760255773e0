// GPL v2 or later, see LICENSE.
// A bond that softens: straight line, stated energies per area, unloading to the origin, closed book.
#include <pkg/bonded/kernel/BondCriterionOf.hpp>
#include <pkg/bonded/kernel/criteria/SofteningBond.hpp>

#include <gtest/gtest.h>

#include <functional>
#include <random>

namespace {

using namespace yade::ddem;

const BondMaking    making { { 30e9, 0.25 }, 2e-3, 1e-3, 1e-3 };
const BondSection   section { 1e-3 };
const BondStiffness stiffness = bondStiffness(making.elasticity, section, making.length);

SofteningBond::Parameters parameters()
{
	SofteningBond::Parameters p; // C = 20 MPa, 30°, cut-off 10 MPa
	p.tensionEnergy = 60;
	p.shearEnergy   = 400;
	return p;
}

/// A bond on a path of elastic loads, which are stiffness times separation.
struct Path {
	explicit Path(const SofteningBond::Parameters& p) : strength(SofteningBond::strengthOf(p, making)) { }

	/// One step to these separations [m] and rotations [rad] of the section.
	BondAnswer step(const SpaceVector<double>& stretch, const SpaceVector<double>& turn)
	{
		load = { { stiffness.normal * stretch.x, stiffness.shear * stretch.y, stiffness.shear * stretch.z },
			 { stiffness.torsion * turn.x, stiffness.bending * turn.y, stiffness.bending * turn.z } };
		const BondAnswer answer = SofteningBond::advance(strength, memory, section, stiffness, load);
		const auto       middle = [](double a, double b) { return 0.5 * (a + b); };
		const auto       power  = [&](const SpaceVector<double>& now, const SpaceVector<double>& then,
                                       const SpaceVector<double>& to, const SpaceVector<double>& from) {
                        return middle(now.x, then.x) * (to.x - from.x) + middle(now.y, then.y) * (to.y - from.y)
                                + middle(now.z, then.z) * (to.z - from.z);
		};
		work += power(load.force, last.force, stretch, lastStretch)
		        + power(load.moment, last.moment, turn, lastTurn);
		stored = 0.5 * (dot(load.force, stretch) + dot(load.moment, turn));
		lost += answer.lost;
		last        = load;
		lastStretch = stretch;
		lastTurn    = turn;
		return answer;
	}
	/// Pulls, shears, bends or twists up to a given largest separation. \returns the largest load on the way
	double drive(const SpaceVector<double>& stretch, const SpaceVector<double>& turn, int steps = 20000)
	{
		double largest = 0;
		for (int i = 1; i <= steps; i++) {
			const double     part   = double(i) / steps;
			const BondAnswer answer = step(part * stretch, part * turn);
			largest = std::max({ largest, norm(load.force), norm(load.moment) });
			if (answer.overload > 0) {
				gone = part;
				return largest;
			}
		}
		return largest;
	}

	SofteningBond::Strength<double> strength;
	SofteningBond::Memory<double>   memory {};
	BondResultants                  load {}, last {};
	SpaceVector<double>             lastStretch { 0, 0, 0 }, lastTurn { 0, 0, 0 };
	double                          work = 0, stored = 0, lost = 0, gone = 0;
};

TEST(SofteningBond, takesItsEnergyPerAreaInPureTension) // f_t δ_u/2 = G: δ_u = 2 G/f_t = 12 µm
{
	Path         bond(parameters());
	const double largest = bond.drive({ 15e-6, 0, 0 }, {});
	EXPECT_NEAR(largest / section.area, 10e6, 1e-3 * 10e6);
	EXPECT_NEAR(bond.gone * 15e-6, 12e-6, 15e-6 / 20000 * 1.01);
	EXPECT_NEAR(bond.lost, 60 * section.area, 1e-4 * 60 * section.area);
	EXPECT_NEAR(bond.work, bond.lost + bond.stored, 1e-6 * bond.work);
}

TEST(SofteningBond, fallsAlongAStraightLine)
{
	Path         bond(parameters());
	const double first = 10e6 * making.length / 30e9, end = 12e-6;
	for (double opening = 0; opening < end; opening += 0.05e-6) {
		bond.step({ opening, 0, 0 }, {});
		const double expected = opening < first ? 30e9 * opening / making.length
		                                        : 10e6 * (end - opening) / (end - first);
		EXPECT_NEAR(bond.load.force.x / section.area, expected, 1e-6 * 10e6) << opening;
	}
}

TEST(SofteningBond, takesItsEnergyPerAreaInPureShear)
{
	Path         bond(parameters());
	const double largest = bond.drive({ 0, 30e-6, 40e-6 }, {}); // δ_u = 2 G_II/C = 40 µm
	EXPECT_NEAR(largest / section.area, 20e6, 1e-3 * 20e6);
	EXPECT_NEAR(bond.gone * 50e-6, 40e-6, 50e-6 / 20000 * 1.01);
	EXPECT_NEAR(bond.lost, 400 * section.area, 1e-4 * 400 * section.area);
}

TEST(SofteningBond, takesAQuarterInBending) // ∫σ²dA of a round section is a quarter of A σ_rim²
{
	Path bond(parameters());
	bond.drive({ 0, 0, 0 }, { 0, 0.02, 0 });
	ASSERT_GT(bond.gone, 0);
	EXPECT_NEAR(bond.lost, 15 * section.area, 1e-3 * 15 * section.area);
}

TEST(SofteningBond, shearUnderPressureTakesMoreAsTheSquareOfItsStrength)
{
	Path         bond(parameters());
	const double press = -30e6 * making.length / 30e9; // strength 20 + 30 tan 30° = 37.3 MPa
	double       largest = 0;
	for (int i = 0; i <= 40000; i++) {
		const BondAnswer answer = bond.step({ press, 120e-6 * i / 40000, 0 }, {});
		largest                 = std::max(largest, std::abs(bond.load.force.y));
		if (answer.overload > 0) break;
	}
	const double strength = 20e6 + 30e6 * std::tan(M_PI / 6);
	EXPECT_NEAR(largest / section.area, strength, 2e-3 * strength);
	EXPECT_NEAR(bond.lost, 400 * section.area * std::pow(strength / 20e6, 2), 2e-3 * bond.lost);
	EXPECT_NEAR(bond.load.force.x, -30e6 * section.area, 1e-9 * 30e6 * section.area); // pressure is borne in full
}

TEST(SofteningBond, unloadsToTheOriginAndClosesStiff)
{
	Path bond(parameters());
	bond.drive({ 6e-6, 0, 0 }, {}, 1000);
	const double top = bond.load.force.x;
	bond.step({ 3e-6, 0, 0 }, {});
	EXPECT_NEAR(bond.load.force.x, top / 2, 1e-9 * top);
	const double before = bond.lost;
	bond.step({ -1e-6, 0, 0 }, {});
	EXPECT_NEAR(bond.load.force.x, -stiffness.normal * 1e-6, 1e-9 * stiffness.normal * 1e-6);
	EXPECT_EQ(bond.lost, before);
}

TEST(SofteningBond, anyPathClosesItsBookAndOnlyDissipates)
{
	std::mt19937_64                        engine(3);
	std::uniform_real_distribution<double> unit(-1, 1);
	int                                    broke = 0;
	for (int path = 0; path < 300; path++) {
		Path                bond(parameters());
		SpaceVector<double> stretch { 0, 0, 0 }, turn { 0, 0, 0 };
		double              lost = 0;
		bool                gone = false;
		for (int leg = 0; leg < 8 && !gone; leg++) {
			const SpaceVector<double> to { 8e-6 * unit(engine), 8e-6 * unit(engine), 8e-6 * unit(engine) },
			        by { 4e-3 * unit(engine), 4e-3 * unit(engine), 4e-3 * unit(engine) };
			for (int i = 1; i <= 2000 && !gone; i++) {
				const double part = i / 2000.;
				gone = bond.step(stretch + part * (to - stretch), turn + part * (by - turn)).overload
				        > 0;
				EXPECT_GE(bond.lost, lost);
				lost = bond.lost;
			}
			stretch = to, turn = by;
		}
		broke += gone;
		EXPECT_NEAR(bond.work, bond.lost + bond.stored, 2e-4 * (bond.lost + bond.stored)) << path;
	}
	EXPECT_GT(broke, 10);
	EXPECT_LT(broke, 270);
}

TEST(SofteningBond, refusesWhatWouldSnapBack) // ½ σ² d0/E = 3.33 J/m²
{
	auto p          = parameters();
	p.tensionEnergy = 3.3;
	try {
		SofteningBond::strengthOf(p, making);
		FAIL();
	} catch (const std::invalid_argument& error) {
		EXPECT_NE(std::string(error.what()).find("tensionEnergy = 3.3 J/m² is not above the 3.33333 J/m²"),
		          std::string::npos)
		        << error.what();
	}
	p.tensionEnergy = 3.4;
	SofteningBond::strengthOf(p, making);
}

TEST(SofteningBond, namesTheModeThatBrokeIt)
{
	Path pulled(parameters()), sheared(parameters());
	pulled.drive({ 15e-6, 1e-6, 0 }, {});
	sheared.drive({ 1e-6, 50e-6, 0 }, {});
	EXPECT_EQ(SofteningBond::mode(pulled.strength, pulled.memory, {}), BondFailure::Tension);
	EXPECT_EQ(SofteningBond::mode(sheared.strength, sheared.memory, {}), BondFailure::Shear);
}

} // namespace
