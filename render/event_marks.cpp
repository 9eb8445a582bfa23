#include "render/event_marks.h"

#include <algorithm>
#include <cmath>
#include <set>

#include "render/events.h"
#include "render/ground_line.h"
#include "render/layout.h"
#include "render/palette.h"
#include "trackbed/core/angle.h"

namespace trackbed::render {
namespace {

using Kind = RunEvent::Kind;

// Minimum time for which the text of an event is shown [s].
constexpr double kMinTextDuration = 1.5;
constexpr double kFlash = 0.6;  // Duration of the flash in a collision or roll-over [s].
constexpr double kSide = 0.4;   // Side of an event's mark [m].
constexpr double kRim = 0.07;   // Width of the dark rim around a mark [m].
// Height of the marks above the ground, higher than all trails [m].
constexpr double kMarkHeight = 0.030;
constexpr Color kDetected{0.98F, 0.98F, 0.98F};
constexpr Color kRimColor{0.05F, 0.06F, 0.08F};

Color ColorOf(Kind kind) {
  switch (kind) {
    case Kind::kObstacleKnown:
      return kDetected;
    case Kind::kNewPlan:
      return kNewPlanColor;
    case Kind::kRateLimit:
    case Kind::kCollision:
    case Kind::kRollOver:
      break;
  }
  return kLimitColor;
}

const char* LegendText(Kind kind) {
  switch (kind) {
    case Kind::kObstacleKnown:
      return "obstacle detected";
    case Kind::kNewPlan:
      return "new plan";
    case Kind::kRateLimit:
      return "steering rate limit";
    case Kind::kCollision:
      return "collision";
    case Kind::kRollOver:
      break;
  }
  return "roll-over";
}

bool EndsTheRun(Kind kind) {
  return kind == Kind::kCollision || kind == Kind::kRollOver;
}

class EventMarks : public Overlay {
 public:
  explicit EventMarks(const OverlaySetup& setup)
      : recording_(setup.recording), events_(FindEvents(setup.recording)) {}

  [[nodiscard]] std::size_t max_shapes() const override { return 4 * events_.size(); }

  void AddShapes(SceneContext& context) override {
    for (const RunEvent& event : events_) {
      if (event.from > context.time) {
        break;
      }
      const double scale = context.camera.paint_scale;
      if (EndsTheRun(event.kind)) {
        AddCross(context, event, 3.0 * scale);
      } else {
        AddDiamond(context, event, scale);
      }
    }
  }

  void Draw(PictureContext& context) override {
    Canvas canvas(context.image, context.font);
    const Layout layout(context.image.width, context.image.height);
    constexpr std::size_t kMaxLines = 3;
    std::vector<const RunEvent*> shown;
    for (const RunEvent& event : events_) {
      if (event.from <= context.time &&
          context.time <= std::max(event.to, event.from + kMinTextDuration)) {
        // If several plans are adopted in quick succession, only the text of the last one is shown.
        if (!shown.empty() && event.kind == Kind::kNewPlan) {
          std::erase_if(shown, [](const RunEvent* other) { return other->kind == Kind::kNewPlan; });
        }
        shown.push_back(&event);
      }
    }
    if (shown.size() > kMaxLines) {
      shown.erase(shown.begin(), shown.end() - kMaxLines);
    }
    double bottom = context.bottom;
    for (auto event = shown.rbegin(); event != shown.rend(); ++event) {
      bottom = DrawLine(canvas, context.font, layout, context.left, bottom, **event);
    }
    for (const RunEvent& event : events_) {
      if (EndsTheRun(event.kind)) {
        Flash(canvas, layout, context, context.time - event.from);
      }
    }
  }

  void AddLegend(std::vector<LegendEntry>& legend) const override {
    std::set<Kind> kinds;
    for (const RunEvent& event : events_) {
      if (kinds.insert(event.kind).second) {
        legend.push_back(
            {.color = ColorOf(event.kind),
             .text = LegendText(event.kind),
             .symbol = EndsTheRun(event.kind) ? LegendSymbol::kCross : LegendSymbol::kDiamond});
      }
    }
  }

