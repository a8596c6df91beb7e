// math/vec3.h - short names for Eigen's types. Lengths in metres unless a name says otherwise.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

namespace burr::math {

using Vec3 = Eigen::Vector3d;
using Vec3f = Eigen::Vector3f;
using Mat3 = Eigen::Matrix3d;
// DontAlign: rooms compiled for different instruction sets must agree on the layout
using Quat = Eigen::Quaternion<double, Eigen::DontAlign>;
using Ijk = Eigen::Vector3i;  // a voxel, x fastest

inline bool finite(const Vec3& v) noexcept { return v.allFinite(); }

}  // namespace burr::math
