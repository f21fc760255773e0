// GPL v2 or later, see LICENSE.
// Compares the memory layout of YADE's classes, as this plugin was compiled, with the YADE that is running.
#pragma once

#include <string>

namespace yade::ddem {

/// Says, one line each, which of YADE's classes the running YADE lays out in another way than the compiler of this file
/// did; empty when all agree.
///
/// YADE's classes change size and order with its version and features (FEM support adds a member to Shape, Eigen's
/// alignment moves those of State, MPI those of Body, …), and neither compiler nor linker notices: the plugin would
/// read and write beside the members it means.  So stock objects are made by the stock factory and compared with this
/// compiler's view of them: their size, and the place of one of their last members, written by YADE's own attribute
/// setter and read here.
///
/// Limits: covers the classes the plugin derives from, and those whose members it reads; sizes are known to the
/// allocator's granularity of 16 bytes, hence the second comparison.  The caller holds Python's lock.
std::string layoutDifferences();

} // namespace yade::ddem
