// GPL v2 or later, see LICENSE.
#include <pkg/ddem/ScalarDamageMat.hpp>

namespace yade {

DDEM_PLUGIN((ScalarDamageMat))

} // namespace yade
