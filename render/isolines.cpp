#include "render/isolines.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <utility>

namespace trackbed::render {
namespace {

/// Maps each side of a cell to the neighboring sides to which pieces of a contour line connect the
/// cell side.
using Neighbors = std::map<int, std::vector<int>>;

void Join(Neighbors& neighbors, int a, int b) {
  neighbors[a].push_back(b);
  neighbors[b].push_back(a);
}

/// Removes the contour line that begins at the cell side `first` from `neighbors`, and returns the
/// cell sides that the line crosses.
std::vector<int> TakeLine(Neighbors& neighbors, int first) {
  std::vector<int> line{first};
  while (!neighbors[line.back()].empty()) {
    const int here = line.back();
    const int next = neighbors[here].back();
    neighbors[here].pop_back();
    std::vector<int>& back = neighbors[next];
    back.erase(std::find(back.begin(), back.end(), here));
    line.push_back(next);
  }
  return line;
}

}  // namespace

IsolineGrid::IsolineGrid(const Vec2& low, const Vec2& high, double step,
                         const std::function<double(const Vec2&)>& value)
    : low_(low),
      step_(step),
      columns_(static_cast<int>(std::ceil((high.x() - low.x()) / step)) + 1),
      rows_(static_cast<int>(std::ceil((high.y() - low.y()) / step)) + 1) {
  values_.reserve(static_cast<std::size_t>(columns_) * static_cast<std::size_t>(rows_));
  for (int row = 0; row < rows_; ++row) {
    for (int column = 0; column < columns_; ++column) {
      values_.push_back(value(low + step * Vec2(column, row)));
    }
  }
}

double IsolineGrid::lowest() const {
  return *std::min_element(values_.begin(), values_.end());
}

double IsolineGrid::highest() const {
  return *std::max_element(values_.begin(), values_.end());
}

Vec2 IsolineGrid::Crossing(int side, double level) const {
  const int corner = side / 2;
  const int column = corner % columns_;
  const int row = corner / columns_;
  const bool along_x = side % 2 == 0;
  const double from = Value(column, row);
  const double to = along_x ? Value(column + 1, row) : Value(column, row + 1);
  const double part = (level - from) / (to - from);
  return low_ + step_ * Vec2(column + (along_x ? part : 0.0), row + (along_x ? 0.0 : part));
}

std::vector<std::vector<Vec2>> IsolineGrid::At(double level) const {
  Neighbors neighbors;
  for (int row = 0; row + 1 < rows_; ++row) {
    for (int column = 0; column + 1 < columns_; ++column) {
      // Corners of a cell are numbered counterclockwise from the lower left; side i is between
      // corners i and i + 1.
      const std::array<bool, 4> above{Value(column, row) >= level, Value(column + 1, row) >= level,
                                      Value(column + 1, row + 1) >= level,
                                      Value(column, row + 1) >= level};
      const std::array<int, 4> sides{Side(column, row, 0), Side(column + 1, row, 1),
                                     Side(column, row + 1, 0), Side(column, row, 1)};
      std::vector<std::size_t> cut;
      for (std::size_t i = 0; i < 4; ++i) {
        if (above[i] != above[(i + 1) % 4]) {
          cut.push_back(i);
        }
      }
      if (cut.size() == 2) {
        Join(neighbors, sides[cut[0]], sides[cut[1]]);
      } else if (cut.size() == 4) {
        // A piece of a contour line separates each corner above the level from the rest of the
        // cell. A contour piece around a corner crosses the two sides of the cell that meet at the
        // corner.
        for (std::size_t i = 0; i < 4; ++i) {
          if (above[i]) {
            Join(neighbors, sides[(i + 3) % 4], sides[i]);
          }
        }
      }
    }
  }
  // Collects first the open contour lines, then the closed contour lines.
  std::vector<int> begins;
  for (const auto& [side, others] : neighbors) {
    if (others.size() == 1) {
      begins.push_back(side);
    }
  }
  for (const auto& [side, others] : neighbors) {
    begins.push_back(side);
  }
  std::vector<std::vector<Vec2>> lines;
  for (const int begin : begins) {
    if (neighbors[begin].empty()) {
      continue;
    }
    std::vector<Vec2>& line = lines.emplace_back();
    for (const int side : TakeLine(neighbors, begin)) {
      line.push_back(Crossing(side, level));
    }
  }
  return lines;
}

}  // namespace trackbed::render
