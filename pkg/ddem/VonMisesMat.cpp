// GPL v2 or later, see LICENSE.
#include <pkg/ddem/VonMisesMat.hpp>

namespace yade {

DDEM_PLUGIN((VonMisesMat))

} // namespace yade
