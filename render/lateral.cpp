#include "render/lateral.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "render/layout.h"
#include "render/palette.h"
#include "render/round_up.h"

namespace trackbed::render {
namespace {

constexpr double kLength = 40.0;  // Length of the path that the lateral view shows [m].
// Fraction of the shown length of the path that is behind the car.
constexpr double kBehind = 0.75;
// Fraction of half the inset's height that the largest cross-track error of the run takes up.
constexpr double kFill = 0.85;
constexpr double kGridAlpha = 0.35;

/// Indices of the log columns that contain the car's station and cross-track error.
struct AlongPath {
  std::size_t station;
  std::size_t left;
};

std::optional<AlongPath> FindAlongPath(const TimedTable& log) {
  const std::optional<std::size_t> station = log.Find("s_m");
  const std::optional<std::size_t> left = log.Find("cross_track_m");
  return station && left ? std::optional(AlongPath{*station, *left}) : std::nullopt;
}

/// Returns the height of letters in an inset that is `height` px high. The height of an inset is at
/// most 0.3 times that of the frame.
double LetterSize(int height) {
  return std::clamp(std::round(0.085 * height), 11.0, 23.0);
}

}  // namespace

double LateralView::PixelsPerMeter(int width, int height) const {
  const double along = width / kLength;
  const double largest = recording_.scales.error;
  return largest > 0.0 ? std::min(along, kFill * 0.5 * height / (kMagnification * largest)) : along;
}

CanvasPoint LateralView::Place(int width, int height, double car, double station,
                               double left) const {
  const double scale = PixelsPerMeter(width, height);
  return {kBehind * width + scale * (station - car), 0.5 * height - kMagnification * scale * left};
}

void LateralView::DrawAxes(Canvas& canvas, Font& font, int width, int height, double car) const {
  const double scale = PixelsPerMeter(width, height);
  const double hairline = std::max(1.0, 0.005 * height);
  const double letters = LetterSize(height);
  // Draws two or three grid lines on each side of the path, at round distances from the path.
  const double reach = 0.5 * height / (kMagnification * scale);
  const double apart = RoundedUp(reach / 4.0);
  for (double left = apart; left < reach; left += apart) {
    for (const double side : {left, -left}) {
      const double y = Place(width, height, car, car, side).y;
      canvas.Fill({0.0, y - 0.5 * hairline, static_cast<double>(width), hairline}, 0.0, kLabel,
                  kGridAlpha);
      const std::string text = fmt::format("{:+.3g} m", side);
      if (y > 1.6 * letters && y + letters < height) {
        canvas.Text(width - font.Width(text, letters) - 0.3 * letters, y - letters, text, letters,
                    kLabel);
      }
    }
  }
  // Draws a mark at a round station about every 10 m.
  const double step = RoundedUp(width / scale / 5.0);
  const double first = step * std::floor((car - kBehind * width / scale) / step);
  for (double station = first; station < car + width / scale; station += step) {
    const double x = Place(width, height, car, station, 0.0).x;
    canvas.Fill({x - 0.5 * hairline, 0.0, hairline, static_cast<double>(height)}, 0.0, kLabel,
                0.5 * kGridAlpha);
  }
  canvas.Stroke({{0.0, 0.5 * height}, {static_cast<double>(width), 0.5 * height}}, 2.0 * hairline,
                kPlanColor, 0.9);
}

void LateralView::Draw(Image& image, Font& font, double time) const {
  const int width = image.width;
  const int height = image.height;
  Canvas canvas(image, font);
  canvas.Fill({0.0, 0.0, static_cast<double>(width), static_cast<double>(height)}, 0.0, kPanel,
              1.0);
  const double letters = LetterSize(height);
  const TimedTable& own = recording_.plants.front().log();
  const std::optional<AlongPath> path = FindAlongPath(own);
  if (!path) {
    canvas.Text(0.5 * letters, 0.3 * letters, "no path", letters, kValue);
    return;
  }
  const double car = own.Value(own.At(time), path->station);
  DrawAxes(canvas, font, width, height, car);
  const double thick = std::max(1.5, 0.014 * height);
  for (std::size_t i = recording_.plants.size(); i-- > 0;) {
    const TimedTable& log = recording_.plants[i].log();
    const std::optional<AlongPath> along = FindAlongPath(log);
    if (!along) {
      continue;
    }
    std::vector<CanvasPoint> line;
    for (std::size_t row = 0; row < log.times().size() && log.times()[row] <= time; ++row) {
      const CanvasPoint point = Place(width, height, car, log.table().at(row, along->station),
                                      log.table().at(row, along->left));
      // Skips points that are less than half a pixel from the previous point, and most points
      // outside the inset.
      if (point.x > -2.0 &&
          (line.empty() || std::hypot(point.x - line.back().x, point.y - line.back().y) > 0.5)) {
        line.push_back(point);
      }
    }
    const TimedTable::Place place = log.At(time);
    const CanvasPoint now =
        Place(width, height, car, log.Value(place, along->station), log.Value(place, along->left));
    line.push_back(now);
    canvas.Stroke(line, thick, recording_.plants[i].color(), 0.95);
    const double size = 4.0 * thick;
    canvas.FillConvex({{now.x - 0.6 * size, now.y - 0.55 * size},
                       {now.x + 0.6 * size, now.y},
                       {now.x - 0.6 * size, now.y + 0.55 * size}},
                      recording_.plants[i].color(), 1.0);
  }
  canvas.Text(0.5 * letters, 0.3 * letters, "distance from path x10", letters, kValue);
}

}  // namespace trackbed::render
