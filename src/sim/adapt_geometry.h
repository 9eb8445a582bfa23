#pragma once

#include <mujoco/mujoco.h>

#include <Eigen/Core>
#include <optional>

/// Shapes of geoms in a compiled model, in world coordinates.
namespace trackbed::adapt {

using Vector = Eigen::Vector3d;
using Matrix = Eigen::Matrix3d;

Vector ToVector(const mjtNum* numbers);

/// Rotation matrix from MuJoCo's nine numbers, row by row.
Matrix ToMatrix(const mjtNum* numbers);

/// Returns the largest coordinate of a geom along the unit vector `direction` [m]. Returns nullopt
/// for planes and height fields, which are unbounded.
std::optional<double> ReachAlong(const mjModel& model, const mjData& data, int geom,
                                 const Vector& direction);

/// A geom that is round about an axis, such as a wheel.
struct RoundGeom {
  int geom = -1;
  Vector center = Vector::Zero();  ///< Middle of the geom, on its own axis [m].
  double radius = 0.0;             ///< [m]
  double width = 0.0;              ///< Extent along the axis [m].
};

/// Returns the geom as a wheel about the line through `anchor` along the unit vector `axis`;
/// nullopt if the geom is not round about this line. The center of the geom may be up to a tenth of
/// its radius away from the line. The radius of a round mesh may vary by a tenth.
std::optional<RoundGeom> RoundAbout(const mjModel& model, const mjData& data, int geom,
                                    const Vector& anchor, const Vector& axis);

/// Returns the axis about which a cylinder or an ellipsoid with two equal axes is round; nullopt
/// for other geoms. Returns nullopt for a ball, which is round about every axis.
std::optional<Vector> OwnAxis(const mjModel& model, const mjData& data, int geom);

}  // namespace trackbed::adapt
