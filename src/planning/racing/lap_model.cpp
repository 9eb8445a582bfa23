#include "src/planning/racing/lap_model.h"

#include <algorithm>
#include <boost/math/tools/toms748_solve.hpp>
#include <cmath>
#include <cstdint>

#include "trackbed/core/error.h"
#include "trackbed/vehicle/steady_turn.h"

namespace trackbed {
namespace {

/// Returns the largest speed of a lap, by its options or the car's top speed [m/s].
double FastestOn(const LapLimits& limits) {
  const double top = limits.diagram.forces().top_speed;
  const double wanted = limits.options.speed;
  return wanted > 0.0 && top > 0.0 ? std::min(wanted, top) : std::max(wanted, top);
}

/// Returns the largest lateral force that the car may use at any speed [m/s^2].
double LargestLateral(const LapLimits& limits) {
  double largest = 0.0;
  // Between the sections of the diagram, the force is linear in the squared speed, so its maximum
  // is at a section.
  for (const GgvSection& section : limits.diagram.sections()) {
    largest =
        std::max(largest, limits.diagram.MaxLateral({.speed = section.speed, .road = limits.road}));
  }
  return limits.options.share * largest;
}

}  // namespace

LapModel::LapModel(const Track& track, const LapLimits& limits, std::size_t count)
    : limits_(limits),
      fastest_(FastestOn(limits)),
      lateral_(LargestLateral(limits)),
      step_(track.length() / static_cast<double>(count)) {
  centers_.reserve(count);
  for (std::size_t i = 0; i < count; ++i) {
    centers_.push_back(track.At(StationAt(i)));
  }
}

double LapModel::UsableRate() const {
  return limits_.options.share * limits_.vehicle.steering_rate;
}

double LapModel::SteeringAt(double curvature, double speed) const {
  return SteeringInBend(limits_.vehicle,
                        {.curvature = curvature, .speed = speed, .road = limits_.road});
}

LapModel::Turn LapModel::TurnAt(const Lap& lap, std::size_t i, double speed) const {
  const double rate = UsableRate();
  if (rate <= 0.0) {
    return {};
  }
  const double from = lap.curvature[i];
  const double to = lap.curvature[After(i)];
  const auto slopes = [&](double curvature) {
    return SteeringSlopesInBend(limits_.vehicle,
                                {.curvature = curvature, .speed = speed, .road = limits_.road});
  };
  const SteeringSlopes at_from = slopes(from);
  const SteeringSlopes at_to = slopes(to);
  const double turned = SteeringAt(to, speed) - SteeringAt(from, speed);
  const double factor = speed / (lap.lengths[i] * rate);
  return {.ratio = factor * turned,
          .by_from = -factor * at_from.by_curvature,
          .by_to = factor * at_to.by_curvature,
          .by_speed = factor * (turned / speed + at_to.by_speed - at_from.by_speed)};
}

double LapModel::SpeedOfTurn(const Lap& lap, std::size_t i) const {
  const double from = lap.curvature[i];
  const double to = lap.curvature[After(i)];
  // Beyond the lateral grip, the slip of the brush tyre model no longer grows, and the car cannot
  // drive anyway.
  const double sharpest = std::max(std::abs(from), std::abs(to));
  const double most =
      sharpest * fastest_ * fastest_ > lateral_ ? std::sqrt(lateral_ / sharpest) : fastest_;
  const auto beyond = [&](double speed) {
    const double turned = SteeringAt(to, speed) - SteeringAt(from, speed);
    return speed * std::abs(turned) / lap.lengths[i] - UsableRate();
  };
  const double high = beyond(most);
  if (UsableRate() <= 0.0 || high <= 0.0) {
    return fastest_;
  }
  constexpr int kBits = 40;
  std::uintmax_t iterations = 100;
  return boost::math::tools::toms748_solve(beyond, 0.0, most, -UsableRate(), high,
                                           boost::math::tools::eps_tolerance<double>(kBits),
                                           iterations)
      .first;
}

Lap LapModel::Drive(const TrackLine& line) const {
  Lap lap;
  for (std::size_t i = 0; i < count(); ++i) {
    const double s = StationAt(i);
    const LineOffset offset = line.At(s);
    TRACKBED_REQUIRE(1.0 - centers_[i].curvature * offset.d > 0.0,
                     "LapModel: the line folds over at s = {} m", s);
    lap.shapes.push_back(ShapeAt(centers_[i], offset));
    const double square = lap.shapes.back().square.value();
    lap.stretch.push_back(std::sqrt(square));
    lap.curvature.push_back(lap.shapes.back().cross.value() / (square * lap.stretch.back()));
    lap.sharpest = std::max(lap.sharpest, std::abs(lap.curvature.back()));
  }
  std::vector<LimitStation> stations(count());
  double length = 0.0;
  for (std::size_t i = 0; i < count(); ++i) {
    lap.lengths.push_back(0.5 * step_ * (lap.stretch[i] + lap.stretch[After(i)]));
    stations[i].s = length;
    stations[i].curvature = lap.curvature[i];
    stations[i].road = limits_.road;
    stations[i].cap = fastest_;
    length += lap.lengths.back();
  }
  for (std::size_t i = 0; i < count(); ++i) {
    const double cap = SpeedOfTurn(lap, i);
    for (LimitStation* at : {&stations[i], &stations[After(i)]}) {
      at->cap = std::min(at->cap, cap);
    }
  }
  const LimitSpeeds found = LimitSpeedsAround(stations, length, limits_.diagram, limits_.options);
  lap.speeds = found.speeds;
  lap.time = found.time;
  return lap;
}

}  // namespace trackbed
