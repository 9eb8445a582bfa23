#include <cmath>
#include <nlohmann/json.hpp>
#include <optional>
#include <utility>

#include "python/src/bindings.h"
#include "python/src/observation.h"
#include "python/src/plugins.h"
#include "trackbed/analysis/evaluate_run.h"
#include "trackbed/analysis/parallel.h"
#include "trackbed/core/error.h"
#include "trackbed/drive/drive.h"

// Loops that Python steps.
// 1. Prepare plans a scenario once; each loop starts from the plan.
// 2. Loop wraps a SteppedLoop with a mutex, because several threads of Python may share a loop.
//    Steps release the GIL, so that other threads of Python run meanwhile.
// 3. VectorLoop steps several loops on its own threads, and writes one row of an array for each.
namespace trackbed::python {
namespace {

/// A planned scenario, from which loops are made.
struct Prepared {
  std::shared_ptr<const Scenario> scenario;
  std::shared_ptr<const CarModel> car;
  FeasiblePlan plan;
};

std::shared_ptr<Prepared> Prepare(const std::shared_ptr<Scenario>& scenario) {
  const WithoutGil release;
  std::shared_ptr<const CarModel> car = Cars().Load(*scenario);
  FeasiblePlan plan = PlanScenario(*scenario, *car);
  if (!plan.ok()) {
    throw RunError("no plan: " + plan->reason);
  }
  return std::make_shared<Prepared>(Prepared{scenario, std::move(car), std::move(plan)});
}

/// Measures and judges the log of a loop, as a run with this plant alone.
std::shared_ptr<RunResult> ResultOf(const Prepared& prepared, const std::string& plant,
                                    RunLog log) {
  auto result = std::make_shared<RunResult>();
  result->scenario = *prepared.scenario;
  result->scenario.drive.plants = {plant};
  result->scene = prepared.car->scene();
  result->vehicle = prepared.car->params();
  result->plan = prepared.plan;
  result->interrupted = log.status == DriveStatus::kInterrupted;
  log.plant = plant;
  AddLog(*result, *prepared.car, std::move(log));
  JudgeRun(*result, *prepared.car);
  return result;
}

/// Returns the log of a loop with a row for the present moment, which the loop itself logs in the
/// next step.
RunLog LogUntilNow(const SteppedLoop& loop) {
  RunLog log = loop.log();
  if (log.rows.empty() || log.rows.back().state.time < loop.row().state.time) {
    log.rows.push_back(loop.row());
  }
  return log;
}

/// A loop that Python steps. A mutex lets only one thread use the loop at a time.
class Loop {
 public:
  Loop(const Prepared& prepared, const std::string& plant, bool keeps_log)
      : loop_(MakeSteppedLoop(prepared.scenario, prepared.car, prepared.plan, plant, keeps_log)) {}

  /// Calls `use` with the loop, while no other thread uses it. A caller inside of a plug-in does
  /// not wait for another user of the loop, because the loop may wait for the plug-in.
  template <typename Use>
  auto With(const Use& use, bool waits = !InsidePlugin()) {
    std::unique_lock lock(mutex_, std::defer_lock);
    if (waits) {
      lock.lock();
    } else if (!lock.try_lock()) {
      throw RunError(
          "a plug-in uses the loop that calls it, or a loop of another thread; make a "
          "loop in the plug-in");
    }
    return use(loop_);
  }

 private:
  std::mutex mutex_;
  SteppedLoop loop_;
};

/// Advances a loop by one control period. Without a steering angle, the scenario's controller
/// steers.
void Advance(SteppedLoop& loop, std::optional<double> steering,
             std::optional<double> acceleration) {
  if (loop.status()) {
    throw RunError(std::string("the run has ended (") + ToString(*loop.status()) +
                   "); call reset() or set state before the next step");
  }
  if (steering) {
    loop.Step(*steering, acceleration);
  } else {
    loop.Step();
  }
}

/// Loops that are stepped together on several threads.
class VectorLoop {
 public:
  VectorLoop(std::vector<std::shared_ptr<Loop>> loops, int threads)
      : loops_(std::move(loops)), threads_(threads) {}

