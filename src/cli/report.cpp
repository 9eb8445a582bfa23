#include "trackbed/report/report.h"

#include <fmt/format.h>

#include <filesystem>
#include <memory>
#include <optional>

#include "src/cli/output_file.h"
#include "src/cli/terminal.h"
#include "src/cli/verbs.h"
#include "trackbed/analysis/output_folder.h"
#include "trackbed/analysis/run_folder.h"
#include "trackbed/analysis/written_names.h"
#include "trackbed/core/error.h"
#include "trackbed/core/spelling.h"

namespace trackbed::cli {
namespace {

namespace fs = std::filesystem;

struct ReportOptions {
  std::vector<std::string> paths;
  std::string out;
  std::string film = "embedded";
  bool quiet = false;
};

FilmPlace ParseFilmPlace(const std::string& film) {
  const std::vector<std::pair<std::string, FilmPlace>> places{{"embedded", FilmPlace::kEmbedded},
                                                              {"beside", FilmPlace::kBeside},
                                                              {"none", FilmPlace::kAbsent}};
  std::vector<std::string> names;
  for (const auto& [name, place] : places) {
    if (film == name) {
      return place;
    }
    names.push_back(name);
  }
  throw InputError(Problem{.file = "--film", .message = "unknown " + UnknownName(film, names)});
}

int Report(const ReportOptions& options) {
  const FilmPlace film = ParseFilmPlace(options.film);
  const std::vector<fs::path> paths(options.paths.begin(), options.paths.end());
  const fs::path& first = paths.front();
  // Write a report of several runs to the current folder, not into a run folder.
  const fs::path folder = paths.size() > 1          ? fs::path()
                          : fs::is_directory(first) ? first
                                                    : first.parent_path();
  const fs::path file = options.out.empty() ? folder / run_folder::kReport : fs::path(options.out);
  if (options.out.empty()) {
    RequireNoForeignFile(file);
  } else {
    PrepareOutputFile("--out", file, paths, HasInHead(std::string(kPageMark)));
  }
  const std::optional<OutputFolder> in_use = LockFolderOf(file, folder);
  WriteReport(paths, file, film);
  if (!options.quiet) {
    Print("{}\n", file.string());
  }
  return kOk;
}

}  // namespace

void AddReport(const Command& command) {
  const auto options = std::make_shared<ReportOptions>();
  command
      .AddPositional(
          "folder", options->paths,
          "Folders of finished runs (several are compared), the folder of one "
          "comparison, or the folder or .csv file of a study (of two, of one study before and "
          "after a change)")
      .Required()
      .TypeName("DIR...");
  command
      .AddOption("-o,--out", options->out,
                 "Page to write (default: report.html in the folder, or in the current directory "
                 "for several folders)")
      .TypeName("FILE");
  command
      .AddOption("--film", options->film,
                 "Video of each run: embedded in the page, linked to its file (beside), or none")
      .TypeName("embedded|beside|none");
  command.AddFlag("-q,--quiet", options->quiet, "Print errors only");
  command.AddExample("The page of a finished run", "trackbed report out/three_turns");
  command.OnRun([options] { return Report(*options); });
}

}  // namespace trackbed::cli
