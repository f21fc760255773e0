// GPL v2 or later, see LICENSE.
// Entries of the bonded model in O.energy.
#pragma once

#include <pkg/ddem/YadeInclude.hpp>

#include <array>

namespace yade {

/** Books energies of bonds, contacts and walls. Safe in parallel loops: EnergyTracker makes new entries without a lock
 * and moves its arrays then, so all of ours are made at once, by the first thread that comes,
 * before any thread adds to one of them.
 */
class BondedEnergy {
public:
	enum Entry {
		BondElastic,
		ContactElastic,
		WallElastic,
		BondBroken,
		BondSoftening,
		Friction,
		ContactDamping,
		EntryCount
	};

	/// Adds to an entry. Those named …Elastic start from zero in every step. \param value [J]
	void add(EnergyTracker& book, Entry entry, Real value)
	{
		if (owner.load(std::memory_order_acquire) != &book) find(book);
		book.energies.add(size_t(ids[entry]), value);
	}

private:
	void find(EnergyTracker& book);

	std::atomic<EnergyTracker*> owner { nullptr };
	std::array<int, EntryCount> ids {};
};

} // namespace yade
