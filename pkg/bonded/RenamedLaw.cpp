// GPL v2 or later, see LICENSE.
#include <pkg/bonded/RenamedLaw.hpp>

namespace yade {

DDEM_PLUGIN((Law2_ScGeom_BondedPhys_MohrCoulomb))

} // namespace yade
