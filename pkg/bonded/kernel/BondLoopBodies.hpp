// GPL v2 or later, see LICENSE.
// Body of the bond loop, compiled once per instruction set.
#pragma once

#include <pkg/bonded/kernel/BondLoops.hpp>
#include <pkg/bonded/kernel/SphereMotion.hpp>
#include <pkg/ddem/kernel/algebra/Lanes.hpp>

namespace yade::ddem {

/// \tparam Unit names the instruction set, so that the linker keeps a copy for each
/// Flattened: between functions lanes would go through memory, which takes an eighth of the time.
template <class Unit, class Number, BondConvention convention>
[[gnu::flatten]] bool bondLoop(const BondArrays& a, std::size_t begin, std::size_t end)
{
	using L             = Lanes<Number>;
	constexpr auto row  = std::ptrdiff_t(sizeof(BondSystem::Row) / sizeof(double));
	bool           over = false;
	for (std::size_t j = begin; j < end; j += L::width) {
		const auto constant = [&](int which) { return L::load(a.constant[which] + j); };
		const auto frame = [&](int which) -> SpaceRotation<Number> {
			return { constant(which), constant(which + 1), constant(which + 2), constant(which + 3) };
		};

		Number position1[4], orientation1[4], position2[4], orientation2[4];
		L::gatherRows(a.pose, sphereRow, a.first + j, position1);
		L::gatherRows(a.pose + 4, sphereRow, a.first + j, orientation1);
		L::gatherRows(a.pose, sphereRow, a.second + j, position2);
		L::gatherRows(a.pose + 4, sphereRow, a.second + j, orientation2);
		const SpaceVector<Number> branch { position2[0] - position1[0], position2[1] - position1[1],
			                           position2[2] - position1[2] };
		const SpaceRotation<Number> q1 { orientation1[0], orientation1[1], orientation1[2], orientation1[3] };
		const SpaceRotation<Number> q2 { orientation2[0], orientation2[1], orientation2[2], orientation2[3] };

		const BondOf<Number> bond { { constant(BondSystem::Normal), constant(BondSystem::Shear),
			                      constant(BondSystem::Bending), constant(BondSystem::Torsion) },
			                    constant(BondSystem::Length),
			                    constant(BondSystem::Radius1),
			                    constant(BondSystem::Radius2),
			                    frame(BondSystem::Frame1),
			                    frame(BondSystem::Frame2) };
		BondLoadsOf<Number>  loads;
		if constexpr (convention == BondConvention::Esys) loads = esysBondLoads(bond, branch, q1, q2);
		else loads = bondLoads(bond, branch, q1, q2);
		const BondStressOf<Number> stress = bondStress(BondSectionOf<Number>(0.5 * bond.length), loads.section);
		const Number overload = bondOverload(
		        constant(BondSystem::Cohesion), constant(BondSystem::Friction),
		        constant(BondSystem::TensionLimit), stress);
		over |= any(!(overload <= Number(0.))); // in this form it notices what is not a number, too

		double* const to = a.rows + std::ptrdiff_t(j) * row;
		L::storeRows(to, row, { loads.force.x, loads.force.y, loads.force.z, stress.normal });
		L::storeRows(to + 4, row, { loads.moment1.x, loads.moment1.y, loads.moment1.z, stress.shear });
		L::storeRows(to + 8, row, { loads.moment2.x, loads.moment2.y, loads.moment2.z, loads.energy });
	}
	return over;
}

template <class Unit, class Number> BondLoop bondLoopFor(BondConvention convention)
{
	return convention == BondConvention::Esys ? bondLoop<Unit, Number, BondConvention::Esys>
	                                          : bondLoop<Unit, Number, BondConvention::Consistent>;
}

} // namespace yade::ddem
