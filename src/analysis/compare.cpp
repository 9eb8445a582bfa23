#include "trackbed/analysis/compare.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <nlohmann/json.hpp>
#include <utility>

#include "src/analysis/metric_table.h"
#include "trackbed/analysis/json_file.h"
#include "trackbed/analysis/run_folder.h"
#include "trackbed/control/steering_controller.h"
#include "trackbed/core/angle.h"
#include "trackbed/core/error.h"
#include "trackbed/core/file.h"
#include "trackbed/core/spelling.h"
#include "trackbed/scenario/log_columns.h"
#include "trackbed/scenario/record.h"

// Compares two runs at equal stations. Both traces are interpolated linearly at every station where
// either run has a log row, within the stations that both runs cover. Stations in gaps of the logs
// of recorded runs are not compared. A difference between two runs is the value of the second run
// minus the value of the first run. The rms difference comes from the exact integral of the
// squared, piecewise linear difference over arc length. The maximum difference between two runs is
// the largest magnitude among the compared stations.
namespace trackbed {
namespace {

namespace fs = std::filesystem;

/// Position between two rows of a trace that corresponds to a station: the fraction `share` of the
/// way from row `before` to the next row.
struct Place {
  std::size_t before = 0;
  double share = 0.0;

  [[nodiscard]] double Between(const std::vector<double>& values) const {
    return std::lerp(values[before], values[before + 1], share);
  }
};

Place PlaceAt(const Trace& trace, double station) {
  const std::vector<double>& s = trace.station;
  const auto after = std::upper_bound(s.begin() + 1, s.end() - 1, station) - s.begin();
  const auto i = static_cast<std::size_t>(after);
  return {i - 1, (station - s[i - 1]) / (s[i] - s[i - 1])};
}

Pose2 PoseIn(const Trace& trace, const Place& place) {
  const Pose2& a = trace.pose[place.before];
  const Pose2& b = trace.pose[place.before + 1];
  return {std::lerp(a.x, b.x, place.share), std::lerp(a.y, b.y, place.share),
          std::lerp(a.yaw, b.yaw, place.share)};
}

/// Difference between two runs at one station: the state of the second run minus the state of the
/// first run.
struct RowDifference {
  double s = 0.0;
  double first_t = 0.0;
  double second_t = 0.0;
  Vec2 position = Vec2::Zero();
  double yaw = 0.0;
  double yaw_rate = 0.0;
  double steering = 0.0;
  bool after_gap = false;  // whether a gap in the compared stations precedes this row
};

/// Returns whether the trace has data at `place`, that is, whether `place` is not in a gap of a
/// recorded run.
bool IsValid(const Trace& trace, const Place& place) {
  return trace.valid.empty() || ((place.share >= 1.0 || trace.valid[place.before]) &&
                                 (place.share <= 0.0 || trace.valid[place.before + 1]));
}

/// Computes the differences at every station where either run has a log row, within the range of
/// stations that both runs cover.
std::vector<RowDifference> DifferencesAtRows(const Trace& first, const Trace& second) {
  if (first.station.size() < 2 || second.station.size() < 2) {
    return {};
  }
  const double from = std::max(first.station.front(), second.station.front());
  const double to = std::min(first.station.back(), second.station.back());
  if (!(from < to)) {
    return {};
  }
  std::vector<double> stations;
  std::merge(first.station.begin(), first.station.end(), second.station.begin(),
             second.station.end(), std::back_inserter(stations));
  stations.erase(std::unique(stations.begin(), stations.end()), stations.end());
  std::vector<RowDifference> all;
  const Vec2 between_origins = second.origin - first.origin;
  bool after_gap = false;
  for (const double s : stations) {
    if (s < from || s > to) {
      continue;
    }
    const Place a = PlaceAt(first, s);
    const Place b = PlaceAt(second, s);
    if (!IsValid(first, a) || !IsValid(second, b)) {
      after_gap = true;
      continue;
    }
    const Pose2 pose_1 = PoseIn(first, a);
    const Pose2 pose_2 = PoseIn(second, b);
    all.push_back({.s = s,
                   .first_t = a.Between(first.time),
                   .second_t = b.Between(second.time),
                   .position = pose_2.position() - pose_1.position() + between_origins,
                   .yaw = AngleDifference(pose_2.yaw, pose_1.yaw),
                   .yaw_rate = b.Between(second.yaw_rate) - a.Between(first.yaw_rate),
                   .steering = b.Between(second.steering) - a.Between(first.steering),
                   .after_gap = std::exchange(after_gap, false)});
  }
  return all;
}

/// Computes the maximum and the rms of a quantity over arc length. The argument `of` is a function
/// that returns the compared quantity of a row, as a vector. The compared quantity is assumed to be
/// linear between rows.
template <typename Of>
Difference ComputeDifference(const std::vector<RowDifference>& rows, const Of& of) {
  Difference difference;
  double integral = 0.0;
  double length = 0.0;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const Vec2 here = of(rows[i]);
    if (i == 0 || here.norm() > difference.max) {
      difference.max = here.norm();
      difference.max_s = rows[i].s;
      difference.max_t = rows[i].first_t;
    }
    if (i > 0 && !rows[i].after_gap) {
      length += rows[i].s - rows[i - 1].s;
      // The mean square of a vector that varies linearly from a to b is (a.a + a.b + b.b)/3, with
      // the dot products a.a, a.b and b.b.
      const Vec2 before = of(rows[i - 1]);
      integral += (rows[i].s - rows[i - 1].s) *
                  (before.squaredNorm() + before.dot(here) + here.squaredNorm()) / 3.0;
    }
  }
  difference.rms = length > 0.0 ? std::sqrt(integral / length) : difference.max;
  return difference;
}

void AddRow(Trace& trace, double station, double time, const Pose2& pose, double yaw_rate,
            double steering, bool valid) {
  if (trace.station.empty() || station > trace.station.back()) {
    trace.station.push_back(station);
    trace.time.push_back(time);
    trace.pose.push_back(pose);
    trace.yaw_rate.push_back(yaw_rate);
    trace.steering.push_back(steering);
    trace.valid.push_back(valid);
  }
}

}  // namespace

