#include "render/trail.h"

#include <algorithm>

#include "render/error_ribbon.h"
#include "render/ground_line.h"

namespace trackbed::render {
namespace {

bool Differ(const Color& a, const Color& b) {
  return a.r != b.r || a.g != b.g || a.b != b.b;
}

class Trails : public Overlay {
 public:
  explicit Trails(const OverlaySetup& setup) : recording_(setup.recording) {
    const std::size_t cars = setup.Shows("ghosts") ? setup.recording.plants.size() : 1;
    for (std::size_t car = 0; car < cars; ++car) {
      // The error ribbon, if shown, replaces the car's trail.
      if (car > 0 || !setup.Shows("error") || !HasErrorScale(setup.recording)) {
        trails_.push_back({car, Trail(setup.recording, car)});
      }
    }
  }

  [[nodiscard]] std::size_t max_shapes() const override {
    std::size_t sum = 0;
    for (const auto& [car, trail] : trails_) {
      sum += trail.max_shapes();
    }
    return sum;
  }

  void AddShapes(SceneContext& context) override {
    for (const auto& [car, trail] : trails_) {
      trail.AddShapes(context, TrailStyle(recording_, car, context.camera.paint_scale));
    }
  }

 private:
  struct CarTrail {
    std::size_t car;
    Trail trail;
  };
  const Recording& recording_;
  std::vector<CarTrail> trails_;
};

}  // namespace

RibbonStyle TrailStyle(const Recording& recording, std::size_t car, double scale) {
  const Color color = recording.plants[car].color();
  if (car == 0) {
    return {color, 0.14 * scale, 0.024};
  }
  return {color, 0.28 * scale, std::max(0.018 - 0.002 * static_cast<double>(car), 0.010)};
}

Trail::Trail(const Recording& recording, std::size_t car, const std::vector<Color>& colors)
    : recording_(recording), car_(car) {
  const PlantRecording& plant = recording.plants[car];
  std::vector<Point> driven;
  for (const double time : plant.times()) {
    driven.push_back(recording.OnGround(plant.Position(time)));
  }
  // Keeps points of the trail where its line bends or changes color.
  std::vector<std::size_t> kept = KeptPoints(driven);
  for (std::size_t i = 1; i < colors.size(); ++i) {
    if (Differ(colors[i], colors[i - 1])) {
      kept.push_back(i);
    }
  }
  std::sort(kept.begin(), kept.end());
  kept.erase(std::unique(kept.begin(), kept.end()), kept.end());
  for (const std::size_t i : kept) {
    points_.push_back(driven[i]);
    times_.push_back(plant.times()[i]);
    if (!colors.empty()) {
      colors_.push_back(colors[i]);
    }
  }
}

void Trail::AddShapes(SceneContext& context, RibbonStyle style) const {
  for (std::size_t i = 1; i < points_.size() && times_[i - 1] < context.time; ++i) {
    // The last piece of the trail ends at the car's present position.
    const Point end = times_[i] <= context.time
                          ? points_[i]
                          : recording_.OnGround(recording_.plants[car_].Position(context.time));
    if (!colors_.empty()) {
      style.color = colors_[i - 1];
    }
    AddPiece(context, recording_.world, points_[i - 1], end, style);
  }
}

OverlayEntry TrailOverlay() {
  return MakeOverlayEntry<Trails>("trail", "the track of each car's rear-axle center");
}

}  // namespace trackbed::render
