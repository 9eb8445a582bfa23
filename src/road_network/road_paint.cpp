#include "trackbed/road_network/road_paint.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <sstream>
#include <string>
#include <string_view>
#include <utility>

#include "trackbed/core/error.h"

namespace trackbed {
namespace {

constexpr double kDashLength = 3.0;  // Length of a dash [m].
// Distance from the start of a dash to the start of the next dash [m].
constexpr double kDashPeriod = 9.0;
// Width of a road mark whose width the file does not specify [m].
constexpr double kDefaultMarkWidth = 0.12;
constexpr double kDoubleGap = 0.1;  // Lateral gap between the two lines of a double road mark [m].

Vec2 Beside(const Road& road, double s, double piece_of, double t) {
  return SurfaceLineAt(road, {.value = t}, s, piece_of).position;
}

/// Returns evenly spaced stations from `from` to `to`, including both, at most `spacing` apart.
std::vector<double> Stations(double from, double to, double spacing) {
  const auto parts =
      std::max<std::size_t>(1, static_cast<std::size_t>(std::ceil((to - from) / spacing)));
  std::vector<double> stations;
  for (std::size_t i = 0; i <= parts; ++i) {
    stations.push_back(
        i == parts ? to : std::lerp(from, to, static_cast<double>(i) / static_cast<double>(parts)));
  }
  return stations;
}

bool IsPaved(const Lane& lane) {
  static constexpr std::array<std::string_view, 6> kUnpaved{"none", "sidewalk", "border",
                                                            "curb", "walking",  "median"};
  return std::find(kUnpaved.begin(), kUnpaved.end(), lane.type) == kUnpaved.end();
}

/// Returns for each line of a road mark, from left to right, whether the line is dashed. For
/// example, the mark "solid broken" has two lines, of which only the second is dashed.
std::vector<bool> DashedLines(const std::string& type) {
  if (type == "none") {
    return {};
  }
  if (type == "botts dots") {
    return {false};
  }
  std::istringstream words(type);
  std::vector<bool> dashed;
  for (std::string word; words >> word && dashed.size() < 2;) {
    dashed.push_back(word == "broken");
  }
  return dashed;
}

/// Computes the areas of a road network that are painted in pictures: paved areas and road marks.
class Painter {
 public:
  Painter(const RoadNetwork& network, double spacing) : spacing_(spacing) {
    double length = 0.0;  // total length of all lanes of the network [m]
    for (const auto& [id, road] : network.roads) {
      for (std::size_t i = 0; i < road.sections.size(); ++i) {
        length += (road.SectionEnd(i) - road.sections[i].s) *
                  static_cast<double>(road.sections[i].lanes.size() + 2);
      }
    }
    constexpr double kMaxPoints = 1e5;
    spacing_ = std::max(spacing_, length / kMaxPoints);
    for (const auto& [id, road] : network.roads) {
      for (std::size_t i = 0; i < road.sections.size(); ++i) {
        Section(road, i);
      }
    }
  }

  [[nodiscard]] RoadPaint Take() { return std::move(paint_); }

 private:
  void Section(const Road& road, std::size_t index) {
    const LaneSection& section = road.sections[index];
    const double end = road.SectionEnd(index);
    // Paint each group of adjacent paved lanes as a single area, beginning at the leftmost lane.
    const std::vector<Lane>& lanes = section.lanes;
    for (std::size_t first = 0; first < lanes.size();) {
      if (lanes[first].id == 0 || !IsPaved(lanes[first])) {
        ++first;
        continue;
      }
      std::size_t last = first;
      while (last + 1 < lanes.size() && (lanes[last + 1].id == 0 || IsPaved(lanes[last + 1]))) {
        ++last;
      }
      Band(road, index, lanes[first].id, lanes[last].id);
      first = last + 1;
    }
    for (const Lane& lane : lanes) {
      for (std::size_t i = 0; i < lane.marks.size(); ++i) {
        const double from = section.s + lane.marks[i].s;
        const double to =
            i + 1 < lane.marks.size() ? std::min(end, section.s + lane.marks[i + 1].s) : end;
        if (from < to) {
          Mark(road, index, lane, lane.marks[i], from, to);
        }
      }
    }
  }

  void Band(const Road& road, std::size_t section, int left, int right) {
    PavedBand band;
    const double end = road.SectionEnd(section);
    for (const double s : Stations(road.sections[section].s, end, spacing_)) {
      const double piece_of = s == end ? std::nextafter(s, 0.0) : s;
      const LaneBorders a = LaneBordersAt(road, section, left, s, piece_of);
      const LaneBorders b = LaneBordersAt(road, section, right, s, piece_of);
      band.left.push_back(Beside(road, s, piece_of, (left > 0 ? a.outer : a.inner).value));
      band.right.push_back(Beside(road, s, piece_of, (right < 0 ? b.outer : b.inner).value));
    }
    paint_.bands.push_back(std::move(band));
  }

  void Mark(const Road& road, std::size_t section, const Lane& lane, const RoadMark& mark,
            double from, double to) {
    const std::vector<bool> dashed = DashedLines(mark.type);
    const double width = mark.width > 0.0 ? mark.width : kDefaultMarkWidth;
    for (std::size_t i = 0; i < dashed.size(); ++i) {
      const double offset = dashed.size() == 1 ? 0.0 : (i == 0 ? 0.5 : -0.5) * (kDoubleGap + width);
      const auto add = [&](double begin, double end) {
        PaintedLine line{.points = {}, .width = width, .yellow = mark.color == "yellow"};
        for (const double s : Stations(begin, end, spacing_)) {
          const double piece_of = s == to ? std::nextafter(s, 0.0) : s;
          const double t = LaneBordersAt(road, section, lane.id, s, piece_of).outer.value;
          line.points.push_back(Beside(road, s, piece_of, t + offset));
        }
        paint_.lines.push_back(std::move(line));
      };
      if (!dashed[i]) {
        add(from, to);
        continue;
      }
      // In a large network, increase the distance between the dashes, so that the number of points
      // does not exceed its limit.
      const double period = std::max(kDashPeriod, 2.0 * spacing_);
      for (double begin = from; begin < to; begin += period) {
        add(begin, std::min(begin + kDashLength, to));
      }
    }
  }

  double spacing_;
  RoadPaint paint_;
};

}  // namespace

RoadPaint PaintRoads(const RoadNetwork& network, double spacing) {
  TRACKBED_CHECK(spacing > 0.0, "spacing {}", spacing);
  return Painter(network, spacing).Take();
}

}  // namespace trackbed