 private:
  [[nodiscard]] Point Beside(const Point& place, double x, double y) const {
    return recording_.OnGround({place.x + x, place.y + y});
  }

  /// Adds a diamond-shaped mark with a dark rim, aligned with the car's heading.
  void AddDiamond(SceneContext& context, const RunEvent& event, double scale) const {
    const double heading = recording_.plants.front().Heading(event.from) + 0.25 * kPi;
    const double c = std::cos(heading);
    const double s = std::sin(heading);
    const auto square = [&](double side, double height, const Color& color) {
      // half the mark's side, reduced because AddRibbonPiece lengthens a piece by 0.15 of its width
      const double half = 0.5 * side / 1.15;
      AddPiece(context, recording_.world, Beside(event.place, -half * c, -half * s),
               Beside(event.place, half * c, half * s), {color, side, height});
    };
    square((kSide + kRim) * scale, kMarkHeight, kRimColor);
    square(kSide * scale, kMarkHeight + 0.002, ColorOf(event.kind));
  }

  void AddCross(SceneContext& context, const RunEvent& event, double scale) const {
    const double heading = recording_.plants.front().Heading(event.from);
    for (const double turn : {0.25, -0.25}) {
      const double x = 0.5 * kSide * scale * std::cos(heading + turn * kPi);
      const double y = 0.5 * kSide * scale * std::sin(heading + turn * kPi);
      AddPiece(context, recording_.world, Beside(event.place, -x, -y), Beside(event.place, x, y),
               {kRimColor, 0.4 * kSide * scale, kMarkHeight});
      AddPiece(context, recording_.world, Beside(event.place, -x, -y), Beside(event.place, x, y),
               {ColorOf(event.kind), 0.25 * kSide * scale, kMarkHeight + 0.002});
    }
  }

  /// Draws the text of an event in a panel. Returns the row at which the lower edge of the next
  /// panel, above this panel, must be [px].
  static double DrawLine(Canvas& canvas, const Font& font, const Layout& layout, double first,
                         double bottom, const RunEvent& event) {
    const double tall = layout.label + 0.6 * layout.pad;
    const double top = bottom - tall;
    const double mark = 0.5 * layout.label;
    const double left = first + layout.pad;
    canvas.Fill({first, top, font.Width(event.text, layout.label) + mark + 2.5 * layout.pad, tall},
                layout.round(), EndsTheRun(event.kind) ? kLimitColor : kPanel,
                EndsTheRun(event.kind) ? 0.9 : kPanelAlpha);
    const double x = left + 0.5 * mark;
    const double y = top + 0.5 * tall;
    const double half = 0.5 * mark;
    canvas.FillConvex({{x - half, y}, {x, y - half}, {x + half, y}, {x, y + half}},
                      EndsTheRun(event.kind) ? kValue : ColorOf(event.kind), 1.0);
    canvas.Text(left + mark + 0.5 * layout.pad, top + 0.3 * layout.pad, event.text, layout.label,
                kValue);
    return top - 0.4 * layout.pad;
  }

  /// Draws a fading border around the frame.
  static void Flash(Canvas& canvas, const Layout& layout, const PictureContext& context,
                    double since) {
    if (since < 0.0 || since >= kFlash) {
      return;
    }
    const double alpha = 0.85 * (1.0 - since / kFlash);
    const double thick = 1.2 * layout.margin;
    const double width = context.image.width;
    const double height = context.image.height;
    canvas.Fill({0.0, 0.0, width, thick}, 0.0, kLimitColor, alpha);
    canvas.Fill({0.0, height - thick, width, thick}, 0.0, kLimitColor, alpha);
    canvas.Fill({0.0, thick, thick, height - 2.0 * thick}, 0.0, kLimitColor, alpha);
    canvas.Fill({width - thick, thick, thick, height - 2.0 * thick}, 0.0, kLimitColor, alpha);
  }

  const Recording& recording_;
  std::vector<RunEvent> events_;  // events in the order of time
};

}  // namespace

OverlayEntry EventOverlay() {
  return MakeOverlayEntry<EventMarks>(
      "events", "marks and labels: obstacle detected, new plan, rate limit, collision, roll-over");
}

}  // namespace trackbed::render
