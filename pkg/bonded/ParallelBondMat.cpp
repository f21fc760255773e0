// GPL v2 or later, see LICENSE.
#include <pkg/bonded/ParallelBondMat.hpp>

namespace yade {

DDEM_PLUGIN((ParallelBondMat))

} // namespace yade
