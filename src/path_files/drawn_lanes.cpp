#include "trackbed/path_files/drawn_lanes.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "trackbed/core/csv_rows.h"
#include "trackbed/core/error.h"
#include "trackbed/core/table.h"
#include "trackbed/core/text_table.h"

namespace trackbed {
namespace {

constexpr std::array<const char*, 5> kColumns{"lane", "left_x_m", "left_y_m", "right_x_m",
                                              "right_y_m"};
using LaneRow = std::array<double, kColumns.size()>;

/// Reads the rows of a file of lanes.
class LaneRows {
 public:
  explicit LaneRows(const std::filesystem::path& file) : name_(file.string()) {
    ReadCsvTable(
        file, {}, problems_,
        [&](const std::vector<std::string>& names, int line) { TakeNames(names, line); },
        [&](const std::vector<std::string>& cells, int line) { TakeRow(cells, line); });
    CheckLast();
    problems_.ThrowIfAny();
  }

  DrawnLanes lanes;

 private:
  void Add(int line, std::string key, std::string message) {
    problems_.Add({name_, line, 0, std::move(key), std::move(message)});
  }

  void TakeNames(const std::vector<std::string>& names, int line) {
    count_ = names.size();
    for (std::size_t i = 0; i < kColumns.size(); ++i) {
      const auto found = std::find(names.begin(), names.end(), kColumns[i]);
      if (found == names.end()) {
        Add(line, kColumns[i],
            "missing column; a file of lanes has the columns lane, left_x_m, "
            "left_y_m, right_x_m and right_y_m");
        is_broken_ = true;
      }
      columns_[i] = static_cast<std::size_t>(found - names.begin());
    }
  }

  void TakeRow(const std::vector<std::string>& cells, int line) {
    if (is_broken_) {
      return;
    }
    if (cells.size() != count_) {
      Add(line, "", fmt::format("{} cells, the header has {}", cells.size(), count_));
      return;
    }
    if (++rows_ > kMaxLanePoints) {
      Add(line, "", fmt::format("more than {} rows", kMaxLanePoints));
      is_broken_ = true;
      return;
    }
    LaneRow numbers{};
    for (std::size_t i = 0; i < kColumns.size(); ++i) {
      constexpr double kLargest = 1e7;
      const std::optional<double> number = CellNumber(cells[columns_[i]]);
      if (!number || std::abs(*number) > kLargest) {
        Add(line, kColumns[i],
            fmt::format("'{}' is no number between {} and {}", cells[columns_[i]], -kLargest,
                        kLargest));
        return;
      }
      numbers[i] = *number;
    }
    if (!lane_ || *lane_ != numbers[0]) {
      CheckLast();
      lane_ = numbers[0];
      lanes.emplace_back();
    }
    last_line_ = line;
    lanes.back().left.emplace_back(numbers[1], numbers[2]);
    lanes.back().right.emplace_back(numbers[3], numbers[4]);
  }

  void CheckLast() {
    if (!lanes.empty() && lanes.back().left.size() < 2) {
      Add(last_line_, kColumns[0], "a lane of one row; must have at least two");
    }
  }

  std::string name_;
  ProblemList problems_;
  std::array<std::size_t, kColumns.size()> columns_{};
  std::size_t count_ = 0;
  std::size_t rows_ = 0;
  std::optional<double> lane_;
  int last_line_ = 0;
  bool is_broken_ = false;
};

}  // namespace

DrawnLanes LanesNear(const DrawnLanes& lanes, const std::vector<Vec2>& path, double reach) {
  // Thin the path: each omitted point is within kStep of a kept point.
  constexpr double kStep = 5.0;  // [m]
  std::vector<Vec2> places;
  for (const Vec2& point : path) {
    if (places.empty() || (point - places.back()).norm() > kStep) {
      places.push_back(point);
    }
  }
  reach += kStep;
  DrawnLanes near;
  std::size_t points = 0;
  for (const DrawnLane& lane : lanes) {
    Vec2 low = lane.left.front();
    Vec2 high = low;
    for (const std::vector<Vec2>* bound : {&lane.left, &lane.right}) {
      for (const Vec2& point : *bound) {
        low = low.cwiseMin(point);
        high = high.cwiseMax(point);
      }
    }
    const bool is_near = std::any_of(places.begin(), places.end(), [&](const Vec2& point) {
      return (point - point.cwiseMax(low).cwiseMin(high)).norm() <= reach;
    });
    if (is_near && points + lane.left.size() <= kMaxLanePoints) {
      points += lane.left.size();
      near.push_back(lane);
    }
  }
  return near;
}

std::string LanesCsv(const DrawnLanes& lanes) {
  Table table({kColumns.begin(), kColumns.end()});
  for (std::size_t i = 0; i < lanes.size(); ++i) {
    for (std::size_t k = 0; k < lanes[i].left.size(); ++k) {
      const Vec2& left = lanes[i].left[k];
      const Vec2& right = lanes[i].right[k];
      table.AddRow({static_cast<double>(i), left.x(), left.y(), right.x(), right.y()});
    }
  }
  return table.ToCsv();
}

DrawnLanes ReadLanesCsv(const std::filesystem::path& file) {
  return std::move(LaneRows(file).lanes);
}

}  // namespace trackbed
