#include "render/recorded_plans.h"

#include <fmt/format.h>

#include <cmath>
#include <utility>

#include "trackbed/analysis/json_file.h"
#include "trackbed/analysis/run_folder.h"
#include "trackbed/core/error.h"

namespace trackbed::render {
namespace {

namespace fs = std::filesystem;

[[noreturn]] void Reject(const fs::path& file, std::string key, std::string message) {
  throw InputError(
      Problem{.file = file.string(), .key = std::move(key), .message = std::move(message)});
}

std::vector<double> FiniteColumn(const Table& table, const fs::path& file, const char* column) {
  if (table.Find(column) < 0) {
    Reject(file, column, "no such column");
  }
  std::vector<double> values = table.Column(column);
  for (std::size_t row = 0; row < values.size(); ++row) {
    if (!std::isfinite(values[row])) {
      Reject(file, column, fmt::format("row {}: not finite", row + 1));
    }
  }
  return values;
}

}  // namespace

Table ReadRunTable(const fs::path& file) {
  return ReadCsv(run_folder::RequireFile(file));
}

std::vector<Point> ReadPlan(const fs::path& file) {
  std::vector<Point> points;
  std::error_code ignored;
  if (!fs::exists(file, ignored)) {
    return points;
  }
  const Table table = ReadRunTable(file);
  const std::vector<double> x = FiniteColumn(table, file, "x_m");
  const std::vector<double> y = FiniteColumn(table, file, "y_m");
  for (std::size_t i = 0; i < x.size(); ++i) {
    points.push_back({x[i], y[i]});
  }
  return points;
}

// The plan file lists the plans one after the other; each row has the adoption time of the plan to
// which the row belongs.
std::vector<NewPlan> ReadNewPlans(const fs::path& file) {
  std::vector<NewPlan> plans;
  std::error_code ignored;
  if (!fs::exists(file, ignored)) {
    return plans;
  }
  const Table table = ReadRunTable(file);
  const std::vector<double> from = FiniteColumn(table, file, "from_t_s");
  const std::vector<double> x = FiniteColumn(table, file, "x_m");
  const std::vector<double> y = FiniteColumn(table, file, "y_m");
  for (std::size_t i = 0; i < from.size(); ++i) {
    if (i > 0 && from[i] < from[i - 1]) {
      Reject(file, "from_t_s",
             fmt::format("row {}: {} comes before {}", i + 1, from[i], from[i - 1]));
    }
    if (i == 0 || from[i] > from[i - 1]) {
      plans.push_back({from[i], {}});
    }
    plans.back().path.push_back({x[i], y[i]});
  }
  return plans;
}

std::vector<CurvatureProfile> ReadCurvatures(const fs::path& file, double begin) {
  std::vector<CurvatureProfile> profiles;
  std::error_code ignored;
  if (!fs::exists(file, ignored)) {
    return profiles;
  }
  const Table table = ReadRunTable(file);
  if (table.Find("s_m") < 0 || table.Find("curvature_radpm") < 0) {
    return profiles;
  }
  const std::vector<double> s = FiniteColumn(table, file, "s_m");
  const std::vector<double> curvature = FiniteColumn(table, file, "curvature_radpm");
  const std::vector<double> from = table.Find("from_t_s") < 0
                                       ? std::vector<double>(s.size(), begin)
                                       : FiniteColumn(table, file, "from_t_s");
  for (std::size_t i = 0; i < s.size(); ++i) {
    if (i == 0 || from[i] > from[i - 1]) {
      profiles.push_back({.from = from[i], .s = {}, .curvature = {}});
    }
    CurvatureProfile& profile = profiles.back();
    // If several rows have the same station, as at a jump of the curvature, only the first row is
    // kept.
    if (profile.s.empty() || s[i] > profile.s.back()) {
      profile.s.push_back(s[i]);
      profile.curvature.push_back(curvature[i]);
    }
  }
  return profiles;
}

std::vector<std::vector<Point>> ReadGates(const fs::path& file) {
  std::error_code ignored;
  if (!fs::exists(file, ignored)) {
    return {};
  }
  std::vector<std::vector<Point>> gates;
  for (const std::vector<Vec2>& cones : GateCones(ReadJson(file))) {
    std::vector<Point>& points = gates.emplace_back();
    for (const Vec2& cone : cones) {
      points.push_back({cone.x(), cone.y()});
    }
  }
  return gates;
}

}  // namespace trackbed::render
