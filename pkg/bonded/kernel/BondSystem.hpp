// GPL v2 or later, see LICENSE.
// All bonds of a sample as arrays, evaluated together.
//
// Bonds are computed a SIMD batch at a time, each into a row of its own; then every particle collects the rows of its
// bonds in a fixed order. So results do not depend on the number of threads, bit by bit.
#pragma once

#include <pkg/bonded/kernel/BondStrength.hpp>
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

/// Loads of one bond in either convention.
inline BondLoads bondLoads(
        BondConvention             convention,
        const Bond&                bond,
        const SpaceVector<double>& branch,
        const SpaceRotation<double>&    orientation1,
        const SpaceRotation<double>&    orientation2)
{
	return convention == BondConvention::Esys ? esysBondLoads(bond, branch, orientation1, orientation2)
	                                          : bondLoads(bond, branch, orientation1, orientation2);
}

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
		Frame1,
		Frame2   = Frame1 + 4,
		Cohesion = Frame2 + 4,
		Friction,
		TensionLimit,
		ConstantCount
	};

	void clear();
	/// \param first,second rows of the particles
	void add(std::int32_t first, std::int32_t second, const Bond& bond, const MohrCoulomb& strength);
	/// To be called once all bonds have been added. \throws std::logic_error if a bond names
	/// a particle that does not exist
	void assemble(std::size_t particles);

	std::size_t size() const { return count; }
	std::size_t particles() const { return collectStart.size() - 1; }

	/** Computes all bonds and collects their loads.
	 * \param pose rows of the particles, see SphereMotion
	 * \param load rows that get the loads of every particle's bonds, see SphereMotion
	 * \param overloaded gets the bonds beyond their strength or with stresses that are not a number, in order;
	 * their loads are included
	 * \param energy whether to add up the stored energy
	 * \returns stored energy [J], 0 unless asked for
	 */
	double
	step(BondConvention convention, bool energy, const double* pose, double* load,
	     std::vector<std::int32_t>& overloaded);

	/// Takes a bond out for good; its particles' loads of this step no longer contain it.
	void remove(std::size_t bond, double* load);

	const Row&   row(std::size_t bond) const { return rows[bond]; }
	double       constant(Constant which, std::size_t bond) const { return constants[which][bond]; }
	std::int32_t firstOf(std::size_t bond) const { return first[bond]; }
	std::int32_t secondOf(std::size_t bond) const { return second[bond]; }

private:
	void collect(std::size_t particle, double* load) const;

	std::size_t                                    count = 0;
	/// like all constants padded to whole SIMD batches once assembled
	std::vector<std::int32_t>                      first, second;
	std::array<std::vector<double>, ConstantCount> constants;
	std::vector<Row>                               rows;
	std::vector<char>                              over;   ///< of every chunk: has an overloaded bond
	std::vector<double>                            stored; ///< of every chunk [J]
	std::vector<std::size_t>                       collectStart { 0 };
	std::vector<std::int32_t>                      collectRow; ///< 2 · bond + (0: as first, 1: as second particle)
};

} // namespace yade::ddem
