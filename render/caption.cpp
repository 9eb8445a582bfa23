#include "render/caption.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "render/layout.h"
#include "render/tyre_forces.h"
#include "trackbed/core/angle.h"

// Draws the caption of a frame in panels: title, note and wind at the top left, the legend at the
// top right. The readings of the caption are drawn above the panels at the bottom of the frame.
// Text sizes are determined by Layout; the legend is drawn smaller and the note is shortened if
// necessary to fit.
namespace trackbed::render {
namespace {

struct Reading {
  std::string label;
  std::string value;
  // longest possible text of the displayed value; determines the column's width, so that columns
  // stay in place when numbers change
  std::string widest;
};

/// Formats a number with a plus or minus sign, or without a sign if it rounds to zero.
std::string Signed(double value, int digits, const char* unit) {
  const std::string text = fmt::format("{:+.{}f}", value, digits);
  const bool zero = text.find_first_not_of("+-0.") == std::string::npos;
  return fmt::format("{}{}", zero ? text.substr(1) : text, unit);
}

/// Formats a lateral and a longitudinal difference between two cars, as "0.98 m left, 0.12 m
/// ahead". If the stations of both cars are known, the longitudinal difference is the difference of
/// these stations.
std::string RelativePositionText(const RelativePosition& apart) {
  const double ahead = apart.station.value_or(apart.ahead);
  return fmt::format("{:.2f} m {}, {:.2f} m {}", std::abs(apart.left),
                     apart.left < 0.0 ? "right" : "left", std::abs(ahead),
                     ahead < 0.0 ? "behind" : "ahead");
}

std::vector<Reading> ReadingsToShow(const Readings& readings) {
  std::vector<Reading> shown{
      {"t", fmt::format("{:.2f} s", readings.time), "000.00 s"},
      {"speed", fmt::format("{:.1f} m/s", readings.speed), "00.0 m/s"},
  };
  if (readings.lateral_acceleration) {
    shown.push_back(
        {"lateral", Signed(*readings.lateral_acceleration, 1, " m/s^2"), "+00.0 m/s^2"});
  }
  if (readings.tyre_use) {
    shown.push_back({"grip used", fmt::format("{:.0f} %", 100.0 * *readings.tyre_use), "000 %"});
  }
  if (readings.aids) {
    shown.push_back({"aids", *readings.aids, "ABS ESC"});
  }
  if (readings.hitch_angle) {
    shown.push_back(
        {"hitch", Signed(*readings.hitch_angle * 180.0 / kPi, 1, " deg"), "+000.0 deg"});
  }
  if (readings.cross_track) {
    shown.push_back({"off path", Signed(*readings.cross_track, 2, " m"), "+0.00 m"});
  }
  if (readings.apart) {
    shown.push_back({"difference between plants", RelativePositionText(*readings.apart),
                     "0.00 m right, 0.00 m behind"});
  }
  return shown;
}

/// Draws the readings in a narrow bar above the row `bottom` [px]. The bar with the readings has
/// several lines if the frame is too narrow for one line. Returns the top row of the bar with the
/// readings [px].
double DrawReadings(Canvas& canvas, const Font& font, const Layout& layout, double width,
                    double bottom, const Readings& readings) {
  const double space = 0.4 * layout.pad;  // gap between a label and its value
  const double widest = width - 2.0 * (layout.margin + layout.pad);
  // Lines of readings; each reading is stored with the position of its left edge.
  std::vector<std::vector<std::pair<Reading, double>>> lines(1);
  double pen = 0.0;
  double longest = 0.0;
  for (const Reading& reading : ReadingsToShow(readings)) {
    const double own =
        font.Width(reading.label, layout.label) + space +
        std::max(font.Width(reading.widest, layout.label), font.Width(reading.value, layout.label));
    if (pen > 0.0 && pen + own > widest) {
      lines.emplace_back();
      pen = 0.0;
    }
    lines.back().emplace_back(reading, pen);
    longest = std::max(longest, pen + own);
    pen += own + layout.gap;
  }
  const double tall = layout.label * static_cast<double>(lines.size()) + 0.8 * layout.pad;
  const double top = bottom - tall;
  canvas.Fill({layout.margin, top, longest + 2.0 * layout.pad, tall}, layout.round(), kPanel,
              kPanelAlpha);
  double line_top = top + 0.4 * layout.pad;
  for (const auto& line : lines) {
    for (const auto& [reading, at] : line) {
      const double left = layout.margin + layout.pad + at;
      canvas.Text(left, line_top, reading.label, layout.label, kLabel);
      canvas.Text(left + font.Width(reading.label, layout.label) + space, line_top, reading.value,
                  layout.label, kValue);
    }
    line_top += layout.label;
  }
  return top;
}

/// Draws the symbol of a legend entry in the entry's color, in a cell of `width` by `height` px.
void DrawSymbol(Canvas& canvas, const LegendEntry& entry, double left, double top, double width,
                double height) {
  const double middle_x = left + 0.5 * width;
  const double middle_y = top + 0.53 * height;
  const double thick = 0.28 * height;
  if (!entry.ramp.empty()) {
    const double part = width / static_cast<double>(entry.ramp.size());
    for (std::size_t i = 0; i < entry.ramp.size(); ++i) {
      canvas.Fill(
          {left + part * static_cast<double>(i), middle_y - 0.75 * thick, part, 1.5 * thick}, 0.0,
          entry.ramp[i], 1.0);
    }
    return;
  }
  const double half = 0.36 * height;
  switch (entry.symbol) {
    case LegendSymbol::kLine:
      canvas.Fill({left, middle_y - 0.5 * thick, width, thick}, 0.5 * thick, entry.color, 1.0);
      break;
    case LegendSymbol::kOutline:
      canvas.Stroke({{left + 1.0, middle_y - half},
                     {left + width - 1.0, middle_y - half},
                     {left + width - 1.0, middle_y + half},
                     {left + 1.0, middle_y + half},
                     {left + 1.0, middle_y - half}},
                    std::max(1.2, 0.09 * height), entry.color, 1.0);
      break;
    case LegendSymbol::kDiamond:
      canvas.FillConvex({{middle_x - half, middle_y},
                         {middle_x, middle_y - half},
                         {middle_x + half, middle_y},
                         {middle_x, middle_y + half}},
                        entry.color, 1.0);
      break;
    case LegendSymbol::kCross:
      for (const double side : {-1.0, 1.0}) {
        canvas.Stroke(
            {{middle_x - half, middle_y - side * half}, {middle_x + half, middle_y + side * half}},
            0.22 * height, entry.color, 1.0);
      }
      break;
    case LegendSymbol::kDial: {
      std::vector<CanvasPoint> rim;
      constexpr int kCorners = 24;
      for (int i = 0; i <= kCorners; ++i) {
        const double angle = 2.0 * kPi * i / kCorners;
        rim.push_back({middle_x + half * std::cos(angle), middle_y + half * std::sin(angle)});
      }
      canvas.Stroke(rim, std::max(1.2, 0.07 * height), entry.color, 1.0);
      canvas.Stroke({{middle_x, middle_y}, {middle_x - 0.5 * half, middle_y - 0.5 * half}},
                    std::max(1.5, 0.12 * height), entry.color, 1.0);
      break;
    }
  }
}

/// Returns the size of the legend's letters [px]. The letters are made smaller until the legend
/// fits into half of the frame's height, but not smaller than the smallest readable size.
double LegendLetters(const Layout& layout, int height, int lines) {
  constexpr double kMaxHeightShare = 0.5;
  // minimum size of the legend's labels, as a fraction of their normal size
  constexpr double kMinLabelShare = 0.75;
  const double room = kMaxHeightShare * height - layout.margin - 1.2 * layout.pad;
  return std::round(
      std::clamp(room / std::max(1, lines), kMinLabelShare * layout.label, layout.label));
}

/// Draws the legend and returns the bottom row of the legend's panel [px].
double DrawLegend(Canvas& canvas, const Font& font, const Layout& layout, const Image& image,
                  const std::vector<LegendEntry>& legend) {
  int lines = 0;
  for (const LegendEntry& entry : legend) {
    lines += entry.note.empty() ? 1 : 2;
  }
  const double letters = LegendLetters(layout, image.height, lines);
  double widest = 0.0;
  for (const LegendEntry& entry : legend) {
    widest = std::max({widest, font.Width(entry.text, letters), font.Width(entry.note, letters)});
  }
  const double swatch = 1.3 * letters;
  const double total = 2.4 * layout.pad + swatch + widest;
  const double tall = letters * lines + 1.2 * layout.pad;
  const double left = image.width - layout.margin - total;
  canvas.Fill({left, layout.margin, total, tall}, layout.round(), kPanel, kPanelAlpha);
  double top = layout.margin + 0.6 * layout.pad;
  for (const LegendEntry& entry : legend) {
    DrawSymbol(canvas, entry, left + layout.pad, top, swatch, letters);
    for (const auto& [text, color] :
         {std::pair(entry.text, kValue), std::pair(entry.note, kLabel)}) {
      if (!text.empty()) {
        canvas.Text(left + 1.4 * layout.pad + swatch, top, text, letters, color);
        top += letters;
      }
    }
  }
  return layout.margin + tall;
}

/// Returns the height of the title's letters [px].
double TitleSize(const Layout& layout) {
  return std::round(0.5 * (layout.label + layout.value));
}
double TitlePanel(const Layout& layout) {
  return TitleSize(layout) + 0.8 * layout.pad;
}

/// Returns the top of the panel for a line of the caption [px]. Line 0 of the caption is the title.
double TopOfLine(const Layout& layout, int line) {
  return layout.margin + line * (TitlePanel(layout) + 0.5 * layout.pad);
}

void DrawLine(Canvas& canvas, const Font& font, const Layout& layout, int line,
              const std::string& text) {
  const double size = TitleSize(layout);
  const double top = TopOfLine(layout, line);
  canvas.Fill({layout.margin, top, font.Width(text, size) + 2.0 * layout.pad, TitlePanel(layout)},
              layout.round(), kPanel, kPanelAlpha);
  canvas.Text(layout.margin + layout.pad, top + 0.4 * layout.pad, text, size, kValue);
}

/// Draws the direction of the wind as an arrow. The arrow points up if the wind blows along the
/// camera's azimuth.
void DrawWind(Canvas& canvas, const Font& font, const Layout& layout, int line, const Vec2& wind,
              double azimuth) {
  constexpr double kCalm = 0.05;  // wind speed below which no arrow is drawn [m/s]
  const double size = TitleSize(layout);
  const double tall = TitlePanel(layout);
  const double top = TopOfLine(layout, line);
  const double speed = wind.norm();
  const std::string text = fmt::format("wind {:.1f} m/s", speed);
  const double arrow = 1.1 * size;
  const double wide = std::max(font.Width(text, size), font.Width("wind 00.0 m/s", size));
  canvas.Fill({layout.margin, top, wide + arrow + 2.6 * layout.pad, tall}, layout.round(), kPanel,
              kPanelAlpha);
  if (speed >= kCalm) {
    canvas.Arrow(layout.margin + layout.pad + 0.5 * arrow, top + 0.5 * tall, arrow,
                 std::atan2(wind.y(), wind.x()) - azimuth + 0.5 * kPi, kValue);
  }
  canvas.Text(layout.margin + 1.6 * layout.pad + arrow, top + 0.4 * layout.pad, text, size, kValue);
}

/// Shortens the name of a folder if it is too long for a frame.
std::string Shortened(const std::string& title) {
  constexpr std::size_t kMaxTitleLength = 32;
  return title.size() <= kMaxTitleLength ? title : title.substr(0, kMaxTitleLength - 3) + "...";
}

/// Shortens a text to `width` [px], so that it does not overlap the legend.
std::string Fitting(const Font& font, const std::string& text, double size, double width) {
  if (font.Width(text, size) <= width) {
    return text;
  }
  std::string shown = text;
  while (!shown.empty() && font.Width(shown + "...", size) > width) {
    shown.pop_back();
  }
  return shown + "...";
}

class CaptionPanels : public Overlay {
 public:
  explicit CaptionPanels(const OverlaySetup& setup)
      : recording_(setup.recording),
        forces_(setup.recording),
        caption_{setup.title, recording_.note} {}

