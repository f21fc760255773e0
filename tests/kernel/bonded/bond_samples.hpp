// GPL v2 or later, see LICENSE.
// Bonds with Eigen's vectors, whose operations tests need.
#pragma once

#include <pkg/bonded/kernel/BondCriterionOf.hpp>
#include <pkg/bonded/kernel/BondSystem.hpp>
#include <pkg/bonded/kernel/criteria/MohrCoulomb.hpp>
#include <pkg/ddem/kernel/algebra/EigenSpace.hpp>

namespace bond_samples {

using namespace yade::ddem;
using Vector     = Eigen::Vector3d;
using Quaternion = Eigen::Quaterniond;

/// BondLoads in Eigen's vectors.
struct Loads {
	Vector         force, moment1, moment2, axis;
	BondResultants section;
	double         energy;
};

/// A bond between particles that touch: equal radii of half the branch unless given.
inline Bond
join(const BondStiffness& stiffness, const Vector& branch, const Quaternion& q1, const Quaternion& q2,
     double radius1 = 0)
{
	const double first = radius1 > 0 ? radius1 : branch.norm() / 2;
	return makeBond(stiffness, first, branch.norm() - first, spaceVector(branch), rotation(q1), rotation(q2));
}

inline Loads
loadsOf(const Bond& bond, const Vector& branch, const Quaternion& q1, const Quaternion& q2,
        BondConvention convention = BondConvention::Consistent)
{
	const BondLoads l = bondLoads(convention, bond, spaceVector(branch), rotation(q1), rotation(q2));
	return { eigenVector(l.force),
		 eigenVector(l.moment1),
		 eigenVector(l.moment2),
		 eigenVector(l.axis),
		 l.section,
		 l.energy };
}

/// A bond that breaks by Mohr-Coulomb with tan φ = 1. \param cohesion [Pa]
inline BreakableBond breakable(const Bond& bond, double cohesion)
{
	MohrCoulomb::Parameters parameters;
	parameters.cohesion             = cohesion;
	const BondCriterion& criterion = bondCriterion<MohrCoulomb>();
	return { bond, &criterion,
		 criterion.strengthOf(BondCriterionOf<MohrCoulomb>::valuesOf(parameters), {}), {} };
}

} // namespace bond_samples
