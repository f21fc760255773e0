// GPL v2 or later, see LICENSE.
// Entries of the bonded model in O.energy.
#include <pkg/bonded/BondedEnergy.hpp>

#include <mutex>

namespace yade {

void BondedEnergy::find(EnergyTracker& book)
{
	static std::mutex                 mutex; // one for all laws: they make the same entries
	const std::lock_guard<std::mutex> lock(mutex);
	if (owner.load(std::memory_order_relaxed) == &book) return;
	static const std::array<std::pair<const char*, bool>, EntryCount> entries { { { "bondElastic", true },
		                                                                      { "contactElastic", true },
		                                                                      { "wallElastic", true },
		                                                                      { "bondBroken", false },
		                                                                      { "bondSoftening", false },
		                                                                      { "friction", false },
		                                                                      { "contactDamping", false } } };
	for (size_t i = 0; i < EntryCount; i++) {
		ids[i] = -1;
		book.findId(entries[i].first, ids[i], entries[i].second);
	}
	owner.store(&book, std::memory_order_release);
}

} // namespace yade
