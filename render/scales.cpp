#include "render/scales.h"

#include <algorithm>
#include <cmath>

#include "render/recording.h"
#include "render/round_up.h"
#include "trackbed/core/angle.h"

namespace trackbed::render {

Scales ComputeScales(const Recording& recording) {
  constexpr double kMinError = 0.05;
  const PlantRecording& car = recording.plants.front();
  Scales scales{.end = recording.end(), .steering = kPi / 180.0};
  double error = kMinError;
  for (const double time : car.log().times()) {
    const Readings readings = car.ReadingsAt(time);
    error = std::max(error, std::abs(readings.cross_track.value_or(0.0)));
    scales.steering = std::max(
        {scales.steering, std::abs(readings.steering_command), std::abs(readings.steering)});
    scales.curvature =
        std::max(scales.curvature, std::abs(recording.PlannedCurvature(time).value_or(0.0)));
  }
  if (!recording.plan.empty() && car.log().Find("cross_track_m")) {
    scales.error = RoundedUp(error);
  }
  return scales;
}

void ShareScales(std::span<Recording> recordings) {
  Scales most;
  for (const Recording& recording : recordings) {
    const Scales& own = recording.scales;
    most = {std::max(most.end, own.end), std::max(most.error, own.error),
            std::max(most.steering, own.steering), std::max(most.curvature, own.curvature)};
  }
  for (Recording& recording : recordings) {
    recording.scales = most;
  }
}

}  // namespace trackbed::render
