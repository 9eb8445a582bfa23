#include "render/timed_table.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "render/recorded_plans.h"
#include "trackbed/core/error.h"

namespace trackbed::render {
namespace {

namespace fs = std::filesystem;

constexpr double kMaxRunDuration = 1e6;  // maximum time limit of a run [s]

[[noreturn]] void RejectTable(const fs::path& file, std::string key, std::string message) {
  throw InputError(
      Problem{.file = file.string(), .key = std::move(key), .message = std::move(message)});
}

}  // namespace

TimedTable::TimedTable(const fs::path& file) : file_(file), table_(ReadRunTable(file)), times_() {
  times_ = [&] {
    const std::size_t column = Require("t_s");
    std::vector<double> times;
    for (std::size_t row = 0; row < table_.rows(); ++row) {
      times.push_back(table_.at(row, column));
    }
    return times;
  }();
  if (times_.empty()) {
    RejectTable(file_, "", "no rows");
  }
  for (std::size_t row = 0; row < times_.size(); ++row) {
    if (!(std::abs(times_[row]) <= kMaxRunDuration)) {
      RejectTable(file_, "t_s",
                  fmt::format("row {}: {} is out of range; must be at least {} and at most {}",
                              row + 1, times_[row], -kMaxRunDuration, kMaxRunDuration));
    }
    if (row > 0 && !(times_[row] > times_[row - 1])) {
      RejectTable(
          file_, "t_s",
          fmt::format("row {}: {} does not come after {}", row + 1, times_[row], times_[row - 1]));
    }
    for (std::size_t column = 0; column < table_.columns().size(); ++column) {
      if (!std::isfinite(table_.at(row, column))) {
        RejectTable(file_, table_.columns()[column], fmt::format("row {}: not finite", row + 1));
      }
    }
  }
}

std::optional<std::size_t> TimedTable::Find(const std::string& column) const {
  const int index = table_.Find(column);
  return index < 0 ? std::nullopt : std::optional(static_cast<std::size_t>(index));
}

std::size_t TimedTable::Require(const std::string& column) const {
  const std::optional<std::size_t> index = Find(column);
  if (!index) {
    RejectTable(file_, column, "no such column");
  }
  return *index;
}

TimedTable::Place TimedTable::At(double time) const {
  const auto after = std::upper_bound(times_.begin(), times_.end(), time);
  if (after == times_.begin()) {
    return {0, 0, 0.0};
  }
  const auto row = static_cast<std::size_t>(after - times_.begin()) - 1;
  if (after == times_.end()) {
    return {row, row, 0.0};
  }
  return {row, row + 1, (time - times_[row]) / (*after - times_[row])};
}

double TimedTable::Value(const Place& place, std::size_t column) const {
  const double here = table_.at(place.row, column);
  return here + place.part * (table_.at(place.next, column) - here);
}

}  // namespace trackbed::render
