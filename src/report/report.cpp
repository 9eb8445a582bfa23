#include "trackbed/report/report.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <nlohmann/json.hpp>

#include "src/report/base64.h"
#include "src/report/comparison_data.h"
#include "src/report/identification_data.h"
#include "src/report/page_text.h"
#include "src/report/readable.h"
#include "src/report/run_data.h"
#include "src/report/study_data.h"
#include "trackbed/analysis/run_folder.h"
#include "trackbed/analysis/run_names.h"
#include "trackbed/core/error.h"
#include "trackbed/core/file.h"
#include "trackbed/report/live.h"

// Makes report pages. The function ReportData collects the data of runs, a comparison, a study or
// an identification as JSON. A report page is a fixed text (page_text.h) with this JSON in a script
// element; the JavaScript in page/ renders the data. All texts in the data pass through
// WithReadableTexts, and '<' is escaped, so that data from untrusted files cannot become markup.
// Videos of runs are either linked or embedded as base64. The page is written atomically, after
// checking that the run folders have not changed meanwhile.
namespace trackbed {
namespace {

constexpr std::size_t kMaxFilmBytes =
    std::size_t{128}  // maximum size of an embedded video [bytes], because videos
                      // are kept in memory
    << 20U;

namespace fs = std::filesystem;
using nlohmann::ordered_json;

/// Maximum number of rows of all logs together on a page, which yields a page size of about 1 MB.
constexpr std::size_t kRows = 7500;

std::string Escaped(const std::string& text) {
  std::string markup;
  for (const char c : text) {
    markup += c == '&' ? "&amp;" : c == '<' ? "&lt;" : c == '>' ? "&gt;" : std::string(1, c);
  }
  return markup;
}

/// Serializes JSON for embedding in an HTML script element. No text in the returned JSON can end
/// the script element.
std::string ScriptJson(const ordered_json& json) {
  // Invalid UTF-8 is replaced here because the keys have not passed through Readable.
  const std::string text = json.dump(-1, ' ', false, ordered_json::error_handler_t::replace);
  std::string safe;
  safe.reserve(text.size());
  for (const char c : text) {
    if (c == '<') {
      safe += "\\u003c";  // '<' occurs in JSON only inside strings
    } else {
      safe += c;
    }
  }
  return safe;
}

/// Converts a file path to a relative URL, percent-encoded where necessary.
std::string FileUrl(const fs::path& path) {
  std::string url;
  for (const char c : path.generic_string()) {
    const auto byte = static_cast<unsigned char>(c);
    if (std::isalnum(byte) != 0 || std::string_view("-._~/").find(c) != std::string_view::npos) {
      url += c;
    } else {
      url += fmt::format("%{:02X}", byte);
    }
  }
  return url;
}

std::string PageTitle(const ordered_json& data) {
  if (data.contains("study")) {
    return data["study"]["name"].get<std::string>();
  }
  if (data.contains("identification")) {
    return data["identification"]["name"].get<std::string>();
  }
  if (data.contains("path_check")) {
    return data["path_check"]["name"].get<std::string>();
  }
  std::string title;
  for (const ordered_json& run : data["runs"]) {
    title += (title.empty() ? "" : " · ") + run["name"].get<std::string>();
  }
  return title;
}

/// Returns whether `path` is the folder or table of a study, but neither a run nor a comparison.
bool IsStudyAlone(const fs::path& path) {
  return !IsRunFolder(path) && !HasComparison(path) && StudyTable(path);
}

void CheckFolders(const std::vector<fs::path>& paths) {
  for (auto path = paths.begin(); path != paths.end(); ++path) {
    std::error_code ignored;
    if (!fs::exists(*path, ignored)) {
      throw InputError(Problem{.file = path->string(), .message = "no such folder"});
    }
    const bool is_comparison = HasComparison(*path);
    if (IsIdentificationFolder(*path)) {
      if (paths.size() > 1) {
        throw InputError(
            Problem{.file = path->string(), .message = "an identification must be given alone"});
      }
      return;
    }
    if (!IsRunFolder(*path) && !is_comparison && !StudyTable(*path)) {
      throw InputError(Problem{.file = path->string(),
                               .message = "not a finished run (no metrics.json), a comparison (no "
                                          "compare.json), an identification (no identify.json) or "
                                          "a study (no sweep.csv or .csv file)"});
    }
    const bool are_two_studies =
        paths.size() == 2 && IsStudyAlone(paths[0]) && IsStudyAlone(paths[1]);
    if (!IsRunFolder(*path) && paths.size() > 1 && !are_two_studies) {
      throw InputError(
          Problem{.file = path->string(),
                  .message = is_comparison ? "a comparison must be given alone"
                                           : "a study must be given alone, or with the same study "
                                             "before a change in front of it"});
    }
    const fs::path real = fs::weakly_canonical(*path);
    if (std::any_of(paths.begin(), path,
                    [&](const fs::path& other) { return fs::weakly_canonical(other) == real; })) {
      throw InputError(Problem{.file = path->string(), .message = "given twice"});
    }
  }
}

/// The folders whose runs a report shows.
struct ShownRuns {
  std::vector<fs::path> folders;       ///< Folders of the runs in the report; empty for a study.
  std::optional<fs::path> comparison;  ///< Folder of the comparison in the report, if any.
};

ShownRuns RunsToShow(const std::vector<fs::path>& paths) {
  TRACKBED_CHECK(!paths.empty(), "a report of nothing");
  CheckFolders(paths);
  const fs::path& first = paths.front();
  if (paths.size() > 1 || !HasComparison(first)) {
    return {IsRunFolder(first) ? paths : std::vector<fs::path>(), std::nullopt};
  }
  ShownRuns shown{ComparedRuns(first), first};
  for (const fs::path& run : shown.folders) {
    if (!IsRunFolder(run)) {
      throw InputError(
          Problem{.file = first.string(),
                  .message = fmt::format("the compared run in {} does not exist (no metrics.json)",
                                         run.lexically_normal().string())});
    }
  }
  return shown;
}

ordered_json MakeReportData(const std::vector<fs::path>& paths, const ShownRuns& shown) {
  if (IsIdentificationFolder(paths.front())) {
    return {{"identification", IdentificationData(paths.front())}};
  }
  if (shown.folders.empty()) {
    const std::optional<fs::path> before =
        paths.size() > 1 ? StudyTable(paths.front()) : std::nullopt;
    return {{"study", StudyData(*StudyTable(paths.back()), before)}};
  }
  std::size_t plants = 0;
  for (const fs::path& folder : shown.folders) {
    plants += PlantCount(folder);
  }
  const std::vector<std::string> names = ShortRunNames(shown.folders);
  ordered_json data{{"runs", ordered_json::array()}};
  for (std::size_t i = 0; i < shown.folders.size(); ++i) {
    data["runs"].push_back(
        RunData(shown.folders[i], names[i], kRows / std::max<std::size_t>(plants, 1)));
  }
  const ordered_json comparison = ComparisonData(shown.folders, shown.comparison);
  if (!comparison.empty()) {
    data["comparison"] = comparison;
  }
  return data;
}

void AddFilms(const ShownRuns& shown, const fs::path& file, FilmPlace place, ordered_json& data) {
  for (std::size_t i = 0; i < shown.folders.size(); ++i) {
    const fs::path video = shown.folders[i] / run_folder::kVideo;
    std::error_code ignored;
    if (!fs::is_regular_file(video, ignored)) {
      continue;
    }
    ordered_json& run = data["runs"][i];
    if (place == FilmPlace::kEmbedded) {
      run["film"] = {{"base64", Base64(ReadFile(run_folder::RequireFile(video), kMaxFilmBytes))}};
    } else {
      const fs::path from = fs::weakly_canonical(fs::absolute(file).parent_path());
      run["film"] = {{"url", FileUrl(fs::weakly_canonical(video).lexically_relative(from))}};
    }
  }
}

}  // namespace

ordered_json ReportData(const std::vector<fs::path>& paths) {
  return MakeReportData(paths, RunsToShow(paths));
}

namespace {

enum class PageUse { kFinished, kLive };

std::string MakePage(const ordered_json& data, PageUse use) {
  const ordered_json shown = WithReadableTexts(data);
  const ordered_json runs = shown.value("runs", ordered_json::array());
  const bool has_scene = std::any_of(
      runs.begin(), runs.end(), [](const ordered_json& run) { return run.contains("vehicle"); });
  const bool live = use == PageUse::kLive;
  const auto only = [](bool shown_here, std::string_view text) {
    return shown_here ? text : std::string_view();
  };
  return fmt::format(
      "{}{}{}{}{}{}<script type=\"application/json\" id=\"data\">{}</script>\n{}{}{}{}",
      kPageBeforeLiveSource, only(live, kLiveSource), kPageBeforeTitle, Escaped(PageTitle(shown)),
      kPageBeforeData, only(has_scene, kSceneCanvas), ScriptJson(shown),
      only(has_scene, kSceneLibraries), kPageBeforeLiveScript, only(live, kLiveScript), kPageEnd);
}

}  // namespace

std::string ReportPage(const ordered_json& data) {
  return MakePage(data, PageUse::kFinished);
}

std::string LivePage(const ordered_json& data, const std::string& id) {
  ordered_json live = data;
  live.erase("comparison");
  live["live"] = {{"id", id}};
  return MakePage(live, PageUse::kLive);
}

std::string ReportPageOf(const std::vector<fs::path>& paths, const fs::path& file, FilmPlace film) {
  const ShownRuns shown = RunsToShow(paths);
  const run_folder::Reading reading(shown.folders);
  ordered_json data = MakeReportData(paths, shown);
  if (film != FilmPlace::kAbsent) {
    AddFilms(shown, file, film, data);
  }
  reading.RequireUnchanged();
  return ReportPage(data);
}

void WriteReport(const std::vector<fs::path>& paths, const fs::path& file, FilmPlace film) {
  const std::string page = ReportPageOf(paths, file, film);
  if (file.has_parent_path()) {
    MakeFolder(file.parent_path());
  }
  WriteFileAtomically(file, page);
}

}  // namespace trackbed
