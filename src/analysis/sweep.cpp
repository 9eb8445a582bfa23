#include "trackbed/analysis/sweep.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <iterator>
#include <mutex>
#include <nlohmann/json.hpp>
#include <utility>

#include "src/analysis/manifest.h"
#include "src/analysis/study_description.h"
#include "trackbed/analysis/json_file.h"
#include "trackbed/analysis/parallel.h"
#include "trackbed/analysis/run_folder.h"
#include "trackbed/analysis/statistics.h"
#include "trackbed/analysis/sweep_rows.h"
#include "trackbed/core/error.h"

// Runs the rows of a study in parallel and records each row when its run finishes
// (sweep_records.cpp). A row of a study is one simulation run: one repetition at one parameter
// point of the study. The row numbers depend only on the study, so a shard or a resumed study can
// run exactly the missing rows. The option `--until` stops sampling when the Wilson intervals of
// the pass rates are narrow enough at all grid points. The widths of the Wilson intervals are
// checked after every kUntilBatch sample points. WriteSweep writes the table of a study row by row
// from the records. MergeRecords joins the records of a study's shards and rejects rows that
// contradict each other.
namespace trackbed {
namespace {

namespace fs = std::filesystem;
using nlohmann::ordered_json;

/// Returns the rows of the study's shard that must be run. Without `again`, the rows to run are
/// those without a record. If `again` lists run statuses, the rows to run are the recorded rows
/// with a listed status.
std::vector<std::size_t> RowsToRun(const SweepRecords& records, const SweepOptions& options) {
  const std::vector<std::string> columns = records.Columns();
  const auto status = static_cast<std::size_t>(std::find(columns.begin(), columns.end(), "status") -
                                               columns.begin());
  std::vector<std::size_t> rows;
  for (std::size_t row = 0; row < records.rows(); ++row) {
    if (!options.shard.Has(row)) {
      continue;
    }
    bool wanted = options.again.empty() && !records.Has(row);
    if (!options.again.empty() && records.Has(row)) {
      const std::string was = ReadRow(records, row).cells.at(status);
      wanted = std::find(options.again.begin(), options.again.end(), was) != options.again.end();
    }
    if (wanted) {
      rows.push_back(row);
    }
  }
  return rows;
}

/// Counts the passed runs at each grid point, over the sample points that have been run so far.
class SampledPassRates {
 public:
  SampledPassRates(const SweepRecords& records, std::size_t repeat, std::size_t samples)
      : records_(records),
        repeat_(repeat),
        samples_(samples),
        passed_(records.rows() / (samples * repeat)) {}

  /// Returns the rows of the next kUntilBatch sample points, at all grid points. NextRows returns
  /// an empty list at the end of the sample.
  [[nodiscard]] std::vector<std::size_t> NextRows() const {
    std::vector<std::size_t> rows;
    const std::size_t end = std::min(sampled_ + kUntilBatch, samples_);
    for (std::size_t grid = 0; grid < passed_.size(); ++grid) {
      for (std::size_t i = sampled_ * repeat_; i < end * repeat_; ++i) {
        rows.push_back(grid * samples_ * repeat_ + i);
      }
    }
    return rows;
  }

  /// Counts the passed runs among `rows`, a list that NextRows has returned. Take() returns false
  /// if the result of a row is missing.
  bool Take(const std::vector<std::size_t>& rows) {
    for (const std::size_t row : rows) {
      if (!records_.Has(row)) {
        return false;
      }
      passed_[row / (samples_ * repeat_)] += ReadRow(records_, row).passed ? 1U : 0U;
    }
    sampled_ = std::min(sampled_ + kUntilBatch, samples_);
    return true;
  }

  /// Returns whether the 95 % confidence interval of every pass rate has a half width of at most
  /// `half_width`.
  [[nodiscard]] bool AreAllKnownTo(double half_width) const {
    return std::all_of(passed_.begin(), passed_.end(), [&](std::size_t passed) {
      const Interval interval = WilsonInterval(passed, sampled_ * repeat_, 0.95);
      return 0.5 * (interval.high - interval.low) <= half_width;
    });
  }

