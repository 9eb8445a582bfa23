#include "src/track/track_rows.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <boost/algorithm/string/predicate.hpp>
#include <charconv>
#include <cmath>
#include <system_error>
#include <utility>

#include "trackbed/core/csv_rows.h"

// Reads the rows of a track. The columns of the track file are found by their usual names. Without
// column names, four columns are read in the order of TUM's track files, and two columns are x and
// y. Missing track widths are taken from the scenario. All faults of the rows are collected before
// the file is rejected.

namespace trackbed {
namespace {

constexpr double kMaxPosition = 1e7;  // Largest permitted |x| and |y| of a point [m].
// Largest permitted distance of a point from the middle of the track, in x and in y [m].
constexpr double kMaxExtent = 1e5;
constexpr double kMaxWidth = 1000.0;  // Largest permitted track width on either side [m].

/// Quantities in the columns of a track.
enum Quantity { kX, kY, kRight, kLeft, kWidth };

/// Usual column names for each quantity of a track, in order of preference. The first column name
/// of each quantity is that of TUM's track files.
const std::array<std::vector<const char*>, kTrackQuantities>& UsualNames() {
  static const std::array<std::vector<const char*>, kTrackQuantities> names{
      {{"x_m", "x", "x [m]", "pos_x", "position_x", "center_x", "x_center", "easting"},
       {"y_m", "y", "y [m]", "pos_y", "position_y", "center_y", "y_center", "northing"},
       {"w_tr_right_m", "w_tr_right", "width_right_m", "width_right", "w_right_m", "w_right",
        "right_width_m", "right_width"},
       {"w_tr_left_m", "w_tr_left", "width_left_m", "width_left", "w_left_m", "w_left",
        "left_width_m", "left_width"},
       {"width_m", "width", "track_width_m", "track_width", "w_tr_m"}}};
  return names;
}

}  // namespace

TrackRows::TrackRows(const std::filesystem::path& file, const TrackReading& reading,
                     std::optional<LogReading> log)
    : name_(file.string()), reading_(reading), log_(log) {
  ReadCsvTable(
      file, {.delimiter = kFindDelimiter, .numbers_columns = true}, problems,
      [&](const std::vector<std::string>& names, int line) { TakeNames(names, line); },
      [&](const std::vector<std::string>& cells, int line) { TakeRow(cells, line); });
  problems.ThrowIfAny();
  CheckExtent();
  problems.ThrowIfAny();
  DropRepeatedEnd();
}

void TrackRows::TakeNames(const std::vector<std::string>& names, int line) {
  names_ = names;
  const auto add = [&](std::string message) {
    problems.Add({.file = name_, .line = line, .message = std::move(message)});
    is_broken_ = true;
  };
  if (names.front() == "1") {
    TakeNumbers(line);
    return;
  }
  std::string others;
  for (std::size_t quantity = 0; quantity < kTrackQuantities; ++quantity) {
    for (const char* usual : UsualNames()[quantity]) {
      for (std::size_t i = 0; i < names.size() && !columns_[quantity]; ++i) {
        if (boost::iequals(names[i], usual)) {
          columns_[quantity] = i;
        }
      }
    }
    if (columns_[quantity] &&
        std::count(names.begin(), names.end(), names[*columns_[quantity]]) > 1) {
      add(fmt::format("the column '{}' is repeated", names[*columns_[quantity]]));
    }
    if (columns_[quantity] && names[*columns_[quantity]] != UsualNames()[quantity].front()) {
      others += (others.empty() ? "" : ", ") + names[*columns_[quantity]];
    }
  }
  for (const Quantity quantity : {kX, kY}) {
    if (!columns_[quantity]) {
      add(
          fmt::format("no column '{}'; the header of a track is "
                      "'# x_m,y_m,w_tr_right_m,w_tr_left_m', but this file has '{}'",
                      UsualNames()[quantity].front(), fmt::join(names, ",")));
    }
  }
  const bool has_sides = columns_[kRight] && columns_[kLeft];
  const bool has_widths = has_sides || columns_[kWidth];
  if (!has_sides && (columns_[kRight] || columns_[kLeft])) {
    const Quantity missing = columns_[kRight] ? kLeft : kRight;
    add(fmt::format("no column '{}', but '{}'", UsualNames()[missing].front(),
                    names[*columns_[missing == kLeft ? kRight : kLeft]]));
  } else if (!has_widths && !reading_.width && !log_) {
    add("no columns of widths, 'w_tr_right_m' and 'w_tr_left_m'; add them, or give the width of "
        "the track by mission.track.width");
  } else if (has_widths && reading_.width) {
    add(
        fmt::format("mission.track.width is given, but the file has the column '{}'; remove one of "
                    "them",
                    names[*columns_[has_sides ? kRight : kWidth]]));
  }
  if (has_sides) {
    columns_[kWidth].reset();
  }
  if (has_widths) {
    log_.reset();
  }
  if (!others.empty()) {
    notes.push_back("columns taken by their names: " + others);
  }
}

/// Assigns the columns of a file without names in the order of TUM's track files.
void TrackRows::TakeNumbers(int line) {
  constexpr std::size_t kWithWidths = 4;
  if (names_.size() != (reading_.width ? 2 : kWithWidths)) {
    problems.Add({.file = name_,
                  .line = line,
                  .message = fmt::format(
                      "no column names before the first row of {} cells; a track without names has "
                      "the columns x, y and the widths to the right and to the left, or x and y "
                      "with mission.track.width; else add the header "
                      "'# x_m,y_m,w_tr_right_m,w_tr_left_m'",
                      names_.size())});
    is_broken_ = true;
    return;
  }
  for (std::size_t i = 0; i < names_.size(); ++i) {
    columns_[i] = i;
  }
  notes.push_back(fmt::format("no column names; columns taken in the order x, y{}",
                              reading_.width ? "" : ", width to the right, width to the left"));
}

void TrackRows::TakeRow(const std::vector<std::string>& cells, int line) {
  if (is_broken_) {
    return;
  }
  const auto add = [&](std::size_t column, std::string message) {
    problems.Add({name_, line, 0, fmt::format("cell {} ({})", column + 1, names_[column]),
                  std::move(message)});
  };
  if (cells.size() != names_.size()) {
    problems.Add(
        {.file = name_,
         .line = line,
         .message = fmt::format("{} cells, the header has {}", cells.size(), names_.size())});
    return;
  }
  TrackNumbers numbers{};
  bool valid = true;
  for (std::size_t i = 0; i < kTrackQuantities; ++i) {
    if (!columns_[i]) {
      continue;
    }
    const std::string& cell = cells[*columns_[i]];
    const auto [end, error] = std::from_chars(cell.data(), cell.data() + cell.size(), numbers[i]);
    if (error != std::errc{} || end != cell.data() + cell.size()) {
      add(*columns_[i], fmt::format("'{}' is not a number", cell));
      valid = false;
    } else if (!std::isfinite(numbers[i])) {
      add(*columns_[i], fmt::format("'{}' is not a finite number", cell));
      valid = false;
    }
  }
  if (!valid) {
    return;
  }
  if (log_) {
    const Vec2 at(numbers[kX], numbers[kY]);
    if (!points.empty() && (at - points.back().position).norm() < log_->spacing) {
      return;
    }
    numbers[kRight] = numbers[kLeft] = log_->half_width;
  } else if (!columns_[kRight]) {
    const double width = columns_[kWidth] ? numbers[kWidth] : *reading_.width;
    numbers[kRight] = 0.5 * width;
    numbers[kLeft] = 0.5 * width;
  }
  points.push_back({{numbers[kX], numbers[kY]}, numbers[kRight], numbers[kLeft]});
  lines.push_back(line);
  CheckNumbers(numbers);
}

void TrackRows::CheckNumbers(const TrackNumbers& numbers) {
  const std::size_t row = points.size() - 1;
  const auto key = [&](Quantity quantity) {
    return columns_[quantity] ? names_[*columns_[quantity]] : UsualNames()[quantity].front();
  };
  for (const Quantity quantity : {kX, kY}) {
    if (std::abs(numbers[quantity]) > kMaxPosition) {
      Add(row, key(quantity),
          fmt::format("{} is out of range; must be between {} and {}", numbers[quantity],
                      -kMaxPosition, kMaxPosition));
    }
  }
  for (const Quantity quantity : {kRight, kLeft}) {
    if (!(numbers[quantity] > 0.0) || numbers[quantity] > kMaxWidth) {
      Add(row, key(columns_[kWidth] ? kWidth : quantity),
          fmt::format("{} is out of range; must be above 0 and at most {}", numbers[quantity],
                      kMaxWidth));
    }
  }
  if (row > 0 && points[row].position == points[row - 1].position) {
    Add(row, "", "same point as in the row before");
  }
}

/// Checks that no point is far from the middle of the track, the median of the coordinates.
void TrackRows::CheckExtent() {
  if (points.empty()) {
    return;
  }
  for (const Quantity quantity : {kX, kY}) {
    const auto at = [&](std::size_t i) { return points[i].position[quantity == kX ? 0 : 1]; };
    std::vector<double> sorted;
    for (std::size_t i = 0; i < points.size(); ++i) {
      sorted.push_back(at(i));
    }
    const auto middle = sorted.begin() + static_cast<std::ptrdiff_t>(sorted.size() / 2);
    std::nth_element(sorted.begin(), middle, sorted.end());
    for (std::size_t i = 0; i < points.size(); ++i) {
      if (std::abs(at(i) - *middle) > kMaxExtent) {
        Add(i, names_[*columns_[quantity]],
            fmt::format("{} is more than {:.0f} km from the middle of the track, {}", at(i),
                        1e-3 * kMaxExtent, *middle));
      }
    }
  }
}

/// Drops the last points if they repeat the first point, up to the rounding of the file.
void TrackRows::DropRepeatedEnd() {
  if (points.size() < Track::kMinPoints) {
    return;
  }
  double length = 0.0;
  for (std::size_t i = 1; i < points.size(); ++i) {
    length += (points[i].position - points[i - 1].position).norm();
  }
  // Distance below which track points count as coinciding, as a fraction of the mean distance
  // between points.
  constexpr double kSame = 1e-3;
  const double same = kSame * length / static_cast<double>(points.size() - 1);
  while (points.size() > 1 && (points.back().position - points.front().position).norm() <= same) {
    notes.push_back(fmt::format("line {}: the first point again, dropped", lines.back()));
    points.pop_back();
    lines.pop_back();
  }
}

}  // namespace trackbed