  [[nodiscard]] std::size_t size() const { return loops_.size(); }

  /// Calls `work` with each loop and its index.
  template <typename Work>
  void ForEach(const Work& work) const {
    const bool waits = !InsidePlugin();
    ForEachIndex(loops_.size(), threads_, [&](std::size_t i) {
      loops_[i]->With([&](SteppedLoop& loop) { work(i, loop); }, waits);
      return true;
    });
  }

 private:
  std::vector<std::shared_ptr<Loop>> loops_;
  int threads_;
};

/// An array for the observations of loops, with one row for each loop.
class ObservationRows {
 public:
  explicit ObservationRows(std::size_t count)
      : rows_({count, kFields.size()}), cells_(rows_.mutable_data()) {}

  /// Writes the observation of a loop to its row; needs no GIL.
  void Write(std::size_t row, const SteppedLoop& loop) {
    const Observation seen = Observe(loop);
    double* const cells = cells_ + row * kFields.size();
    // With constant indices, the compiler reads the members instead of calling the functions.
    [&]<std::size_t... i>(std::index_sequence<i...>) {
      ((cells[i] = kFields[i].value(seen)), ...);
    }
    (std::make_index_sequence<kFields.size()>());
  }

  [[nodiscard]] const py::array_t<double>& rows() const { return rows_; }

