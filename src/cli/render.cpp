#include <fmt/format.h>

#include <charconv>
#include <filesystem>
#include <memory>

#include "src/cli/film_of_run.h"
#include "src/cli/output_file.h"
#include "src/cli/progress_bar.h"
#include "src/cli/terminal.h"
#include "src/cli/verbs.h"
#include "trackbed/analysis/output_folder.h"
#include "trackbed/analysis/run_folder.h"
#include "trackbed/analysis/written_names.h"
#include "trackbed/core/error.h"
#include "trackbed/scenario/scenario.h"

namespace trackbed::cli {
namespace {

namespace fs = std::filesystem;

struct RenderOptions {
  std::string folder;
  std::string size;
  std::optional<double> fps;
  std::optional<std::string> camera;
  std::string quality = FilmOptions{}.quality;
  std::string gl = FilmOptions{}.gl;
  std::string inset;
  std::vector<std::string> overlays;
  std::vector<std::string> plants;
  std::optional<double> from;
  std::optional<double> to;
  std::optional<double> at;
  std::string out;
  bool quiet = false;
};

/// Parses an image size in pixels, such as "1280x720".
std::pair<int, int> ParseSize(const std::string& text) {
  std::pair<int, int> size;
  const char* end = text.data() + text.size();
  const auto width = std::from_chars(text.data(), end, size.first);
  if (width.ec == std::errc{} && width.ptr != end && *width.ptr == 'x') {
    const auto height = std::from_chars(width.ptr + 1, end, size.second);
    if (height.ec == std::errc{} && height.ptr == end) {
      return size;
    }
  }
  throw InputError(
      Problem{.key = "--size", .message = fmt::format("'{}' is not of the form 1280x720", text)});
}

/// Formats a list of choices, such as "chase (behind the car), side (from its right)".
std::string Listed(const std::vector<FilmChoice>& choices) {
  std::string text;
  for (const FilmChoice& choice : choices) {
    text += (text.empty() ? "" : ", ") + choice.name + " (" + choice.summary + ")";
  }
  return text;
}

int RenderOne(const RenderOptions& options) {
  const fs::path folder = options.folder;
  FilmOptions film;
  // If the user does not give the size, the frame rate or the camera, use the value in the run's
  // scenario.
  if (const fs::path resolved = folder / run_folder::kScenarioYaml; fs::exists(resolved)) {
    const RenderSpec render = ReadRenderSpec(run_folder::RequireFile(resolved));
    film = {
        .width = render.width, .height = render.height, .fps = render.fps, .camera = render.camera};
  }
  if (!options.size.empty()) {
    std::tie(film.width, film.height) = ParseSize(options.size);
  }
  film.fps = options.fps.value_or(film.fps);
  film.camera = options.camera.value_or(film.camera);
  film.quality = options.quality;
  film.gl = options.gl;
  film.inset = options.inset;
  film.plants = options.plants;
  film.from = options.from;
  film.to = options.to;
  if (options.overlays == std::vector<std::string>{"none"}) {
    film.overlays.clear();
  } else if (!options.overlays.empty()) {
    film.overlays = options.overlays;
  }
  const char* name = options.at ? run_folder::kPicture : run_folder::kVideo;
  const fs::path out = options.out.empty() ? folder / name : fs::path(options.out);
  if (options.out.empty()) {
    RequireNoForeignFile(out);
  } else if (!fs::is_directory(out)) {
    PrepareOutputFile("--out", out, {}, HasMark);
  }
  const std::optional<OutputFolder> in_use = LockFolderOf(out, folder);
  if (options.at) {
    RenderPicture(folder, out, *options.at, film);
  } else {
    FilmRun(folder, out, film, options.quiet);
  }
  if (!options.quiet) {
    Print("{}\n", out.string());
  }
  return kOk;
}

}  // namespace

void AddRender(const Command& command) {
  const auto options = std::make_shared<RenderOptions>();
  command.AddPositional("run", options->folder, "Folder of a finished run")
      .Required()
      .TypeName("RUNDIR");
  command.AddOption("--size", options->size, "Pixels (default: the scenario's render.size)")
      .TypeName("1280x720");
  command.AddOption("--fps", options->fps, "Frames per second (default: the scenario's render.fps)")
      .TypeName("N");
  command
      .AddOption("--camera", options->camera,
                 "Point of view (default: the scenario's render.camera): " + Listed(Cameras()))
      .TypeName("CAMERA");
  command
      .AddOption("--inset", options->inset,
                 "Another camera, shown as an inset, or " + Listed(FlatInsets()))
      .TypeName("CAMERA");
  command
      .AddOption("--plants", options->plants,
                 "These plants of the run side by side, each alone (default: one picture, the car "
                 "and the others as its ghosts)")
      .Delimiter(',')
      .TypeName("PLANT,...");
  command
      .AddOption(
          "--overlays", options->overlays,
          "What to draw over the world, or none (default: everything): " + Listed(Overlays()))
      .Delimiter(',')
      .TypeName("OVERLAY,...");
  command
      .AddOption("--quality", options->quality,
                 "draft, or film: smooth edges and cast shadows, 4 times slower")
      .TypeName("draft|film")
      .ShowDefault();
  AddGlOption(command, options->gl);
  const Option from = command.AddOption("--from", options->from, "Start time [s]");
  const Option to = command.AddOption("--to", options->to, "End time [s]");
  command
      .AddOption("--at", options->at, "Save the frame at S seconds as FILE.png instead of a video")
      .Excludes(from)
      .Excludes(to)
      .TypeName("S");
  from.TypeName("S");
  to.TypeName("S");
  command
      .AddOption(
          "-o,--out", options->out,
          "A video FILE.mp4, an animated picture FILE.webp or FILE.apng, or frames: DIR/F.png "
          "writes DIR/F_00000.png, ... (default: video.mp4, or picture.png, in the run folder)")
      .TypeName("FILE");
  command.AddFlag("-q,--quiet", options->quiet, "Print errors only");
  command.AddExample("A picture of the tenth second, after `trackbed run three_turns`",
                     "trackbed render out/three_turns --at 10 --quality film --out turn.png");
  command.AddExample("The plants of a run side by side, as an animated picture",
                     "trackbed render out/three_turns --plants kinematic,mujoco --size 640x360 "
                     "--fps 5 --from 9 --to 10 --out split.webp");
  command.OnRun([options] { return RenderOne(*options); });
}

}  // namespace trackbed::cli
