// GPL v2 or later, see LICENSE.
// Compares what this plugin was compiled for with the YADE that is running.
#pragma once

#include <string>

namespace yade::ddem {

/// Says, one line each, in what the running YADE differs from the one this file was compiled for; empty when nothing does.
///
/// YADE's classes change size and layout with its version and features (FEM support adds a member to Shape, Eigen's alignment moves State's, and so on), and
/// neither the compiler nor the linker notices: the plugin would read and write beside the members it means.  So stock objects are made by the stock factory
/// and compared with this compiler's view of them: their size, and the place of one of their last members, written by YADE's own attribute
/// setter and read here.  Limits: the classes checked are those the plugin derives from or whose members it reads; needs the Python interpreter's lock.
std::string layoutDifferences();

} // namespace yade::ddem
