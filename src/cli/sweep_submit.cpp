#include <fmt/format.h>

#include <array>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "src/cli/output_file.h"
#include "src/cli/scenario_options.h"
#include "src/cli/scenario_runs.h"
#include "src/cli/shell_quote.h"
#include "src/cli/terminal.h"
#include "src/cli/verbs.h"
#include "trackbed/analysis/run_folder.h"
#include "trackbed/analysis/sweep.h"
#include "trackbed/core/error.h"

namespace trackbed::cli {
namespace {

namespace fs = std::filesystem;

constexpr const char* kOutOption = "--out";

struct SubmitOptions {
  std::string file;
  std::string out;
  int tasks = 1;
  std::vector<std::string> sbatch;
  ScenarioOptions scenario;
};

/// Quotes `word`, which is the value of the command line option `what`. Throws InputError if the
/// option's value cannot be quoted.
std::string Quoted(std::optional<std::string> (*quoted)(std::string_view word),
                   const std::string& word, const char* what) {
  const std::optional<std::string> text = quoted(word);
  if (!text) {
    throw InputError(Problem{
        .key = what,
        .message = fmt::format("'{}' has a control character or is not UTF-8, which a script for "
                               "Slurm cannot hold; give another name",
                               word)});
  }
  return *text;
}

/// Quotes a word for the shell sh.
std::string ForSh(const std::string& word, const char* what) {
  return Quoted(QuotedForSh, word, what);
}

/// Submits a script to Slurm and returns the number of the Slurm job.
std::string Submit(const std::string& options, const fs::path& script) {
  const std::string command =
      fmt::format("sbatch --parsable {}{} 2>&1", options, ForSh(script.string(), kOutOption));
  const std::unique_ptr<FILE, int (*)(FILE*)> pipe(::popen(command.c_str(), "r"), ::pclose);
  if (!pipe) {
    throw RunError("cannot run sbatch");
  }
  std::string said;
  std::array<char, 256> part{};
  while (std::fgets(part.data(), part.size(), pipe.get()) != nullptr) {
    said += part.data();
  }
  said.erase(said.find_last_not_of("\n") + 1);
  // Slurm prints the job number as "123" or "123;cluster".
  const std::string job = said.substr(0, said.find(';'));
  if (job.empty() || job.find_first_not_of("0123456789") != std::string::npos) {
    throw RunError(fmt::format("sbatch did not take {}: {}", script.string(), said));
  }
  return job;
}

/// Returns the shell command that each task of a Slurm array executes. The shell command runs the
/// shard of the study whose number is in Slurm's environment variables.
std::string SweepCommand(const Study& study, const std::string& program, const fs::path& out) {
  std::string command =
      fmt::format("{} sweep {} --out {} --quiet --jobs \"${{SLURM_CPUS_PER_TASK:-1}}\"",
                  ForSh(program, "program"), ForSh(fs::absolute(study.file).string(), "study"),
                  ForSh(out.string(), kOutOption));
  for (const Override& text : study.overrides) {
    command += " --set " + ForSh(text, "--set");
  }
  for (const fs::path& folder : study.asset_folders) {
    command += " --allow-assets " + ForSh(fs::absolute(folder).string(), "--allow-assets");
  }
  return command;
}

/// Returns the first lines of a Slurm script, which contain the options for Slurm.
std::string SbatchLines(const std::vector<std::string>& options) {
  std::string lines = "#!/bin/sh\n";
  for (const std::string& option : options) {
    lines += fmt::format("#SBATCH {}\n", Quoted(QuotedForSbatch, option, kOutOption));
  }
  return lines;
}

struct Scripts {
  std::string array;
  std::string merge;
};

Scripts MakeScripts(const Study& study, int tasks, const fs::path& out) {
  const std::string program = fs::read_symlink("/proc/self/exe").string();
  const std::string folder = "--chdir=" + out.string();
  // The Slurm scripts open their log files themselves, because Slurm replaces % and \ in the path
  // of a log file.
  const std::string no_log = "--output=/dev/null";
  const std::string log = fmt::format("exec > {}/", ForSh(out.string(), kOutOption));
  return {.array = SbatchLines({"--job-name=" + study.name, fmt::format("--array=1-{}", tasks),
                                "--requeue", no_log, folder}) +
                   log + "\"task_${SLURM_ARRAY_TASK_ID:-1}.log\" 2>&1\n" +
                   fmt::format("exec {}\n", SweepCommand(study, program, out)),
          .merge = SbatchLines({fmt::format("--job-name={}_merge", study.name), no_log, folder}) +
                   log + "merge.log 2>&1\n" +
                   fmt::format("exec {} sweep merge {} --quiet\n", ForSh(program, "program"),
                               ForSh(out.string(), kOutOption))};
}

/// Throws RunError if Slurm would write its logs through a link, or would overwrite a file that is
/// not a log of an earlier submission.
void RequireNoForeignLogs(const fs::path& out, bool submitted) {
  std::error_code error;
  for (fs::directory_iterator at(out, error), end; !error && at != end; at.increment(error)) {
    const std::string name = at->path().filename().string();
    const bool is_log =
        name == "merge.log" || (name.starts_with("task_") && name.ends_with(".log"));
    std::error_code ignored;
    if (is_log && !(submitted && fs::is_regular_file(at->symlink_status(ignored)))) {
      throw RunError(
          fmt::format("{} is in the way of Slurm's logs; move it away, or choose another "
                      "folder (--out)",
                      at->path().string()));
    }
  }
}

/// Writes the Slurm scripts to the output folder. When WriteScripts returns, the output folder is
/// unlocked, so that the Slurm tasks can write to it.
void WriteScripts(const Scripts& scripts, const fs::path& out) {
  const std::vector<std::string> names{run_folder::kArraySh, run_folder::kMergeSh};
  const OutputFolder folder(out, names);
  RequireNoForeignLogs(out, fs::exists(out / run_folder::kArraySh));
  ResultWriter writer(folder);
  writer.Add(run_folder::kArraySh, scripts.array);
  writer.Add(run_folder::kMergeSh, scripts.merge);
  writer.Commit(run_folder::kSubmission, {});
}

int SubmitStudy(const SubmitOptions& options) {
  const Study study = options.scenario.ReadStudyFile(options.file);
  const CheckedStudy checked = CheckStudy(study, /*all=*/false);
  const fs::path out = fs::absolute(OutputFolderOf(options.out, study.name));
  const Scripts scripts = MakeScripts(study, options.tasks, out);
  std::string sbatch;
  for (const std::string& option : options.sbatch) {
    sbatch += ForSh(option, "--sbatch") + " ";
  }
  WriteScripts(scripts, out);
  const fs::path merge = out / run_folder::kMergeSh;
  const std::string job = Submit(sbatch, out / run_folder::kArraySh);
  // The Slurm job that merges the shards starts after all tasks have succeeded. Slurm cancels the
  // merge job if a task fails.
  const std::string last = Submit(
      fmt::format("{}--dependency=afterok:{} --kill-on-invalid-dep=yes ", sbatch, job), merge);
  if (!options.scenario.quiet) {
    Print("{}: {} rows in {} tasks of job {}, then job {} merges them, in {}\n", study.name,
          CountRows(checked.points), options.tasks, job, last, out.string());
  }
  return kOk;
}

}  // namespace

void AddSweepSubmit(const Command& command) {
  const auto options = std::make_shared<SubmitOptions>();
  command.AddPositional("study", options->file, "Study file").Required().TypeName("STUDY");
  command.AddOption("--tasks", options->tasks, "Tasks of the array, each of which runs a shard")
      .Required()
      .Range(1, 100000)
      .TypeName("N");
  command
      .AddOption("-o,--out", options->out,
                 "Output folder, which all nodes have (default: out/<study>)")
      .TypeName("DIR");
  command
      .AddOption("--sbatch", options->sbatch,
                 "An option for sbatch, such as --sbatch=--time=2:00:00; may be repeated")
      .OneWord()
      .TypeName("OPTION");
  options->scenario.AddTo(command);
  command.AddExample("A study as fifty tasks of a Slurm array, two hours each",
                     "trackbed sweep submit study.yaml --tasks 50 --out /shared/study "
                     "--sbatch=--time=2:00:00");
  command.OnRun([options] { return SubmitStudy(*options); });
}

}  // namespace trackbed::cli
