#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <nlohmann/json.hpp>

#include "tests/geometry/random.h"
#include "tests/tolerance.h"
#include "tests/vehicle/reference_car.h"
#include "trackbed/planning/path_file/path_file_planner.h"
#include "trackbed/planning/registry/planners.h"

// Stops and waits of plans that follow the speeds and times of a file.
namespace trackbed {
namespace {

using ::testing::Contains;
using ::testing::HasSubstr;

Plan PlanAlong(const PathPoints& given, double start_speed = 0.0) {
  PathFileOptions options;
  options.speeds = PathSpeeds::kFile;
  options.path = std::make_shared<const FittedPath>(FitPath(given, {}));
  PlanRequest request;
  request.vehicle = ReferenceCar();
  request.start = options.path->path.At(0.0).pose;
  request.start_speed = start_speed;
  request.speed = {.speed = 3.0, .acceleration = 1.0, .deceleration = 1.5};
  return *MakePlan(request, options);
}

/// Samples a car on the x axis that drives `legs` [m] from rest to rest, and waits before each leg
/// and at the end for a duration of `waits` [s].
struct Recorder {
  double period = 0.1;
  double acceleration = 1.0;
  bool has_speeds = true;

  [[nodiscard]] PathPoints Record(const std::vector<double>& legs,
                                  const std::vector<double>& waits) const {
    PathPoints given;
    double s = 0.0;
    double time = 0.0;
    const auto add = [&](double x, double v) {
      given.points.emplace_back(1e-3 * std::round(1e3 * x), 0.0);  // as files round positions
      given.speed.push_back(v);
      given.time.push_back(time);
      time += period;
    };
    for (std::size_t i = 0; i < waits.size(); ++i) {
      for (double t = 0.0; t < waits[i] - 0.5 * period; t += period) {
        add(s, 0.0);
      }
      if (i == legs.size()) {
        break;
      }
      // Accelerates over the first half of the leg, and brakes over the second.
      const double half = std::sqrt(legs[i] / acceleration);
      for (double t = 0.0; t < 2.0 * half; t += period) {
        const double left = std::min(t, 2.0 * half - t);
        const double way = 0.5 * acceleration * left * left;
        add(t < half ? s + way : s + legs[i] - way, acceleration * left);
      }
      s += legs[i];
    }
    add(s, 0.0);
    for (std::size_t i = 0; !has_speeds && i < given.points.size(); ++i) {
      // As the reader computes the speeds from the times.
      const std::size_t k = std::min(i, given.points.size() - 2);
      given.speed[i] = (given.points[k + 1] - given.points[k]).norm() / period;
    }
    return given;
  }
};

// The duration of a stop is uncertain by the sampling periods before and after the stop. Positions
// are rounded to 1 mm, so the car seems to stand while it is within 0.5 mm, 0.03 s on either side.
TEST(FileWaits, LastAsLongAsTheCarStands) {
  Random random(47);
  for (int i = 0; i < 60; ++i) {
    const Recorder recorder{.period = random.Uniform(0.05, 0.2), .has_speeds = i % 2 == 0};
    SCOPED_TRACE(i);
    const std::vector<double> waits{0.0, random.Uniform(2.0, 20.0), 0.0, random.Uniform(2.0, 20.0)};
    const std::vector<double> legs{random.Uniform(4.0, 20.0), random.Uniform(4.0, 20.0),
                                   random.Uniform(4.0, 20.0), random.Uniform(4.0, 20.0)};
    const Plan plan = PlanAlong(recorder.Record(legs, waits));
    ASSERT_TRUE(plan.ok()) << plan.reason;
    constexpr double kMaxDeviation = 0.05;  // of the fit [m]
    const double stations[] = {legs[0], legs[0] + legs[1] + legs[2]};
    std::vector<PlannedWait> long_waits;
    for (const PlannedWait& wait : plan.waits) {
      if (wait.duration > 1.0) {
        long_waits.push_back(wait);
      }
    }
    ASSERT_EQ(long_waits.size(), 2U);
    for (std::size_t k = 0; k < 2; ++k) {
      EXPECT_NEAR(long_waits[k].s, stations[k], Tolerance(kMaxDeviation));
      EXPECT_NEAR(long_waits[k].duration, waits[2 * k + 1],
                  Tolerance(2.0 * recorder.period + 0.06));
      EXPECT_EQ(plan.reference.speed.SpeedAt(long_waits[k].s), 0.0);
    }
  }
}

// The recorder of a standing car jitters by centimeters, and the speeds follow from the times.
TEST(FileWaits, AreFoundAmongJitter) {
  PathPoints given;
  const auto add = [&](double x, double y, double step) {
    given.time.push_back(given.time.empty() ? 0.0 : given.time.back() + step);
    given.points.emplace_back(x, y);
  };
  for (int i = 0; i <= 40; ++i) {
    add(0.5 * i, 0.0, 0.25);
    if (i == 20) {
      add(9.99, 0.001, 2.0);
      add(10.005, -0.001, 3.0);
    }
  }
  for (std::size_t i = 0; i < given.points.size(); ++i) {
    const std::size_t k = std::min(i, given.points.size() - 2);
    given.speed.push_back((given.points[k + 1] - given.points[k]).norm() /
                          (given.time[k + 1] - given.time[k]));
  }
  const Plan plan = PlanAlong(given, 2.0);
  ASSERT_EQ(plan.waits.size(), 1U);
  EXPECT_NEAR(plan.waits[0].s, 10.0, Tolerance(0.05));
  EXPECT_NEAR(plan.waits[0].duration, 5.0, Tolerance(1e-9));
}

// From 3 m/s, the car brakes at 1.5 m/s^2 in 2 s, waits, and is at 1 m/s after 0.5 m and 1 s.
TEST(FileWaits, IncludeTheTimeOfStepsThatNeedLess) {
  PathPoints given;
  given.points = {{0.0, 0.0}, {10.0, 0.0}, {13.0, 0.0}, {13.5, 0.0}, {23.0, 0.0}};
  given.speed = {3.0, 3.0, 0.0, 1.0, 1.0};
  given.time = {0.0, 10.0 / 3.0, 16.0 / 3.0, 16.0 / 3.0 + 8.5, 30.0};
  const Plan plan = PlanAlong(given, 3.0);
  ASSERT_EQ(plan.waits.size(), 1U);
  EXPECT_NEAR(plan.waits[0].s, 13.0, Tolerance(1e-9));
  EXPECT_NEAR(plan.waits[0].duration, 7.5, Tolerance(1e-9));
  EXPECT_NEAR(plan.Duration() - plan.reference.speed.TimeAt(plan.reference.path.length()), 7.5,
              Tolerance(1e-9));
  EXPECT_THAT(plan.notes,
              Contains(HasSubstr("waits as long as the file's car: 7.5 s at s = 13 m")));
  const nlohmann::json json = DiagnosticsJson(plan);
  EXPECT_EQ(json.at("waits").size(), 1U);
  EXPECT_NEAR(json.at("waits")[0].at("duration_s").get<double>(), 7.5, Tolerance(1e-9));
  // Without times, the car does not wait.
  given.time.clear();
  EXPECT_TRUE(PlanAlong(given, 3.0).waits.empty());
}

TEST(FileWaits, AreAtCuspsAndAtTheStartToo) {
  PathPoints given;
  given.points = {{0.0, 0.0}, {0.0, 0.0}, {4.0, 0.0}, {8.0, 0.0},
                  {8.0, 0.0}, {4.0, 0.0}, {2.0, 0.0}};
  given.direction = {1, 1, 1, 1, -1, -1, -1};
  given.speed = {0.0, 0.0, 1.0, 0.0, 0.0, 1.0, 0.0};
  given.time = {0.0, 6.0, 14.0, 22.0, 27.0, 35.0, 39.0};
  const Plan plan = PlanAlong(given);
  ASSERT_TRUE(plan.ok()) << plan.reason;
  ASSERT_EQ(plan.waits.size(), 2U);
  EXPECT_EQ(plan.waits[0].s, 0.0);
  EXPECT_NEAR(plan.waits[0].duration, 6.0, Tolerance(1e-9));
  EXPECT_NEAR(plan.waits[1].s, 8.0, Tolerance(1e-6));
  EXPECT_NEAR(plan.waits[1].duration, 5.0, Tolerance(1e-9));
  EXPECT_TRUE(plan.stops.empty());
}

// A car that creeps over 5 m at 0.05 m/s does not stand anywhere, and a rolling car does not wait.
TEST(FileWaits, NeedACarThatStands) {
  PathPoints given;
  for (int i = 0; i <= 400; ++i) {
    const double x = 0.05 * i;
    given.points.emplace_back(x, 0.0);
    const bool creeps = x > 5.0 && x < 10.0;
    given.speed.push_back(creeps ? 0.05 : 2.0);
    given.time.push_back(given.time.empty() ? 0.0 : given.time.back() + (creeps ? 1.0 : 0.025));
  }
  EXPECT_TRUE(PlanAlong(given, 2.0).waits.empty());
  EXPECT_TRUE(PlanAlong(given, 2.0).stops.empty());
}

}  // namespace
}  // namespace trackbed
