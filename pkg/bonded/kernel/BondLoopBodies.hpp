// GPL v2 or later, see LICENSE.
// Body of the bond loop, compiled once per criterion and instruction set.
#pragma once

#include <criteria/AllBondCriteria.hpp>
#include <pkg/bonded/kernel/BondCriterionOf.hpp>
#include <pkg/bonded/kernel/BondLoops.hpp>
#include <pkg/bonded/kernel/SphereMotion.hpp>
#include <pkg/ddem/kernel/algebra/Lanes.hpp>

#include <type_traits>

namespace yade::ddem {

/// \tparam Unit names the instruction set, so that the linker keeps a copy for each
/// Flattened: between functions lanes would go through memory, which takes an eighth of the time.
template <class Unit, class Number, BondConvention convention, class Criterion>
[[gnu::flatten]] bool bondLoop(const BondArrays& a, std::size_t begin, std::size_t end)
{
	using L             = Lanes<Number>;
	using Strength      = typename Criterion::template Strength<Number>;
	using Memory        = typename Criterion::template Memory<Number>;
	constexpr auto row  = std::ptrdiff_t(sizeof(BondSystem::Row) / sizeof(double));
	constexpr bool remembers = Memory::names.size() > 0; // only then a bond may lose of its loads
	bool           over      = false;
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
			                    constant(BondSystem::SectionRadius),
			                    frame(BondSystem::Frame1),
			                    frame(BondSystem::Frame2) };
		Number numbers[mostStrengths];
		for (std::size_t k = 0; k < Strength::names.size(); k++)
			numbers[k] = L::load(a.strength[k] + j);
		const auto strength = fromNumbers<Strength>(numbers);
		for (std::size_t k = 0; k < Memory::names.size(); k++)
			numbers[k] = L::load(a.memory[k] + j);
		auto memory = fromNumbers<Memory>(numbers);

		BondAnswerOf<Number> answer;
		const auto           advance = [&](BondResultantsOf<Number>& load) {
                        answer = Criterion::advance(
                                strength, memory, BondSectionOf<Number>(bond.sectionRadius), bond.stiffness, load);
		};
		BondLoadsOf<Number> loads;
		if constexpr (remembers) loads = bondLoads(bond, branch, q1, q2, advance);
		// who takes nothing looks afterwards: between the others there are not registers enough, a seventh
		else {
			loads = convention == BondConvention::Esys ? esysBondLoads(bond, branch, q1, q2)
			                                           : bondLoads(bond, branch, q1, q2);
			advance(loads.section);
		}
		const auto beyond = !(answer.overload <= Number(0.)); // so it notices what is not a number, too
		if (any(beyond)) {
			over = true;
			L::store(a.overload + j, answer.overload);
		}
		if constexpr (remembers) {
			toNumbers(memory, numbers);
			for (std::size_t k = 0; k < Memory::names.size(); k++)
				L::store(a.memory[k] + j, numbers[k]);
			L::store(a.lost + j, answer.lost);
		}

		double* const to = a.rows + std::ptrdiff_t(j) * row;
		L::storeRows(to, row, { loads.force.x, loads.force.y, loads.force.z, answer.stress.normal });
		L::storeRows(to + 4, row, { loads.moment1.x, loads.moment1.y, loads.moment1.z, answer.stress.shear });
		L::storeRows(to + 8, row, { loads.moment2.x, loads.moment2.y, loads.moment2.z, loads.energy });
	}
	return over;
}

/// The loop of a criterion among some. In the convention Esys a bond breaks by Mohr-Coulomb.
template <class Unit, class Number> struct BondLoopOf {
	BondConvention       convention;
	const BondCriterion& criterion;

	template <class... Criteria> struct Among {
		static BondLoop find(const BondLoopOf& wanted)
		{
			BondLoop found = nullptr;
			(void)((&bondCriterion<Criteria>() == &wanted.criterion && (found = of<Criteria>(wanted), true))
			       || ...);
			return found;
		}
		template <class Criterion> static BondLoop of(const BondLoopOf& wanted)
		{
			if (wanted.convention == BondConvention::Consistent)
				return bondLoop<Unit, Number, BondConvention::Consistent, Criterion>;
			if constexpr (std::is_same_v<Criterion, MohrCoulomb>)
				return bondLoop<Unit, Number, BondConvention::Esys, Criterion>;
			else
				return nullptr;
		}
	};
	BondLoop find() const { return AllBondCriteria<Among>::find(*this); }
};

} // namespace yade::ddem
