#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <random>
#include <string>

#include "tests/tolerance.h"
#include "trackbed/core/angle.h"
#include "trackbed/drive/drive.h"
#include "trackbed/planning/common/plan.h"

// Compares the open-loop prediction in plan.json with drives of the kinematic car.
namespace trackbed {
namespace {

/// Tolerance of a millimeter [m] over routes of some hundred meters. The run follows the schedule
/// and the speed profile at every physics step T = 2 ms, so the control period of 20 ms causes no
/// error. If braking with the deceleration a ends within a step T at the speed v, the car is up to
/// a T^2/8 ahead of its profile. On a steering ramp with the rate omega, this changes the steering
/// angle at a station by omega a T^2/(8 v). With omega = 0.15 rad/s, a = 1.5 m/s^2 and v = 1.1 m/s,
/// the steering angle errs by 1e-7 rad, which displaces the car by 3 um after 60 m for each ramp.
constexpr double kMillimeter = 1e-3;

std::string Number(double x) {
  return fmt::format("{:.6f}", x);
}

class Routes {
 public:
  explicit Routes(unsigned seed) : random_(seed) {}

  double Between(double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random_);
  }

  /// Legs of `low` to `high` [m] that turn by up to `turn` [rad].
  std::string Waypoints(int count, double low, double high, double turn) {
    std::string text = "[[0, 0]";
    Vec2 at(0.0, 0.0);
    double yaw = 0.0;
    for (int i = 0; i < count; ++i) {
      at += Between(low, high) * Direction(yaw);
      text += ", [" + Number(at.x()) + ", " + Number(at.y()) + "]";
      yaw += Between(-turn, turn);
    }
    return text + "]";
  }

 private:
  std::mt19937 random_;
};

/// Drives a mission open loop and compares the result with the prediction. Returns false if there
/// is no plan.
bool Agrees(const std::string& mission, const std::string& plan) {
  const Scenario scenario =
      ParseScenario("schema: 1\nname: open_loop\nmission: {" + mission + "}\nplan: {" + plan +
                        "}\ncontrol: {method: schedule}\ndrive: {plants: [kinematic], time_limit: "
                        "2000}\n",
                    "open_loop", TRACKBED_SOURCE_DIR);
  const CarModel car = LoadCar(scenario);
  const FeasiblePlan made = PlanScenario(scenario, car.unladen());
  if (!made.ok()) {
    return false;
  }
  SCOPED_TRACE(mission + "\n" + plan);
  const nlohmann::json predicted = DiagnosticsJson(made)["open_loop"];
  const RunLog log = SimulateScenario(scenario, car, made, "kinematic");
  const VehicleState& end = log.rows.back().state;
  EXPECT_NEAR(end.speed, 0.0, 0.01);
  EXPECT_NEAR((end.pose.position() - made->goal.position()).norm(),
              predicted["goal_distance_m"].get<double>(), Tolerance(kMillimeter));
  EXPECT_NEAR(AngleDifference(end.pose.yaw, made->goal.yaw),
              predicted["goal_heading_error_rad"].get<double>(), Tolerance(1e-4));
  return true;
}

TEST(OpenLoopPrediction, IsTheDriveOfFillets) {
  // Legs of 16 to 45 m, corners of up to 2 rad and speeds of up to 5 m/s include turns that the
  // planner slows down.
  Routes routes(1);
  int planned = 0;
  for (int i = 0; i < 120; ++i) {
    planned += Agrees("speed: " + Number(routes.Between(1.0, 5.0)) +
                          ", waypoints: " + routes.Waypoints(5, 16.0, 45.0, 2.0),
                      "method: fillet")
                   ? 1
                   : 0;
  }
  EXPECT_GT(planned, 80);
}

TEST(OpenLoopPrediction, IsTheDriveOfCurves) {
  // The car drives slowly over steps of curvature, and turns its wheels at rest where necessary.
  Routes routes(2);
  int planned = 0;
  for (int i = 0; i < 60; ++i) {
    const std::string headings =
        "[0, " + Number(routes.Between(-3.0, 3.0)) + ", " + Number(routes.Between(-3.0, 3.0)) + "]";
    planned += Agrees("speed: 3, waypoints: " + routes.Waypoints(2, 15.0, 40.0, 2.0) +
                          ", headings: " + headings + (i % 2 == 0 ? ", start: {speed: 0}" : ""),
                      i % 3 == 0 ? "method: reeds_shepp" : "method: dubins")
                   ? 1
                   : 0;
  }
  EXPECT_GT(planned, 40);
}

TEST(OpenLoopPrediction, IsTheDriveOfCoursesAndCorners) {
  Routes routes(3);
  int planned = 0;
  for (int i = 0; i < 40; ++i) {
    std::string segments = "{length: 10, curvature: 0}";
    for (int k = 0; k < 4; ++k) {
      segments += ", {length: " + Number(routes.Between(8.0, 20.0)) +
                  ", curvature: " + Number(routes.Between(-0.08, 0.08)) + "}";
    }
    planned += Agrees("speed: 3", "method: course, segments: [" + segments + "]") ? 1 : 0;
  }
  for (int i = 0; i < 20; ++i) {
    planned +=
        Agrees("speed: 2, waypoints: " + routes.Waypoints(3, 20.0, 30.0, 1.0), "method: astar") ? 1
                                                                                                : 0;
  }
  EXPECT_GT(planned, 45);
}

}  // namespace
}  // namespace trackbed
