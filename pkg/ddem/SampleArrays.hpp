// GPL v2 or later, see LICENSE.
// Whole-sample numpy arrays of deformable triangles.
#pragma once

#include <pkg/ddem/Exposure.hpp>

namespace yade {

/// View, without a copy, of a state array; it keeps the arrays alive. \throws std::invalid_argument
/// for an unknown name.
boost::python::object sampleArray(Exposure& sample, const std::string& name);
/// A quantity of the whole sample, computed now. \throws std::invalid_argument for an unknown name.
boost::python::object sampleValues(const Exposure& sample, const std::string& name);
/// Fields of all laws of the sample: (name, unit, components).
boost::python::list sampleFields(const Exposure& sample);
/// Groups of triangles, see DeformableEngine.groups.
boost::python::list sampleGroups(const Exposure& sample);

} // namespace yade
