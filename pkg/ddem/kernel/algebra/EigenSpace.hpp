// GPL v2 or later, see LICENSE.
// Eigen's vectors and quaternions from and to the kernel's.
#pragma once

#include <pkg/ddem/kernel/algebra/SpaceVector.hpp>

#include <Eigen/Geometry>

namespace yade::ddem {

inline SpaceVector<double> spaceVector(const Eigen::Vector3d& v) { return { v.x(), v.y(), v.z() }; }
inline Eigen::Vector3d     eigenVector(const SpaceVector<double>& v) { return { v.x, v.y, v.z }; }
inline SpaceRotation<double>    rotation(const Eigen::Quaterniond& q) { return { q.w(), q.x(), q.y(), q.z() }; }
inline Eigen::Quaterniond  eigenQuaternion(const SpaceRotation<double>& q) { return { q.w, q.x, q.y, q.z }; }

} // namespace yade::ddem
