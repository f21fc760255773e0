// GPL v2 or later, see LICENSE.
#include <pkg/bonded/SofteningBondMat.hpp>

namespace yade {

DDEM_PLUGIN((SofteningBondMat))

} // namespace yade
