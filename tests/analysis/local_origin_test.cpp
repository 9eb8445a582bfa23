#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <random>
#include <string>
#include <vector>

#include "tests/support/temp_folder.h"
#include "tests/tolerance.h"
#include "trackbed/analysis/metrics.h"
#include "trackbed/analysis/run.h"
#include "trackbed/scenario/scenario.h"

// Tests that a translation of a whole scenario to coordinates as of UTM changes no metric.
namespace trackbed {
namespace {

const Vec2 kUtm(500000.0, 5200000.0);

/// Adds the names of the numbers that differ between two JSON values.
void AddDifferences(const nlohmann::json& a, const nlohmann::json& b, const std::string& name,
                    std::vector<std::string>& differences) {
  if (a.is_number() && b.is_number()) {
    // Coordinates of 5.2e6 m are rounded to 1e-9 m, which changes lengths of 1 mm by 1e-6.
    const double x = a.get<double>();
    const double y = b.get<double>();
    if (std::abs(x - y) > Tolerance(1e-6) * std::max({1e-3, std::abs(x), std::abs(y)})) {
      differences.push_back(fmt::format("{}: {} and {}", name, x, y));
    }
  } else if (a.is_structured() && a.type() == b.type() && a.size() == b.size()) {
    auto own = a.begin();
    auto other = b.begin();
    for (int i = 0; own != a.end(); ++own, ++other, ++i) {
      const std::string key = a.is_object() ? own.key() : std::to_string(i);
      if (key == "formula") {
        continue;  // formulas are in the coordinates of the scenario
      }
      AddDifferences(*own, *other, name + "." + key, differences);
    }
  } else if (a != b) {
    differences.push_back(fmt::format("{}: {} and {}", name, a.dump(), b.dump()));
  }
}

/// The metrics of a run without the entries that state the origin.
nlohmann::json MetricsOf(const RunResult& run) {
  nlohmann::json metrics = MetricsJson(run);
  metrics.erase("origin");
  metrics["verdict"].erase("notes");
  return metrics;
}

/// A scenario with patches, bumps, grades, wind and an obstacle. The car follows waypoints if
/// `seed` is even, otherwise a path file.
std::string Course(unsigned seed, const Vec2& offset, const TempFolder& folder) {
  std::mt19937 random(seed);
  const auto number = [&](double from, double to) {
    return std::round(1e3 * std::uniform_real_distribution<double>(from, to)(random)) / 1e3;
  };
  const auto place = [&](double x, double y) {
    return fmt::format("x: {}, y: {}", x + offset.x(), y + offset.y());
  };
  const double x = number(20.0, 30.0);
  const double y = number(-3.0, 3.0);
  std::string text = "schema: 1\nname: course\ndrive: {plants: [kinematic, mujoco]}\n";
  if (seed % 2 == 0) {
    text += fmt::format(
        "mission: {{speed: 3, waypoints: [[{}, {}], [{}, {}], [{}, {}]]}}\nplan: {{method: "
        "dubins}}\n",
        offset.x(), offset.y(), x + offset.x(), y + offset.y(), 50.0 + offset.x(),
        number(8.0, 15.0) + offset.y());
  } else {
    std::string points = "x_m,y_m\n";
    for (double at = 0.0; at <= 50.0; at += 1.0) {
      points += fmt::format("{},{:.3f}\n", at + offset.x(), 3.0 * std::sin(at / 12.0) + offset.y());
    }
    folder.Write("path.csv", points);
    text += "mission: {speed: 3}\nplan: {method: path_file, file: path.csv}\n";
  }
  text += fmt::format(
      "world:\n  friction_patches: [{{{}, length: 8, width: 8, friction: 0.6}}]\n"
      "  obstacles: [{{box: {{{}, length: 2, width: 1}}}}]\n"
      "  wind: {{gusts: [{{y: 8, shape: step, area: {{{}, length: 8, width: 20}}}}]}}\n",
      place(number(5.0, 45.0), number(-2.0, 2.0)), place(25.0, number(25.0, 30.0)),
      place(number(5.0, 45.0), 0.0));
  text += seed % 3 == 0
              ? "  ground: {grade: {x: 0.04, y: -0.02}}\n"
              : fmt::format("  ground: {{bumps: [{{{}, length: 4, width: 3, height: 0.05}}]}}\n",
                            place(number(10.0, 40.0), number(-2.0, 2.0)));
  return text +
         fmt::format("expect: {{requirements: [{{name: past, formula: eventually x_m > {}}}]}}\n",
                     40.0 + offset.x());
}

TEST(LocalOriginRun, ChangesNoMetric) {
  for (unsigned seed = 0; seed < 6; ++seed) {
    const TempFolder folder;
    const auto run = [&](const Vec2& offset) {
      return RunScenario(ParseScenario(Course(seed, offset, folder), "course.yaml", folder.path()));
    };
    const RunResult here = run(Vec2::Zero());
    const RunResult there = run(kUtm);
    ASSERT_TRUE(here.plan.ok()) << here.plan->reason;
    ASSERT_EQ(there.scenario.origin, kUtm);
    std::vector<std::string> differences;
    AddDifferences(MetricsOf(here), MetricsOf(there), "", differences);
    EXPECT_THAT(differences, testing::IsEmpty()) << "seed " << seed;
    EXPECT_THAT(there.verdict.notes,
                testing::Contains(testing::HasSubstr("local origin (500000, 5200000) m")));
    EXPECT_EQ(MetricsJson(there).at("origin"), nlohmann::ordered_json({500000.0, 5200000.0}));
    const Table log = ToTable(there.logs.front());
    EXPECT_EQ(log.Column("origin_x_m").back(), kUtm.x());
    EXPECT_EQ(log.Column("origin_y_m").back(), kUtm.y());
  }
}

}  // namespace
}  // namespace trackbed
