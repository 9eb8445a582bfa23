// NaN at the public entries: an error, or a result that is NaN or says that there is none. Other
// numbers that no one means, infinities among them, may be taken; but nothing may crash on them.

#include <cmath>
#include <functional>
#include <limits>
#include <string>
#include <vector>

#include "tests/properties/problems.h"
#include "tests/properties/property.h"
#include "trackbed/control/optimal_steering.h"
#include "trackbed/control/preview.h"
#include "trackbed/control/speed_controller.h"
#include "trackbed/core/angle.h"
#include "trackbed/optimize/quadratic_program.h"
#include "trackbed/optimize/search.h"
#include "trackbed/path/bezier.h"
#include "trackbed/path/frenet_frame.h"
#include "trackbed/path/smooth_curvature.h"
#include "trackbed/planning/common/corners.h"
#include "trackbed/planning/common/curvature_steps.h"
#include "trackbed/planning/common/occupancy_grid.h"
#include "trackbed/planning/curves/dubins.h"
#include "trackbed/planning/curves/reeds_shepp.h"
#include "trackbed/planning/frenet/polynomial.h"
#include "trackbed/planning/registry/planners.h"
#include "trackbed/planning/sampling/rrt.h"
#include "trackbed/planning/sampling/rrt_star.h"
#include "trackbed/planning/sampling/smoothing.h"
#include "trackbed/vehicle/kinematic_car.h"
#include "trackbed/vehicle/magic_formula.h"
#include "trackbed/vehicle/single_track_car.h"
#include "trackbed/vehicle/steering_faults.h"
#include "trackbed/vehicle/steering_schedule.h"
#include "trackbed/world/world.h"

