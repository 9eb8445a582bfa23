#include <benchmark/benchmark.h>

#include <algorithm>
#include <cmath>
#include <nlopt.hpp>
#include <string>
#include <vector>

#include "bench/in_turn.h"
#include "trackbed/control/controllers.h"
#include "trackbed/control/optimal_steering.h"
#include "trackbed/control/steering_controller.h"
#include "trackbed/drive/drive.h"
#include "trackbed/planning/common/plan.h"

// Times one update of each steering controller, and compares optimal_steering with bare NLopt.
namespace trackbed::bench {
namespace {

/// A car that weaves along the route of three turns, at most 5 cm beside its plan.
class Route {
 public:
  Route() : scenario_(Read()), car_(LoadCar(scenario_)), plan_(PlanScenario(scenario_, car())) {
    const Path& path = plan_.reference.path;
    for (double s = 0.5; s < path.length() - 0.5; s += 0.06) {
      VehicleState state;
      state.time = s / 3.0;
      state.distance = s;
      state.speed = 3.0;
      state.pose = Compose(path.At(s).pose, {0.0, 0.05 * std::sin(s / 3.0), 0.01 * std::sin(s)});
      state.steering_actuator = plan_.schedule.At(s);
      state.steering = state.steering_actuator;
      inputs_.push_back({.vehicle = car(),
                         .reference = plan_.reference,
                         .schedule = plan_.schedule,
                         .state = state,
                         .station = s,
                         .period = 0.02,
                         .plan_time = state.time});
    }
  }

  [[nodiscard]] const VehicleParams& car() const { return car_.params(); }
  [[nodiscard]] const std::vector<ControlInput>& inputs() const { return inputs_; }

 private:
  static Scenario Read() { return ReadScenario(DataFolder() / "scenarios" / "three_turns.yaml"); }

  Scenario scenario_;
  CarModel car_;
  Plan plan_;
  std::vector<ControlInput> inputs_;
};

/// Times single updates along the route.
void TimeUpdate(benchmark::State& state, const ControllerOptions& options) {
  const Route route;
  const auto controller = MakeSteeringController(options);
  std::size_t next = 0;
  double slowest = 0.0;
  for ([[maybe_unused]] auto round : state) {
    const Stopwatch stopwatch;
    benchmark::DoNotOptimize(controller->Steer(route.inputs()[next]));
    slowest = std::max(slowest, stopwatch.Seconds());
    next = (next + 1) % route.inputs().size();
  }
  state.counters["slowest_us"] = 1e6 * slowest;
}

constexpr double kHorizon = 2.0;  // [m]

/// Makes optimal_steering search at every update, for any deviation.
OptimalSteeringOptions Searching(SearchMethod method) {
  OptimalSteeringOptions options;
  options.horizon = kHorizon;
  options.search.method = method;
  options.deviation_limit = 0.0;
  return options;
}

/// One call of NLopt with the roll-outs of one update and nothing else.
double BareSteering(nlopt::algorithm algorithm, const VehicleParams& car,
                    const SteeringProblem& problem, const OptimalSteeringOptions& options) {
  struct Data {
    const VehicleParams& car;
    const SteeringProblem& problem;
  } data{car, problem};
  nlopt::opt search(algorithm, 1U);
  const double lower = TurnShare(car, problem, -problem.max_steering);
  const double upper = TurnShare(car, problem, problem.max_steering);
  search.set_lower_bounds(lower);
  search.set_upper_bounds(upper);
  search.set_min_objective(
      [](unsigned, const double* x, double*, void* pointer) {
        const Data& own = *static_cast<const Data*>(pointer);
        const double steering = SteeringOfShare(own.car, own.problem, x[0]);
        return DeviationCost(DeviationAhead(own.car, own.problem, steering), {});
      },
      &data);
  search.set_maxeval(ControlEvaluations(options.search.method));
  search.set_population(static_cast<unsigned>(options.search.population));
  search.set_xtol_abs(options.search.tolerance * (upper - lower));
  if (SearchFor(options.search.method).random) {
    nlopt::srand(1);
  }
  const double margin = 0.05 * (upper - lower);
  std::vector<double> x{
      std::clamp(TurnShare(car, problem, problem.start), lower + margin, upper - margin)};
  double value = 0.0;
  try {
    search.optimize(x, value);
  } catch (const nlopt::roundoff_limited&) {
    // Ignore the exception: NLopt keeps the best point so far.
  }
  return SteeringOfShare(car, problem, x[0]);
}

struct Compared {
  SearchMethod method;
  nlopt::algorithm algorithm;
};

void CompareSteering(benchmark::State& state, const Compared& compared) {
  constexpr double kLimit = 1.25;
  const Route route;
  const OptimalSteeringOptions options = Searching(compared.method);
  std::vector<SteeringProblem> problems;
  for (const ControlInput& input : route.inputs()) {
    const Pose2 wanted = input.reference.path.At(input.station + kHorizon).pose;
    const Vec2 aim = ToLocal(input.state.pose, wanted.position());
    problems.push_back({.wanted = {aim.x(), aim.y(), wanted.yaw - input.state.pose.yaw},
                        .distance = kHorizon,
                        .speed = input.state.speed,
                        .steering = input.state.steering_actuator,
                        .max_steering = input.vehicle.steering_limit,
                        .start = input.state.steering_actuator});
  }
  const double updates = static_cast<double>(problems.size());
  const double ours = CompareInTurn(
      state, kLimit,
      [&] {
        const auto controller = MakeSteeringController(options);
        const Stopwatch stopwatch;
        for (const ControlInput& input : route.inputs()) {
          benchmark::DoNotOptimize(controller->Steer(input));
        }
        return stopwatch.Seconds();
      },
      [&] {
        // Each search starts at the result of the previous one, as in the controller.
        double last = problems.front().start;
        const Stopwatch stopwatch;
        for (SteeringProblem& problem : problems) {
          problem.start = last;
          last = BareSteering(compared.algorithm, route.car(), problem, options);
        }
        return stopwatch.Seconds();
      });
  state.counters["update_us"] = 1e6 * ours / updates;
}

bool RegisterControl() {
  for (const ControllerEntry& controller : Controllers()) {
    RegisterGuarded(std::string("ControlUpdate/") + controller.name, TimeUpdate,
                    controller.defaults)
        ->Unit(benchmark::kMicrosecond);
  }
  for (const SearchEntry& search : Searches()) {
    const std::string name = std::string("ControlUpdate/optimal_steering/") + search.name;
    RegisterGuarded(name, TimeUpdate, Searching(search.method))->Unit(benchmark::kMicrosecond);
  }
  for (const Compared& compared : {Compared{SearchMethod::kIsres, nlopt::GN_ISRES},
                                   Compared{SearchMethod::kEsch, nlopt::GN_ESCH},
                                   Compared{SearchMethod::kCrs2, nlopt::GN_CRS2_LM},
                                   Compared{SearchMethod::kCobyla, nlopt::LN_COBYLA},
                                   Compared{SearchMethod::kNelderMead, nlopt::LN_NELDERMEAD}}) {
    const std::string name =
        std::string("OptimalSteeringOverNlopt/") + SearchFor(compared.method).name;
    RegisterGuarded(name, CompareSteering, compared)
        ->UseManualTime()
        ->Iterations(15)
        ->Unit(benchmark::kMillisecond);
  }
  return true;
}

[[maybe_unused]] const bool control_registered = RegisterControl();

}  // namespace
}  // namespace trackbed::bench
