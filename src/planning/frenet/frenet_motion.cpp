#include "trackbed/planning/frenet/frenet_motion.h"

#include <algorithm>
#include <cmath>

#include "trackbed/core/error.h"

namespace trackbed {
namespace {

/// Minimum distance between two points that form a path segment [m].
constexpr double kMinSegmentLength = 1e-3;

/// Returns the number of equal time intervals into which a piece is divided. Returns nullopt if the
/// Frenet frame does not exist at a point of the motion.
std::optional<int> CountIntervals(const Path& path, const FrenetPiece& piece, double time_step,
                                  double spacing) {
  constexpr int kProbes = 16;
  double fastest = 0.0;
  for (int i = 0; i <= kProbes; ++i) {
    const auto motion = FromFrenet(path, piece.At(piece.duration * i / kProbes));
    if (!motion || !std::isfinite(motion->speed)) {
      return std::nullopt;
    }
    fastest = std::max(fastest, std::abs(motion->speed));
  }
  const double step = std::min(time_step, spacing / std::max(fastest, 1e-9));
  return std::max(1, static_cast<int>(std::ceil(piece.duration / step)));
}

}  // namespace

FrenetState FrenetPiece::At(double t) const {
  FrenetState state{s.At(t), s.At(t, 1), s.At(t, 2)};
  if (over_station) {
    const double along = state.s - s.coefficients[0];
    state.d = d.At(along);
    state.d_slope = d.At(along, 1);
    state.d_bend = d.At(along, 2);
  } else {
    state.d = d.At(t);
    state.d_slope = d.At(t, 1) / state.s_rate;
    state.d_bend =
        (d.At(t, 2) - state.d_slope * state.s_acceleration) / (state.s_rate * state.s_rate);
  }
  return state;
}

double FrenetMotion::duration() const {
  double duration = 0.0;
  for (const FrenetPiece& piece : pieces) {
    duration += piece.duration;
  }
  return duration;
}

FrenetState FrenetMotion::At(double t) const {
  TRACKBED_CHECK(!pieces.empty(), "a motion without pieces");
  double left = std::max(t, 0.0);
  for (const FrenetPiece& piece : pieces) {
    if (left < piece.duration) {
      return piece.At(left);
    }
    left -= piece.duration;
  }
  return pieces.back().At(pieces.back().duration);
}

std::optional<std::vector<TrajectoryPoint>> SampleMotion(const Path& path,
                                                         const FrenetMotion& motion,
                                                         double time_step, double spacing) {
  TRACKBED_CHECK(time_step > 0.0 && spacing > 0.0, "time step {}, spacing {}", time_step, spacing);
  std::vector<TrajectoryPoint> points;
  double began = 0.0;
  for (const FrenetPiece& piece : motion.pieces) {
    const auto intervals = CountIntervals(path, piece, time_step, spacing);
    if (!intervals) {
      return std::nullopt;
    }
    for (int i = points.empty() ? 0 : 1; i <= *intervals; ++i) {
      const double t = piece.duration * i / *intervals;
      TrajectoryPoint point{began + t, 0.0, piece.At(t), {}};
      const auto state = FromFrenet(path, point.frenet);
      if (!state || !std::isfinite(state->curvature)) {
        return std::nullopt;
      }
      point.motion = *state;
      if (!points.empty()) {
        const TrajectoryPoint& last = points.back();
        const double h = point.t - last.t;
        // Integrate by the Euler-Maclaurin formula, which is the trapezoidal rule corrected by the
        // accelerations at both ends.
        point.distance =
            last.distance +
            std::max(0.0, 0.5 * h * (last.motion.speed + state->speed) +
                              h * h / 12.0 * (last.motion.acceleration - state->acceleration));
      }
      points.push_back(point);
    }
    began += piece.duration;
  }
  return points;
}

Reference ToReference(const std::vector<TrajectoryPoint>& points) {
  TRACKBED_CHECK(!points.empty(), "a trajectory without points");
  std::vector<TrajectoryPoint> kept{points.front()};
  for (const TrajectoryPoint& point : points) {
    if (point.distance - kept.back().distance >= kMinSegmentLength) {
      kept.push_back(point);
    }
  }
  if (kept.size() > 1) {
    kept.back() = points.back();  // replace the last kept point by the end of the motion
  }
  std::vector<CurvePoint> curve;
  std::vector<SpeedProfile::Knot> knots;
  for (const TrajectoryPoint& point : kept) {
    curve.push_back({point.distance, point.motion.pose.yaw, point.motion.curvature});
    knots.push_back({point.distance, std::max(point.motion.speed, 0.0)});
  }
  return {Path(points.front().motion.pose, SegmentsThrough(curve)), SpeedProfile(std::move(knots))};
}

}  // namespace trackbed
