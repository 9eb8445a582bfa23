#include "src/planning/racing/lap_model.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "trackbed/core/error.h"

namespace trackbed {

LapModel::LapModel(const Track& track, const LapLimits& limits, std::size_t count)
    : limits_(limits), step_(track.length() / static_cast<double>(count)) {
  centers_.reserve(count);
  for (std::size_t i = 0; i < count; ++i) {
    centers_.push_back(track.At(StationAt(i)));
  }
}

double LapModel::SteeringReach(const Lap& lap, std::size_t i) const {
  if (limits_.steering_rate <= 0.0 || limits_.wheelbase <= 0.0) {
    return std::numeric_limits<double>::infinity();
  }
  // If the curvature changes by d kappa, the steering angle delta = atan(L kappa) changes by L |d
  // kappa|/(1 + (L kappa)^2).
  const double tangent =
      limits_.wheelbase * std::min(std::abs(lap.curvature[i]), std::abs(lap.curvature[After(i)]));
  return limits_.options.share * limits_.steering_rate * lap.lengths[i] *
         (1.0 + tangent * tangent) / limits_.wheelbase;
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
    length += lap.lengths.back();
  }
  for (std::size_t i = 0; i < count(); ++i) {
    const std::size_t next = After(i);
    const double turned = std::abs(lap.curvature[next] - lap.curvature[i]);
    const double reach = SteeringReach(lap, i);
    if (std::isfinite(reach) && turned > 0.0) {
      for (LimitStation* at : {&stations[i], &stations[next]}) {
        at->cap = at->cap > 0.0 ? std::min(at->cap, reach / turned) : reach / turned;
      }
    }
  }
  const LimitSpeeds found = LimitSpeedsAround(stations, length, limits_.diagram, limits_.options);
  lap.speeds = found.speeds;
  lap.time = found.time;
  return lap;
}

}  // namespace trackbed
