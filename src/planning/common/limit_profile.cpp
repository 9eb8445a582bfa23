#include "trackbed/planning/common/limit_profile.h"

#include <algorithm>
#include <boost/math/tools/toms748_solve.hpp>
#include <cmath>
#include <limits>

#include "src/planning/common/jerk_limit.h"
#include "trackbed/core/error.h"
#include "trackbed/vehicle/params.h"

// Computes the speed profile at the limit of a g-g-v diagram by forward and backward passes
// (Heilmeier et al. 2020). For each station, MaxSquares computes the largest v^2 that the tyres'
// lateral limit and the speed cap permit. In the forward pass, the car accelerates as hard as
// possible; in the backward pass, it brakes as late as possible. With a jerk limit, LimitJerk and
// the two passes are repeated alternately until the passes hardly change the speeds. A car that
// starts too fast brakes as hard as possible; the result names the first station at which the car
// exceeds the limit. For a lap, the passes start at the slowest station and repeat until the speeds
// at start and end agree.

namespace trackbed {
namespace {

using Squares = std::vector<double>;  // Squared speeds of the car [m^2/s^2], one per station.

/// Computes the accelerations that are available to a car at a station, as functions of the squared
/// speed.
class Capability {
 public:
  Capability(const GgvDiagram& diagram, const LimitOptions& options)
      : diagram_(diagram), options_(options) {}

  /// Returns the largest acceleration dv/dt of the car [m/s^2].
  [[nodiscard]] double MaxAcceleration(const LimitStation& at, double squared) const {
    const Demand demand = DemandAt(at, squared);
    return Accelerations(demand).largest / demand.stretch;
  }

  [[nodiscard]] double MinAcceleration(const LimitStation& at, double squared) const {
    const Demand demand = DemandAt(at, squared);
    return Accelerations(demand).smallest / demand.stretch;
  }

  /// Returns the margin of the tyres to their limit [m/s^2], which is negative beyond the limit.
  /// If the margin is positive, the brakes can prevent the car from speeding up, but a lack of
  /// drive force may slow it down.
  [[nodiscard]] double Margin(const LimitStation& at, double squared) const {
    const Demand demand = DemandAt(at, squared);
    const double across = options_.share * diagram_.MaxLateral(demand.point) - demand.point.lateral;
    const double weight = demand.load - kMinLoad;
    if (across <= 0.0) {
      return std::min(across, weight);
    }
    GgvPoint whole = demand.point;
    whole.lateral /= options_.share;
    const TyreRange tyres = diagram_.TyresAt(whole);
    const LongitudinalForces& car = diagram_.forces();
    const double resistance = car.drag * whole.speed * whole.speed / car.mass + demand.slope;
    return std::min({across, weight, resistance - options_.share * tyres.braking});
  }

  /// Returns the largest squared speed, at most `most`, that is within the tyres' limit; 0 if no
  /// speed is.
  [[nodiscard]] double MaxSquared(const LimitStation& at, double most) const;

 private:
  // Vertical load as a fraction of the weight below which the car counts as airborne.
  static constexpr double kMinLoad = 0.05;

  struct Demand {
    GgvPoint point;
    // Vertical load f_n/g of the car as a fraction of the weight; may be negative.
    double load = 1.0;
    double stretch = 1.0;  // Ratio A of the road's length to its horizontal length.
    // Component of gravity that acts against the car's motion along the road [m/s^2].
    double slope = 0.0;
  };

  [[nodiscard]] static Demand DemandAt(const LimitStation& at, double squared) {
    Demand demand;
    const double steep = 1.0 + at.grade * at.grade;  // square of A = road length/horizontal length
    const double tilt = std::sqrt(steep + at.bank * at.bank);
    demand.stretch = std::sqrt(steep);
    const double gravity = kGravity + squared * at.crest;
    const double turn = squared * at.curvature;
    demand.load = (gravity - at.bank * turn) / (tilt * kGravity);
    demand.slope = at.grade * gravity / demand.stretch;
    demand.point = {
        .speed = std::sqrt(steep * squared),
        .road = at.road,
        .load = std::max(0.0, demand.load),
        .lateral = std::abs(steep * turn + at.bank * gravity) / (tilt * demand.stretch)};
    return demand;
  }

