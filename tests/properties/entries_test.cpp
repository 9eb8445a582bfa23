// If an argument of a public function is NaN, the function must throw an error, return NaN, or
// report failure. For other invalid numbers, such as infinity, the function may return a result,
// but must not crash.

#include "tests/properties/entries.h"

#include <cmath>
#include <functional>
#include <limits>
#include <ostream>
#include <string>
#include <utility>
#include <vector>

#include "tests/properties/problems.h"
#include "tests/properties/property.h"
#include "tests/support/case_names.h"
#include "trackbed/planning/registry/planners.h"

namespace properties {
namespace {

using namespace trackbed;

/// Calls of the public functions of a part of the library.
struct Part {
  const char* name;
  std::vector<Entry> (*entries)();
};

void PrintTo(const Part& part, std::ostream* out) {
  *out << part.name;
}

class Entries : public testing::TestWithParam<Part> {};

INSTANTIATE_TEST_SUITE_P(Public, Entries,
                         testing::Values(Part{"geometry", &OfGeometry}, Part{"paths", &OfPaths},
                                         Part{"speeds", &OfSpeeds}, Part{"curves", &OfCurves},
                                         Part{"vehicles", &OfVehicles}, Part{"worlds", &OfWorlds},
                                         Part{"planning", &OfPlanning},
                                         Part{"optimizers", &OfOptimizers}),
                         kNamedByParameter);

TEST_P(Entries, TakeNoNaNForANumber) {
  for (const Entry& entry : GetParam().entries()) {
    double result = kNone;
    bool refused = false;
    EXPECT_NO_THROW(refused = Refuses([&] { result = entry.call(std::nan("")); })) << entry.name;
    EXPECT_TRUE(refused || !std::isfinite(result)) << entry.name << " gives " << result;
  }
}

TEST_P(Entries, SurviveEveryNumber) {
  const double smallest = std::numeric_limits<double>::denorm_min();
  const double largest = std::numeric_limits<double>::max();
  for (const Entry& entry : GetParam().entries()) {
    for (const double number : {HUGE_VAL, -HUGE_VAL, largest, -largest, smallest, -smallest, 0.0,
                                -0.0, 1e-9, -1e-9, 1e9, -1e9}) {
      SCOPED_TRACE(entry.name);
      EXPECT_NO_THROW(Refuses([&] { (void)entry.call(number); })) << number;
    }
  }
}

/// Returns references to all numbers in a planning request, with their names.
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
