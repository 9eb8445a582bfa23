#include <fmt/format.h>

#include <array>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "src/cli/scenario_options.h"
#include "src/cli/scenario_runs.h"
#include "src/cli/verbs.h"
#include "trackbed/analysis/sweep.h"
#include "trackbed/core/error.h"
#include "trackbed/core/file.h"

namespace trackbed::cli {
namespace {

namespace fs = std::filesystem;

struct SubmitOptions {
  std::string file;
  std::string out;
  int tasks = 1;
  std::vector<std::string> sbatch;
  ScenarioOptions scenario;
};

/// A word as the shell takes it for that word.
std::string Quoted(const std::string& word) {
  std::string quoted = "'";
  for (const char c : word) {
    quoted += c == '\'' ? "'\\''" : std::string(1, c);
  }
  return quoted + "'";
}

/// Hands a script to Slurm; its job's number.
std::string Submit(const std::string& options, const fs::path& script) {
  const std::string command =
      fmt::format("sbatch --parsable {} {} 2>&1", options, Quoted(script.string()));
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
  // "123", or "123;cluster".
  const std::string job = said.substr(0, said.find(';'));
  if (job.empty() || job.find_first_not_of("0123456789") != std::string::npos) {
    throw RunError(fmt::format("sbatch did not take {}: {}", script.string(), said));
  }
  return job;
}

int SubmitStudy(const SubmitOptions& options) {
  const Study study = options.scenario.ReadStudyFile(options.file);
  const CheckedStudy checked = CheckStudy(study, /*all=*/false);
  const fs::path out =
      fs::absolute(options.out.empty() ? fs::path("out") / study.name : fs::path(options.out));
  const std::string program = fs::read_symlink("/proc/self/exe").string();
  std::string sweep = fmt::format(
      "{} sweep {} --out {} --quiet --jobs \"${{SLURM_CPUS_PER_TASK:-1}}\"", Quoted(program),
      Quoted(fs::absolute(options.file).string()), Quoted(out.string()));
  for (const Override& text : study.overrides) {
    sweep += " --set " + Quoted(text);
  }
  for (const fs::path& folder : study.asset_folders) {
    sweep += " --allow-assets " + Quoted(fs::absolute(folder).string());
  }
  std::string sbatch;
  for (const std::string& option : options.sbatch) {
    sbatch += Quoted(option) + " ";
  }
  MakeFolder(out);
  const auto write = [&](const char* name, const std::string& lines) {
    WriteFileAtomically(out / name, "#!/bin/sh\n" + lines);
    return out / name;
  };
  const fs::path array = write(
      "array.sh", fmt::format("#SBATCH --job-name={}\n#SBATCH --array=1-{}\n#SBATCH --requeue\n"
                              "#SBATCH --output=task_%a.log\n#SBATCH --chdir={}\nexec {}\n",
                              study.name, options.tasks, out.string(), sweep));
  const fs::path merge = write(
      "merge.sh", fmt::format("#SBATCH --job-name={}_merge\n#SBATCH --output=merge.log\n"
                              "#SBATCH --chdir={}\nexec {} sweep merge {} --quiet\n",
                              study.name, out.string(), Quoted(program), Quoted(out.string())));
  const std::string job = Submit(sbatch, array);
  // The merging waits until all tasks have ended well, and goes when one has not.
  const std::string last = Submit(
      fmt::format("{}--dependency=afterok:{} --kill-on-invalid-dep=yes", sbatch, job), merge);
  if (!options.scenario.quiet) {
    fmt::print("{}: {} rows in {} tasks of job {}, then job {} merges them, in {}\n", study.name,
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