  [[nodiscard]] AccelerationRange Accelerations(const Demand& demand) const {
    return diagram_.AccelerationsAt(demand.point, options_.share, demand.slope);
  }

  const GgvDiagram& diagram_;
  const LimitOptions& options_;
};

double Capability::MaxSquared(const LimitStation& at, double most) const {
  const double at_most = Margin(at, most);
  if (at_most >= 0.0) {
    return most;
  }
  double low = 0.0;
  double at_low = Margin(at, low);
  // Search for any permitted speed, because on a bank that is too steep to stand on, low speeds are
  // not permitted either.
  constexpr int kMaxAttempts = 64;
  for (int i = kMaxAttempts - 1; at_low < 0.0 && i > 0; --i) {
    low = most * i / kMaxAttempts;
    at_low = Margin(at, low);
  }
  if (at_low <= 0.0) {
    return at_low < 0.0 ? 0.0 : low;
  }
  std::uintmax_t iterations = 40;
  const auto [below, above] = boost::math::tools::toms748_solve(
      [&](double squared) { return Margin(at, squared); }, low, most, at_low, at_most,
      boost::math::tools::eps_tolerance<double>(30), iterations);
  return Margin(at, above) >= 0.0 ? above : below;
}

/// Returns the largest squared speed, at most `most`, that a car can have at one end of an interval
/// of `length` [m]. The squared speed at the other end of the interval is `from`. The function
/// `can` returns the available acceleration or deceleration at a squared speed.
template <typename Can>
double Reach(double from, double length, double most, const Can& can) {
  const auto spare = [&](double squared) {
    return can(squared) - (squared - from) / (2.0 * length);
  };
  const double at_most = spare(most);
  if (at_most >= 0.0) {
    return most;
  }
  double low = std::max(0.0, std::min(from, most) * 0.5);
  double at_low = spare(low);
  if (at_low < 0.0) {
    low = 0.0;
    at_low = spare(low);
  }
  if (at_low <= 0.0 || low >= most) {
    return low;  // even the lowest speed cannot be reached, because the road is too steep
  }
  std::uintmax_t iterations = 12;
  const auto [below, above] = boost::math::tools::toms748_solve(
      spare, low, most, at_low, at_most, boost::math::tools::eps_tolerance<double>(24), iterations);
  return spare(above) >= 0.0 ? above : below;
}

class Passes {
 public:
  Passes(const std::vector<LimitStation>& stations, const Capability& can)
      : stations_(stations), capability_(can) {}

  /// Limits each squared speed to the value that the car can reach by accelerating from the
  /// previous station.
  void Forward(Squares& squares) const {
    for (std::size_t i = 0; i + 1 < squares.size(); ++i) {
      const double length = stations_[i + 1].s - stations_[i].s;
      const double step = 2.0 * length * capability_.MaxAcceleration(stations_[i], squares[i]);
      const double most = std::clamp(squares[i] + step, 0.0, squares[i + 1]);
      squares[i + 1] = Reach(squares[i], length, most, [&](double squared) {
        return capability_.MaxAcceleration(stations_[i + 1], squared);
      });
    }
  }

  /// Limits each squared speed to the largest value from which the car can brake to the speed at
  /// the next station.
  void Backward(Squares& squares) const {
    for (std::size_t i = squares.size() - 1; i-- > 0;) {
      const double length = stations_[i + 1].s - stations_[i].s;
      const double step =
          -2.0 * length * capability_.MinAcceleration(stations_[i + 1], squares[i + 1]);
      const double most = std::clamp(squares[i + 1] + step, 0.0, squares[i]);
      squares[i] = Reach(squares[i + 1], length, most, [&](double squared) {
        return -capability_.MinAcceleration(stations_[i], squared);
      });
    }
  }

  /// If the squared speed `start` of the car is above the profile, raises the first squared speeds
  /// of the profile. At the raised speeds, the car brakes as hard as it can until its speed meets
  /// the profile.
  void BrakeFrom(double start, Squares& squares) const {
    squares[0] = start;
    for (std::size_t i = 0; i + 1 < squares.size(); ++i) {
      const double length = stations_[i + 1].s - stations_[i].s;
      const double braked =
          squares[i] + 2.0 * length * capability_.MinAcceleration(stations_[i], squares[i]);
      if (braked <= squares[i + 1]) {
        return;
      }
      squares[i + 1] = braked;
    }
  }