namespace properties {
namespace {

using namespace trackbed;

/// A call with one number of its own choice, all else good. What it returns is finite exactly if
/// the call says that all is well.
struct Entry {
  std::string name;
  std::function<double(double number)> call;
};

constexpr double kGood = 0.0;
const double kNone = std::numeric_limits<double>::quiet_NaN();

double SumOf(const Pose2& pose) {
  return pose.x + pose.y + pose.yaw;
}
double SumOf(const Vec2& point) {
  return point.x() + point.y();
}

const Path& Bend() {
  static const Path path({}, {{.length = 20.0},
                              {.length = 10.0, .curvature = 0.0, .sharpness = 0.01},
                              {.length = 15.0, .curvature = 0.1}});
  return path;
}

World WorldWithAll() {
  World world;
  world.friction_patches = {{{{5.0, 0.0, 0.0}, 2.0, 2.0}, 0.5}};
  world.ground.bumps = {{.area = {{10.0, 0.0, 0.0}, 4.0, 4.0}}};
  world.ground.side_slopes = {{.area = {{20.0, 0.0, 0.0}, 10.0, 4.0}, .slope = 0.1}};
  world.wind.velocity = {1.0, 0.0};
  world.wind.gusts = {{.velocity = {2.0, 0.0}, .from = 1.0, .duration = 3.0}};
  world.obstacles = {{.footprint = {{30.0, 5.0, 0.3}, 2.0, 1.0}, .velocity = {0.5, 0.0}}};
  return world;
}

const OrientedBox kBox{{1.0, 2.0, 0.3}, 3.0, 2.0};

std::vector<Entry> OfGeometry() {
  return {
      {"WrapAngle", [](double x) { return WrapAngle(x); }},
      {"AngleDifference", [](double x) { return AngleDifference(1.0, x); }},
      {"Direction", [](double x) { return SumOf(Direction(x)); }},
      {"Compose",
       [](double x) {
         return SumOf(Compose({x, 0.0, 0.0}, {1.0, 0.0, 0.0}));
       }},
      {"ToWorld",
       [](double x) {
         return SumOf(ToWorld({0.0, 0.0, x}, {1.0, 0.0}));
       }},
      {"ToLocal",
       [](double x) {
         return SumOf(ToLocal({0.0, x, 0.0}, {1.0, 0.0}));
       }},
      {"MoveOnArc distance", [](double x) { return SumOf(MoveOnArc({}, x, 1.0)); }},
      {"MoveOnArc turn", [](double x) { return SumOf(MoveOnArc({}, 1.0, x)); }},
      {"Contains",
       [](double x) {
         return Contains(kBox, {x, 2.0}) ? kGood : kNone;
       }},
      {"Separation place",
       [](double x) {
         return Separation(kBox, {{x, 0.0, 0.0}, 1.0, 1.0});
       }},
      {"Separation yaw",
       [](double x) {
         return Separation(kBox, {{9.0, 0.0, x}, 1.0, 1.0});
       }},
      {"Separation size",
       [](double x) {
         return Separation(kBox, {{9.0, 0.0, 0.0}, x, 1.0});
       }},
      {"Distance",
       [](double x) {
         return Distance(kBox, {{x, 0.0, 0.0}, 1.0, 1.0});
       }},
      {"Distance of a line",
       [](double x) {
         return Distance({9.0, x}, {9.0, 2.0}, kBox);
       }},
      {"Distance width",
       [](double x) {
         return Distance({9.0, 0.0}, {9.0, 2.0}, {{}, 1.0, x});
       }},
  };
}

std::vector<Entry> OfPaths() {
  const SpeedLimits limits{3.0, 1.0, 1.5};
  return {
      {"Path start",
       [](double x) {
         return Path({x, 0.0, 0.0}, {{.length = 1.0}}).length();
       }},
      {"Path length", [](double x) { return Path({}, {{.length = x}}).length(); }},
      {"Path curvature",
       [](double x) { return Path({}, {{.length = 1.0, .curvature = x}}).length(); }},
      {"Path sharpness",
       [](double x) {
         return Path({}, {{.length = 1.0, .curvature = 0.0, .direction = 1, .sharpness = x}})
             .length();
       }},
      {"Path::At", [](double x) { return SumOf(Bend().At(x).pose); }},
      {"Path::BendAt", [](double x) { return Bend().BendAt(x).curvature; }},
      {"Path::BendAt of an arc",
       [](double x) {
         return Path({}, {{1.0, 0.2, 1}}).BendAt(x).curvature;
       }},
      {"Path::Project x",
       [](double x) {
         return Bend().Project({x, 0.0, 0.0}).s;
       }},
      {"Path::Project yaw",
       [](double x) {
         return Bend().Project({1.0, 0.0, x}).s;
       }},
      {"Path::Project from",
       [](double x) {
         return Bend().Project({1.0, 0.0, 0.0}, {x, 3.0}).s;
       }},
      {"Path::Sample", [](double x) { return static_cast<double>(Bend().Sample(x).size()); }},
      {"Path::Cut from",
       [](double x) {
         return static_cast<double>(Bend().Cut({x, 30.0}).size());
       }},
      {"Path::Cut to",
       [](double x) {
         return static_cast<double>(Bend().Cut({0.0, x}).size());
       }},
      {"SplitIntoLegs",
       [](double x) {
         return static_cast<double>(SplitIntoLegs(Bend(), {x, 2.0}).size());
       }},
      {"SegmentsThrough s",
       [](double x) {
         return SegmentsThrough({{}, {x, 0.0, 0.0}}).front().length;
       }},
      {"SegmentsThrough yaw",
       [](double x) {
         return SegmentsThrough({{}, {1.0, x, 0.0}}).front().sharpness;
       }},
      {"SpeedProfile s",
       [](double x) {
         return SpeedProfile({{x, 1.0}}).knots().front().speed;
       }},
      {"SpeedProfile speed",
       [](double x) {
         return SpeedProfile({{0.0, 1.0}, {1.0, x}}).knots().front().speed;
       }},
      {"SpeedAt",
       [](double x) {
         return SpeedProfile({{0.0, 1.0}, {1.0, 2.0}}).SpeedAt(x);
       }},
      {"AccelerationAt",
       [](double x) {
         return SpeedProfile({{0.0, 1.0}, {1.0, 2.0}}).AccelerationAt(x);
       }},
      {"TimeAt",
       [](double x) {
         return SpeedProfile({{0.0, 1.0}, {1.0, 2.0}}).TimeAt(x);
       }},
      {"StationAt",
       [](double x) {
         return SpeedProfile({{0.0, 1.0}, {1.0, 2.0}}).StationAt(x);
       }},
      {"StopAtEnd length",
       [=](double x) { return StopAtEnd(x, 1.0, limits).knots().back().speed; }},
      {"StopAtEnd start speed",
       [=](double x) { return StopAtEnd(20.0, x, limits).knots().back().speed; }},
      {"StopAtEnd speed",
       [](double x) {
         return StopAtEnd(20.0, 1.0, {x, 1.0, 1.0}).knots().back().speed;
       }},
      {"StopAtEnd acceleration",
       [](double x) {
         return StopAtEnd(20.0, 1.0, {3.0, x, 1.0}).knots().back().speed;
       }},
      {"StopAtEnd deceleration",
       [](double x) {
         return StopAtEnd(20.0, 1.0, {3.0, 1.0, x}).knots().back().speed;
       }},
      {"StopAtEnd cap",
       [=](double x) {
         return StopAtEnd(20.0, 1.0, limits, {{5.0, 10.0, x}}).knots().back().speed;
       }},
      {"StopAtEnd cap from",
       [=](double x) {
         return StopAtEnd(20.0, 1.0, limits, {{x, 10.0, 1.0}}).knots().back().speed;
       }},
      {"StopAtCusps stop",
       [=](double x) { return StopAtCusps(Bend(), 1.0, limits, {}, {x}).knots().back().speed; }},
      {"Excerpt",
       [](double x) {
         return Excerpt(SpeedProfile({{0.0, 1.0}, {1.0, 2.0}}), {x, 1.0}).knots().back().s;
       }},
      {"SmoothCurvature", [](double x) { return SmoothCurvature(Bend(), x).length(); }},
      {"Bezier point",
       [](double x) {
         return BezierCurve({{0.0, x}, {1.0, 0.0}}).Length();
       }},
      {"Bezier spacing",
       [](double x) {
         return BezierCurve({{0.0, 0.0}, {1.0, 0.0}}).Points(x, 0.0).back().s;
       }},
      {"Bezier At",
       [](double x) {
         return SumOf(BezierCurve({{0.0, 0.0}, {1.0, 0.0}}).At(x));
       }},
      {"ToFrenet",
       [](double x) {
         const auto state = ToFrenet(Bend(), {.pose = {x, 0.0, 0.0}});
         return state ? state->d : kNone;
       }},
      {"ToFrenet speed",
       [](double x) {
         const auto state = ToFrenet(Bend(), {.pose = {}, .speed = x});
         return state ? state->s_rate : kNone;
       }},
      {"FromFrenet",
       [](double x) {
         const auto motion = FromFrenet(Bend(), {.s = 1.0, .d = x});
         return motion ? SumOf(motion->pose) : kNone;
       }},
      {"FromFrenet s",
       [](double x) {
         const auto motion = FromFrenet(Bend(), {.s = x});
         return motion ? SumOf(motion->pose) : kNone;
       }},
  };
}

std::vector<Entry> OfVehicles() {
  const VehicleParams car = ScaledCar(1.0);
  VehicleParams slipping = car;
  slipping.yaw_inertia = 2000.0;
  slipping.cornering_stiffness_front = slipping.cornering_stiffness_rear = 1e5;
  const auto kinematic = [car](const Command& command, double duration) {
    KinematicCar own(car, ReferencePoint::kRearAxle, {.pose = {}, .speed = 2.0});
    own.Step(command, duration);
    return SumOf(own.state().pose);
  };
  const auto single_track = [slipping](const Command& command, double duration) {
    SingleTrackCar own(slipping, {.pose = {}, .speed = 2.0});
    own.Step(command, duration);
    return SumOf(own.state().pose);
  };
  return {
      {"KinematicCar steering", [=](double x) { return kinematic({.steering = x}, 0.01); }},
      {"KinematicCar acceleration", [=](double x) { return kinematic({.acceleration = x}, 0.01); }},
      {"KinematicCar duration", [=](double x) { return kinematic({}, x > 1e6 ? 1.0 : x); }},
      {"SingleTrackCar steering", [=](double x) { return single_track({.steering = x}, 0.01); }},
      {"SingleTrackCar acceleration",
       [=](double x) { return single_track({.acceleration = x}, 0.01); }},
      {"SingleTrackCar duration", [=](double x) { return single_track({}, x > 1e6 ? 1.0 : x); }},
      {"FaultySteering", [](double x) { return FaultySteering({}, 0.01, 0.0).Pass(x); }},
      {"FaultySteering delay",
       [](double x) { return FaultySteering({.delay = x}, 0.01, 0.0).Pass(0.1); }},
      {"FaultySteering factor",
       [](double x) { return FaultySteering({.factor = x}, 0.01, 0.0).Pass(0.1); }},
      {"FaultySteering backlash",
       [](double x) { return FaultySteering({.backlash = x}, 0.01, 0.0).Pass(0.1); }},
      {"FaultySteering timestep",
       [](double x) { return FaultySteering({.delay = 0.1}, x, 0.0).Pass(0.1); }},
      {"SteeringSchedule turn",
       [](double x) {
         return SteeringSchedule({{x, 10.0, 0.2}}, 0.05).At(5.0);
       }},
      {"SteeringSchedule steering",
       [](double x) {
         return SteeringSchedule({{1.0, 10.0, x}}, 0.05).At(5.0);
       }},
      {"SteeringSchedule slope",
       [](double x) {
         return SteeringSchedule({{1.0, 10.0, 0.2}}, x).At(5.0);
       }},
      {"SteeringSchedule knot",
       [](double x) {
         return SteeringSchedule::Through({{0.0, x}, {1.0, 0.0}}).At(0.5);
       }},
      {"SteeringSchedule knot distance",
       [](double x) {
         return SteeringSchedule::Through({{x, 0.1}}).At(0.5);
       }},
      {"SteeringSchedule::At",
       [](double x) {
         return SteeringSchedule::Through({{0.0, 0.1}, {1.0, 0.0}}).At(x);
       }},
      {"RollOut distance",
       [=](double x) {
         return SumOf(RollOut(car, {.pose = {}, .speed = 1.0}, {}, std::min(x, 1e3), 0.1).pose);
       }},
      {"RollOut step",
       [=](double x) {
         return SumOf(
             RollOut(car, {.pose = {}, .speed = 1.0}, {}, 5.0, x > 0.0 ? std::max(x, 1e-3) : x)
                 .pose);
       }},
      {"SteeringForCurvature", [=](double x) { return SteeringForCurvature(car, x); }},
      {"CurvatureForSteering", [=](double x) { return CurvatureForSteering(car, x); }},
      {"AckermannAngles", [=](double x) { return AckermannAngles(car, x).left; }},
      {"BicycleAngle",
       [=](double x) {
         return BicycleAngle(car, {x, 0.1});
       }},
      {"RampPose", [=](double x) { return SumOf(RampPose(car, x, 2.0)); }},
  };
}

std::vector<Entry> OfWorlds() {
  const VehicleParams car = ScaledCar(1.0);
  const auto clearance = [car](const Pose2& pose, double time) {
    return Clearance(WorldWithAll(), car, pose, time).value();
  };
  return {
      {"Clearance x",
       [=](double x) {
         return clearance({x, 0.0, 0.0}, 0.0);
       }},
      {"Clearance yaw",
       [=](double x) {
         return clearance({0.0, 0.0, x}, 0.0);
       }},
      {"Clearance time", [=](double x) { return clearance({}, x); }},
      {"Clearance length",
       [=](double x) {
         VehicleParams other = car;
         other.length = x;
         return Clearance(WorldWithAll(), other, {}, 0.0).value();
       }},
      {"Clearance obstacle",
       [=](double x) {
         World world = WorldWithAll();
         world.obstacles[0].footprint.center.x = x;
         return Clearance(world, car, {}, 0.0).value();
       }},
      {"Clearance velocity",
       [=](double x) {
         World world = WorldWithAll();
         world.obstacles[0].velocity.x() = x;
         return Clearance(world, car, {}, 1.0).value();
       }},
      {"ApproachBetween",
       [=](double x) {
         return ApproachBetween(WorldWithAll(), car, {{}, 0.0, 20.0}, {{x, 0.0, 0.0}, 1.0, 20.0})
             .clearance;
       }},
      {"GroundHeight",
       [](double x) {
         return GroundHeight(WorldWithAll(), {x, 0.0});
       }},
      {"GroundNormal",
       [](double x) {
         return GroundNormal(WorldWithAll(), {10.0, x}).sum();
       }},
      {"RoadFactor",
       [](double x) {
         return RoadFactor(WorldWithAll(), {x, 0.0});
       }},
      {"WindAt",
       [](double x) {
         return SumOf(WindAt(WorldWithAll(), {0.0, 0.0}, x));
       }},
      {"IsKnown by time",
       [=](double x) {
         const Obstacle box{.footprint = kBox, .known_from_time = 2.0, .known_from_range = {}};
         return IsKnown(box, x, kBox) ? kGood : kNone;
       }},
  };
}

std::vector<Entry> OfPlanning() {
  const VehicleParams car = ScaledCar(1.0);
  const auto rrt = [](Vec2 start, double inflation, double expand) {
    return PlanRrt({.start = start,
                    .goal = {9.0, 0.0},
                    .low = {-10.0, -10.0},
                    .high = {10.0, 10.0},
                    .obstacles = {kBox},
                    .inflation = inflation},
                   {.iterations = 100, .expand_distance = expand}, 1)
                       .status == RrtStatus::kReached
               ? kGood
               : kNone;
  };
  return {
      {"Dubins",
       [](double x) {
         return Dubins({}, {x, 1.0, 0.0}, 5.0).length;
       }},
      {"Dubins radius",
       [](double x) {
         return Dubins({}, {9.0, 1.0, 0.0}, x).length;
       }},
      {"ReedsShepp",
       [](double x) {
         return ReedsShepp({}, {9.0, 1.0, x}, 5.0).length;
       }},
      {"ReedsShepp radius",
       [](double x) {
         return ReedsShepp({}, {9.0, 1.0, 0.0}, x).length;
       }},
      {"CornerAt", [=](double x) { return CornerAt(car, x, 2.0, 0.2).tangent_length; }},
      {"CornerAt speed", [=](double x) { return CornerAt(car, 1.0, x, 0.2).tangent_length; }},
      {"CornerAt curvature", [=](double x) { return CornerAt(car, 1.0, 2.0, x).tangent_length; }},
      {"StepSpeed", [=](double x) { return StepSpeed(car, 0.0, x); }},
      {"Rasterize cell",
       [](double x) {
         return static_cast<double>(Rasterize({}, {{0.0, 0.0}, {9.0, 9.0}}, x, {kBox}, 0.1).size());
       }},
      {"Rasterize inflation",
       [](double x) {
         return static_cast<double>(Rasterize({}, {{0.0, 0.0}, {9.0, 9.0}}, 1.0, {kBox}, x).size());
       }},
      {"Rasterize box",
       [](double x) {
         return static_cast<double>(
             Rasterize({}, {{0.0, 0.0}, {9.0, 9.0}}, 1.0, {{{x, 0.0, 0.0}, 1.0, 1.0}}, 0.1).size());
       }},
      {"CollisionChecker distance",
       [=](double x) { return CollisionChecker(car, {kBox}, x).Clearance({}); }},
      {"PlanRrt start",
       [=](double x) {
         return rrt({x, 0.0}, 0.1, 2.0);
       }},
      {"PlanRrt inflation",
       [=](double x) {
         return rrt({-9.0, 0.0}, x, 2.0);
       }},
      {"PlanRrt step",
       [=](double x) {
         return rrt({-9.0, 0.0}, 0.1, x);
       }},
      {"QuinticBetween",
       [](double x) {
         return QuinticBetween({}, {1.0, 0.0, 0.0}, x).At(0.5);
       }},
      {"PreviewAngle", [](double x) { return PreviewAngle(Bend(), {}, 0.0, x); }},
      {"PreviewAngle station", [](double x) { return PreviewAngle(Bend(), {}, x, 3.0); }},
      {"PredictPose", [=](double x) { return SumOf(PredictPose(car, 0.0, x, 2.0, 5.0)); }},
      {"SpeedControl",
       [](double x) {
         return SpeedControl({}, SpeedProfile({{0.0, 1.0}, {9.0, 0.0}}), x, 1.0, 0.02);
       }},
      {"SpeedControl speed",
       [](double x) {
         return SpeedControl({}, SpeedProfile({{0.0, 1.0}, {9.0, 0.0}}), 1.0, x, 0.02);
       }},
  };
}

std::vector<Entry> OfOptimizers() {
  const auto search = [](double lower, double start, double tolerance) {
    return Search({.lower = {lower},
                   .upper = {2.0},
                   .start = {start},
                   .objective = [](std::span<const double> x) { return x[0] * x[0]; }},
                  {.method = SearchMethod::kNelderMead,
                   .population = 20,
                   .evaluations = 50,
                   .tolerance = tolerance},
                  1)
        .value;
  };
  const auto program = [](double h, double f, double g, double b) {
    QuadraticProgram own;
    own.hessian = QuadraticProgram::Matrix::Identity(1, 1) * h;
    own.linear = QuadraticProgram::Vector::Constant(1, f);
    own.constraints = QuadraticProgram::Rows::Constant(1, 1, g);
    own.bounds = QuadraticProgram::Bounds::Constant(1, b);
    const QuadraticSolution solution = Solve(own);
    return solution.ok ? solution.x[0] : kNone;
  };
  return {
      {"Search bound", [=](double x) { return search(x, 1.0, 1e-9); }},
      {"Search start", [=](double x) { return search(-1.0, x, 1e-9); }},
      {"Search tolerance", [=](double x) { return search(-1.0, 1.0, x); }},
      {"Solve Hessian", [=](double x) { return program(x, 1.0, 1.0, -2.0); }},
      {"Solve linear", [=](double x) { return program(1.0, x, 1.0, -2.0); }},
      {"Solve constraint", [=](double x) { return program(1.0, 1.0, x, -2.0); }},
      {"Solve bound", [=](double x) { return program(1.0, 1.0, 1.0, x); }},
  };
}

class Entries : public testing::TestWithParam<std::vector<Entry> (*)()> {};

INSTANTIATE_TEST_SUITE_P(Public, Entries,
                         testing::Values(&OfGeometry, &OfPaths, &OfVehicles, &OfWorlds, &OfPlanning,
                                         &OfOptimizers));

TEST_P(Entries, TakeNoNaNForANumber) {
  for (const Entry& entry : GetParam()()) {
    double result = kNone;
    bool refused = false;
    EXPECT_NO_THROW(refused = Refuses([&] { result = entry.call(std::nan("")); })) << entry.name;
    EXPECT_TRUE(refused || !std::isfinite(result)) << entry.name << " gives " << result;
  }
}

TEST_P(Entries, SurviveEveryNumber) {
  const double smallest = std::numeric_limits<double>::denorm_min();
  const double largest = std::numeric_limits<double>::max();
  for (const Entry& entry : GetParam()()) {
    for (const double number : {HUGE_VAL, -HUGE_VAL, largest, -largest, smallest, -smallest, 0.0,
                                -0.0, 1e-9, -1e-9, 1e9, -1e9}) {
      SCOPED_TRACE(entry.name);
      EXPECT_NO_THROW(Refuses([&] { (void)entry.call(number); })) << number;
    }
  }
}

/// All numbers of a planning problem.
std::vector<std::pair<std::string, std::function<double&(PlanRequest&)>>> NumbersOf() {
  std::vector<std::pair<std::string, std::function<double&(PlanRequest&)>>> numbers{
      {"start.x", [](PlanRequest& r) -> double& { return r.start.x; }},
      {"start.yaw", [](PlanRequest& r) -> double& { return r.start.yaw; }},
      {"start_speed", [](PlanRequest& r) -> double& { return r.start_speed; }},
      {"start_steering", [](PlanRequest& r) -> double& { return r.start_steering; }},
      {"waypoint", [](PlanRequest& r) -> double& { return r.waypoints[2].x(); }},
      {"heading", [](PlanRequest& r) -> double& { return r.headings[1]; }},
      {"obstacle x", [](PlanRequest& r) -> double& { return r.obstacles[0].center.x; }},
      {"obstacle yaw", [](PlanRequest& r) -> double& { return r.obstacles[0].center.yaw; }},
      {"obstacle length", [](PlanRequest& r) -> double& { return r.obstacles[0].length; }},
      {"wind", [](PlanRequest& r) -> double& { return r.wind.velocity.x(); }},
      {"friction", [](PlanRequest& r) -> double& { return r.friction; }},
      {"patch x", [](PlanRequest& r) -> double& { return r.friction_patches[0].area.center.x; }},
      {"patch", [](PlanRequest& r) -> double& { return r.friction_patches[0].friction; }},
      {"speed", [](PlanRequest& r) -> double& { return r.speed.speed; }},
      {"acceleration", [](PlanRequest& r) -> double& { return r.speed.acceleration; }},
      {"deceleration", [](PlanRequest& r) -> double& { return r.speed.deceleration; }},
  };
  for (double VehicleParams::*number :
       {&VehicleParams::wheelbase, &VehicleParams::length, &VehicleParams::width,
        &VehicleParams::rear_overhang, &VehicleParams::steering_limit,
        &VehicleParams::steering_rate, &VehicleParams::friction_lateral,
        &VehicleParams::max_deceleration, &VehicleParams::top_speed}) {
    numbers.emplace_back("vehicle " + std::to_string(numbers.size() - 16),
                         [number](PlanRequest& r) -> double& { return r.vehicle.*number; });
  }
  return numbers;
}

TEST(MakePlan, RefusesEveryNumberThatIsNone) {
  for (const PlannerEntry& entry : Planners()) {
    for (const auto& [name, number_in] : NumbersOf()) {
      for (const double bad : {std::nan(""), HUGE_VAL, -HUGE_VAL}) {
        PlanRequest request;
        request.vehicle = ScaledCar(1.0);
        request.waypoints = {{0.0, 0.0}, {40.0, 0.0}, {80.0, 30.0}};
        request.headings = {0.0, 0.3, 0.6};
        request.obstacles = {{{200.0, 0.0, 0.0}, 1.0, 1.0}};
        request.friction_patches = {{{{200.0, 0.0, 0.0}, 1.0, 1.0}, 0.5}};
        request.speed = {3.0, 1.0, 1.5};
        number_in(request) = bad;
        EXPECT_TRUE(Refuses([&] { (void)MakePlan(request, entry.defaults); }))
            << entry.name << ", " << name << " " << bad;
      }
    }
  }
}

}  // namespace
}  // namespace properties
