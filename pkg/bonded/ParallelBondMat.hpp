// GPL v2 or later, see LICENSE.
// Material of parallel bonds.
#pragma once

#include <pkg/bonded/BondedMat.hpp>
#include <pkg/bonded/kernel/criteria/ParallelBond.hpp>

namespace yade {

class ParallelBondMat : public BondedMat {
public:
	virtual ~ParallelBondMat() = default;
	DDEM_CRITERION_OF_MATERIAL(ParallelBondMat, ddem::ParallelBond, PARALLEL_BOND_PARAMETERS)

	// clang-format off
	YADE_CLASS_BASE_DOC_ATTRS_CTOR(ParallelBondMat, BondedMat,
		"Bonds that break as the parallel bonds of Potyondy and Cundall (2004), which users of PFC know, with "
		"strengths in tension and in shear that are free of each other: in tension where "
		":math:`\\sigma=F_n/A+\\beta|M_b|R/I` exceeds *tensileStrength*, in shear where "
		":math:`\\tau=|F_s|/A+\\beta|M_t|R/J` exceeds :math:`C-\\tan\\varphi\\,F_n/A` (tension positive). "
		"The bond's radius is :math:`\\lambda\\min(r_1,r_2)`.\n\n"
		"From PFC's names: *pb_ten* is *tensileStrength*, *pb_coh* is *cohesion*, *pb_fa* is "
		"*bondFrictionAngle* (here in rad), *pb_mcf* is *momentContribution*, *pb_rmul* is *radiusFactor*; "
		"*pb_emod* is :yref:`young<ElastMat.young>`, and *pb_kratio*, normal over shear stiffness, is "
		"2(1 + :yref:`poisson<ElastMat.poisson>`).\n\n"
		"Limits: while a bond holds, the contact beneath it bears nothing, where PFC's grain contact acts "
		"beside it; take that into *young*. Where two materials meet, the larger *momentContribution* counts.",
		PARALLEL_BOND_PARAMETERS(DDEM_ATTRIBUTE),
		createIndex(); takeStrengthOfCriterion();
	);
	// clang-format on
	REGISTER_CLASS_INDEX(ParallelBondMat, BondedMat);
};
REGISTER_SERIALIZABLE(ParallelBondMat);

} // namespace yade
