#include "render/error_ribbon.h"

#include <algorithm>
#include <cmath>

#include "render/round_up.h"

namespace trackbed::render {

Color ErrorColor(double share) {
  const double at = std::clamp(share, 0.0, 1.0) * (kErrorColors.size() - 1);
  const auto below = std::min(static_cast<std::size_t>(at), kErrorColors.size() - 2);
  const auto part = static_cast<float>(at - static_cast<double>(below));
  const Color& a = kErrorColors[below];
  const Color& b = kErrorColors[below + 1];
  return {a.r + part * (b.r - a.r), a.g + part * (b.g - a.g), a.b + part * (b.b - a.b)};
}

double ErrorScale(const Recording& recording) {
  const PlantRecording& car = recording.plants.front();
  const std::optional<std::size_t> column = car.log().Find("cross_track_m");
  if (recording.plan.empty() || !column) {
    return 0.0;
  }
  constexpr double kLeast = 0.05;
  double most = kLeast;
  for (std::size_t row = 0; row < car.log().times().size(); ++row) {
    most = std::max(most, std::abs(car.log().table().at(row, *column)));
  }
  return RoundedUp(most);
}

std::vector<double> ErrorShares(const Recording& recording, double scale) {
  constexpr double kSteps = 16.0;
  constexpr double kHold = 0.6;  // of a step: half would change where two steps meet
  const PlantRecording& car = recording.plants.front();
  std::vector<double> shares;
  double step = -1.0;
  for (const double time : car.times()) {
    const double share = kSteps * std::abs(car.ReadingsAt(time).cross_track.value_or(0.0)) / scale;
    if (step < 0.0 || std::abs(share - step) > kHold) {
      step = std::round(share);
    }
    shares.push_back(step / kSteps);
  }
  return shares;
}

}  // namespace trackbed::render
