#include "src/sim/adapt_geometry.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace trackbed::adapt {
namespace {

/// Largest deviation of a round geom from a circle, and largest offset from the axis, both divided
/// by the radius.
constexpr double kOutOfRound = 0.1;
/// Smallest cosine of the angle between two axes that count as parallel; the angle is 8 degrees.
constexpr double kParallel = 0.99;

/// Returns the largest coordinate of a mesh along `direction` [m].
double MeshReach(const mjModel& model, const mjData& data, int geom, const Vector& direction) {
  const int mesh = model.geom_dataid[geom];
  const Vector own = ToMatrix(data.geom_xmat + 9 * geom).transpose() * direction;
  double reach = -std::numeric_limits<double>::infinity();
  const float* vertex = model.mesh_vert + 3 * static_cast<std::ptrdiff_t>(model.mesh_vertadr[mesh]);
  for (int i = 0; i < model.mesh_vertnum[mesh]; ++i, vertex += 3) {
    reach = std::max(reach, own.x() * vertex[0] + own.y() * vertex[1] + own.z() * vertex[2]);
  }
  return reach;
}

std::optional<RoundGeom> RoundMesh(const mjModel& model, const mjData& data, int geom,
                                   const Vector& anchor, const Vector& axis) {
  const Vector at = ToVector(data.geom_xpos + 3 * geom);
  const Vector side = axis.unitOrthogonal();
  const Vector other = axis.cross(side);
  double least = std::numeric_limits<double>::infinity();
  double most = 0.0;
  constexpr int kDirections = 24;
  for (int i = 0; i < kDirections; ++i) {
    const double angle = 2.0 * std::numbers::pi * i / kDirections;
    const Vector direction = std::cos(angle) * side + std::sin(angle) * other;
    const double reach = MeshReach(model, data, geom, direction) + direction.dot(at - anchor);
    least = std::min(least, reach);
    most = std::max(most, reach);
  }
  if (!(least > (1.0 - kOutOfRound) * most)) {
    return std::nullopt;
  }
  const double above = MeshReach(model, data, geom, axis);
  const double below = -MeshReach(model, data, geom, -axis);
  const Vector middle = anchor + axis * (axis.dot(at - anchor) + 0.5 * (above + below));
  return RoundGeom{geom, middle, most, above - below};
}

}  // namespace

Vector ToVector(const mjtNum* numbers) {
  return {numbers[0], numbers[1], numbers[2]};
}

Matrix ToMatrix(const mjtNum* numbers) {
  return Eigen::Map<const Eigen::Matrix<mjtNum, 3, 3, Eigen::RowMajor>>(numbers);
}

std::optional<double> ReachAlong(const mjModel& model, const mjData& data, int geom,
                                 const Vector& direction) {
  const Vector size = ToVector(model.geom_size + 3 * geom);
  const Vector own = ToMatrix(data.geom_xmat + 9 * geom).transpose() * direction;
  const double middle = direction.dot(ToVector(data.geom_xpos + 3 * geom));
  switch (model.geom_type[geom]) {
    case mjGEOM_SPHERE:
      return middle + size[0];
    case mjGEOM_CAPSULE:
      return middle + size[0] + size[1] * std::abs(own.z());
    case mjGEOM_ELLIPSOID:
      return middle + own.cwiseProduct(size).norm();
    case mjGEOM_CYLINDER:
      return middle + size[0] * std::hypot(own.x(), own.y()) + size[1] * std::abs(own.z());
    case mjGEOM_BOX:
      return middle + own.cwiseAbs().dot(size);
    case mjGEOM_MESH:
      return middle + MeshReach(model, data, geom, direction);
    default:
      return std::nullopt;
  }
}

std::optional<Vector> OwnAxis(const mjModel& model, const mjData& data, int geom) {
  const Matrix axes = ToMatrix(data.geom_xmat + 9 * geom);
  const Vector size = ToVector(model.geom_size + 3 * geom);
  if (model.geom_type[geom] == mjGEOM_CYLINDER) {
    return axes.col(2);
  }
  if (model.geom_type[geom] == mjGEOM_ELLIPSOID) {
    for (int i = 0; i < 3; ++i) {
      const double a = size[(i + 1) % 3];
      const double b = size[(i + 2) % 3];
      if (std::abs(a - b) <= kOutOfRound * std::max(a, b) && size[i] < std::min(a, b)) {
        return axes.col(i);
      }
    }
  }
  return std::nullopt;
}

std::optional<RoundGeom> RoundAbout(const mjModel& model, const mjData& data, int geom,
                                    const Vector& anchor, const Vector& axis) {
  const int type = model.geom_type[geom];
  if (type == mjGEOM_MESH) {
    return RoundMesh(model, data, geom, anchor, axis);
  }
  const Vector at = ToVector(data.geom_xpos + 3 * geom);
  const Vector size = ToVector(model.geom_size + 3 * geom);
  const Vector along = ToMatrix(data.geom_xmat + 9 * geom).col(2);
  RoundGeom round{.geom = geom, .center = at, .radius = size[0], .width = 2.0 * size[0]};
  if (type == mjGEOM_CYLINDER || type == mjGEOM_CAPSULE) {
    if (std::abs(along.dot(axis)) < kParallel) {
      return std::nullopt;
    }
    round.width = 2.0 * (size[1] + (type == mjGEOM_CAPSULE ? size[0] : 0.0));
  } else if (type == mjGEOM_ELLIPSOID) {
    const std::optional<Vector> own = OwnAxis(model, data, geom);
    if (!own || std::abs(own->dot(axis)) < kParallel) {
      return std::nullopt;
    }
    round.radius = size.maxCoeff();
    round.width = 2.0 * size.minCoeff();
  } else if (type != mjGEOM_SPHERE) {
    return std::nullopt;
  }
  const Vector from = at - anchor;
  const double off = (from - axis * axis.dot(from)).norm();
  return off <= kOutOfRound * round.radius ? std::optional(round) : std::nullopt;
}

}  // namespace trackbed::adapt
