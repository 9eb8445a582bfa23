#include "render/plan_lines.h"

#include <algorithm>

#include "render/ground_line.h"
#include "render/palette.h"

namespace trackbed::render {
namespace {

constexpr double kPlanWidth = 0.48;
constexpr double kPlanHeight = 0.008;
// An abandoned plan fades into the asphalt, not to translucent paint: that would be darker where
// two pieces overlap. It is narrower than the trails of ghosts, so what is left of it to see is
// what was not driven.
constexpr double kAbandonedWidth = 0.24;
constexpr Color kAsphalt{0.60F, 0.62F, 0.60F};
constexpr float kAbandonedShare = 0.35F;  // of its own color
// A plan that was driven for less than this leaves nothing behind: planning again twice a second
// would fill the road with fans of lines [s].
constexpr double kBrief = 1.0;

/// `newer` plans have been adopted since.
RibbonStyle PlanStyle(const Color& color, std::size_t newer, double scale) {
  if (newer == 0) {
    return {color, kPlanWidth * scale, kPlanHeight};
  }
  const auto fade = [](float own, float asphalt) {
    return asphalt + kAbandonedShare * (own - asphalt);
  };
  // Most lie on each other where they rejoin the route: the newer above the older.
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
  /// A thinned plan, and from when it holds.
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
  std::vector<Line> lines_;  // in the order of time
};

}  // namespace

OverlayEntry PlanOverlay() {
  return EntryOf<PlanLines>("plan", "the planned path, and replanned ones");
}

}  // namespace trackbed::render
