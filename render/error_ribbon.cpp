#include "render/error_ribbon.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "render/trail.h"

namespace trackbed::render {
namespace {

constexpr double kRibbonWidth = 0.26;  // [m]

/// Formats a length for the legend, as "5 cm" or "2 m".
std::string Length(double meters) {
  return meters < 1.0 ? fmt::format("{:.3g} cm", 100.0 * meters) : fmt::format("{:.3g} m", meters);
}

class ErrorRibbon : public Overlay {
 public:
  explicit ErrorRibbon(const OverlaySetup& setup)
      : recording_(setup.recording), scale_(setup.recording.scales.error) {
    if (!HasErrorScale(setup.recording)) {
      return;
    }
    std::vector<Color> colors;
    for (const double fraction : ErrorFractions(setup.recording)) {
      colors.push_back(ErrorColor(fraction));
    }
    trail_.emplace(setup.recording, 0, colors);
  }

  [[nodiscard]] std::size_t max_shapes() const override {
    return trail_ ? trail_->max_shapes() : 0;
  }

  void AddShapes(SceneContext& context) override {
    if (trail_) {
      RibbonStyle style = TrailStyle(recording_, 0, context.camera.paint_scale);
      style.width = kRibbonWidth * context.camera.paint_scale;
      trail_->AddShapes(context, style);
    }
  }

  void AddLegend(std::vector<LegendEntry>& legend) const override {
    if (trail_) {
      legend.push_back({.text = fmt::format("cross-track error, 0 to {}", Length(scale_)),
                        .ramp = {kErrorColors.begin(), kErrorColors.end()}});
    }
  }

 private:
  const Recording& recording_;
  double scale_;  // [m]
  std::optional<Trail> trail_;
};

}  // namespace

Color ErrorColor(double fraction) {
  const double at = std::clamp(fraction, 0.0, 1.0) * (kErrorColors.size() - 1);
  const auto below = std::min(static_cast<std::size_t>(at), kErrorColors.size() - 2);
  const auto part = static_cast<float>(at - static_cast<double>(below));
  const Color& a = kErrorColors[below];
  const Color& b = kErrorColors[below + 1];
  return {a.r + part * (b.r - a.r), a.g + part * (b.g - a.g), a.b + part * (b.b - a.b)};
}

bool HasErrorScale(const Recording& recording) {
  return recording.scales.error > 0.0;
}

std::vector<double> ErrorFractions(const Recording& recording) {
  constexpr double kSteps = 16.0;
  // the trail's color changes when the error deviates from the value of the present color by this
  // fraction of a color step; values above 0.5 cause hysteresis
  constexpr double kHysteresis = 0.6;
  const PlantRecording& car = recording.plants.front();
  std::vector<double> fractions;
  double step = -1.0;
  for (const double time : car.times()) {
    const double steps =
        kSteps * std::abs(car.ReadingsAt(time).cross_track.value_or(0.0)) / recording.scales.error;
    if (step < 0.0 || std::abs(steps - step) > kHysteresis) {
      step = std::round(steps);
    }
    fractions.push_back(step / kSteps);
  }
  return fractions;
}

OverlayEntry ErrorOverlay() {
  return MakeOverlayEntry<ErrorRibbon>("error", "the car's trail colored by its cross-track error");
}

}  // namespace trackbed::render
