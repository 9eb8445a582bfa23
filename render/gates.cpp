#include "render/gates.h"

#include "render/ground_line.h"

namespace trackbed::render {
namespace {

constexpr Color kGate{0.98F, 0.98F, 0.98F};
constexpr double kGateWidth = 0.14;  // Width of the gate lines [m].
// Height of the gate lines above the ground, below plans and trails [m].
constexpr double kGateHeight = 0.005;

class GateLines : public Overlay {
 public:
  explicit GateLines(const OverlaySetup& setup) : recording_(setup.recording) {
    for (const std::vector<Point>& gate : recording_.gates) {
      std::array<Vec2, 4> corners;
      for (std::size_t i = 0; i < corners.size(); ++i) {
        corners[i] = {gate[i].x, gate[i].y};
      }
      lines_.push_back(Outline(recording_, corners));
    }
  }

  [[nodiscard]] std::size_t max_shapes() const override { return PointCount(lines_); }

  void AddShapes(SceneContext& context) override {
    for (const std::vector<Point>& line : lines_) {
      AddLine(context, recording_.world, line,
              {kGate, kGateWidth * context.camera.paint_scale, kGateHeight});
    }
  }

  void AddLegend(std::vector<LegendEntry>& legend) const override {
    if (!lines_.empty()) {
      legend.push_back({.color = kGate, .text = "gate", .symbol = LegendSymbol::kOutline});
    }
  }

 private:
  const Recording& recording_;
  std::vector<std::vector<Point>> lines_;
};

}  // namespace

OverlayEntry GateOverlay() {
  return MakeOverlayEntry<GateLines>("gates", "outlines of the gates that the plan leads through");
}

}  // namespace trackbed::render
