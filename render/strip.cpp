#include "render/strip.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "render/palette.h"
#include "trackbed/core/angle.h"

namespace trackbed::render {
namespace {

constexpr Color kCurvature{0.86F, 0.88F, 0.84F};
constexpr Color kCommand{1.00F, 1.00F, 1.00F};
// Color of the curve of the actual steering angle; equal to the car's color.
constexpr Color kActual = CarColor(0);
// Size of the chart's labels relative to Layout::label; slightly smaller than the labels of the
// legend.
constexpr double kLettersToCell = 0.86;

class StripPanel : public Overlay {
 public:
  explicit StripPanel(const OverlaySetup& setup)
      : strip_(setup.recording, setup.width, setup.height, setup.font),
        gap_(0.5 * Layout(setup.width, setup.height).pad) {}

  void Draw(PictureContext& context) override {
    strip_.Draw(context.image, context.font, context.time);
    context.bottom = strip_.top() - gap_;
  }

 private:
  Strip strip_;
  double gap_;  // gap between the chart and the next panel [px]
};

}  // namespace

Strip::Strip(const Recording& recording, int width, int height, Font& font)
    : begin_(recording.begin()), end_(recording.scales.end), layout_(width, height) {
  const double tall = 4.1 * layout_.label;
  const double letters = kLettersToCell * layout_.label;
  panel_ = {layout_.margin, height - layout_.margin - tall, width - 2.0 * layout_.margin, tall};
  left_ = static_cast<int>(std::round(panel_.left + layout_.pad));
  top_ = static_cast<int>(std::round(panel_.top + 0.4 * layout_.pad + letters));
  columns_ = std::max(2, static_cast<int>(panel_.width - 2.0 * layout_.pad));
  rows_ = std::max(4, static_cast<int>(panel_.top + tall - 0.5 * layout_.pad) - top_);

  const Scales& most = recording.scales;
  std::vector<double> command;
  std::vector<double> actual;
  std::vector<double> curvature;
  for (int column = 0; column < columns_; ++column) {
    const double time = begin_ + (end_ - begin_) * column / (columns_ - 1);
    // The curves of the chart end where the car's log ends.
    if (time <= recording.plants.front().log().end()) {
      const Readings readings = recording.plants.front().ReadingsAt(time);
      command.push_back(readings.steering_command);
      actual.push_back(readings.steering);
      curvature.push_back(recording.PlannedCurvature(time).value_or(0.0));
    }
  }

  Image scratch;
  const auto blank = [&] {
    scratch.Resize(columns_, rows_);
    std::fill(scratch.rgb.begin(), scratch.rgb.end(), std::uint8_t{0});
    return Canvas(scratch, font);
  };
  // Maximum height of a curve above the middle of the plot [px]; leaves room for the line's
  // thickness.
  const double reach = 0.5 * rows_ - layout_.hairline;
  const auto curve = [&](const std::vector<double>& values, double hairlines) {
    std::vector<CanvasPoint> points;
    for (const double value : values) {
      points.push_back(
          {static_cast<double>(points.size()) + 0.5, 0.5 * rows_ - reach * value / most.steering});
    }
    blank().Stroke(points, hairlines * layout_.hairline, kValue, 1.0);
    return MakeMask(scratch);
  };
  // The curve drawn on top is narrower, so that both curves are visible where they coincide.
  command_ = curve(command, 2.6);
  actual_ = curve(actual, 1.1);
  if (most.curvature > 0.0) {
    Canvas canvas = blank();
    double column = 0.0;
    for (const double value : curvature) {
      const double middle = 0.5 * rows_;
      const double up = reach * value / most.curvature;
      canvas.FillConvex({{column, middle},
                         {column + 1.0, middle},
                         {column + 1.0, middle - up},
                         {column, middle - up}},
                        kValue, 1.0);
      column += 1.0;
    }
    curvature_ = MakeMask(scratch);
  }

  const double degrees = most.steering * 180.0 / kPi;
  labels_ = {{0.0, kCommand, "steering command"},
             {0.0, kActual, fmt::format("actual steering (full scale +/-{:.1f} deg)", degrees)}};
  if (most.curvature > 0.0) {
    labels_.insert(labels_.begin(),
                   {0.0, kCurvature,
                    fmt::format("planned curvature (full scale +/-{:.3g} 1/m)", most.curvature)});
  }
  double pen = left_;
  for (Label& label : labels_) {
    label.left = pen;
    pen += font.Width(label.text, letters) + layout_.gap;
  }
}

double Strip::PixelColumn(double time) const {
  return end_ > begin_ ? std::clamp((time - begin_) / (end_ - begin_), 0.0, 1.0) * (columns_ - 1)
                       : 0.0;
}

Strip::Mask Strip::MakeMask(const Image& drawn) const {
  Mask mask;
  mask.reserve(drawn.rgb.size() / 3);
  for (std::size_t i = 0; i < drawn.rgb.size(); i += 3) {
    mask.push_back(drawn.rgb[i]);
  }
  return mask;
}

void Strip::Blend(Image& image, const Mask& mask, Color color, double alpha, int first,
                  int last) const {
  if (mask.empty()) {
    return;
  }
  const std::array<int, 3> rgb{static_cast<int>(255.0F * color.r),
                               static_cast<int>(255.0F * color.g),
                               static_cast<int>(255.0F * color.b)};
  const int weight = static_cast<int>(256.0 * alpha);
  const int right = std::min(last, image.width - left_);
  const int bottom = std::min(rows_, image.height - top_);
  for (int row = 0; row < bottom; ++row) {
    const std::uint8_t* share = mask.data() + static_cast<std::ptrdiff_t>(row) * columns_;
    std::uint8_t* pixel = image.Pixel(left_ + first, top_ + row);
    for (int column = first; column < right; ++column, pixel += 3) {
      if (share[column] > 0) {
        for (std::size_t i = 0; i < 3; ++i) {
          // Rounds the mixed color to nearest in fixed-point arithmetic, in units of 1/65280 (255
          // times 256).
          const int change = weight * share[column] * (rgb[i] - pixel[i]);
          pixel[i] = static_cast<std::uint8_t>(pixel[i] +
                                               (change + (change < 0 ? -32640 : 32640)) / 65280);
        }
      }
    }
  }
}

void Strip::Draw(Image& image, Font& font, double time) const {
  Canvas canvas(image, font);
  canvas.Fill(panel_, layout_.round(), kPanel, kPanelAlpha);
  const double cursor = PixelColumn(time);
  const int now = std::min(columns_, static_cast<int>(cursor) + 1);
  Blend(image, curvature_, kCurvature, 0.55, 0, now);
  Blend(image, curvature_, kCurvature, 0.28, now, columns_);
  canvas.Fill(
      {static_cast<double>(left_), top_ + 0.5 * rows_ - 0.5, static_cast<double>(columns_), 1.0},
      0.0, kLabel, 0.55);
  Blend(image, command_, kCommand, 1.0, 0, now);
  Blend(image, actual_, kActual, 1.0, 0, now);
  canvas.Fill(
      {left_ + cursor, static_cast<double>(top_), layout_.hairline, static_cast<double>(rows_)},
      0.0, kValue, 0.9);
  for (const Label& label : labels_) {
    canvas.Text(label.left, panel_.top + 0.3 * layout_.pad, label.text,
                kLettersToCell * layout_.label, label.color);
  }
}

OverlayEntry StripOverlay() {
  OverlayEntry entry = MakeOverlayEntry<StripPanel>(
      "strip", "planned curvature and steering over time; only where named");
  entry.by_default = false;
  return entry;
}

}  // namespace trackbed::render
