#include "src/planning/replan/passing.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "trackbed/vehicle/state.h"
#include "trackbed/world/world.h"

// Finds the leader, and decides where, how fast and whether a car may pass a moving leader. Because
// of oncoming obstacles, the car pulls out only if it could finish passing. The planner checks the
// passing maneuver after the motion, with constant limits, against all obstacles and the end of the
// route.

namespace trackbed {
namespace {

/// Tolerance of offsets and speeds that reach a bound exactly.
constexpr double kRounding = 1e-9;

/// Tolerance of the clearance [m], which may be smaller between samples.
constexpr double kClearanceTolerance = 1e-2;

/// Largest slopes of the quintic that moves by 1 within a length of 1: 10/sqrt(3) in the second
/// derivative, 60 in the third.
const double kQuinticBend = 10.0 / std::sqrt(3.0);
constexpr double kQuinticJerk = 60.0;

/// Largest acceleration of the quartic between two speeds that differ by 1 within a time of 1.
constexpr double kQuarticAcceleration = 1.5;

/// Returns whether a car that drives along the route at an offset [m] is on the road.
bool IsOnRoad(const VehicleParams& vehicle, const RoadWidths& road, double offset) {
  const double half = 0.5 * vehicle.width - kRounding;
  return offset + half <= road.left && half - offset <= road.right;
}

double RoomBeside(const AlongRequest& request, const AlongSettings& settings) {
  return 0.5 * request.vehicle.width + settings.safe_distance;
}

/// Continues a motion after its end. In the continuation, times count from the end of the motion.
class Continuation {
 public:
  explicit Continuation(const FrenetState& from) : end_(from) {}

  void ChangeSpeed(double speed, double acceleration) {
    const double duration = kQuarticAcceleration * std::abs(speed - end_.s_rate) / acceleration;
    if (duration > 0.0) {
      Add({duration, QuarticBetween({end_.s, end_.s_rate, 0.0}, {0.0, speed, 0.0}, duration),
           Polynomial{{end_.d}}, true});
    }
  }

  void KeepSpeed(double duration) {
    if (duration > 0.0) {
      Add({duration, Polynomial{{end_.s, end_.s_rate}}, Polynomial{{end_.d}}, true});
    }
  }

  void ReturnWithin(double length) {
    if (length > 0.0) {
      Add({length / end_.s_rate, Polynomial{{end_.s, end_.s_rate}},
           QuinticBetween({end_.d}, {0.0}, length), true});
    }
  }

  [[nodiscard]] const FrenetState& end() const { return end_; }
  [[nodiscard]] const FrenetMotion& motion() const { return motion_; }

 private:
  void Add(const FrenetPiece& piece) {
    motion_.pieces.push_back(piece);
    end_ = piece.At(piece.duration);
  }

