#include <fmt/format.h>

#include <memory>

#include "src/cli/scenario_options.h"
#include "src/cli/scenario_runs.h"
#include "src/cli/terminal.h"
#include "src/cli/verbs.h"
#include "trackbed/analysis/sweep.h"
#include "trackbed/core/error.h"
#include "trackbed/drive/drive.h"
#include "trackbed/falsify/falsify.h"
#include "trackbed/identify/identify.h"
#include "trackbed/scenario/study_reader.h"

namespace trackbed::cli {

void AddCheck(const Command& command) {
  struct Options {
    std::vector<std::string> paths;
    ScenarioOptions scenario;
  };
  const auto options = std::make_shared<Options>();
  command
      .AddPositional("files", options->paths,
                     "Scenario or study files, or folders searched recursively")
      .Required()
      .TypeName("SCENARIO...");
  options->scenario.AddTo(command);
  command.AddExample("Validate two shipped scenarios", "trackbed check three_turns slalom");
  command.OnRun([options] {
    int exit_code = kOk;
    for (const auto& file : ScenarioFiles(options->paths, FolderContent::kScenariosAndStudies)) {
      try {
        RefuseFolder(file);
        if (IsIdentification(file)) {
          CheckIdentification(ReadIdentification(file, Paths(options->scenario.asset_folders)));
        } else if (IsStudy(file)) {
          Study study = options->scenario.ReadStudyFile(file);
          if (study.sample || !study.search) {
            static_cast<void>(CheckStudy(study));
          }
          if (study.search) {
            static_cast<void>(CheckSearch(std::move(study)));
          }
        } else {
          const Scenario scenario = options->scenario.Read(file);
          RefuseOverlapAtStart(file.string(), scenario, LoadCar(scenario).params());
        }
        if (!options->scenario.quiet) {
          Print("{}: ok\n", file.string());
        }
      } catch (const InputError& error) {
        PrintTo(stderr, "{}\n", Lines{error.what()});
        exit_code = kBadInput;
      }
    }
    return exit_code;
  });
}

}  // namespace trackbed::cli
