// GPL v2 or later, see LICENSE.
#include <pkg/ddem/ConcreteDamageMat.hpp>

namespace yade {

DDEM_PLUGIN((ConcreteDamageMat))

} // namespace yade
