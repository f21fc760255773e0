// GPL v2 or later, see LICENSE.
#include <criteria/AllBondCriteria.hpp>
#include <pkg/bonded/kernel/BondCriterionOf.hpp>

#include <stdexcept>

namespace yade::ddem {

namespace {

	template <class... Criteria> struct Known {
		static std::vector<const BondCriterion*> all() { return { &bondCriterion<Criteria>()... }; }
	};

} // namespace

const BondCriterion& bondCriterion(const std::string& name)
{
	static const auto known = AllBondCriteria<Known>::all();
	std::string       names;
	for (const BondCriterion* criterion : known) {
		if (criterion->name() == name) return *criterion;
		names += " " + criterion->name();
	}
	throw std::invalid_argument("there is no criterion of bonds '" + name + "'; there are:" + names);
}

} // namespace yade::ddem
