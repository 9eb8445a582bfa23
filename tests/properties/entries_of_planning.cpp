// Calls of the public functions of planning, control and the optimizers.

#include <span>

#include "tests/properties/entries.h"
#include "tests/properties/problems.h"
#include "trackbed/control/optimal_steering.h"
#include "trackbed/control/preview.h"
#include "trackbed/control/speed_controller.h"
#include "trackbed/optimize/quadratic_program.h"
#include "trackbed/optimize/search.h"
#include "trackbed/planning/common/collision_checker.h"
#include "trackbed/planning/common/corners.h"
#include "trackbed/planning/common/curvature_steps.h"
#include "trackbed/planning/common/occupancy_grid.h"
#include "trackbed/planning/curves/dubins.h"
#include "trackbed/planning/curves/reeds_shepp.h"
#include "trackbed/planning/frenet/polynomial.h"
#include "trackbed/planning/sampling/rrt.h"

namespace properties {

using namespace trackbed;

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
               ? kWell
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

}  // namespace properties