 private:
  const SweepRecords& records_;
  std::size_t repeat_;
  std::size_t samples_;
  std::vector<std::size_t> passed_;  // Number of passed rows at each grid point.
  std::size_t sampled_ = 0;          // Number of sample points that have been run so far.
};

/// Calls `take` with every recorded row of the study's shard, in order.
void ForEachRow(const SweepRecords& records, const Shard& shard,
                const std::function<void(SweepRow row)>& take) {
  for (std::size_t i = 0; i < records.rows(); ++i) {
    if (shard.Has(i) && records.Has(i)) {
      take(ReadRow(records, i));
    }
  }
}

/// Returns the content of sweep.json, which describes the study and the rows that were run.
ordered_json Description(const SweepRecords& records, const Shard& shard,
                         const SweepSummary& sweep) {
  ordered_json json = records.header();
  json.erase("columns");
  if (shard.count > 1) {
    json["shard"] = {shard.index, shard.count};
  }
  json["complete"] = sweep.complete();
  json["rows"] = sweep.rows;
  json["rows_expected"] = sweep.rows_expected;
  json["runs"] = sweep.runs;
  json["refused"] = sweep.refused;
  json["errors"] = sweep.errors;
  if (json.contains("bisect")) {
    json["bisections"] = ordered_json::array();
    ForEachRow(records, shard, [&](SweepRow row) {
      if (!row.bisection.is_null()) {
        json["bisections"].push_back(std::move(row.bisection));
      }
    });
  }
  return json;
}

}  // namespace

SweepSummary Summarize(const SweepRecords& records, const Shard& shard) {
  SweepSummary sweep;
  for (std::size_t i = 0; i < records.rows(); ++i) {
    sweep.rows_expected += shard.Has(i) ? 1U : 0U;
  }
  ForEachRow(records, shard, [&](const SweepRow& row) {
    sweep.rows += 1;
    sweep.runs += row.runs;
    sweep.passed += row.passed ? 1U : 0U;
    sweep.refused += row.refused ? 1U : 0U;
    sweep.errors += row.error ? 1U : 0U;
  });
  return sweep;
}

std::size_t CountRows(const StudyPoints& points) {
  return points.size() * static_cast<std::size_t>(points.study().repeat);
}

void RunRows(const StudyPoints& points, const RunScenarioOnce& run, SweepRecords& records,
             const SweepOptions& options) {
  TRACKBED_CHECK(options.jobs > 0, "{} jobs", options.jobs);
  TRACKBED_CHECK(records.rows() == CountRows(points), "records of {} rows for a study of {}",
                 records.rows(), CountRows(points));
  const Study& study = points.study();
  const auto repeat = static_cast<std::size_t>(study.repeat);
  const std::size_t rows = RowsToRun(records, options).size();
  std::mutex mutex;
  std::size_t finished = 0;
  const auto run_row = [&](std::size_t row) {
    const RunScenarioOnce run_scenario = [&](const Scenario& scenario) {
      std::optional<RunOutcome> outcome =
          options.interrupted && options.interrupted() ? std::nullopt : run(scenario);
      if (outcome && options.finished && !study.bisect) {
        options.finished(row, *outcome);
      }
      return outcome;
    };
    const std::optional<SweepRow> made =
        MakeRow(study, run_scenario, points.Read(row / repeat), row % repeat);
    if (!made) {
      return false;
    }
    records.Append(row, ToJson(*made));
    if (options.progress) {
      const std::lock_guard lock(mutex);
      options.progress(static_cast<double>(++finished) / static_cast<double>(rows));
    }
    return true;
  };
  const auto run_rows = [&](const std::vector<std::size_t>& some) {
    ForEachIndex(some.size(), options.jobs, [&](std::size_t i) { return run_row(some[i]); });
  };
  if (!options.until_pass_rate) {
    run_rows(RowsToRun(records, options));
    return;
  }
  TRACKBED_CHECK(study.sample && !study.bisect, "a sample is needed");
  SampledPassRates rates(records, repeat, static_cast<std::size_t>(study.sample->count));
  while (!rates.AreAllKnownTo(*options.until_pass_rate)) {
    const std::vector<std::size_t> next = rates.NextRows();
    std::vector<std::size_t> missing;
    std::copy_if(next.begin(), next.end(), std::back_inserter(missing),
                 [&](std::size_t row) { return !records.Has(row); });
    run_rows(missing);
    if (next.empty() || !rates.Take(next)) {
      return;  // end the loop: all rows have been run, or the study was interrupted
    }
  }
}

SweepSummary WriteSweep(const SweepRecords& records, const Shard& shard, const OutputFolder& folder,
                        const std::string& stopped) {
  ResultWriter writer(folder);
  const SweepSummary summary = AddSweep(records, shard, writer, stopped);
  writer.Commit();
  return summary;
}

SweepSummary AddSweep(const SweepRecords& records, const Shard& shard, ResultWriter& writer,
                      const std::string& stopped) {
  const SweepSummary summary = Summarize(records, shard);
  bool header = true;
  std::size_t next = 0;
  writer.Add(run_folder::kSweepCsv, [&] {
    constexpr std::size_t kChunkSize = 65536;
    std::string part = std::exchange(header, false) ? CsvLine(records.Columns()) : "";
    for (; next < records.rows() && part.size() < kChunkSize; ++next) {
      if (shard.Has(next) && records.Has(next)) {
        part += CsvLine(ReadRow(records, next).cells);
      }
    }
    return part;
  });
  ordered_json description = Description(records, shard, summary);
  if (!stopped.empty()) {
    description["stopped"] = stopped;
  }
  writer.Add(run_folder::kSweepJson, JsonText(description));
  // Also remove the old report and the old outcome of a search or verification, because these files
  // describe the old rows of the study.
  writer.EndResult(run_folder::kStudy,
                   {run_folder::kReport, run_folder::kFalsifyJson, run_folder::kVerifyJson});
  return summary;
}

SweepResult RunSweep(const StudyPoints& points, const RunScenarioOnce& run,
                     const SweepOptions& options) {
  SweepRecords records = SweepRecords::InMemory(SweepHeader(points));
  RunRows(points, run, records, options);
  SweepResult sweep{.table = TextTable(records.Columns()),
                    .description = {},
                    .summary = Summarize(records, options.shard)};
  sweep.description = Description(records, options.shard, sweep.summary);
  ForEachRow(records, options.shard,
             [&](SweepRow row) { sweep.table.AddRow(std::move(row.cells)); });
  return sweep;
}

ordered_json SweepHeader(const StudyPoints& points,
                         const std::map<std::string, std::string>& inputs) {
  ordered_json json = DescribeStudy(points.study());
  json["rows_expected"] = CountRows(points);
  json["columns"] = TableColumns(points.study());
  json["versions"] = Versions();
  if (!inputs.empty()) {
    json["inputs"] = inputs;
  }
  return json;
}

void MergeRecords(const std::vector<fs::path>& files, SweepRecords& records) {
  for (const fs::path& file : files) {
    const SweepRecords part(file);
    if (part.header() != records.header()) {
      throw InputError(Problem{
          .file = file.string(),
          .message = fmt::format("is of another study than the first ({})",
                                 fmt::join(Differences(part.header(), records.header()), "; "))});
    }
    for (std::size_t row = 0; row < part.rows(); ++row) {
      if (!part.Has(row)) {
        continue;
      }
      const ordered_json content = part.Read(row);
      if (!records.Has(row)) {
        records.Append(row, content);
      } else if (records.Read(row) != content) {
        throw InputError(Problem{
            .file = file.string(),
            .message = fmt::format("row {} differs from that of another part ({})", row,
                                   fmt::join(Differences(content, records.Read(row)), "; "))});
      }
    }
  }
}

std::vector<std::size_t> WorstRows(const SweepRecords& records) {
  const JsonValue keep = records.Header().At("keep");
  const std::string by = keep.At("by").Text();
  const bool highest = keep.At("highest").Flag();
  const std::vector<std::string> columns = records.Columns();
  if (std::find(columns.begin(), columns.end(), by) == columns.end()) {
    keep.At("by").Refuse("a column");
  }
  const auto column =
      static_cast<std::size_t>(std::find(columns.begin(), columns.end(), by) - columns.begin());
  std::vector<std::pair<double, std::size_t>> rows;
  for (std::size_t row = 0; row < records.rows(); ++row) {
    const std::string cell =
        records.Has(row) ? ReadRow(records, row).cells.at(column) : std::string();
    if (const std::optional<double> value = CellNumber(cell)) {
      rows.emplace_back(highest ? -*value : *value, row);
    }
  }
  std::sort(rows.begin(), rows.end());
  const std::size_t count = keep.At("count").Count();
  std::vector<std::size_t> worst;
  for (auto row = rows.begin(); row != rows.end() && worst.size() < count; ++row) {
    worst.push_back(row->second);
  }
  return worst;
}

std::vector<Override> OverridesOfRow(const SweepRecords& records, std::size_t row) {
  if (row >= records.rows() || !records.Has(row)) {
    throw InputError(Problem{
        .key = "row",
        .message = row < records.rows()
                       ? fmt::format("{} has not been run", row)
                       : fmt::format("{}; the study has 0 to {}", row, records.rows() - 1)});
  }
  const JsonValue header = records.Header();
  std::vector<Override> overrides;
  for (const auto& [key, value] : header.At("set").Members()) {
    // Use the value of a text unchanged, and write any other value as JSON, which is valid YAML.
    const nlohmann::ordered_json& json = value.json();
    overrides.push_back(
        fmt::format("{}={}", key, json.is_string() ? json.get<std::string>() : json.dump()));
  }
  const std::vector<std::string> given = header.At("overrides").Texts();
  overrides.insert(overrides.end(), given.begin(), given.end());
  const std::vector<std::string> columns = records.Columns();
  const std::vector<std::string> cells = ReadRow(records, row).cells;
  for (std::size_t i = 0; i < columns.size() && columns[i] != "status"; ++i) {
    if (!cells.at(i).empty()) {
      overrides.push_back(columns[i] + "=" + cells[i]);
    }
  }
  return overrides;
}

std::string MissingRows(const SweepRecords& records) {
  constexpr std::size_t kMaxRanges = 10;
  std::string text;
  std::size_t ranges = 0;
  for (std::size_t row = 0; row < records.rows(); ++row) {
    if (records.Has(row)) {
      continue;
    }
    const std::size_t first = row;
    while (row + 1 < records.rows() && !records.Has(row + 1)) {
      ++row;
    }
    if (++ranges > kMaxRanges) {
      return text + ", ...";
    }
    text += text.empty() ? "" : ", ";
    text += first == row ? fmt::format("{}", row) : fmt::format("{} to {}", first, row);
  }
  return text;
}

}  // namespace trackbed
