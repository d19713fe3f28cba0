#pragma once

#include <Eigen/Core>
#include <cstdint>

/// The scalar and index types that all of strake shares.
namespace strake {

using Vec2 = Eigen::Vector2d;
using Vec3 = Eigen::Vector3d;
using Mat2 = Eigen::Matrix2d;
using Mat3 = Eigen::Matrix3d;

/// Index of a vertex, face, half-edge or wedge; kNone where there is none.
using Index = std::int32_t;
inline constexpr Index kNone = -1;

}  // namespace strake
