#include <benchmark/benchmark.h>

#include <string>
#include <utility>
#include <vector>

#include "bench/in_turn.h"
#include "tests/planning/poses.h"
#include "trackbed/planning/curves/continuous_curvature.h"
#ifdef TRACKBED_STEERING_FUNCTIONS
#include <steering_functions/hc_cc_state_space/cc00_reeds_shepp_state_space.hpp>
#include <steering_functions/hc_cc_state_space/cc_dubins_state_space.hpp>
#include <steering_functions/hc_cc_state_space/hc_reeds_shepp_state_space.hpp>
#endif

// Curves of continuous curvature, compared with hbanzhaf's steering_functions if CMake finds it
// (-Dsteering_functions_DIR=...), else timed alone.
namespace trackbed::bench {
namespace {

constexpr int kPairs = 5000;
/// The Prius at 3 m/s.
constexpr CurveLimits kCar{.radius = 5.61, .sharpness = 0.150568 / (2.7 * 3.0)};

using Pairs = std::vector<std::pair<CurveState, CurveState>>;

/// Poses in a box of 40 m, with straight wheels or with any steering.
Pairs RandomPairs(bool steered) {
  Random random(1);
  const auto state = [&] {
    const double most = steered ? 1.0 / kCar.radius : 0.0;
    const Pose2 pose = RandomPose(random, 20.0);
    return CurveState{pose, random.Uniform(-most, most)};
  };
  Pairs pairs;
  for (int i = 0; i < kPairs; ++i) {
    const CurveState from = state();
    pairs.emplace_back(from, state());
  }
  return pairs;
}

using Shortest = ShortestCurve (ContinuousCurves::*)(const CurveState&, const CurveState&) const;

/// Returns the time of one curve [s].
double OurSeconds(const Pairs& pairs, Shortest shortest) {
  const ContinuousCurves curves(kCar);
  const Stopwatch stopwatch;
  for (const auto& [from, to] : pairs) {
    benchmark::DoNotOptimize((curves.*shortest)(from, to));
  }
  return stopwatch.Seconds() / kPairs;
}

#ifdef TRACKBED_STEERING_FUNCTIONS
steering::State ToState(const CurveState& state) {
  steering::State own{};
  own.x = state.pose.x;
  own.y = state.pose.y;
  own.theta = state.pose.yaw;
  own.kappa = state.curvature;
  return own;
}

template <typename Space>
void Compare(benchmark::State& state, Shortest shortest, bool steered, const Space& space) {
  const Pairs pairs = RandomPairs(steered);
  std::vector<std::pair<steering::State, steering::State>> states;
  for (const auto& [from, to] : pairs) {
    states.emplace_back(ToState(from), ToState(to));
  }
  CompareInTurn(
      state, 1.0, [&] { return OurSeconds(pairs, shortest); },
      [&] {
        const Stopwatch stopwatch;
        for (const auto& [from, to] : states) {
          benchmark::DoNotOptimize(space.get_controls(from, to));
        }
        return stopwatch.Seconds() / kPairs;
      });
}

/// Spacing of sampled paths, which the benchmark does not use [m].
constexpr double kUnused = 0.1;

void Register() {
  const double curvature = 1.0 / kCar.radius;
  for (const bool steered : {false, true}) {
    const std::string states = steered ? "/steered" : "/straight";
    RegisterGuarded(
        "CcDubinsOverPeer" + states,
        [=](benchmark::State& state) {
          Compare(state, &ContinuousCurves::Dubins, steered,
                  steering::CC_Dubins_State_Space(curvature, kCar.sharpness, kUnused, true));
        })
        ->UseManualTime()
        ->Iterations(21)
        ->Unit(benchmark::kNanosecond);
    RegisterGuarded("HcReedsSheppOverPeer" + states,
                    [=](benchmark::State& state) {
                      Compare(
                          state, &ContinuousCurves::HybridReedsShepp, steered,
                          steering::HC_Reeds_Shepp_State_Space(curvature, kCar.sharpness, kUnused));
                    })
        ->UseManualTime()
        ->Iterations(21)
        ->Unit(benchmark::kNanosecond);
  }
  RegisterGuarded("CcReedsSheppOverPeer/straight",
                  [=](benchmark::State& state) {
                    Compare(
                        state, &ContinuousCurves::ReedsShepp, false,
                        steering::CC00_Reeds_Shepp_State_Space(curvature, kCar.sharpness, kUnused));
                  })
      ->UseManualTime()
      ->Iterations(21)
      ->Unit(benchmark::kNanosecond);
}
#else
void Register() {
  for (const auto& [name, shortest] :
       {std::pair("CcDubins", &ContinuousCurves::Dubins),
        std::pair("CcReedsShepp", &ContinuousCurves::ReedsShepp),
        std::pair("HcReedsShepp", &ContinuousCurves::HybridReedsShepp)}) {
    for (const bool steered : {false, true}) {
      RegisterGuarded(std::string(name) + (steered ? "/steered" : "/straight"),
                      [steered, curves = shortest](benchmark::State& state) {
                        const Pairs pairs = RandomPairs(steered);
                        for (auto _ : state) {
                          state.SetIterationTime(OurSeconds(pairs, curves));
                        }
                      })
          ->UseManualTime()
          ->Iterations(21)
          ->Unit(benchmark::kNanosecond);
    }
  }
}
#endif

[[maybe_unused]] const bool continuous_curves_registered = (Register(), true);

}  // namespace
}  // namespace trackbed::bench
