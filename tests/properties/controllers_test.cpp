// Properties that every registered controller must have for every path and every state.

#include "trackbed/control/controllers.h"

#include <cmath>
#include <string>
#include <vector>

#include "tests/properties/option_numbers.h"
#include "tests/properties/problems.h"
#include "tests/properties/property.h"
#include "tests/tolerance.h"
#include "trackbed/core/angle.h"
#include "trackbed/planning/common/course_schedule.h"

namespace properties {
namespace {

using namespace trackbed;

class EveryController : public testing::TestWithParam<ControllerEntry> {};

INSTANTIATE_TEST_SUITE_P(Registry, EveryController, testing::ValuesIn(Controllers()),
                         [](const auto& test) { return std::string(test.param.name); });

/// The inputs of a controller.
struct Situation {
  VehicleParams vehicle;
  Pose2 start;  // Start pose of the path.
  std::vector<Segment> segments;
  VehicleState state;
  double station = 0.0;
  double period = 0.02;
};

double SteeringIn(const ControllerEntry& entry, const Situation& now) {
  const Path path(now.start, now.segments);
  const Reference reference{path, StopAtEnd(path.length(), 3.0, {5.0, 1.0, 1.5})};
  const SteeringSchedule schedule =
      path.length() > 0.0 ? CourseSchedule(now.vehicle, now.segments, 3.0) : SteeringSchedule();
  return MakeSteeringController(entry.defaults)
      ->Steer({.vehicle = now.vehicle,
               .reference = reference,
               .schedule = schedule,
               .state = now.state,
               .station = now.station,
               .period = now.period});
}

/// Returns a random car near its path.
Situation UsualSituation() {
  Situation now{.vehicle = ScaledCar(1.0)};
  const int direction = OnceIn(4) ? -1 : 1;
  const int count = Pick(1, 3);
  for (int i = 0; i < count; ++i) {
    now.segments.push_back({.length = *Between(5.0, 40.0),
                            .curvature = *Within(0.15),
                            .direction = direction,
                            .sharpness = OnceIn(2) ? *Within(0.002) : 0.0});
  }
  const Path path({}, now.segments);
  now.station = path.length() * *Between(0.05, 0.95);
  now.state.pose = Compose(path.At(now.station).pose, {0.0, *Within(0.8), *Within(0.3)});
  now.state.speed = direction * *Between(0.5, 12.0);
  now.state.steering = *Within(0.3);
  now.state.steering_actuator = now.state.steering;
  now.state.yaw_rate = now.state.speed * CurvatureForSteering(now.vehicle, now.state.steering);
  now.state.lateral_speed = now.vehicle.cg_to_rear * now.state.yaw_rate;
  return now;
}

/// Returns a random car at any pose, on a random path that may have no segments.
Situation WildSituation() {
  const double scale = *PowerOfTen(-6, 3);
  Situation now{.vehicle = ScaledCar(OnceIn(2) ? scale : 1.0)};
  const int count = Pick(0, 3);
  for (int i = 0; i < count; ++i) {
    now.segments.push_back({.length = scale * *Between(0.001, 40.0),
                            .curvature = *Within(1.0) / scale,
                            .direction = OnceIn(3) ? -1 : 1,
                            .sharpness = OnceIn(3) ? *Within(0.1) / (scale * scale) : 0.0});
  }
  const Path path({}, now.segments);
  now.station = path.length() * *Between(-1.0, 2.0);
  const double beside = scale * *PowerOfTen(-3, 3);
  now.state.pose = Compose(path.At(now.station).pose,
                           {beside * *Within(1.0), beside * *Within(1.0), *Within(20.0)});
  now.state.speed = OnceIn(3) ? 0.0 : *Within(1.0) * *PowerOfTen(-9, 2);
  now.state.steering = *Within(1.2) * now.vehicle.steering_limit;
  now.state.steering_actuator = *Within(1.2) * now.vehicle.steering_limit;
  now.state.yaw_rate = *Within(2.0);
  now.state.lateral_speed = *Within(2.0);
  now.state.time = *Between(0.0, 100.0);
  now.state.distance = *Between(0.0, 100.0);
  now.period = *PowerOfTen(-3, 0);
  return now;
}

void Log(const Situation& now) {
  RC_LOG() << "car of " << now.vehicle.length << " m at " << now.state.pose.x << " "
           << now.state.pose.y << " " << now.state.pose.yaw << ", " << now.state.speed
           << " m/s, steering " << now.state.steering << ", station " << now.station << ", period "
           << now.period << "\n";
  for (const Segment& segment : now.segments) {
    RC_LOG() << "  " << segment.length << " m of " << segment.curvature << " " << segment.sharpness
             << ", direction " << segment.direction << "\n";
  }
}

TEST_P(EveryController, AnswersWithAnAngleWhereverTheCarIs) {
  Check(1.0, [&] {
    const Situation now = WildSituation();
    Log(now);
    double angle = 0.0;
    const std::string refusal = Refusal([&] { angle = SteeringIn(GetParam(), now); });
    RC_TAG(refusal.empty() ? std::string("angle") : refusal);
    RC_ASSERT(std::isfinite(angle));
  });
}

// Tolerance [rad] of steering angles. Searches stop within 1e-6 of the steering range of 0.5 rad,
// and quadratic programs within 1e-9.
constexpr double kSearch = 1e-6;

TEST_P(EveryController, SteersTheOtherWayInAMirroredWorld) {
  Check(1.0, [&] {
    const Situation now = UsualSituation();
    Log(now);
    Situation mirrored = now;
    for (Segment& segment : mirrored.segments) {
      segment.curvature = -segment.curvature;
      segment.sharpness = -segment.sharpness;
    }
    VehicleState& state = mirrored.state;
    state.pose = {state.pose.x, -state.pose.y, -state.pose.yaw};
    for (double* number :
         {&state.steering, &state.steering_actuator, &state.yaw_rate, &state.lateral_speed}) {
      *number = -*number;
    }
    const double a = SteeringIn(GetParam(), now);
    const double b = SteeringIn(GetParam(), mirrored);
    RC_LOG() << a << " and " << b;
    RC_ASSERT(std::abs(a + b) <= Tolerance(kSearch));
  });
}

TEST_P(EveryController, SteersTheSameEverywhere) {
  Check(1.0, [&] {
    const Situation now = UsualSituation();
    Log(now);
    const Pose2 by{*Within(1000.0), *Within(1000.0), *Within(kPi)};
    Situation moved = now;
    moved.start = by;
    moved.state.pose = Compose(by, now.state.pose);
    const double a = SteeringIn(GetParam(), now);
    const double b = SteeringIn(GetParam(), moved);
    RC_LOG() << a << " and " << b;
    RC_ASSERT(std::abs(a - b) <= Tolerance(kSearch));
  });
}

TEST_P(EveryController, RefusesOptionsThatAreNoNumbers) {
  for (const double bad : {std::nan(""), HUGE_VAL, -HUGE_VAL}) {
    ControllerOptions options = GetParam().defaults;
    std::vector<std::string> keys_of;
    const auto visit = [&](KeyVisitor& keys) { Visit(keys, options); };
    ForEachNumber(visit, [&](const std::string& key, double&, Range) { keys_of.push_back(key); });
    for (std::size_t i = 0; i < keys_of.size(); ++i) {
      options = GetParam().defaults;
      std::size_t k = 0;
      ForEachNumber(
          visit, [&](const std::string&, double& value, Range) { value = k++ == i ? bad : value; });
      EXPECT_THROW(MakeSteeringController(options), PreconditionError) << keys_of[i] << " " << bad;
    }
  }
}

TEST_P(EveryController, RefusesAStateThatIsNoNumber) {
  const Segment straight{.length = 50.0};
  for (const double bad : {std::nan(""), HUGE_VAL, -HUGE_VAL}) {
    for (double VehicleState::*number :
         {&VehicleState::speed, &VehicleState::distance, &VehicleState::lateral_speed,
          &VehicleState::yaw_rate, &VehicleState::steering, &VehicleState::steering_actuator}) {
      Situation now{.vehicle = ScaledCar(1.0), .start = {}, .segments = {straight}};
      now.state.*number = bad;
      EXPECT_TRUE(Refuses([&] { SteeringIn(GetParam(), now); }));
    }
    for (double Pose2::*number : {&Pose2::x, &Pose2::y, &Pose2::yaw}) {
      Situation now{.vehicle = ScaledCar(1.0), .start = {}, .segments = {straight}};
      now.state.pose.*number = bad;
      EXPECT_TRUE(Refuses([&] { SteeringIn(GetParam(), now); }));
    }
    for (double Situation::*number : {&Situation::station, &Situation::period}) {
      Situation now{.vehicle = ScaledCar(1.0), .start = {}, .segments = {straight}};
      now.*number = bad;
      EXPECT_TRUE(Refuses([&] { SteeringIn(GetParam(), now); }));
    }
  }
}

}  // namespace
}  // namespace properties
