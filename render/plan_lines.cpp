#include "render/plan_lines.h"

#include <algorithm>

#include "render/ground_line.h"
#include "render/palette.h"

namespace trackbed::render {
namespace {

constexpr double kPlanWidth = 0.48;
constexpr double kPlanHeight = 0.008;
// A replaced plan is drawn in a color near that of asphalt, since translucent paint would be darker
// where two pieces overlap. The line of a replaced plan is narrower than the trails of ghosts, so
// only the part that no car has driven remains visible.
constexpr double kAbandonedWidth = 0.24;
constexpr Color kAsphalt{0.60F, 0.62F, 0.60F};
constexpr float kAbandonedShare = 0.35F;  // Weight of the plan's color in the mixture with the
                                          // color of asphalt.
// Plans that the car followed for less than this time are not shown after they are replaced [s].
// With two replans per second, all replaced plans together would cover the road with lines.
constexpr double kBrief = 1.0;

/// Returns the style of a plan's line. `newer` is the number of plans that the car adopted later.
RibbonStyle PlanStyle(const Color& color, std::size_t newer, double scale) {
  if (newer == 0) {
    return {color, kPlanWidth * scale, kPlanHeight};
  }
  const auto fade = [](float own, float asphalt) {
    return asphalt + kAbandonedShare * (own - asphalt);
  };
  // Replaced plans often overlap where they rejoin the route, so newer plans are drawn above older
  // ones.
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
  std::vector<Line> lines_;  // lines in the order of time
};

}  // namespace

OverlayEntry PlanOverlay() {
  return MakeOverlayEntry<PlanLines>("plan", "the planned path, and replanned ones");
}

}  // namespace trackbed::render
