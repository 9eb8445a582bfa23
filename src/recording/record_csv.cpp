#include "trackbed/recording/record_csv.h"

#include <fmt/format.h>

#include <cmath>
#include <functional>
#include <vector>

#include "src/recording/drive_extent.h"
#include "trackbed/core/error.h"
#include "trackbed/core/table.h"

namespace trackbed {
namespace {

/// A column of the CSV file, and the field of RecordedSample that is stored in the column.
struct Column {
  const char* name;
  std::function<double&(RecordedSample& sample)> number;
  // Member of RecordedDrive that tells whether the drive has this column; null if every drive has
  // the column.
  bool RecordedDrive::*has = nullptr;
};

const std::vector<Column>& Columns() {
  using S = RecordedSample;
  static const std::vector<Column> columns{
      {"t_s", [](S& s) -> double& { return s.time; }},
      {"x_m", [](S& s) -> double& { return s.pose.x; }},
      {"y_m", [](S& s) -> double& { return s.pose.y; }},
      {"yaw_rad", [](S& s) -> double& { return s.pose.yaw; }},
      {"speed_mps", [](S& s) -> double& { return s.velocity_V.x(); }},
      {"rear_lateral_speed_mps", [](S& s) -> double& { return s.velocity_V.y(); }},
      {"yaw_rate_radps", [](S& s) -> double& { return s.yaw_rate; }},
      {"rear_longitudinal_acceleration_mps2", [](S& s) -> double& { return s.acceleration_V.x(); }},
      {"rear_lateral_acceleration_mps2", [](S& s) -> double& { return s.acceleration_V.y(); }},
      {"yaw_acceleration_radps2", [](S& s) -> double& { return s.yaw_acceleration; }},
      {"steering_rad", [](S& s) -> double& { return s.steering; }, &RecordedDrive::has_steering},
      {"steering_command_rad", [](S& s) -> double& { return s.steering_command; },
       &RecordedDrive::has_steering_command},
      {"throttle_mps2", [](S& s) -> double& { return s.throttle; }, &RecordedDrive::has_throttle}};
  return columns;
}

constexpr const char* kValid = "valid";

}  // namespace

std::string RecordCsv(const RecordedDrive& drive) {
  std::vector<std::string> names;
  for (const Column& column : Columns()) {
    if (column.has == nullptr || drive.*column.has) {
      names.emplace_back(column.name);
    }
  }
  names.emplace_back(kValid);
  Table table(names);
  std::vector<double> row;
  for (RecordedSample sample : drive.samples) {
    row.clear();
    for (const Column& column : Columns()) {
      if (column.has == nullptr || drive.*column.has) {
        row.push_back(column.number(sample));
      }
    }
    row.push_back(sample.valid ? 1.0 : 0.0);
    table.AddRow(row);
  }
  return table.ToCsv();
}

RecordedDrive ReadRecordCsv(const std::filesystem::path& file) {
  std::vector<std::string> needed{kValid};
  std::vector<std::string> optional;
  for (const Column& column : Columns()) {
    (column.has == nullptr ? needed : optional).emplace_back(column.name);
  }
  const CsvExcerpt excerpt = ReadCsvExcerpt(file, needed, optional);
  const Table& table = excerpt.table;
  if (table.rows() < 2) {
    throw InputError(Problem{.file = file.string(),
                             .message = fmt::format("{} rows; must be at least 2", table.rows())});
  }
  RecordedDrive drive{.name = file.stem().string()};
  drive.samples.resize(table.rows());
  for (const Column& column : Columns()) {
    const int index = table.Find(column.name);
    if (index < 0) {
      continue;
    }
    if (column.has != nullptr) {
      drive.*column.has = true;
    }
    for (std::size_t row = 0; row < table.rows(); ++row) {
      column.number(drive.samples[row]) = table.at(row, static_cast<std::size_t>(index));
    }
  }
  const auto valid = static_cast<std::size_t>(table.Find(kValid));
  for (std::size_t row = 0; row < table.rows(); ++row) {
    drive.samples[row].valid = table.at(row, valid) != 0.0;
  }
  const auto last = static_cast<double>(table.rows() - 1);
  drive.period = drive.samples.back().time / last;
  ProblemList problems;
  for (std::size_t row = 0; row < table.rows(); ++row) {
    const double expected = static_cast<double>(row) * drive.period;
    // Permitted deviation of a sample's time from the constant period, as a fraction of the period.
    constexpr double kRounding = 1e-6;
    if (!(drive.period > 0.0) ||
        std::abs(drive.samples[row].time - expected) > kRounding * drive.period) {
      problems.Add({file.string(), excerpt.lines[row], 0, "t_s",
                    fmt::format("{} is not on a uniform grid from 0 on", drive.samples[row].time)});
    }
  }
  std::vector<Vec2> positions;
  for (const RecordedSample& sample : drive.samples) {
    positions.push_back(sample.pose.position());
  }
  const std::string extent = ExtentProblem(
      positions, [&](std::size_t row) { return fmt::format("line {}", excerpt.lines[row]); });
  if (!extent.empty()) {
    problems.Add({.file = file.string(), .message = extent});
  }
  problems.ThrowIfAny();
  drive.notes.push_back(fmt::format("{}: {} samples, {:.6g} s apart", file.filename().string(),
                                    table.rows(), drive.period));
  return drive;
}

}  // namespace trackbed
