#include <benchmark/benchmark.h>

#include <string>

#include "bench/in_turn.h"
#include "tests/planning/frenet_scenes.h"
#include "trackbed/planning/frenet/lattice.h"

// Times one planning cycle in the Frenet frame. Goal: at most 1 ms for 525 candidates, and 10 ms
// for the lattice.
namespace trackbed::bench {
namespace {

struct Scene {
  std::string name;
  FrenetRequest request;
};

std::vector<Scene> Scenes() {
  FrenetRequest request = OnPath(5.0);
  request.start.d = 0.2;
  request.road = {4.0, 4.0};
  std::vector<Scene> scenes{{"free", request}};
  request.obstacles = {BoxAt(BentRoad(), 25.0, 0.3), BoxAt(BentRoad(), 40.0, -3.0),
                       BoxAt(BentRoad(), 50.0, 2.0)};
  request.obstacles.back().velocity = {-0.5, 0.2};
  scenes.push_back({"boxes", request});
  request.obstacles = {BoxAt(BentRoad(), 12.0, 0.0, 1.0, 20.0)};
  scenes.push_back({"blocked", request});
  return scenes;
}

void Report(benchmark::State& state, const FrenetPlan& plan) {
  state.counters["candidates"] = plan.candidates;
  state.counters["checked"] = plan.checked;
  state.counters["found"] = plan.ok() ? 1 : 0;
}

bool RegisterFrenet() {
  for (const Scene& scene : Scenes()) {
    RegisterGuarded("FrenetCycle/" + scene.name, [scene](benchmark::State& state) {
      const Path path = BentRoad();
      FrenetPlan plan;
      for (auto _ : state) {
        plan = PlanFrenet(path, scene.request, {});
      }
      Report(state, plan);
    })->Unit(benchmark::kMicrosecond);
    RegisterGuarded("LatticeCycle/" + scene.name, [scene](benchmark::State& state) {
      const Path path = BentRoad();
      FrenetPlan plan;
      for (auto _ : state) {
        plan = PlanLattice(path, scene.request, {});
      }
      Report(state, plan);
    })->Unit(benchmark::kMicrosecond);
  }
  return true;
}

[[maybe_unused]] const bool frenet_registered = RegisterFrenet();

}  // namespace
}  // namespace trackbed::bench
