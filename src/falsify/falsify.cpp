#include "trackbed/falsify/falsify.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "src/falsify/point_search.h"
#include "src/falsify/search_loop.h"
#include "src/falsify/search_runs.h"
#include "trackbed/analysis/robustness.h"
#include "trackbed/core/error.h"
#include "trackbed/core/stopwatch.h"
#include "trackbed/core/text_table.h"
#include "trackbed/scenario/study_points.h"

// Searches the parameter space of a study for a point at which the run violates an expectation.
// Falsification first runs the nominal point. After the nominal point, a search algorithm
// (point_search.cpp) proposes batches of points to find the smallest robustness. The search ends
// when a run fails (unless `stop` is false), when the budget of runs is exhausted, or when the time
// budget is exhausted. The failing point nearest to the nominal point becomes the counterexample,
// which is then moved closer to the nominal point (shrink.cpp). All runs are recorded
// (search_runs.cpp), so that an interrupted search continues without repeating runs.
namespace trackbed {
namespace {

using nlohmann::ordered_json;

class Falsifier {
 public:
  Falsifier(const CheckedSearch& search, SweepRecords& records, const FalsifyOptions& options)
      : search_(search),
        spec_(*search.study.search),
        options_(options),
        runs_(search, records, options) {}

  FalsifyResult Run() {
    const std::optional<SearchRun> nominal = RunNominal();
    const bool finished = nominal && (nominal_fails_ || RunSearch(nominal->robustness));
    result_.runs = runs_.count();
    if (finished && result_.counterexample && !nominal_fails_ && spec_.shrink_runs > 0) {
      ShrinkCounterexample();
    }
    result_.shrink_runs = runs_.count() - result_.runs;
    if (interrupted_) {
      result_.status = FalsifyStatus::kInterrupted;
    } else if (result_.counterexample) {
      result_.status = FalsifyStatus::kBroken;
    }
    return result_;
  }

 private:
  /// Runs the scenario at the study's nominal point; returns nullopt if the run was interrupted.
  std::optional<SearchRun> RunNominal() {
    const UnitPoint& nominal = search_.space.nominal();
    const auto runs = runs_.Run({nominal}, "nominal");
    if (!runs) {
      interrupted_ = true;
      return std::nullopt;
    }
    const SearchRun& run = runs->front();
    if (run.status == "refused") {
      throw InputError(Problem{.file = search_.study.file,
                               .key = "nominal",
                               .message = "there is no such scenario: " + run.reason});
    }
    Take(nominal, run);
    nominal_fails_ = run.violated();
    return run;
  }

  /// Runs the search for a failing point; returns false if the search was interrupted.
  bool RunSearch(std::optional<double> at_nominal) {
    const std::unique_ptr<PointSearch> search = MakePointSearch(spec_, search_.space, at_nominal);
    const Stopwatch clock;
    FollowSearch(*search, search_.space, [&](const std::vector<UnitPoint>& points) {
      auto values = RunBatchOf(points);
      if (!values || (result_.counterexample && spec_.stop)) {
        values.reset();
      } else if (options_.time_limit && clock.Seconds() > *options_.time_limit) {
        result_.out_of_time = true;
        values.reset();
      }
      return values;
    });
    return !interrupted_;
  }

  std::optional<std::vector<std::optional<double>>> RunBatchOf(
      const std::vector<UnitPoint>& points) {
    std::size_t next = runs_.count();  // row number of the next new run
    const auto runs = runs_.Run(points, "search");
    if (!runs) {
      interrupted_ = true;
      return std::nullopt;
    }
    std::vector<std::optional<double>> values;
    for (std::size_t i = 0; i < points.size(); ++i) {
      values.push_back((*runs)[i].robustness);
      if ((*runs)[i].row == next) {
        Take(points[i], (*runs)[i]);
        ++next;
      }
    }
    return values;
  }

