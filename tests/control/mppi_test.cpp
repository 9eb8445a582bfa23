#include "trackbed/control/mppi.h"

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "src/control/obstacle_cells.h"
#include "src/control/roll_out.h"
#include "tests/control/loop.h"
#include "tests/geometry/random.h"
#include "tests/tolerance.h"
#include "trackbed/control/lqr.h"
#include "trackbed/control/surroundings.h"
#include "trackbed/world/world.h"

// Tests the model of mppi against the single-track car, its distances against the exact distance
// of rectangles, and its commands around obstacles, within edges and on several threads.
namespace trackbed {
namespace mppi_test {

class GivenSurroundings final : public Surroundings {
 public:
  std::vector<SeenObstacle> obstacles;
  PathEdges edges;

  [[nodiscard]] const std::vector<SeenObstacle>& Obstacles() const override { return obstacles; }
  [[nodiscard]] const PathEdges& Edges() const override { return edges; }
  [[nodiscard]] double RoadFriction() const override { return 1.0; }
};

constexpr double kPeriod = 0.05;  // [s]

/// Poses of a kinematic car on a straight along x at constant speed.
struct Straight {
  VehicleParams vehicle = ReferenceCar();
  GivenSurroundings surroundings;
  double offset = 0.0;
  double speed = 10.0;
  double length = 100.0;