Pose2 Trace::PoseAt(double at) const {
  return PoseIn(*this, PlaceAt(*this, at));
}

double Trace::TimeAt(double at) const {
  return PlaceAt(*this, at).Between(time);
}

Trace MakeTrace(const RunLog& log, StationSource source) {
  Trace trace{.name = log.plant};
  trace.origin = log.origin;
  for (const LogRow& row : log.rows) {
    const VehicleState& state = row.state;
    if (log.contact_time && state.time > *log.contact_time) {
      // Ignore the rows after the contact, in which an obstacle pushes the car and the controller
      // no longer determines the motion.
      break;
    }
    const bool projected = row.tracking && source == StationSource::kProjection;
    AddRow(trace, projected ? row.tracking->s : state.distance, state.time, state.pose,
           state.yaw_rate, state.steering, row.valid);
  }
  return trace;
}

Vec2 OriginIn(const Table& table) {
  Vec2 origin = Vec2::Zero();
  for (std::size_t i = 0; i < kOriginColumns.size() && table.rows() > 0; ++i) {
    if (const int column = table.Find(kOriginColumns[i]); column >= 0) {
      origin[static_cast<Eigen::Index>(i)] = table.at(0, static_cast<std::size_t>(column));
    }
  }
  return origin;
}

Trace ReadTrace(const fs::path& file, const std::string& name, std::optional<double> contact_time) {
  const Table table =
      ReadCsvExcerpt(file,
                     {"s_m", "t_s", "x_m", "y_m", "yaw_rad", "yaw_rate_radps", "steering_rad"},
                     {"valid", kOriginColumns[0], kOriginColumns[1]})
          .table;
  const auto column = [&](std::string_view of) { return table.Column(of); };
  const auto s = column("s_m");
  const auto t = column("t_s");
  const auto x = column("x_m");
  const auto y = column("y_m");
  const auto yaw = column("yaw_rad");
  const auto yaw_rate = column("yaw_rate_radps");
  const auto steering = column("steering_rad");
  if (table.rows() < 2) {
    throw InputError(
        Problem{.file = file.string(),
                .message = fmt::format("a log needs at least two rows; found {}", table.rows())});
  }
  const int valid = table.Find("valid");
  Trace trace{.name = name};
  trace.origin = OriginIn(table);
  for (std::size_t i = 0; i < table.rows(); ++i) {
    if (contact_time && t[i] > *contact_time) {
      break;
    }
    AddRow(trace, s[i], t[i], {x[i], y[i], yaw[i]}, yaw_rate[i], steering[i],
           valid < 0 || table.at(i, static_cast<std::size_t>(valid)) != 0.0);
  }
  return trace;
}