  FrenetState end_;
  FrenetMotion motion_;
};

}  // namespace

double FrontOverAxle(const VehicleParams& vehicle) {
  return vehicle.length - vehicle.rear_overhang;
}

std::optional<Leader> LeaderIn(const Path& path, const AlongRequest& request,
                               const AlongSettings& settings, double to) {
  const double front = FrontOverAxle(request.vehicle);
  const double room = 0.5 * request.vehicle.width + settings.safe_distance;
  std::optional<Leader> nearest;
  for (std::size_t i = 0; i < request.obstacles.size(); ++i) {
    const OrientedBox& box = request.obstacles[i].box;
    Leader leader{.obstacle = i,
                  .rear = std::numeric_limits<double>::infinity(),
                  .left = -std::numeric_limits<double>::infinity(),
                  .right = std::numeric_limits<double>::infinity(),
                  .front = -std::numeric_limits<double>::infinity()};
    // Extend the range of the projection beyond the station `to`, because an obstacle's front may
    // lie beyond `to`.
    const Stations within{request.start.s, to + std::hypot(box.length, box.width)};
    for (const Vec2& corner : box.Corners()) {
      const Projection at = path.Project({corner.x(), corner.y(), 0.0}, within);
      leader.rear = std::min(leader.rear, at.s);
      leader.front = std::max(leader.front, at.s);
      leader.left = std::max(leader.left, at.cross_track);
      leader.right = std::min(leader.right, at.cross_track);
    }
    const bool in_lane = leader.right < room && leader.left > -room;
    const bool ahead = leader.rear > request.start.s + front && leader.rear < to;
    if (in_lane && ahead && (!nearest || leader.rear < nearest->rear)) {
      leader.speed = request.obstacles[i].velocity.dot(Direction(path.At(leader.rear).pose.yaw));
      nearest = leader;
    }
  }
  return nearest;
}

std::vector<double> ClearanceMargins(const AlongRequest& request, const AlongSettings& settings,
                                     const Pose2& start) {
  const OrientedBox footprint = FootprintAt(request.vehicle, start);
  std::vector<double> margins;
  for (const MovingBox& obstacle : request.obstacles) {
    margins.push_back(std::min(settings.safe_distance, Separation(footprint, obstacle.box)) -
                      kClearanceTolerance);
  }
  return margins;
}

std::optional<std::size_t> FirstTooNear(const AlongRequest& request,
                                        const std::vector<double>& margins,
                                        const std::vector<TrajectoryPoint>& points, double from,
                                        double shift) {
  for (const TrajectoryPoint& point : points) {
    if (point.t <= from) {
      continue;
    }
    const OrientedBox there = FootprintAt(request.vehicle, point.motion.pose);
    for (std::size_t i = 0; i < margins.size(); ++i) {
      if (Separation(there, request.obstacles[i].At(shift + point.t)) < margins[i]) {
        return i;
      }
    }
  }
  return std::nullopt;
}

bool ClearsLaterally(const AlongRequest& request, const AlongSettings& settings,
                     const Leader& leader, double d) {
  const double room = RoomBeside(request, settings) - kRounding;
  return d - room >= leader.left || d + room <= leader.right;
}

double ShiftLength(const VehicleParams& vehicle, const FrenetLimits& limits, double speed,
                   double aside) {
  const double shift = std::abs(aside);
  const double rate = limits.max_steering_rate_fraction * vehicle.steering_rate;
  const double bend = kQuinticBend * shift;
  return std::max({std::cbrt(kQuinticJerk * vehicle.wheelbase * shift * speed / rate),
                   std::sqrt(bend * vehicle.min_turning_radius()),
                   speed * std::sqrt(bend / limits.max_lateral_acceleration)});
}

double LongestShiftTime(const VehicleParams& vehicle, const RoadWidths& road,
                        const AlongOptions& options, double speed) {
  if (!(speed > 0.0)) {
    return 0.0;
  }
  return std::visit(
      [&](const auto& own) {
        double longest = 0.0;
        for (const double offset : own.end_offsets) {
          if (IsOnRoad(vehicle, road, offset)) {
            longest = std::max(longest, ShiftLength(vehicle, own.limits, speed, offset) / speed);
          }
        }
        return longest;
      },
      options);
}

void AddTimesToShift(AlongOptions& options, const VehicleParams& vehicle, const RoadWidths& road,
                     double speed) {
  constexpr double kGrowth = 1.25;
  auto* frenet = std::get_if<FrenetOptions>(&options);
  if (frenet == nullptr || frenet->end_times.empty()) {
    return;
  }
  const double needed = LongestShiftTime(vehicle, road, options, speed);
  const double given = *std::max_element(frenet->end_times.begin(), frenet->end_times.end());
  if (given >= needed) {
    return;
  }
  double last = given;
  while (last < kGrowth * needed) {
    last *= kGrowth;
    frenet->end_times.push_back(last);
  }
  frenet->weights.k_dt *= given / last;
  frenet->weights.k_st *= given / last;
}

std::vector<double> PassingOffsets(const AlongRequest& request, const AlongSettings& settings,
                                   const Leader& leader, const AlongOptions& options) {
  const double room = RoomBeside(request, settings);
  std::vector<double> offsets{leader.left + room, leader.right - room};
  std::visit(
      [&](const auto& own) {
        offsets.insert(offsets.end(), own.end_offsets.begin(), own.end_offsets.end());
      },
      options);
  std::erase_if(offsets, [&](double d) {
    return !ClearsLaterally(request, settings, leader, d) ||
           !IsOnRoad(request.vehicle, settings.road, d);
  });
  return offsets;
}

std::vector<double> PassingSpeeds(const AlongRequest& request, const Leader& leader,
                                  const AlongOptions& options) {
  if (leader.speed >= request.wanted) {
    return {};
  }
  std::vector<double> speeds;
  if (request.start.s_rate >= leader.speed) {
    speeds.push_back(leader.speed);
  }
  std::visit(
      [&](const auto& own) {
        for (const double factor : own.speed_factors) {
          if (factor * request.wanted > leader.speed) {
            speeds.push_back(factor * request.wanted);
          }
        }
      },
      options);
  std::sort(speeds.rbegin(), speeds.rend());
  return speeds;
}

std::vector<AlongOptions> PullOutOptions(AlongOptions options, const AlongRequest& request,
                                         const std::vector<double>& offsets, double speed) {
  // Lengths of the lateral motion, as multiples of the shortest length. The multiple 1.5 leaves a
  // margin for the approximations of ShiftLength.
  constexpr std::array kLengths{1.0, 1.5};
  std::visit(
      [&](auto& own) {
        own.end_offsets = offsets;
        own.speed_factors = {speed / request.wanted};
      },
      options);
  const double start = std::max(request.start.s_rate, 0.0);
  std::vector<double> aside(offsets);
  for (double& offset : aside) {
    offset = std::abs(offset - request.start.d);
  }
  const double nearest = *std::min_element(aside.begin(), aside.end());
  // A motion that ends before the next new plan would make the car brake, because the car brakes
  // after the end of a motion.
  constexpr double kShortest = 1.0;  // [s]
  const double length = std::max(
      ShiftLength(request.vehicle, std::visit([](const auto& own) { return own.limits; }, options),
                  std::max(start, speed), nearest),
      kShortest * std::max(start, speed));
  std::vector<AlongOptions> variants;
  if (auto* frenet = std::get_if<FrenetOptions>(&options)) {
    if (frenet->lateral == LateralMotion::kAuto) {
      frenet->lateral = LateralMotion::kOverStation;
    }
    for (const double times : kLengths) {
      const double end_time = times * length / (0.5 * (start + speed));
      if (end_time > 0.0) {
        frenet->end_times.push_back(end_time);
      }
    }
  } else {
    const auto& lattice = std::get<LatticeOptions>(options);
    for (const double times : kLengths) {
      if (times * length > 0.0 && times * length < lattice.layers * lattice.spacing) {
        LatticeOptions shorter = lattice;
        shorter.layers = 1;
        shorter.spacing = times * length;
        variants.emplace_back(std::move(shorter));
      }
    }
  }
  variants.push_back(std::move(options));
  return variants;
}

namespace {

/// Returns why the car cannot finish passing if it accelerates to `passing_speed` [m/s] after the
/// motion; empty if the car can finish passing.
std::string WhyNotPastAt(double passing_speed, const RouteFrame& frame, const AlongRequest& request,
                         const AlongSettings& settings, const FrenetLimits& limits,
                         const Leader& leader, const FrenetMotion& motion) {
  const double began = motion.duration();
  Continuation past(motion.At(began));
  if (past.end().s_rate < passing_speed) {
    past.ChangeSpeed(passing_speed, request.speed.acceleration);
  }
  const double speed = past.end().s_rate;
  const double behind = leader.front + leader.speed * (began + past.motion().duration()) +
                        settings.safe_distance + request.vehicle.rear_overhang - past.end().s;
  if (behind > 0.0 && speed <= leader.speed) {
    return fmt::format("the leader drives at {:.3g} m/s, the car at most at {:.3g} m/s",
                       leader.speed, speed);
  }
  const double pulling_in = ShiftLength(request.vehicle, limits, speed, past.end().d);
  const double passing = behind > 0.0 ? behind / (speed - leader.speed) : 0.0;
  // With the deceleration a, a stop from the speed v by a quartic s(t) takes the time c v/a and the
  // distance c v^2/(2 a). The factor c is kQuarticAcceleration.
  const double stopping = kQuarticAcceleration * speed / request.speed.deceleration;
  const double left = frame.goal - past.end().s - 0.5 * speed * stopping;
  if (!(speed * passing + pulling_in <= left)) {
    return "the route ends before the car could be past";
  }
  // At the end of the route, the leader may still approach the car that has passed it.
  double arrival = began + past.motion().duration() + left / speed + stopping;
  AlongRequest beyond = request;
  beyond.start.s = leader.front - FrontOverAxle(request.vehicle);
  const auto next = LeaderIn(frame.path, beyond, settings, frame.goal);
  if (next && next->speed >= kStandstillSpeed && next->speed < speed) {
    // The car may have to follow the next leader to the end of the route.
    const double ahead = FrontOverAxle(request.vehicle) + settings.gap;
    arrival = std::max(arrival, (frame.goal + ahead - next->rear) / next->speed +
                                    settings.time_gap + 0.5 * stopping);
  }
  const double behind_goal = frame.goal - request.vehicle.rear_overhang - settings.gap;
  if (leader.front + leader.speed * (arrival + settings.time_gap) > behind_goal) {
    return "the leader would reach the car where it stops at the end of the route";
  }
  past.KeepSpeed(passing);
  past.ReturnWithin(pulling_in);
  if (past.motion().pieces.empty()) {
    return "";
  }
  const auto points = SampleMotion(frame.path, past.motion(), limits.time_step,
                                   std::numeric_limits<double>::infinity());
  if (!points) {
    return "the route bends too much beside the leader";
  }
  const auto start = FromFrenet(frame.path, request.start);
  if (start && FirstTooNear(request, ClearanceMargins(request, settings, start->pose), *points, 0.0,
                            began)) {
    return "an obstacle would be in the way before the car could be past";
  }
  return "";
}

}  // namespace

std::string WhyNotPast(const RouteFrame& frame, const AlongRequest& request,
                       const AlongSettings& settings, const FrenetLimits& limits,
                       const Leader& leader, const FrenetMotion& motion) {
  // A slower car needs more time to pass, but a shorter distance to pull in and to stop.
  constexpr std::array kSpeedShares{1.0, 0.75, 0.5, 0.25, 0.0};
  const double slowest = std::min(motion.At(motion.duration()).s_rate, request.wanted);
  std::string why;
  for (const double share : kSpeedShares) {
    const double speed = std::lerp(slowest, request.wanted, share);
    const std::string own = WhyNotPastAt(speed, frame, request, settings, limits, leader, motion);
    if (own.empty()) {
      return "";
    }
    why = why.empty() ? own : why;
  }
  return why;
}

std::string WhyNoPullOut(const RejectionCounts& rejected) {
  const auto any = [&](std::initializer_list<Rejection> of) {
    return std::any_of(of.begin(), of.end(), [&](Rejection each) { return rejected.Of(each) > 0; });
  };
  std::vector<const char*> needs;
  if (any({Rejection::kCollision})) {
    needs.push_back("come closer to an obstacle than plan.replan.safe_distance");
  }
  if (any({Rejection::kRoad})) {
    needs.push_back("leave the road");
  }
  if (any({Rejection::kCurvature, Rejection::kSteeringRate})) {
    needs.push_back("steer more than the car can");
  }
  if (any({Rejection::kSpeed, Rejection::kAcceleration})) {
    needs.push_back("exceed the limits of speed or acceleration");
  }
  if (any({Rejection::kFrame})) {
    needs.push_back("turn away from the route");
  }
  return needs.empty()
             ? "beside the leader, the car could not brake to a stop"
             : fmt::format("each motion beside the leader would {}", fmt::join(needs, " or "));
}

std::string WhyNoRoom(const AlongRequest& request, const AlongSettings& settings,
                      const Leader& leader) {
  const double needed = request.vehicle.width + settings.safe_distance;
  return fmt::format(
      "no room to pass: it would need a road of {:.3g} m to the left of the route or {:.3g} m to "
      "the right, and plan.replan.road has {:.3g} m and {:.3g} m",
      leader.left + needed, needed - leader.right, settings.road.left, settings.road.right);
}

}  // namespace trackbed
