// GPL v2 or later, see LICENSE.
// Sums over tiles in one fixed binary tree.
#pragma once

#include <cstddef>
#include <vector>

namespace yade::ddem {

/** Sum of the tiles' own sums: neighbours are added in pairs, then neighbouring pairs, and so on; one left over goes
 * up as it is. The tree depends on the number of tiles alone. A domain that owns a run of tiles can hand over the
 * sums of its largest complete subtrees, so the total has the same bits for any division into domains
 * and any number of threads.
 * Sum needs operator+= and a value-initialised zero. */
template <class Sum> Sum treeSum(std::vector<Sum> sums)
{
	if (sums.empty()) return Sum();
	for (std::size_t count = sums.size(); count > 1; count = (count + 1) / 2)
		for (std::size_t i = 0; i < (count + 1) / 2; i++) {
			Sum sum = sums[2 * i];
			if (2 * i + 1 < count) sum += sums[2 * i + 1];
			sums[i] = sum;
		}
	return sums[0];
}

} // namespace yade::ddem
