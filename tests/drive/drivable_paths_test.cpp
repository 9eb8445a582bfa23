#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <optional>
#include <random>
#include <string>
#include <vector>

#include "tests/tolerance.h"
#include "tests/vehicle/reference_car.h"
#include "trackbed/control/controllers.h"
#include "trackbed/control/preview.h"
#include "trackbed/control/rear_axle_feedback.h"
#include "trackbed/control/stanley.h"
#include "trackbed/core/angle.h"
#include "trackbed/path/reference.h"
#include "trackbed/planning/path_file/path_check.h"
#include "trackbed/vehicle/kinematic_car.h"

// Compares the results of CheckPath on random paths with runs of the kinematic car on them.
namespace trackbed {
namespace {

/// The deliberate flaw of a path.
enum class Flaw { kNone, kCorner, kReversal, kJolt };

struct RandomPath {
  PathPoints points;
  PathFitOptions fit;
  double speed = 0.0;  // [m/s]
  Flaw flaw = Flaw::kNone;
  std::optional<Vec2> place;  // position of the flaw
};

/// Points on a curve of random bends, 0.3 to 2 m apart, with up to 2 cm of noise.
RandomPath MakePath(std::mt19937& random) {
  const auto between = [&](double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random);
  };
  RandomPath made;
  made.speed = between(0.5, 6.0);
  made.fit.max_deviation = between(0.02, 0.1);
  made.fit.fit = between(0.0, 1.0) < 0.15 ? PathFit::kPolyline : PathFit::kSpline;
  double noise = between(0.0, 1.0) < 0.5 ? 0.0 : between(0.0, 0.02);
  const double step = between(0.3, 2.0);
  const double sharpest = std::exp(between(std::log(0.003), std::log(0.12)));
  const double wavelength = between(20.0, 80.0);
  const double phase = between(0.0, 2.0 * kPi);
  const int count = static_cast<int>(between(50.0, 120.0) / step);
  const double chance = between(0.0, 1.0);
  made.flaw = chance < 0.5    ? Flaw::kNone
              : chance < 0.7  ? Flaw::kCorner
              : chance < 0.85 ? Flaw::kReversal
                              : Flaw::kJolt;
  if (made.flaw == Flaw::kReversal) {
    noise = 0.0;  // noise could hide the reversal
  }
  const int flawed = static_cast<int>(between(0.3, 0.7) * count);
  Pose2 pose{between(-100.0, 100.0), between(-100.0, 100.0), between(-kPi, kPi)};
  for (int i = 0; i < count; ++i) {
    made.points.points.push_back(pose.position() +
                                 noise * Vec2(between(-1.0, 1.0), between(-1.0, 1.0)));
    if (i == flawed && made.flaw != Flaw::kNone) {
      made.place = made.points.points.back();
      const double side = between(0.0, 1.0) < 0.5 ? -1.0 : 1.0;
      if (made.flaw == Flaw::kCorner) {
        pose.yaw += side * between(0.9, 2.0);
      } else if (made.flaw == Flaw::kReversal) {
        pose.yaw += kPi;
      } else {
        // A lateral step larger than the spline's allowed deviation.
        pose.x -= side * 1.5 * std::sin(pose.yaw);
        pose.y += side * 1.5 * std::cos(pose.yaw);
      }
    }
    const double curvature = sharpest * std::sin(2.0 * kPi * i * step / wavelength + phase);
    pose = Compose(pose, {step * std::cos(0.5 * curvature * step),
                          step * std::sin(0.5 * curvature * step), curvature * step});
  }
  return made;
}

/// The largest cross-track error [m] of the kinematic car at constant speed.
double LargestError(const ControllerOptions& options, const Path& path, double speed) {
  constexpr double kPeriod = 0.02;  // [s]
  const VehicleParams vehicle = ReferenceCar();
  const auto controller = MakeSteeringController(options);
  const PathPoint start = path.At(0.0);
  KinematicCar car(vehicle, ReferencePoint::kRearAxle,
                   {.pose = start.pose,
                    .speed = speed,
                    .steering = SteeringForCurvature(vehicle, start.curvature)});
  const Reference reference{path, SpeedProfile({{0.0, speed}})};
  double station = 0.0;
  double largest = 0.0;
  while (station < path.length() - 0.1) {
    const VehicleState state = car.FullState();
    const Projection tracking = path.Project(state.pose, {station - 2.0, station + 4.0});
    station = tracking.s;
    largest = std::max(largest, std::abs(tracking.cross_track));
    if (largest > 3.0 || state.time > 2.0 * path.length() / speed) {
      return 3.0;
    }
    car.Step({.steering = controller->Steer({.vehicle = vehicle,
                                             .reference = reference,
                                             .schedule = {},
                                             .state = state,
                                             .station = station,
                                             .period = kPeriod}),
              .acceleration = 0.0,
              .gear = 1},
             kPeriod);
  }
  return largest;
}

/// The environment variable TRACKBED_RANDOM_PATHS sets the number of paths; 1000 take half a
/// minute.
int Count() {
  const char* count = std::getenv("TRACKBED_RANDOM_PATHS");
  return count == nullptr ? 200 : std::atoi(count);
}

TEST(DrivablePaths, AreDrivenAndOthersHaveAPlaceAndAReason) {
  std::mt19937 random(26);
  int drivable = 0;
  int flawed = 0;
  double worst = 0.0;
  for (int i = 0; i < Count(); ++i) {
    SCOPED_TRACE(fmt::format("path {}", i));
    const RandomPath made = MakePath(random);
    const FittedPath fitted = FitPath(made.points, made.fit);
    const PathCheck check = CheckPath(fitted, ReferenceCar(), {.speed = made.speed});
    if (check.drivable()) {
      ++drivable;
      EXPECT_NE(made.flaw, Flaw::kReversal);
      double best = 3.0;
      for (const ControllerOptions& options :
           {ControllerOptions(RearAxleFeedbackOptions{}), ControllerOptions(PreviewOptions{}),
            ControllerOptions(StanleyOptions{})}) {
        best = best <= 0.02 ? best : std::min(best, LargestError(options, fitted.path, made.speed));
      }
      EXPECT_LE(best, 0.1);
      worst = std::max(worst, best);
      continue;
    }
    // Each fault lies on the path, within its stretch, and exceeds its limit.
    for (const PathFault& fault : check.faults) {
      EXPECT_GT(fault.required, fault.limit);
      EXPECT_GE(fault.s, fault.stations.from);
      EXPECT_LE(fault.s, fault.stations.to);
      EXPECT_FALSE(ToString(fault).empty());
      if (fault.kind == PathFaultKind::kSteeringRate ||
          fault.kind == PathFaultKind::kSteeringAngle) {
        // Computes the largest steering angle and steering rate from the curvature of the path,
        // over the piece of 0.05 m that begins at the fault.
        constexpr double kStep = 1e-4;  // [m]
        double angle = 0.0;
        double rate = 0.0;
        const double end = std::min(fault.s + 0.05, fitted.path.length() - kStep);
        for (double s = fault.s; s < end; s += kStep) {
          const auto steering = [&](double at) {
            return SteeringForCurvature(ReferenceCar(), fitted.path.At(at).curvature);
          };
          angle = std::max(angle, std::abs(steering(s)));
          rate = std::max(rate, made.speed * std::abs(steering(s + kStep) - steering(s)) / kStep);
        }
        const bool is_rate = fault.kind == PathFaultKind::kSteeringRate;
        // CheckPath samples pieces at their ends and at their largest curvature. Within a piece
        // whose steering turns by 0.1 rad or more, the rate may be larger.
        EXPECT_NEAR(is_rate ? rate : angle, fault.required, Tolerance(0.1 * fault.required));
        EXPECT_GT(is_rate ? rate : angle, 0.95 * fault.limit);
      }
    }
    if (made.place) {
      ++flawed;
      const auto distance = [&](const PathFault& fault) {
        return (fault.position - *made.place).norm();
      };
      const auto nearest =
          std::min_element(check.faults.begin(), check.faults.end(),
                           [&](const auto& a, const auto& b) { return distance(a) < distance(b); });
      // The spline bends within some points of the flaw, which are up to 2 m apart.
      EXPECT_LE(distance(*nearest), made.flaw == Flaw::kReversal ? 1e-9 : 4.0);
      if (made.flaw == Flaw::kReversal) {
        EXPECT_EQ(nearest->kind, PathFaultKind::kReversal);
      } else if (made.fit.fit == PathFit::kPolyline) {
        EXPECT_EQ(nearest->kind, PathFaultKind::kHeadingJump);
      }
    }
  }
  // Both results occur often.
  EXPECT_GT(drivable, Count() / 10);
  EXPECT_GT(flawed, Count() / 5);
  RecordProperty("drivable", drivable);
  RecordProperty("worst_cross_track_mm", static_cast<int>(1000.0 * worst));
}

}  // namespace
}  // namespace trackbed
