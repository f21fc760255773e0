// GPL v2 or later, see LICENSE.
// Why, when and where a bond broke.
#include <pkg/bonded/BrokenBond.hpp>

namespace yade {

DDEM_PLUGIN((BrokenBond))

} // namespace yade
