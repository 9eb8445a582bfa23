#include "render/plan_lines.h"

#include <algorithm>

#include "render/ground_line.h"
#include "render/palette.h"

namespace trackbed::render {
namespace {

constexpr double kPlanWidth = 0.48;
constexpr double kPlanHeight = 0.008;
// Replaced plans are drawn in an opaque color near that of asphalt, since translucent paint would
// be darker where two pieces overlap. The line of a replaced plan is narrower than the trails of
// ghosts, so only its undriven part remains visible.
constexpr double kAbandonedWidth = 0.24;
constexpr Color kAsphalt{0.60F, 0.62F, 0.60F};
// Weight of the plan's color in its mixture with the color of asphalt.
constexpr float kAbandonedShare = 0.35F;
// Minimum time for which the car must have followed a replaced plan, so that the plan is still
// shown [s]. If all replaced plans were shown, two replans per second would cover the road with
// lines.
constexpr double kBrief = 1.0;

/// Returns the style of the line that shows a plan. The argument `newer` is the number of plans
/// that the car adopted later.
RibbonStyle PlanStyle(const Color& color, std::size_t newer, double scale) {
  if (newer == 0) {
    return {color, kPlanWidth * scale, kPlanHeight};
  }
  const auto fade = [](float own, float asphalt) {
    return asphalt + kAbandonedShare * (own - asphalt);
  };
  // Replaced plans often overlap where they return to the route, so newer plans are drawn above
  // older plans.
  return {{fade(color.r, kAsphalt.r), fade(color.g, kAsphalt.g), fade(color.b, kAsphalt.b)},
          kAbandonedWidth * scale,
          std::max(kPlanHeight - 0.001 * static_cast<double>(newer), 0.002)};
}

class PlanLines : public Overlay {
 public:
  explicit PlanLines(const OverlaySetup& setup) : recording_(setup.recording) {
    Add(recording_.begin(), kPlanColor, recording_.plan);
    for (const NewPlan& plan : recording_.new_plans) {
      Add(plan.from, kNewPlanColor, plan.path);
    }
  }

  [[nodiscard]] std::size_t max_shapes() const override {
    std::size_t sum = 0;
    for (const Line& line : lines_) {
      sum += line.points.size();
    }
    return sum;
  }

  void AddShapes(SceneContext& context) override {
    const auto held = static_cast<std::size_t>(std::count_if(
        lines_.begin(), lines_.end(), [&](const Line& line) { return line.from <= context.time; }));
    for (std::size_t i = 0; i < held; ++i) {
      const Line& line = lines_[i];
      const bool abandoned_new_one = i > 0 && i + 1 < held;
      if (abandoned_new_one && lines_[i + 1].from - line.from < kBrief) {
        continue;
      }
      AddLine(context, recording_.world, line.points,
              PlanStyle(line.color, held - 1 - i, context.camera.paint_scale));
    }
  }

  void AddLegend(std::vector<LegendEntry>& legend) const override {
    if (!recording_.plan.empty()) {
      legend.push_back({kPlanColor, "planned path"});
    }
    if (!recording_.new_plans.empty()) {
      legend.push_back({kNewPlanColor, "replanned path"});
    }
  }

 private:
  /// The thinned line of a plan, and the time at which the car adopted the plan [s].
  struct Line {
    double from;
    Color color;
    std::vector<Point> points;
  };

  void Add(double from, const Color& color, const std::vector<Point>& path) {
    std::vector<Point> points;
    for (const Point& point : path) {
      points.push_back(recording_.OnGround(point));
    }
    lines_.push_back({from, color, Thinned(points)});
  }

  const Recording& recording_;
  std::vector<Line> lines_;  // lines of the plans in the order of time
};

}  // namespace

OverlayEntry PlanOverlay() {
  return MakeOverlayEntry<PlanLines>("plan", "the planned path, and replanned ones");
}

}  // namespace trackbed::render