 private:
  py::array_t<double> rows_;
  double* cells_;
};

py::array_t<double> ObserveAll(const VectorLoop& loops) {
  ObservationRows seen(loops.size());
  {
    const WithoutGil release;
    loops.ForEach([&](std::size_t i, const SteppedLoop& loop) { seen.Write(i, loop); });
  }
  return seen.rows();
}

/// Advances all loops that have not ended, each with its steering angle and acceleration, and
/// returns the observations after that. An acceleration of NaN leaves the speed to the plan.
py::array_t<double> AdvanceAll(const VectorLoop& loops, const std::optional<Numbers>& steering,
                               const std::optional<Numbers>& acceleration) {
  const double* const angles = steering ? steering->data() : nullptr;
  const double* const rates = acceleration ? acceleration->data() : nullptr;
  ObservationRows seen(loops.size());
  {
    const WithoutGil release;
    loops.ForEach([&](std::size_t i, SteppedLoop& loop) {
      if (!loop.status()) {
        const bool has_rate = rates != nullptr && !std::isnan(rates[i]);
        Advance(loop, angles != nullptr ? std::optional(angles[i]) : std::nullopt,
                has_rate ? std::optional(rates[i]) : std::nullopt);
      }
      seen.Write(i, loop);
    });
  }
  return seen.rows();
}

/// Returns the curvature of each loop's present plan at `distances` [m] ahead of the car, with one
/// row for each loop.
py::array_t<double> CurvatureAhead(const VectorLoop& loops, const Numbers& distances) {
  const auto count = static_cast<std::size_t>(distances.size());
  py::array_t<double> rows({loops.size(), count});
  double* const cells = rows.mutable_data();
  const double* const ahead = distances.data();
  {
    const WithoutGil release;
    loops.ForEach([&](std::size_t i, const SteppedLoop& loop) {
      const ControlInput input = loop.input();
      for (std::size_t k = 0; k < count; ++k) {
        cells[i * count + k] = input.reference.path.At(input.station + ahead[k]).curvature;
      }
    });
  }
  return rows;
}

void BindPrepared(py::module_& module) {
  py::class_<Prepared, std::shared_ptr<Prepared>>(module, "Prepared")
      .def_property_readonly("name", [](const Prepared& p) { return p.scenario->name; })
      .def_property_readonly("period",
                             [](const Prepared& p) { return p.scenario->drive.control_period; })
      .def_property_readonly("steering_limit",
                             [](const Prepared& p) { return p.car->params().steering_limit; })
      .def_property_readonly("path_length",
                             [](const Prepared& p) { return p.plan->reference.path.length(); });
  module.def("prepare", &Prepare);
}

void BindLoop(py::module_& module) {
  py::class_<SteppedLoop, std::shared_ptr<SteppedLoop>>(module, "LoopState");
  py::class_<Loop, std::shared_ptr<Loop>>(module, "Loop")
      .def(py::init([](const Prepared& prepared, const std::string& plant, bool keeps_log) {
        const WithoutGil release;
        return std::make_shared<Loop>(prepared, plant, keeps_log);
      }))
      .def("restart",
           [](Loop& self, const Prepared& prepared, const std::string& plant, bool keeps_log) {
             const WithoutGil release;
             SteppedLoop started =
                 MakeSteppedLoop(prepared.scenario, prepared.car, prepared.plan, plant, keeps_log);
             self.With([&](SteppedLoop& loop) { loop = std::move(started); });
           })
      .def("step",
           [](Loop& self, std::optional<double> steering, std::optional<double> acceleration) {
             const WithoutGil release;
             return self.With([&](SteppedLoop& loop) {
               Advance(loop, steering, acceleration);
               return Observe(loop);
             });
           })
      .def("observe",
           [](Loop& self) {
             const WithoutGil release;
             return self.With([](const SteppedLoop& loop) { return Observe(loop); });
           })
      .def("save",
           [](Loop& self) {
             const WithoutGil release;
             return self.With([](const SteppedLoop& loop) {
               return std::make_shared<SteppedLoop>(loop.Copy());
             });
           })
      .def("restore",
           [](Loop& self, const SteppedLoop& state) {
             const WithoutGil release;
             SteppedLoop copy = state.Copy();
             self.With([&](SteppedLoop& loop) { loop = std::move(copy); });
           })
      .def("reference",
           [](Loop& self, const Numbers& stations) {
             return ReferenceAt(
                 [&](const auto& use) {
                   self.With([&](const SteppedLoop& loop) { use(loop.plan().reference); });
                 },
                 stations);
           })
      .def("result",
           [](Loop& self, const Prepared& prepared, const std::string& plant) {
             const WithoutGil release;
             return ResultOf(prepared, plant,
                             self.With([](const SteppedLoop& loop) { return LogUntilNow(loop); }));
           })
      .def("log", [](Loop& self) {
        const WithoutGil release;
        return std::make_shared<Columns>(
            self.With([](const SteppedLoop& loop) { return ToTable(loop.log()); }));
      });
}

void BindVectorLoop(py::module_& module) {
  py::class_<VectorLoop>(module, "VectorLoop")
      .def(py::init<std::vector<std::shared_ptr<Loop>>, int>())
      .def("observe", &ObserveAll)
      .def("step", &AdvanceAll)
      .def("curvature_ahead", &CurvatureAhead)
      .def_property_readonly("statuses",
                             [](const VectorLoop& self) {
                               std::vector<std::optional<std::string>> all(self.size());
                               const WithoutGil release;
                               self.ForEach([&](std::size_t i, const SteppedLoop& loop) {
                                 if (loop.status()) {
                                   all[i] = ToString(*loop.status());
                                 }
                               });
                               return all;
                             })
      .def_property_readonly("ended", [](const VectorLoop& self) {
        py::array_t<bool> ended(std::vector{static_cast<py::ssize_t>(self.size())});
        bool* const cells = ended.mutable_data();
        const WithoutGil release;
        self.ForEach(
            [&](std::size_t i, const SteppedLoop& loop) { cells[i] = loop.status().has_value(); });
        return ended;
      });
}

}  // namespace

void BindLoops(py::module_& module) {
  BindObservation(module);
  BindPrepared(module);
  BindLoop(module);
  BindVectorLoop(module);
}

}  // namespace trackbed::python