  void Take(const UnitPoint& point, const SearchRun& run) {
    if (run.status == "driven") {
      throw InputError(Problem{.file = search_.study.scenario.string(),
                               .key = "expect",
                               .message = "a search needs a scenario that expects something"});
    }
    result_.refused += run.status == "refused" ? 1U : 0U;
    result_.errors += run.status == "error" ? 1U : 0U;
    result_.violations += run.violated() ? 1U : 0U;
    if (!run.robustness) {
      return;
    }
    const SearchedPoint here = At(point, run);
    if (!result_.least || here.robustness < result_.least->robustness) {
      result_.least = here;
    }
    if (!run.violated()) {
      return;
    }
    if (!result_.first) {
      result_.first = here;
    }
    const UnitPoint& nominal = search_.space.nominal();
    if (!result_.counterexample ||
        Distance(point, nominal) < Distance(result_.counterexample->point, nominal)) {
      result_.counterexample = here;
    }
  }

  [[nodiscard]] SearchedPoint At(const UnitPoint& point, const SearchRun& run) const {
    return {.row = run.row,
            .point = point,
            .settings = PointWith(search_.study, search_.space.Settings(point)).settings,
            .robustness = run.robustness.value_or(0.0),
            .limit = run.limit,
            .reason = run.reason};
  }

  void ShrinkCounterexample() {
    const std::size_t most = runs_.count() + static_cast<std::size_t>(spec_.shrink_runs);
    const auto evaluate = [&](const UnitPoint& point) -> std::optional<Evaluation> {
      if (runs_.count() >= most && !runs_.Has(point)) {
        return std::nullopt;
      }
      const auto runs = runs_.Run({point}, "shrink");
      if (!runs) {
        interrupted_ = true;
        return std::nullopt;
      }
      const SearchRun& run = runs->front();
      return Evaluation{.robustness = run.robustness, .violated = run.violated()};
    };
    result_.shrunk =
        Shrink(search_.space, result_.counterexample->point, spec_.tolerance, evaluate);
    const auto runs = runs_.Run({result_.shrunk.point}, "shrink");
    TRACKBED_CHECK(runs && runs->front().violated(), "the counterexample passes");
    result_.counterexample = At(result_.shrunk.point, runs->front());
  }