 private:
  const std::vector<LimitStation>& stations_;
  const Capability& capability_;
};

void Check(const std::vector<LimitStation>& stations, const LimitOptions& options) {
  TRACKBED_REQUIRE(stations.size() >= 2, "LimitSpeeds: {} stations; must be at least two",
                   stations.size());
  TRACKBED_REQUIRE(options.share > 0.0 && options.share <= 1.0 && options.jerk >= 0.0 &&
                       options.speed >= 0.0 && std::isfinite(options.jerk) &&
                       std::isfinite(options.speed),
                   "LimitSpeeds: share {}, jerk {} m/s^3, speed {} m/s", options.share,
                   options.jerk, options.speed);
  for (std::size_t i = 0; i < stations.size(); ++i) {
    const LimitStation& at = stations[i];
    TRACKBED_REQUIRE(std::isfinite(at.s) && std::isfinite(at.curvature) &&
                         std::isfinite(at.grade) && std::isfinite(at.bank) &&
                         std::isfinite(at.crest) && std::isfinite(at.road) && at.road > 0.0 &&
                         std::isfinite(at.cap) && at.cap >= 0.0,
                     "LimitSpeeds: a number of the station {} m is not finite or negative", at.s);
    TRACKBED_REQUIRE(i == 0 || at.s > stations[i - 1].s,
                     "LimitSpeeds: stations {} and {} m do not rise", stations[i - 1].s, at.s);
  }
}

/// Returns the largest permitted squared speed at each station, regardless of the other stations.
Squares MaxSquares(const std::vector<LimitStation>& stations, const GgvDiagram& diagram,
                   const LimitOptions& options, const Capability& can) {
  double fastest = std::numeric_limits<double>::infinity();
  for (const double speed : {options.speed, diagram.forces().top_speed}) {
    fastest = speed > 0.0 ? std::min(fastest, speed) : fastest;
  }
  TRACKBED_REQUIRE(std::isfinite(fastest), "LimitSpeeds: neither the options nor the car {}",
                   "give a largest speed");
  Squares squares;
  squares.reserve(stations.size());
  for (const LimitStation& at : stations) {
    const double cap = at.cap > 0.0 ? std::min(at.cap, fastest) : fastest;
    squares.push_back(can.MaxSquared(at, cap * cap));
  }
  return squares;
}

std::vector<double> StationList(const std::vector<LimitStation>& stations) {
  std::vector<double> s;
  s.reserve(stations.size());
  for (const LimitStation& at : stations) {
    s.push_back(at.s);
  }
  return s;
}

LimitSpeeds Result(const std::vector<LimitStation>& stations, const Squares& squares) {
  LimitSpeeds result;
  for (std::size_t i = 0; i < squares.size(); ++i) {
    result.speeds.push_back(std::sqrt(squares[i]));
    if (i > 0) {
      result.time +=
          2.0 * (stations[i].s - stations[i - 1].s) / (result.speeds[i - 1] + result.speeds[i]);
    }
  }
  return result;
}

/// Repeats jerk limiting and the two passes alternately until the passes hardly lower the squared
/// speeds.
template <typename Smooth, typename Pass>
void SmoothWithin(const Smooth& smooth, const Pass& pass, Squares& squares) {
  constexpr int kMaxIterations = 100;
  // Relative decrease of a squared speed that counts as no change.
  constexpr double kMinDecrease = 1e-4;
  for (int round = 0; round < kMaxIterations; ++round) {
    smooth(squares);
    const Squares before = squares;
    pass(squares);
    bool lowered = false;
    for (std::size_t i = 0; i < squares.size(); ++i) {
      lowered = lowered || before[i] - squares[i] > kMinDecrease * before[i];
    }
    if (!lowered) {
      squares = before;
      return;
    }
  }
  smooth(squares);
}

/// Repeats forward and backward passes over a lap until the speeds at its start and end agree. The
/// last element of `squares` is the squared speed at the first station one lap later.
void PassAroundLap(const Passes& passes, Squares& squares) {
  constexpr int kLaps = 50;
  constexpr double kEqualityTolerance = 1e-12;
  for (int lap = 0; lap < kLaps; ++lap) {
    const double before = squares.front();
    squares.back() = before;
    passes.Forward(squares);
    squares.front() = squares.back();
    passes.Backward(squares);
    squares.back() = squares.front();
    if (before - squares.front() <= kEqualityTolerance * before) {
      return;
    }
  }
}

}  // namespace

LimitSpeeds LimitSpeedsAlong(const std::vector<LimitStation>& stations, const GgvDiagram& diagram,
                             const LimitOptions& options, double start_speed, double end_speed) {
  Check(stations, options);
  TRACKBED_REQUIRE(std::isfinite(start_speed) && start_speed >= 0.0 && std::isfinite(end_speed) &&
                       end_speed >= 0.0,
                   "LimitSpeedsAlong: start speed {}, end speed {} m/s", start_speed, end_speed);
  const Capability can(diagram, options);
  const Passes passes(stations, can);
  const Squares allowed = MaxSquares(stations, diagram, options, can);
  const double start = start_speed * start_speed;
  Squares squares = allowed;
  squares.front() = std::min(squares.front(), start);
  squares.back() = std::min(squares.back(), end_speed * end_speed);
  passes.Forward(squares);
  passes.Backward(squares);
  if (options.jerk > 0.0) {
    const std::vector<double> s = StationList(stations);
    SmoothWithin([&](Squares& lowered) { LimitJerk(s, options.jerk, lowered); },
                 [&](Squares& lowered) {
                   passes.Forward(lowered);
                   passes.Backward(lowered);
                 },
                 squares);
  }
  if (squares.front() < start) {
    passes.BrakeFrom(start, squares);
  }
  LimitSpeeds result = Result(stations, squares);
  constexpr double kLimitRounding = 1e-6;
  for (std::size_t i = 0; i < squares.size() && !result.excess; ++i) {
    const double cap = stations[i].cap;
    const bool capped = cap > 0.0 && squares[i] > cap * cap * (1.0 + kLimitRounding);
    if (squares[i] > allowed[i] * (1.0 + kLimitRounding) &&
        (capped || can.Margin(stations[i], squares[i]) < 0.0)) {
      result.excess = {stations[i].s, result.speeds[i], std::sqrt(allowed[i])};
    }
  }
  return result;
}

LimitSpeeds LimitSpeedsAround(const std::vector<LimitStation>& stations, double length,
                              const GgvDiagram& diagram, const LimitOptions& options) {
  Check(stations, options);
  TRACKBED_REQUIRE(std::isfinite(length) && length > stations.back().s - stations.front().s,
                   "LimitSpeedsAround: a length of {} m with stations from {} to {} m", length,
                   stations.front().s, stations.back().s);
  const Capability can(diagram, options);
  const Squares allowed = MaxSquares(stations, diagram, options, can);
  // Start the lap at the slowest station, because, except on slopes, no pass lowers the speed at
  // this station.
  const auto slowest = std::min_element(allowed.begin(), allowed.end()) - allowed.begin();
  std::vector<LimitStation> lap(stations.begin() + slowest, stations.end());
  Squares squares(allowed.begin() + slowest, allowed.end());
  for (std::ptrdiff_t i = 0; i <= slowest; ++i) {
    lap.push_back(stations[static_cast<std::size_t>(i)]);
    lap.back().s += length;
    squares.push_back(allowed[static_cast<std::size_t>(i)]);
  }
  const Passes passes(lap, can);
  PassAroundLap(passes, squares);
  if (options.jerk > 0.0) {
    const std::vector<double> s = StationList(lap);
    SmoothWithin([&](Squares& lowered) { LimitJerkAround(s, options.jerk, lowered); },
                 [&](Squares& lowered) { PassAroundLap(passes, lowered); }, squares);
  }
  LimitSpeeds result = Result(lap, squares);
  result.speeds.pop_back();
  std::rotate(result.speeds.begin(), result.speeds.end() - slowest, result.speeds.end());
  return result;
}

}  // namespace trackbed
