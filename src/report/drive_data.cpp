#include "src/report/drive_data.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <vector>

#include "src/report/numbers.h"
#include "src/report/scene_data.h"
#include "trackbed/core/table.h"
#include "trackbed/sim/tyre_grip.h"

namespace trackbed {
namespace {

namespace fs = std::filesystem;
using nlohmann::ordered_json;

// Tolerance within which the actuator counts as having reached the commanded steering angle [rad].
constexpr double kReachedTolerance = 1e-6;
// Shortest interval of rate-limited steering that is shown [s].
constexpr double kMinSpan = 0.1;

/// Returns the time intervals in which the steering actuator did not reach the command of the
/// previous log row.
std::vector<std::array<double, 2>> RateLimitSpans(const Table& log) {
  const std::vector<double> time = log.Column("t_s");
  const std::vector<double> commanded = log.Column("steering_command_rad");
  const std::vector<double> reached = log.Column("steering_actuator_rad");
  std::vector<std::array<double, 2>> spans;
  for (std::size_t i = 0; i + 1 < time.size(); ++i) {
    if (std::abs(commanded[i] - reached[i + 1]) <= kReachedTolerance) {
      continue;
    }
    if (!spans.empty() && time[i] - spans.back()[1] < kMinSpan) {
      spans.back()[1] = time[i + 1];
    } else {
      spans.push_back({time[i], time[i + 1]});
    }
  }
  spans.erase(std::remove_if(spans.begin(), spans.end(),
                             [](const auto& span) { return span[1] - span[0] < kMinSpan; }),
              spans.end());
  return spans;
}

/// Returns the time at which the planner detected an obstacle [s]; nullopt if the obstacle was
/// never detected or was known from the start.
std::optional<double> KnownFrom(const Obstacle& obstacle, const Table& log,
                                const VehicleParams& car) {
  const std::vector<double> time = log.Column("t_s");
  const std::vector<double> x = log.Column("x_m");
  const std::vector<double> y = log.Column("y_m");
  const std::vector<double> yaw = log.Column("yaw_rad");
  for (std::size_t i = 0; i < time.size(); ++i) {
    if (IsKnown(obstacle, time[i], FootprintAt(car, {x[i], y[i], yaw[i]}))) {
      return i == 0 ? std::nullopt : std::optional(time[i]);
    }
  }
  return std::nullopt;
}

TyreLaw LawOf(const std::string& plant, TyreLaw scenario_law) {
  return plant == "mujoco:contact"         ? TyreLaw::kContact
         : plant == "mujoco:magic_formula" ? TyreLaw::kMagicFormula
                                           : scenario_law;
}

std::string ForceColumn(const char* kind, const char* wheel) {
  return fmt::format("{}_force_{}_N", kind, wheel);
}

/// Fractions of the available friction that a tyre uses in the longitudinal and lateral directions,
/// for each row of a log.
struct TyreShares {
  std::vector<double> along;
  std::vector<double> across;
};

TyreShares SharesOf(std::size_t wheel, const Table& log, TyreLaw law, const World& world,
                    const CarModel& car) {
  const VehicleParams& params = car.params();
  const std::vector<double> x = log.Column("x_m");
  const std::vector<double> y = log.Column("y_m");
  const std::vector<double> yaw = log.Column("yaw_rad");
  const auto force = [&](const char* kind) {
    return log.Column(ForceColumn(kind, kWheels[wheel]));
  };
  const std::vector<double> load = force("normal");
  const std::vector<double> along = force("longitudinal");
  const std::vector<double> across = force("lateral");
  const bool front = wheel < 2;
  const double ahead = front ? params.wheelbase : 0.0;
  const double left =
      0.5 * (front ? params.track_front : params.track_rear) * (wheel % 2 == 0 ? 1.0 : -1.0);
  TyreShares shares;
  for (std::size_t i = 0; i < log.rows(); ++i) {
    const double c = std::cos(yaw[i]);
    const double s = std::sin(yaw[i]);
    const Vec2 under(x[i] + ahead * c - left * s, y[i] + ahead * s + left * c);
    const TyreFriction friction = FindTyreFriction(car, law, wheel, load[i]);
    const double most = std::max(0.0, load[i]) * RoadFactor(world, under);
    const auto share = [&](double part, double coefficient) {
      return most * coefficient > 0.0 ? part / (most * coefficient) : 0.0;
    };
    shares.along.push_back(share(along[i], friction.longitudinal));
    shares.across.push_back(share(across[i], friction.lateral));
  }
  return shares;
}

}  // namespace

ordered_json EventsJson(const fs::path& log, const World& world, const VehicleParams& car) {
  const Table table = ReadCsvExcerpt(log, {"t_s", "x_m", "y_m", "yaw_rad", "steering_command_rad"},
                                     {"steering_actuator_rad"})
                          .table;
  ordered_json json{{"rate_limit", ordered_json::array()}, {"known", ordered_json::array()}};
  if (table.Find("steering_actuator_rad") >= 0) {
    for (const auto& [from, to] : RateLimitSpans(table)) {
      json["rate_limit"].push_back({Rounded(from), Rounded(to)});
    }
  }
  for (std::size_t i = 0; i < world.obstacles.size(); ++i) {
    if (const auto time = KnownFrom(world.obstacles[i], table, car)) {
      json["known"].push_back({i, Rounded(*time)});
    }
  }
  return json;
}

ordered_json TyresJson(const fs::path& log, const std::string& plant, TyreLaw scenario_law,
                       const World& world, const CarModel& car, std::size_t row_limit) {
  std::vector<std::string> columns;
  for (const char* wheel : kWheels) {
    for (const char* kind : {"normal", "longitudinal", "lateral"}) {
      columns.push_back(ForceColumn(kind, wheel));
    }
  }
  const Table table = ReadCsvExcerpt(log, {"t_s", "x_m", "y_m", "yaw_rad"}, columns).table;
  const bool has_all = std::all_of(columns.begin(), columns.end(), [&](const std::string& column) {
    return table.Find(column) >= 0;
  });
  if (!has_all || table.rows() == 0 || car.params().kind != VehicleKind::kSteered) {
    return nullptr;
  }
  std::vector<TyreShares> shares;
  for (std::size_t wheel = 0; wheel < kWheels.size(); ++wheel) {
    shares.push_back(SharesOf(wheel, table, LawOf(plant, scenario_law), world, car));
  }
  const auto used = [&](std::size_t row) {
    double most = 0.0;
    for (const TyreShares& tyre : shares) {
      most = std::max(most, std::hypot(tyre.along[row], tyre.across[row]));
    }
    return most;
  };
  const std::vector<double> times = table.Column("t_s");
  std::vector<std::size_t> rows;
  const std::vector<std::size_t> ends = RowsOfMotion(times, row_limit);
  for (std::size_t k = 0; k < ends.size(); ++k) {
    std::size_t best = ends[k];
    for (std::size_t row = k == 0 ? ends[k] : ends[k - 1] + 1; row < ends[k]; ++row) {
      best = used(row) > used(best) ? row : best;
    }
    rows.push_back(best);
  }
  const auto at_rows = [&](const std::vector<double>& all) {
    std::vector<double> values;
    std::transform(rows.begin(), rows.end(), std::back_inserter(values),
                   [&](std::size_t row) { return all[row]; });
    return values;
  };
  ordered_json json{{"t", FloatsJson(at_rows(times))}};
  for (std::size_t wheel = 0; wheel < kWheels.size(); ++wheel) {
    json[kWheels[wheel]] = {{"along", ChannelJson(at_rows(shares[wheel].along))},
                            {"across", ChannelJson(at_rows(shares[wheel].across))}};
  }
  return json;
}

}  // namespace trackbed
