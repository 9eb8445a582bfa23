#include "src/control/ramped_path.h"

#include <algorithm>
#include <cmath>

#include "trackbed/core/angle.h"

namespace trackbed {
namespace {

/// Ratio of the lengths of tail and curvature ramp (RampedPath).
constexpr double kTail = 2.0;
/// Minimum ratio of the lengths of tail and curvature ramp. At this ratio, the tail needs at most
/// 1.25 times the maximum steering rate.
constexpr double kShortestTail = 1.0;

/// Offset of the ramped path from the path, and its derivatives with respect to the station.
struct Offset {
  double e = 0.0;
  double slope = 0.0;
  double bend = 0.0;
};

/// Largest second derivative of the polynomial (1 - u)^3 (1 + 3 u + 6 u^2), the shape of a tail for
/// u from 0 to 1.
const double kTailBend = 10.0 / std::sqrt(3.0);

/// Returns the offset of the ramped path at the distance x from a curvature step of height 1. The
/// argument `tail` is the length of the tail on the side of x. The fraction `before` of the ramp's
/// sideways shift lies before the curvature step.
Offset OffsetFrom(double x, double ramp, double tail, double before) {
  const double side = x < 0.0 ? -1.0 : 1.0;
  const double half = 0.5 * ramp;
  const double d = std::abs(x);
  const double end = (x < 0.0 ? -before : 1.0 - before) * ramp * ramp / 24.0;
  if (d < half) {
    // On the curvature ramp, the second derivative of the offset is linear in the distance x from
    // the step. At the ramp's end, the slope and the second derivative of the offset are 0.
    const double left = half - d;
    return {.e = end - side * left * left * left / (6.0 * ramp),
            .slope = left * left / (2.0 * ramp),
            .bend = -side * left / ramp};
  }
  if (d - half >= tail) {
    return {};
  }
  const double u = (d - half) / tail;
  const double v = 1.0 - u;
  return {.e = end * v * v * v * (1.0 + 3.0 * u + 6.0 * u * u),
          .slope = -side * end * 30.0 * u * u * v * v / tail,
          .bend = -end * 60.0 * u * v * (1.0 - 2.0 * u) / (tail * tail)};
}

}  // namespace

void RampedPath::Update(const ControlInput& input, double ahead) {
  input_ = &input;
  steps_.clear();
  const VehicleParams& vehicle = input.vehicle;
  const auto steering = [&](double curvature) {
    return std::clamp(SteeringForCurvature(vehicle, curvature), -vehicle.steering_limit,
                      vehicle.steering_limit);
  };
  const double last = input.station + ahead;
  const double tightest = CurvatureForSteering(vehicle, vehicle.steering_limit);
  const std::vector<Segment>& segments = input.reference.path.segments();
  steps_.reserve(segments.size());  // a path has at most one step per segment
  double station = 0.0;
  double leg = 0.0;      // Station at which the leg between cusps begins.
  std::size_t kept = 0;  // Number of curvature steps before the present leg.
  const auto end_leg = [&] {
    for (std::size_t i = kept; i < steps_.size(); ++i) {
      Step& step = steps_[i];
      const double room_before = step.station - step.tail_before;
      const double room_after = station - step.station;
      step.ramp = std::min({step.ramp, 2.0 * room_before, 2.0 * room_after,
                            std::max(room_before, room_after) / (0.5 + kShortestTail)});
      step.tail_before = std::min(kTail * step.ramp, room_before - 0.5 * step.ramp);
      step.tail_after = std::min(kTail * step.ramp, room_after - 0.5 * step.ramp);
      // The tails of two neighboring curvature steps may overlap, so their curvatures add up. The
      // factor 2 in `bend` leaves enough steering angle for two overlapping tails.
      const double bend = 2.0 * kTailBend / 24.0 * step.ramp * step.ramp;
      const auto share = [&](double tail, double curvature) {
        const double left = std::max(tightest - std::abs(curvature), 0.0);
        return std::min(tail * tail * left / (bend * std::abs(step.height)), 0.5);
      };
      // The steering rate on a tail is proportional to its share, divided by the cube of its
      // length.
      const double rate_before = std::pow(step.tail_before, 3);
      const double rate_after = std::pow(step.tail_after, 3);
      const double share_before = rate_before * share(step.tail_before, step.from);
      const double share_after = rate_after * share(step.tail_after, step.from + step.height);
      step.before = share_before + share_after > 0.0 ? share_before / (share_before + share_after)
                                                     : rate_before / (rate_before + rate_after);
    }
    kept = steps_.size();
    leg = station;
  };
  for (std::size_t i = 0; i < segments.size(); ++i) {
    const Segment& segment = segments[i];
    if (i > 0) {
      const Segment& before = segments[i - 1];
      if (before.direction != segment.direction) {
        end_leg();
      } else if (const double end = before.CurvatureAt(before.length); end != segment.curvature) {
        const double ramp = SpeedAt(station) *
                            std::abs(steering(segment.curvature) - steering(end)) /
                            vehicle.steering_rate;
        const double reach = (0.5 + kTail) * ramp;
        if (station + reach > input.station && station - reach < last) {
          steps_.push_back({.station = station,
                            .from = end,
                            .height = segment.curvature - end,
                            .ramp = ramp,
                            .tail_before = leg,  // start of the leg; end_leg replaces this value
                            .tail_after = 0.0,
                            .before = 0.5,
                            .direction = segment.direction});
        }
      }
    }
    station += segment.length;
  }
  end_leg();
  std::erase_if(steps_, [](const Step& step) { return !(step.ramp > 0.0); });
}

void RampedPath::UpdateWithoutRamps(const ControlInput& input) {
  input_ = &input;
  steps_.clear();
}

PathPoint RampedPath::At(double s) const {
  PathPoint point = input_->reference.path.At(s);
  for (const Step& step : steps_) {
    const double x = s - step.station;
    const double tail = x < 0.0 ? step.tail_before : step.tail_after;
    const auto [e, slope, bend] = OffsetFrom(x, step.ramp, tail, step.before);
    if (step.direction != point.direction) {
      continue;
    }
    const double yaw = point.pose.yaw;
    point.pose.x -= step.height * e * std::sin(yaw);
    point.pose.y += step.height * e * std::cos(yaw);
    // On a reverse segment, a slope of the offset turns the car's heading to the opposite side.
    point.pose.yaw = WrapAngle(yaw + step.direction * step.height * slope);
    point.curvature += step.height * bend;
  }
  return point;
}

double RampedPath::SpeedAt(double s) const {
  const SpeedProfile& planned = input_->reference.speed;
  const double speed = std::abs(input_->state.speed);
  if (planned.knots().empty()) {
    return speed;
  }
  return std::max(planned.SpeedAt(s) + speed - planned.SpeedAt(input_->station), 0.0);
}

Tracking RampedPath::Track() const {
  Tracking tracking;
  tracking.foot = At(input_->station);
  const Pose2& pose = input_->state.pose;
  tracking.cross_track = ToLocal(tracking.foot.pose, pose.position()).y();
  tracking.heading_error = AngleDifference(pose.yaw, tracking.foot.pose.yaw);
  return tracking;
}

double RampedPath::CurvatureAfter(double way) const {
  const PathPoint here = At(input_->station);
  const PathPoint ahead = At(input_->station + way);
  return ahead.direction == here.direction ? ahead.curvature : here.curvature;
}

}  // namespace trackbed
