#include "src/falsify/search_runs.h"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "trackbed/analysis/parallel.h"
#include "trackbed/analysis/robustness.h"
#include "trackbed/analysis/sweep_rows.h"
#include "trackbed/core/error.h"
#include "trackbed/core/text_table.h"

namespace trackbed {
namespace {

constexpr const char* kRefusedRow = "refused";
constexpr const char* kErrorRow = "error";

std::size_t ParameterCount(const Study& study) {
  return study.vary.size() + study.derive.size();
}

}  // namespace

std::vector<std::string> SearchColumns(const Study& study) {
  std::vector<std::string> columns;
  for (const Variation& variation : study.vary) {
    columns.push_back(variation.key);
  }
  for (const DerivedKey& derived : study.derive) {
    columns.push_back(derived.key);
  }
  columns.insert(columns.end(), {"status", "robustness", "limit", "phase"});
  for (const OutputSpec& output : study.outputs) {
    columns.push_back(output.path);
  }
  columns.emplace_back("reason");
  return columns;
}

std::vector<std::string> SearchRuns::Texts(const UnitPoint& point) const {
  std::vector<std::string> texts;
  for (const Setting& setting : search_.space.Settings(point)) {
    texts.push_back(setting.value);
  }
  return texts;
}

bool SearchRuns::Has(const UnitPoint& point) const {
  return known_.find(Texts(point)) != known_.end();
}

std::optional<std::vector<SearchRun>> SearchRuns::Run(const std::vector<UnitPoint>& points,
                                                      const char* phase) {
  struct Task {
    std::size_t row;
    UnitPoint point;
  };
  std::vector<Task> tasks;
  std::vector<std::vector<std::string>> texts;
  // Row number of each new point in the table of runs, keyed by the values of the point.
  std::map<std::vector<std::string>, std::size_t> rows;
  for (const UnitPoint& point : points) {
    texts.push_back(Texts(point));
    if (known_.find(texts.back()) != known_.end()) {
      continue;
    }
    if (rows.try_emplace(texts.back(), next_).second) {
      if (!records_.Has(next_)) {
        tasks.push_back({next_, point});
      }
      ++next_;
    }
  }
  std::vector<char> done(tasks.size(), 0);
  ForEachIndex(tasks.size(), options_.jobs, [&](std::size_t i) {
    done[i] = RunRow(tasks[i].row, tasks[i].point, phase) ? 1 : 0;
    return done[i] != 0;
  });
  if (std::find(done.begin(), done.end(), 0) != done.end()) {
    return std::nullopt;
  }
  for (const auto& [text, row] : rows) {
    known_.emplace(text, FromRecords(row, text));
  }
  std::vector<SearchRun> runs;
  for (const std::vector<std::string>& text : texts) {
    runs.push_back(known_.at(text));
  }
  return runs;
}

bool SearchRuns::RunRow(std::size_t row, const UnitPoint& point, const char* phase) {
  const Study& study = search_.study;
  const StudyPoint at = PointWith(study, search_.space.Settings(point));
  SweepRow made{.cells = {}, .runs = 1, .bisection = {}};
  Outputs outputs;
  std::string status;
  std::string reason;
  std::optional<RunRobustness> robustness;
  if (!at.refused.empty()) {
    status = kRefusedRow;
    reason = at.refused;
  } else {
    try {
      if (options_.interrupted && options_.interrupted()) {
        return false;
      }
      const std::optional<RunOutcome> outcome =
          DriveOnce(search_.runs, at.scenario, options_.interrupted);
      if (!outcome) {
        return false;
      }
      status = outcome->status;
      reason = outcome->reason;
      outputs = outcome->outputs;
      made.passed = outcome->passed;
      robustness = RobustnessOf(*outcome->result);
    } catch (const InputError& error) {
      status = kRefusedRow;
      reason = error.problems().front().WithoutPlace();
    } catch (const RunError&) {
      throw;
    } catch (const std::exception& error) {
      status = kErrorRow;
      reason = error.what();
    }
  }
  made.refused = status == kRefusedRow;
  made.error = status == kErrorRow;
  made.runs = made.refused || made.error ? 0 : 1;
  for (std::size_t i = 0; i < ParameterCount(study); ++i) {
    made.cells.push_back(i < at.settings.size() ? CellText(at.settings[i].value) : "");
  }
  made.cells.insert(made.cells.end(), {status, robustness ? ShortestText(robustness->value) : "",
                                       robustness ? robustness->limit : "", phase});
  for (const OutputSpec& output : study.outputs) {
    const auto found = outputs.find(output.path);
    made.cells.push_back(found == outputs.end() ? "" : found->second);
  }
  made.cells.push_back(std::move(reason));
  records_.Append(row, ToJson(made));
  if (options_.progress) {
    const std::lock_guard lock(mutex_);
    options_.progress(row);
  }
  return true;
}

SearchRun SearchRuns::FromRecords(std::size_t row, const std::vector<std::string>& texts) const {
  const std::vector<std::string> cells = ReadRow(records_, row).cells;
  const std::size_t count = ParameterCount(search_.study);
  const bool matches = cells.size() == SearchColumns(search_.study).size() &&
                       std::equal(texts.begin(), texts.end(), cells.begin());
  if (!matches) {
    throw RunError(
        fmt::format("row {} of the records is of another point than the search proposes; --restart "
                    "removes them",
                    row));
  }
  SearchRun run{.row = row,
                .status = cells[count],
                .robustness = CellNumber(cells[count + 1]),
                .limit = cells[count + 2],
                .reason = cells.back()};
  return run;
}

}  // namespace trackbed
