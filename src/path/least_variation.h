#pragma once

#include <cstddef>
#include <limits>
#include <optional>
#include <vector>

#include "src/path/smoothing_spline.h"
#include "trackbed/path/path.h"

namespace trackbed {

/// Curvature bound that means no bound [1/m].
inline constexpr double kUnbounded = std::numeric_limits<double>::infinity();

/// A point of a LeastVariationCurve at which two of its segments meet.
struct CurveNode {
  Pose2 pose;              ///< Position [m] and heading [rad, not wrapped] of the curve.
  double curvature = 0.0;  ///< Curvature [1/m], positive to the left.
  double sharpness = 0.0;  ///< Derivative of the curvature along the curve [1/m^2].
  /// Length from the preceding node to this node [m], > 0; without meaning at the first node.
  double length = 0.0;
  /// Given point to which the curve is fitted at this node [m]; nullopt at a node between two given
  /// points.
  std::optional<Vec2> point{};
  double weight = 0.0;  ///< Length of the path that the point represents [m].
};

/// Fits a curve whose curvature varies as little as possible (a minimum variation curve, Moreton
/// and Séquin 1992). The curve minimizes the cost
///     sum over i of w_i n_i^2 + l^6 integral of (kappa'(s) - c)^2 ds.
/// In this cost, n_i [m] is the distance of the given point i from the curve, w_i [m] is the weight
/// of the point, l [m] is the smoothing length, and kappa' is the sharpness. The constant c, the
/// mean sharpness, is chosen to minimize the cost. For lines, arcs and clothoids, the integral of
/// (kappa' - c)^2 is 0, with a constant c. If all points lie on a line, arc or clothoid, the fitted
/// curve is this line, arc or clothoid, up to rounding.
///
/// The sharpness is continuous and is linear between nodes, so curvature and sharpness are
/// continuous. An open curve begins at the first point and ends at the last point, with the
/// prescribed headings. A closed curve returns to its first node with equal curvature and
/// sharpness; the last node repeats the first.
///
/// With a finite `max_curvature` [1/m], > 0, the cost has a penalty term: k l^4 times the integral
/// of (|kappa| - max_curvature)^2, with the smoothing length l and a large factor k. The penalty
/// term covers the parts of the curve on which |kappa| exceeds max_curvature, and is evaluated at
/// the nodes. With the penalty, the curve exceeds max_curvature at the nodes by less than a
/// thousandth of the excess without the penalty. Where the curvature jumps, as between a line and
/// an arc, a curve without the penalty has a larger curvature than the arc.
///
/// The argument `nodes` contains at least three nodes with initial values. In an open curve, the
/// first and the last node must have a point to fit. `headings` must be empty for a closed curve.
/// Newton's method converges if the distances of the initial curve from the points are small
/// compared with its radii of curvature. LeastVariationCurve returns nullopt if Newton's method
/// does not converge. The computing time is about 20 us per node.
std::optional<std::vector<CurveNode>> LeastVariationCurve(std::vector<CurveNode> nodes,
                                                          double smoothing_length, bool closed,
                                                          const EndHeadings& headings = {},
                                                          double max_curvature = kUnbounded);

/// Returns the segments between the nodes.
std::vector<Segment> SegmentsBetween(const std::vector<CurveNode>& nodes);

}  // namespace trackbed
