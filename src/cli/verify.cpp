#include "trackbed/falsify/verify.h"

#include <fmt/format.h>

#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <thread>

#include "src/cli/output_file.h"
#include "src/cli/progress_bar.h"
#include "src/cli/scenario_options.h"
#include "src/cli/sweep_folders.h"
#include "src/cli/terminal.h"
#include "src/cli/verbs.h"
#include "trackbed/analysis/json_file.h"
#include "trackbed/analysis/run_folder.h"
#include "trackbed/analysis/written_names.h"

namespace trackbed::cli {
namespace {

namespace fs = std::filesystem;

struct VerifyVerbOptions {
  std::string file;
  std::string out;
  VerifyClaim claim;
  bool restart = false;
  int jobs = 0;  // number of parallel threads; 0: one per hardware thread
  ScenarioOptions scenario;
};

int Verify(const VerifyVerbOptions& options) {
  const CheckedStudy checked =
      CheckStudy(options.scenario.ReadStudyFile(options.file), /*all=*/false);
  CheckVerifiable(checked.points);
  const std::string& name = checked.points.study().name;
  const fs::path out = OutputFolderOf(options.out, name + "_verify");
  // Lock the output folder before the runs, so that a locking error appears before the long
  // computation.
  const OutputFolder folder(out, FileNamesOfVerb("verify"));
  const fs::path file = out / run_folder::kSweepRecords;
  if (options.restart) {
    SweepRecords::Remove(file);
  }
  SweepRecords records(file, SweepHeader(checked.points, checked.inputs));
  const auto threads = static_cast<int>(std::max(1U, std::thread::hardware_concurrency()));
  VerifyResult result;
  {
    ProgressBar bar(name, options.scenario.quiet);
    result = trackbed::Verify(checked, options.claim, records,
                              {.jobs = options.jobs > 0 ? options.jobs : threads,
                               .interrupted = [] { return interrupted.load(); },
                               .progress = [&](double fraction) { bar.Show(fraction); }});
  }
  const std::string said = ToText(result, options.claim);
  ResultWriter writer(folder);
  const SweepSummary table = AddSweep(records, {}, writer, result.interrupted ? "" : said);
  writer.Add(run_folder::kVerifyJson, JsonText(ToJson(result, options.claim)));
  writer.Commit(run_folder::kVerification, {});
  if (!options.scenario.quiet) {
    if (result.interrupted) {
      Print("{}: interrupted after {} runs; the same command goes on\n", name, result.runs);
    } else {
      Print("{}: {}; in {}\n", name, said, (out / run_folder::kSweepCsv).string());
    }
  }
  PrintRowsWithoutRun(name, table);
  return result.interrupted                               ? kInterrupted
         : result.verdict == ProbabilityVerdict::kAtLeast ? kOk
                                                          : kFailedExpectations;
}

}  // namespace

void AddVerify(const Command& command) {
  const auto options = std::make_shared<VerifyVerbOptions>();
  command.AddPositional("study", options->file, "Study file with a random sample")
      .Required()
      .TypeName("STUDY");
  command
      .AddOption("--probability", options->claim.probability,
                 "Claim that a run passes with at least this probability")
      .Range(0.001, 0.999999)
      .ShowDefault()
      .TypeName("P");
  command
      .AddOption("--confidence", options->claim.confidence,
                 "One minus the probability of a wrong claim")
      .Range(0.5, 0.999999)
      .ShowDefault()
      .TypeName("C");
  AddJobs(command, options->jobs, "Runs in parallel");
  command.AddOption("-o,--out", options->out, "Output folder (default: out/<study>_verify)")
      .TypeName("DIR");
  command.AddFlag("--restart", options->restart,
                  "Begin anew; else a verification that was interrupted goes on where it was");
  options->scenario.AddTo(command);
  command.AddExample("Stop as soon as it is known", "trackbed verify STUDY --probability 0.99");
  command.OnRun([options] { return Verify(*options); });
}

}  // namespace trackbed::cli