  void Draw(PictureContext& context) override {
    caption_.legend = context.legend;
    Readings readings = recording_.ReadingsAt(context.time);
    for (const WheelForce& wheel : forces_.At(context.time, context.car)) {
      readings.tyre_use = std::max(readings.tyre_use.value_or(0.0), wheel.Use());
    }
    const Rows free = DrawCaption(context.image, context.font, caption_, readings,
                                  context.camera.azimuth, context.bottom);
    const double gap = 0.5 * Layout(context.image.width, context.image.height).pad;
    context.top = free.top + gap;
    context.bottom = free.bottom - gap;
  }

 private:
  const Recording& recording_;
  TyreForces forces_;
  Caption caption_;
};

}  // namespace

Rows DrawCaption(Image& image, Font& font, const Caption& caption, const Readings& readings,
                 double azimuth, double bottom) {
  Canvas canvas(image, font);
  const Layout layout(image.width, image.height);
  int line = 0;
  DrawLine(canvas, font, layout, line++, Shortened(caption.title));
  if (!caption.note.empty()) {
    constexpr double kShare = 0.7;  // maximum width of the note, as a fraction of the frame's width
    const double width = kShare * image.width - 2.0 * layout.pad;
    DrawLine(canvas, font, layout, line++, Fitting(font, caption.note, TitleSize(layout), width));
  }
  if (readings.wind) {
    DrawWind(canvas, font, layout, line, *readings.wind, azimuth);
  }
  const double top_of_readings = DrawReadings(canvas, font, layout, image.width, bottom, readings);
  return {DrawLegend(canvas, font, layout, image, caption.legend), top_of_readings};
}

OverlayEntry CaptionOverlay() {
  return MakeOverlayEntry<CaptionPanels>("caption", "run name, wind, legend and readings");
}

}  // namespace trackbed::render
