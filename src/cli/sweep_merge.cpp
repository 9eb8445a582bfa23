#include <fmt/format.h>

#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "src/cli/scenario_options.h"
#include "src/cli/sweep_folders.h"
#include "src/cli/terminal.h"
#include "src/cli/verbs.h"
#include "trackbed/analysis/run_folder.h"
#include "trackbed/analysis/sweep.h"
#include "trackbed/analysis/written_names.h"
#include "trackbed/core/error.h"

namespace trackbed::cli {
namespace {

namespace fs = std::filesystem;

struct MergeOptions {
  std::vector<std::string> folders;
  std::string out;
  bool partial = false;
  bool quiet = false;
};

int Merge(const MergeOptions& options) {
  std::vector<fs::path> files;
  for (const std::string& folder : options.folders) {
    const std::vector<fs::path> own = RecordsIn(folder);
    files.insert(files.end(), own.begin(), own.end());
  }
  const nlohmann::ordered_json header = SweepRecords(files.front()).header();
  const fs::path out =
      options.out.empty() ? fs::path(options.folders.front()) : fs::path(options.out);
  const OutputFolder folder(out, FileNamesOfVerb("sweep merge"));
  CheckKeptRows(out);
  SweepRecords records(out / run_folder::kSweepRecords, header,
                       "choose another folder for the table (-o)");
  MergeRecords(files, records);
  const std::string name = records.Header().At("study").Text();
  if (records.count() < records.rows() && !options.partial) {
    throw InputError(Problem{
        .file = out.string(),
        .message =
            fmt::format("{} of {} rows are missing: {}; --partial merges what there is",
                        records.rows() - records.count(), records.rows(), MissingRows(records))});
  }
  const SweepSummary sweep = WriteSweep(records, {}, folder);
  if (!options.quiet) {
    Print("{}: {} of {} rows from {} files, {} passed, in {}\n", name, sweep.rows,
          sweep.rows_expected, files.size(), sweep.passed, (out / run_folder::kSweepCsv).string());
  }
  if (sweep.complete()) {
    ScenarioOptions scenario;
    scenario.quiet = options.quiet;
    KeepWorstRows(records, out, scenario);
  }
  PrintRowsWithoutRun(name, sweep);
  return kOk;
}

}  // namespace

void AddSweepMerge(const Command& command) {
  const auto options = std::make_shared<MergeOptions>();
  command
      .AddPositional("folders", options->folders,
                     "Output folders of shards, or folders that have them")
      .Required()
      .TypeName("DIR...");
  command.AddOption("-o,--out", options->out, "Output folder (default: the first of these)")
      .TypeName("DIR");
  command.AddFlag("--partial", options->partial, "Merge although rows are missing");
  command.AddFlag("-q,--quiet", options->quiet, "Print only problems");
  command.AddExample("One table of what the tasks of a study left in its folder",
                     "trackbed sweep merge /shared/study");
  command.OnRun([options] { return Merge(*options); });
}

}  // namespace trackbed::cli