const std::vector<ComparedQuantity>& ComparedQuantities() {
  using C = PlantComparison;
  using B = DifferenceBounds;
  static const std::vector<ComparedQuantity> quantities{
      {"position", "position", "m", "Maximum distance", "Distance, rms", &C::position,
       &B::position_max},
      {"heading", "heading", "rad", "Maximum heading difference", "Heading difference, rms",
       &C::heading, &B::heading_max},
      {"yaw_rate", "yaw rate", "rad/s", "Maximum yaw rate difference", "Yaw rate difference, rms",
       &C::yaw_rate, &B::yaw_rate_max},
      {"steering", "steering", "rad", "Maximum steering difference", "Steering difference, rms",
       &C::steering, &B::steering_max}};
  return quantities;
}

PlantComparison CompareTraces(const Trace& first, const Trace& second) {
  PlantComparison comparison{.first = first.name, .second = second.name};
  const std::vector<RowDifference> rows = DifferencesAtRows(first, second);
  if (rows.empty()) {
    return comparison;
  }
  comparison.from_s = rows.front().s;
  comparison.to_s = rows.back().s;
  comparison.position =
      ComputeDifference(rows, [](const RowDifference& row) { return row.position; });
  comparison.heading =
      ComputeDifference(rows, [](const RowDifference& row) { return Vec2(row.yaw, 0.0); });
  comparison.yaw_rate =
      ComputeDifference(rows, [](const RowDifference& row) { return Vec2(row.yaw_rate, 0.0); });
  comparison.steering =
      ComputeDifference(rows, [](const RowDifference& row) { return Vec2(row.steering, 0.0); });
  return comparison;
}

PlantComparison ComparePlants(const RunLog& first, const RunLog& second) {
  return CompareTraces(MakeTrace(first), MakeTrace(second));
}

Table DifferencesOverArcLength(const Trace& first, const Trace& second) {
  Table table({"s_m", "first_t_s", "second_t_s", "x_m", "y_m", "position_m", "yaw_rad",
               "yaw_rate_radps", "steering_rad"});
  for (const RowDifference& row : DifferencesAtRows(first, second)) {
    table.AddRow({row.s, row.first_t, row.second_t, row.position.x(), row.position.y(),
                  row.position.norm(), row.yaw, row.yaw_rate, row.steering});
  }
  return table;
}

std::vector<FinishedDrive> ReadRunFolder(const fs::path& folder) {
  const fs::path file = folder / run_folder::kMetricsJson;
  if (!fs::exists(file)) {
    throw InputError(Problem{.file = folder.string(),
                             .message = "not the folder of a finished run (no metrics.json)"});
  }
  const std::vector<std::string> known = DrivenPlantNames();
  std::vector<FinishedDrive> drives;
  const JsonValue json = ReadJson(file);
  if (const std::optional<JsonValue> complete = json.Find("complete");
      complete && !complete->Flag()) {
    throw InputError(Problem{.file = folder.string(),
                             .message = "the run was interrupted; its logs are incomplete"});
  }
  for (const auto& [plant, metrics] : json.At("plants").Members()) {
    if (std::find(known.begin(), known.end(), plant) == known.end()) {
      throw InputError(Problem{.file = file.string(),
                               .key = "plants",
                               .message = "unknown " + UnknownName(plant, known)});
    }
    const std::string status = metrics.At("status").Text();
    std::optional<double> contact_time;
    if (const std::optional<JsonValue> time = metrics.Find("status_t");
        time && status == ToString(DriveStatus::kCollided)) {
      contact_time = time->Number();
    }
    drives.push_back({status, ReadTrace(run_folder::RequireFile(folder / run_folder::LogCsv(plant)),
                                        plant, contact_time)});
  }
  return drives;
}

std::vector<Metric> ListMetrics(const PlantComparison& comparison) {
  std::vector<Metric> all{{"from_s", comparison.from_s, {}}, {"to_s", comparison.to_s, {}}};
  for (const ComparedQuantity& quantity : ComparedQuantities()) {
    const Difference& difference = comparison.*quantity.difference;
    const std::string key = quantity.key;
    all.push_back({key + ".rms", difference.rms, {}});
    all.push_back({key + ".max",
                   difference.max,
                   {.span = MetricSpan::kMoment, .s = difference.max_s, .t = difference.max_t}});
    all.push_back({key + ".max_s", difference.max_s, {}});
    all.push_back({key + ".max_t", difference.max_t, {}});
  }
  return all;
}

nlohmann::ordered_json ToJson(const PlantComparison& comparison) {
  nlohmann::ordered_json json{{"plants", {comparison.first, comparison.second}}};
  for (const Metric& metric : ListMetrics(comparison)) {
    PutMetric(metric, json);
  }
  return json;
}

}  // namespace trackbed