  [[nodiscard]] std::vector<Pose2> Drive(const ControllerOptions& options) const {
    const auto controller = MakeSteeringController(options);
    const Reference reference{Path({}, {{length, 0.0, 1}}), SpeedProfile({{0.0, speed}})};
    KinematicCar car(vehicle, ReferencePoint::kRearAxle,
                     {.pose = {0.0, offset, 0.0}, .speed = speed});
    std::vector<Pose2> poses;
    while (car.FullState().pose.x < length) {
      const VehicleState state = car.FullState();
      poses.push_back(state.pose);
      auto* const sees = dynamic_cast<SeesSurroundings*>(controller.get());
      EXPECT_NE(sees, nullptr);
      sees->See(surroundings);
      car.Step({.steering = controller->Steer({.vehicle = vehicle,
                                               .reference = reference,
                                               .schedule = {},
                                               .state = state,
                                               .station = state.pose.x,
                                               .period = kPeriod})},
               kPeriod);
    }
    return poses;
  }
};

/// Few roll-outs: the tests run on two cores.
MppiOptions Few() {
  return {.samples = 200};
}

double SmallestDistance(const VehicleParams& vehicle, const std::vector<Pose2>& poses,
                        const MovingBox& box) {
  double smallest = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < poses.size(); ++i) {
    smallest = std::min(smallest, Separation(FootprintAt(vehicle, poses[i]),
                                             box.At(kPeriod * static_cast<double>(i))));
  }
  return smallest;
}

TEST(Mppi, PassesABoxThatItsPathHits) {
  Straight road;
  const OrientedBox box{.center = {60.0, 0.3, 0.4}, .length = 2.0, .width = 2.0};
  road.surroundings.obstacles = {{.footprint = box}};
  EXPECT_LT(SmallestDistance(road.vehicle, road.Drive(LqrOptions{}), {box}), 0.0);
  const std::vector<Pose2> poses = road.Drive(Few());
  EXPECT_GT(SmallestDistance(road.vehicle, poses, {box}), 0.0);
  // Behind the box, the car returns to its path.
  EXPECT_LT(std::abs(poses.back().y), 0.3);
}

TEST(Mppi, LetsABoxCross) {
  // Without a change of its path, the car meets the box after 6 s.
  Straight road;
  const MovingBox box{{.center = {60.0, -12.0, 1.0}, .length = 2.0, .width = 1.0}, {0.0, 2.0}};
  road.surroundings.obstacles = {{.footprint = box.box, .velocity = box.velocity}};
  EXPECT_LT(SmallestDistance(road.vehicle, road.Drive(LqrOptions{}), box), 0.0);
  // The surroundings are those of the start: the controller extrapolates from there in the first
  // control period only. Therefore this drive updates them.
  const auto controller = MakeSteeringController(Few());
  const Reference reference{Path({}, {{100.0, 0.0, 1}}), SpeedProfile({{0.0, 10.0}})};
  KinematicCar car(road.vehicle, ReferencePoint::kRearAxle, {.speed = 10.0});
  std::vector<Pose2> poses;
  for (double time = 0.0; car.FullState().pose.x < 100.0; time += kPeriod) {
    poses.push_back(car.FullState().pose);
    road.surroundings.obstacles[0].footprint = box.At(time);
    dynamic_cast<SeesSurroundings&>(*controller).See(road.surroundings);
    car.Step({.steering = controller->Steer({.vehicle = road.vehicle,
                                             .reference = reference,
                                             .schedule = {},
                                             .state = car.FullState(),
                                             .station = car.FullState().pose.x,
                                             .period = kPeriod})},
             kPeriod);
  }
  EXPECT_GT(SmallestDistance(road.vehicle, poses, box), 0.0);
}

TEST(Mppi, KeepsWithinTheEdgesOfItsTrack) {
  // The left edge comes as near as 0.5 m to the path, while half of the car is 0.8625 m wide.
  Straight road;
  road.surroundings.edges.spacing = 0.5;
  for (double s = 0.0; s <= road.length; s += 0.5) {
    const bool narrow = s > 50.0 && s < 60.0;
    road.surroundings.edges.distances.push_back({.left = narrow ? 0.5 : 3.0, .right = 3.0});
  }
  const auto most_left = [&](const std::vector<Pose2>& poses) {
    double most = -10.0;
    for (const Pose2& pose : poses) {
      for (const Vec2& corner : FootprintAt(road.vehicle, pose).Corners()) {
        most = corner.x() > 50.5 && corner.x() < 59.5 ? std::max(most, corner.y()) : most;
      }
    }
    return most;
  };
  EXPECT_GT(most_left(road.Drive(LqrOptions{})), 0.8);
  EXPECT_LT(most_left(road.Drive(Few())), 0.5);
}

TEST(Mppi, CommandsTheSameOnAnyNumberOfThreads) {
  Straight road;
  road.offset = 0.7;
  road.length = 40.0;
  road.surroundings.obstacles = {
      {.footprint = {.center = {25.0, 0.3, 0.4}, .length = 2.0, .width = 2.0}}};
  const auto drive = [&](int threads, std::uint64_t seed) {
    MppiOptions options = Few();
    options.seed = seed;
    tbb::task_arena arena(threads);
    return arena.execute([&] { return road.Drive(options); });
  };
  const std::vector<Pose2> one = drive(1, 7);
  const std::vector<Pose2> two = drive(2, 7);
  const std::vector<Pose2> other = drive(2, 8);
  ASSERT_EQ(one.size(), two.size());
  bool differs = false;
  for (std::size_t i = 0; i < one.size(); ++i) {
    EXPECT_EQ(one[i].y, two[i].y);
    differs = differs || i >= other.size() || one[i].y != other[i].y;
  }
  EXPECT_TRUE(differs) << "the seed has no effect";
}

TEST(Mppi, TurnsTheWheelsOfAStandingCarToItsPath) {
  // A car stands at a cusp, with the steering angle of the piece that it has just driven. The drive
  // waits until the steering angle is constant. By then, the angle must be that of the next piece,
  // which is driven in reverse.
  const VehicleParams vehicle = ReferenceCar();
  constexpr double kCurvature = -0.1;  // [1/m], positive steering to the left
  const double wanted = std::atan(vehicle.wheelbase * kCurvature);
  const auto controller = MakeSteeringController(Few());
  const Reference reference{Path({}, {{10.0, kCurvature, -1}}), SpeedProfile({{0.0, 1.0}})};
  VehicleState state;
  state.steering = 0.4;
  const double period = 0.02;
  const auto periods =
      static_cast<int>(std::ceil((state.steering - wanted) / (vehicle.steering_rate * period)));
  for (int i = 0; i < periods; ++i) {
    const double command = controller->Steer({.vehicle = vehicle,
                                              .reference = reference,
                                              .schedule = {},
                                              .state = state,
                                              .station = 0.0,
                                              .period = period});
    const double most = vehicle.steering_rate * period;
    state.steering += std::clamp(command - state.steering, -most, most);
  }
  // The regulator approaches the angle exponentially at the end, here to within 0.02 rad.
  EXPECT_NEAR(state.steering, wanted, Tolerance(0.02));
}

TEST(Mppi, CopiesSteerAlike) {
  const VehicleParams vehicle = ReferenceCar();
  const auto controller = MakeSteeringController(Few());
  const Reference reference{Path({}, {{100.0, 0.0, 1}}), SpeedProfile({{0.0, 10.0}})};
  const auto steer = [&](SteeringController& by) {
    VehicleState state;
    state.pose = {20.0, 1.0, 0.1};
    state.speed = 10.0;
    return by.Steer({.vehicle = vehicle,
                     .reference = reference,
                     .schedule = {},
                     .state = state,
                     .station = 20.0,
                     .period = 0.02});
  };
  steer(*controller);
  const auto copy = controller->Clone();
  ASSERT_NE(copy, nullptr);
  EXPECT_EQ(steer(*copy), steer(*controller));
}

// --- Model ---------------------------------------------------------------------------------------

/// Largest distance [m] of the roll-out from the single-track car, both with the same rates.
double RollOutError(int steps) {
  const VehicleParams vehicle = ReferenceCarWithTyres();
  const double speed = 15.0;
  const double step = 1.0 / steps;
  const auto rate = [](double time) { return 0.1 * std::cos(5.0 * time); };
  const Reference reference{Path({}, {{100.0, 0.0, 1}}), SpeedProfile({{0.0, speed}})};
  VehicleState state;
  state.speed = speed;
  const ControlInput input{.vehicle = vehicle,
                           .reference = reference,
                           .schedule = {},
                           .state = state,
                           .station = 0.0,
                           .period = 0.02};
  RollOuts roll_outs;
  roll_outs.Prepare(input, ProjectOntoPath(input), 0.0, nullptr, {.steps = steps, .step = step});
  VehicleParams actuated = vehicle;
  actuated.steering_lag = 0.0;
  SingleTrackCar car(actuated, {.speed = speed});
  double error = 0.0;
  double angle = 0.0;
  double wheels = 0.0;
  const double decay = std::exp(-step / vehicle.steering_lag);
  static_cast<void>(roll_outs.Cost([&](int k, const RolledCar& rolled) {
    const Pose2& pose = car.state().pose;
    error = std::max(error, std::hypot(rolled.x - pose.x, rolled.y - pose.y));
    EXPECT_NEAR(rolled.cross_track, rolled.y, Tolerance(1e-12));
    EXPECT_NEAR(rolled.station, rolled.x, Tolerance(1e-12));
    const double turning = rate(k * step);
    angle += turning * step;
    // Wheels that lag behind a ramp.
    wheels = angle - turning * vehicle.steering_lag +
             (wheels - angle + turning * step + turning * vehicle.steering_lag) * decay;
    car.Step({.steering = wheels}, step);
    return turning;
  }));
  return error;
}

TEST(RollOuts, ConvergeToTheSingleTrackCar) {
  // The implicit Euler method is of first order, and so are the wheels, which SingleTrackCar turns
  // at their full rate at the beginning of a step: half the step halves the error. The bounds allow
  // a tenth of the error for terms of second order.
  const double coarse = RollOutError(100);
  const double fine = RollOutError(200);
  EXPECT_LT(fine, 0.05);
  EXPECT_GT(coarse / fine, 1.8);
  EXPECT_LT(coarse / fine, 2.2);
}

// --- Distances -----------------------------------------------------------------------------------

Rectangle AsRectangle(const OrientedBox& box) {
  return {.x = box.center.x,
          .y = box.center.y,
          .cosine = std::cos(box.center.yaw),
          .sine = std::sin(box.center.yaw),
          .half_length = 0.5 * box.length,
          .half_width = 0.5 * box.width};
}

OrientedBox RandomBox(Random& random, double reach) {
  return {.center = {random.Uniform(-reach, reach), random.Uniform(-reach, reach),
                     random.Uniform(-4.0, 4.0)},
          .length = random.Uniform(0.1, 6.0),
          .width = random.Uniform(0.1, 3.0)};
}

TEST(GapOf, BoundsTheDistanceOfRectangles) {
  Random random(91);
  constexpr double kRounding = 1e-12;
  for (int i = 0; i < 2000; ++i) {
    const OrientedBox a = RandomBox(random, 5.0);
    const OrientedBox b = RandomBox(random, 5.0);
    const double distance = Separation(a, b);
    const double gap = GapOf(AsRectangle(a), AsRectangle(b));
    SCOPED_TRACE(fmt::format("case {}: {} m", i, distance));
    EXPECT_EQ(gap < 0.0, distance < 0.0);
    EXPECT_LE(gap, std::max(distance, 0.0) + kRounding);
    EXPECT_GE(gap, distance > 0.0 ? distance / std::sqrt(2.0) - kRounding : -10.0);
  }
}

TEST(ObstacleCells, FindTheSmallestGap) {
  Random random(92);
  const OrientedBox car{.center = {}, .length = 4.45, .width = 1.725};
  const double radius = 0.5 * std::hypot(car.length, car.width);
  const double margin = 1.5;
  constexpr double kRounding = 1e-10;
  for (int i = 0; i < 50; ++i) {
    std::vector<SeenObstacle> obstacles(static_cast<std::size_t>(i * 4));
    for (SeenObstacle& obstacle : obstacles) {
      obstacle.footprint = RandomBox(random, 60.0);
      if (random.Uniform(0.0, 1.0) < 0.2) {
        obstacle.velocity = {random.Uniform(-5.0, 5.0), random.Uniform(-5.0, 5.0)};
      }
    }
    const Pose2 X_WA{random.Uniform(-20.0, 20.0), random.Uniform(-20.0, 20.0),
                     random.Uniform(-4.0, 4.0)};
    ObstacleCells cells;
    cells.Take(obstacles, X_WA, 30.0, radius, margin, 2.0);
    for (int j = 0; j < 50; ++j) {
      OrientedBox at = car;
      at.center = {random.Uniform(-20.0, 20.0), random.Uniform(-20.0, 20.0),
                   random.Uniform(-4.0, 4.0)};
      const double time = random.Uniform(0.0, 2.0);
      OrientedBox in_world = at;
      in_world.center = Compose(X_WA, at.center);
      double expected = margin;
      for (const SeenObstacle& obstacle : obstacles) {
        const OrientedBox there = MovingBox{obstacle.footprint, obstacle.velocity}.At(time);
        expected = std::min(expected, GapOf(AsRectangle(in_world), AsRectangle(there)));
      }
      EXPECT_NEAR(cells.Gap(AsRectangle(at), time), expected, Tolerance(kRounding));
    }
  }
}

}  // namespace mppi_test
}  // namespace trackbed