  const CheckedSearch& search_;
  const SearchSpec& spec_;
  const FalsifyOptions& options_;
  SearchRuns runs_;
  FalsifyResult result_;
  bool nominal_fails_ = false;
  bool interrupted_ = false;
};

ordered_json PointJson(const SearchedPoint& point, const SearchSpace& space) {
  ordered_json json{{"row", point.row}, {"robustness", point.robustness}, {"limit", point.limit}};
  for (const Setting& setting : point.settings) {
    const std::optional<double> number = CellNumber(setting.value);
    json["settings"][setting.key] = number ? ordered_json(*number) : ordered_json(setting.value);
  }
  json["distance"] = Distance(point.point, space.nominal());
  if (!point.reason.empty()) {
    json["reason"] = point.reason;
  }
  return json;
}

ordered_json MarginsJson(const ShrinkResult& shrunk, const SearchSpace& space) {
  ordered_json json = ordered_json::object();
  for (std::size_t i = 0; i < shrunk.keys.size(); ++i) {
    const KeyMargin& margin = shrunk.keys[i];
    ordered_json& key = json[space.keys()[i].key];
    key["nominal"] = space.keys()[i].nominal;
    key["counterexample"] = space.Value(i, shrunk.point[i]);
    if (margin.holds_to) {
      key["holds_up_to"] = space.Value(i, *margin.holds_to);
    }
    if (margin.sensitivity) {
      key["sensitivity"] = *margin.sensitivity;
    }
    const auto reach = [&](const char* name, const std::optional<SingleKeyReach>& alone) {
      if (alone) {
        key["alone"][name] = {{"holds_up_to", space.Value(i, alone->passes)},
                              {"whole_range", alone->whole_range}};
      }
    };
    reach("down", margin.down);
    reach("up", margin.up);
  }
  return json;
}

}  // namespace

const char* ToString(FalsifyStatus status) {
  switch (status) {
    case FalsifyStatus::kBroken:
      return "broken";
    case FalsifyStatus::kNotFalsified:
      return "not_falsified";
    case FalsifyStatus::kInterrupted:
      return "interrupted";
  }
  throw InternalError("no such status of a search");
}

CheckedSearch CheckSearch(Study study) {
  if (!study.search) {
    throw InputError(Problem{.file = study.file,
                             .key = "search",
                             .message = "missing; the study says nothing of a search"});
  }
  Study sampled = study;
  sampled.list.clear();
  sampled.repeat = 1;
  sampled.bisect.reset();
  sampled.sample = SampleSpec{.count = 64, .method = SampleMethod::kSobol, .seed = 1};
  CheckedStudy runs = CheckStudy(std::move(sampled), /*all=*/false);
  std::optional<Scenario> base;
  try {
    base = ReadPoint(study, {});
  } catch (const InputError&) {
    // Ignore an error in the scenario, which may be invalid without values of the searched keys.
    // For an invalid scenario, the study must specify the nominal values in `nominal`.
  }
  SearchSpace space(study, base ? &*base : nullptr);
  return {.study = std::move(study), .runs = std::move(runs), .space = std::move(space)};
}

ordered_json FalsifyHeader(const CheckedSearch& search) {
  const Study& study = search.study;
  const SearchSpec& spec = *study.search;
  ordered_json header = SweepHeader(search.runs.points, search.runs.inputs);
  header.erase("sample");
  header["search"] = {{"method", spec.method},      {"runs", spec.runs},
                      {"restarts", spec.restarts},  {"population", spec.population},
                      {"finish", spec.finish},      {"seed", spec.seed},
                      {"stop", spec.stop},          {"shrink_runs", spec.shrink_runs},
                      {"tolerance", spec.tolerance}};
  for (const SearchKey& key : search.space.keys()) {
    header["nominal"][key.key] = key.nominal;
  }
  // The expected number of rows includes 1 for the run of the nominal point.
  header["rows_expected"] = spec.runs + spec.shrink_runs + 1;
  header["columns"] = SearchColumns(study);
  return header;
}

FalsifyResult Falsify(const CheckedSearch& search, SweepRecords& records,
                      const FalsifyOptions& options) {
  TRACKBED_REQUIRE(options.jobs > 0, "Falsify: {} jobs", options.jobs);
  return Falsifier(search, records, options).Run();
}

FalsifyResult Falsify(const CheckedSearch& search, const FalsifyOptions& options) {
  SweepRecords records = SweepRecords::InMemory(FalsifyHeader(search));
  return Falsify(search, records, options);
}

ordered_json ToJson(const FalsifyResult& result, const CheckedSearch& search) {
  ordered_json json{{"study", search.study.name},
                    {"status", ToString(result.status)},
                    {"runs", result.runs},
                    {"shrink_runs", result.shrink_runs},
                    {"violations", result.violations},
                    {"refused", result.refused},
                    {"errors", result.errors},
                    {"out_of_time", result.out_of_time}};
  const auto add = [&](const char* name, const std::optional<SearchedPoint>& point) {
    if (point) {
      json[name] = PointJson(*point, search.space);
    }
  };
  add("first_violation", result.first);
  add("least_robust", result.least);
  add("counterexample", result.counterexample);
  if (!result.shrunk.point.empty()) {
    json["shrunk_completely"] = result.shrunk.complete;
    json["margins"] = MarginsJson(result.shrunk, search.space);
  }
  return json;
}

RunResult RunCounterexample(const FalsifyResult& result, const CheckedSearch& search) {
  TRACKBED_REQUIRE(result.counterexample.has_value(), "RunCounterexample: there is none");
  const StudyPoint point =
      PointWith(search.study, search.space.Settings(result.counterexample->point));
  std::optional<RunOutcome> outcome = DriveOnce(search.runs, point.scenario);
  TRACKBED_CHECK(outcome && outcome->result && !outcome->passed,
                 "the counterexample passes when it is run again");
  const double robustness = RobustnessOf(*outcome->result).value;
  TRACKBED_CHECK(robustness == result.counterexample->robustness,
                 "the counterexample has the robustness {} when it is run again, not {}",
                 robustness, result.counterexample->robustness);
  return std::move(*outcome->result);
}

}  // namespace trackbed
