// GPL v2 or later, see LICENSE.
// All bonds of a sample as arrays, evaluated together.
//
// Bonds are computed a SIMD batch at a time, each into a row of its own; then every particle collects the rows of its
// bonds in a fixed order. So results do not depend on the number of threads, bit by bit. Bonds of one criterion lie
// together, so that each group runs its own loop.
#pragma once

#include <pkg/bonded/kernel/BondCriterion.hpp>
#include <pkg/bonded/kernel/EsysBond.hpp>

#include <array>
#include <cstdint>
#include <vector>

namespace yade::ddem {

/// How a bond turns motion into loads.
enum class BondConvention {
	Consistent, ///< bondLoads
	Esys        ///< esysBondLoads
};

/// Loads of one bond in either convention. \param weaken as in bondLoads; in Esys only looks
template <class Weaken = AllElastic>
inline BondLoads bondLoads(
        BondConvention             convention,
        const Bond&                bond,
        const SpaceVector<double>& branch,
        const SpaceRotation<double>&    orientation1,
        const SpaceRotation<double>&    orientation2,
        const Weaken&              weaken = {})
{
	if (convention == BondConvention::Consistent)
		return bondLoads(bond, branch, orientation1, orientation2, weaken);
	BondLoads loads = esysBondLoads(bond, branch, orientation1, orientation2);
	weaken(loads.section);
	return loads;
}

/// \throws std::invalid_argument for a criterion that the convention does not know
void requireKnown(BondConvention convention, const BondCriterion& criterion);

/// A bond of a criterion, with what it remembers.
struct BreakableBond {
	Bond                 bond;
	const BondCriterion* criterion;
	BondStrength         strength;
	BondMemory           memory {};
};

class BondSystem {
public:
	/// What a bond did in the last step; a row of plain numbers.
	struct Row {
		SpaceVector<double> force; ///< on the first particle [N]
		double              normalStress;
		SpaceVector<double> moment1;
		double              shearStress;
		SpaceVector<double> moment2;
		double              energy;
	};

	/// Constants of every bond, a list each.
	enum Constant {
		Normal,
		Shear,
		Bending,
		Torsion,
		Length,
		Radius1,
		Radius2,
		SectionRadius,
		Frame1,
		Frame2        = Frame1 + 4,
		ConstantCount = Frame2 + 4
	};

	/// What all bonds did in a step.
	struct Energies {
		double stored = 0; ///< [J]
		double lost   = 0; ///< that criteria took away [J]
	};

	void clear();
	/** Bonds of one criterion must be added one after the other.
	 * \param first,second rows of the particles
	 * \returns the bond's place; some places, to fill batches, hold no bond
	 */
	std::size_t add(std::int32_t first, std::int32_t second, const BreakableBond& bond);
	/// To be called once all bonds have been added. \throws std::logic_error if a bond names
	/// a particle that does not exist
	void assemble(std::size_t particles);

	/// Places, with those that hold no bond.
	std::size_t size() const { return count; }
	std::size_t particles() const { return collectStart.size() - 1; }

	/** Computes all bonds and collects their loads.
	 * \param pose rows of the particles, see SphereMotion
	 * \param load rows that get the loads of every particle's bonds, see SphereMotion
	 * \param overloaded gets the bonds beyond their strength or with stresses that are not a number, in order;
	 * their loads are included
	 * \param energy whether to add up energies
	 * \returns zeros unless asked for
	 */
	Energies
	step(BondConvention convention, bool energy, const double* pose, double* load,
	     std::vector<std::int32_t>& overloaded);

	/// Takes a bond out for good; its particles' loads of this step no longer contain it.
	void remove(std::size_t bond, double* load);

	const Row&   row(std::size_t bond) const { return rows[bond]; }
	double       constant(Constant which, std::size_t bond) const { return constants[which][bond]; }
	std::int32_t firstOf(std::size_t bond) const { return first[bond]; }
	std::int32_t secondOf(std::size_t bond) const { return second[bond]; }
	BondMemory   memoryOf(std::size_t bond) const;

private:
	struct Group {
		const BondCriterion* criterion;
		std::size_t          begin, end; ///< places
	};
	/// Bonds of one group, for one thread.
	struct Chunk {
		std::size_t group, begin, end;
		bool        over = false; ///< has an overloaded bond
		Energies    energies;
	};
	void fillBatch();
	void addEnergies(Chunk& chunk) const;
	void collect(std::size_t particle, double* load) const;

	std::size_t                                    count = 0;
	std::vector<Group>                             groups;
	std::vector<Chunk>                             chunks;
	/// like all columns filled up to whole SIMD batches with copies of the last bond, which nobody collects
	std::vector<std::int32_t>                      first, second;
	std::array<std::vector<double>, ConstantCount> constants;
	std::array<std::vector<double>, mostStrengths> strengths;
	std::array<std::vector<double>, mostMemories>  memories; ///< empty where no criterion has so many
	std::vector<Row>                               rows;
	std::vector<double>                            overload; ///< zero, but of bonds beyond their strength
	std::vector<double>                            lost;     ///< in this step [J], by criteria with a memory
	std::vector<char>                              gone;     ///< removed, or no bond
	std::vector<std::size_t>                       collectStart { 0 };
	std::vector<std::int32_t>                      collectRow; ///< 2 · bond + (0: as first, 1: as second particle)
};

} // namespace yade::ddem
