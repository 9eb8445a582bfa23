#include "trackbed/render/film.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "render/camera.h"
#include "render/gl_choice.h"
#include "render/insets.h"
#include "render/output.h"
#include "render/overlays.h"
#include "render/painter.h"
#include "render/recording.h"
#include "trackbed/analysis/run_folder.h"
#include "trackbed/core/error.h"
#include "trackbed/core/file.h"
#include "trackbed/scenario/cameras.h"
#include "trackbed/sim/mujoco_error.h"

namespace trackbed {
namespace {

namespace fs = std::filesystem;

void CheckSide(std::vector<Problem>& problems, const char* key, int value, int max, bool even) {
  constexpr int kMinSide = 64;
  if (value < kMinSide || value > max) {
    problems.push_back(
        {.file = "",
         .key = key,
         .message = fmt::format("{} px; allowed are {} to {}", value, kMinSide, max)});
  } else if (even && value % 2 != 0) {
    problems.push_back(
        {.file = "",
         .key = key,
         .message = fmt::format("{} px; must be even, because the film stores color for 2x2 pixels",
                                value)});
  }
}

void CheckOptions(const FilmOptions& options, bool even_sides) {
  std::vector<Problem> problems;
  CheckSide(problems, "width", options.width, 7680, even_sides);
  CheckSide(problems, "height", options.height, 4320, even_sides);
  if (!(options.fps >= 1.0 && options.fps <= 240.0)) {
    problems.push_back({.file = "",
                        .key = "fps",
                        .message = fmt::format("{}; allowed are 1 to 240", options.fps)});
  }
  constexpr std::size_t kMaxPlants = 4;
  if (options.plants.size() > kMaxPlants) {
    problems.push_back({.file = "",
                        .key = "plants",
                        .message = fmt::format("{} side by side; allowed are 1 to {}",
                                               options.plants.size(), kMaxPlants)});
  }
  for (auto plant = options.plants.begin(); plant != options.plants.end(); ++plant) {
    if (std::find(options.plants.begin(), plant, *plant) != plant) {
      problems.push_back(
          {.file = "", .key = "plants", .message = fmt::format("'{}' is listed twice", *plant)});
      break;
    }
  }
  if (!problems.empty()) {
    throw InputError(std::move(problems));
  }
  CheckGl(options.gl);
}

/// Reads a separate recording for each plant in `plants` or, if `plants` is empty, a single
/// recording with all plants.
std::vector<render::Recording> ReadRecordings(const fs::path& folder,
                                              const std::vector<std::string>& plants) {
  std::vector<render::Recording> recordings;
  const run_folder::Reading reading({folder});
  for (const std::string& plant : plants) {
    recordings.push_back(render::ReadRecording(folder, {plant}));
  }
  if (plants.empty()) {
    recordings.push_back(render::ReadRecording(folder));
  }
  reading.RequireUnchanged();
  return recordings;
}

/// A time range of a run [s].
struct Times {
  double begin = 0;
  double end = 0;
};

Times RecordedTimes(const std::vector<render::Recording>& recordings) {
  Times times{recordings.front().begin(), recordings.front().end()};
  for (const render::Recording& recording : recordings) {
    times.end = std::max(times.end, recording.end());
  }
  return times;
}

void CheckTime(const char* key, double time, const Times& allowed) {
  // The recorded end of the run may be slightly earlier than displayed, since recorded times are
  // sums of time steps with rounding errors.
  constexpr double kRounding = 1e-6;
  if (!(time >= allowed.begin - kRounding && time <= allowed.end + kRounding)) {
    throw InputError(Problem{.key = key,
                             .message = fmt::format("{} s; allowed are {:.6g} to {:.6g}", time,
                                                    allowed.begin, allowed.end)});
  }
}

/// Returns the time range of the film, which is the whole run by default.
Times RequestedTimes(const FilmOptions& options, const Times& run) {
  Times times = run;
  if (options.from) {
    CheckTime("from", *options.from, run);
    times.begin = *options.from;
  }
  if (options.to) {
    CheckTime("to", *options.to, times);
    times.end = *options.to;
  }
  return times;
}

void MakeParent(const fs::path& output) {
  if (output.has_parent_path()) {
    MakeFolder(output.parent_path());
  }
}

}  // namespace

std::vector<FilmChoice> Cameras() {
  std::vector<FilmChoice> cameras;
  for (const CameraName& camera : CameraNames()) {
    cameras.push_back({camera.name, camera.summary});
  }
  return cameras;
}

std::vector<FilmChoice> FlatInsets() {
  std::vector<FilmChoice> insets;
  for (const render::FlatView& view : render::FlatViewTable()) {
    insets.push_back({std::string(view.name), std::string(view.summary)});
  }
  return insets;
}

std::vector<FilmChoice> Overlays() {
  std::vector<FilmChoice> overlays;
  for (const render::OverlayEntry& overlay : render::OverlayTable()) {
    overlays.push_back({overlay.name, overlay.summary});
  }
  return overlays;
}

std::vector<std::string> DefaultOverlays() {
  std::vector<std::string> names;
  for (const render::OverlayEntry& overlay : render::OverlayTable()) {
    if (overlay.by_default) {
      names.push_back(overlay.name);
    }
  }
  return names;
}

void CheckFilmName(const fs::path& output) {
  render::FilmFormatFor(output);
}

void CheckGl(const std::string& gl) {
  render::ChooseGl(gl, render::ReadGlSurroundings());
}

FilmReport RenderFilm(const fs::path& run_folder, const fs::path& output,
                      const FilmOptions& options,
                      const std::function<void(double fraction)>& progress) {
  const render::FilmFormat& format = render::FilmFormatFor(output);
  CheckOptions(options, format.even_sides);
  const MujocoErrorScope errors;
  std::vector<render::Recording> recordings = ReadRecordings(run_folder, options.plants);
  const auto [begin, end] = RequestedTimes(options, RecordedTimes(recordings));
  render::Painter painter(recordings, options);
  MakeParent(output);
  render::BackgroundOutput film(format.open(output, {.width = options.width,
                                                     .height = options.height,
                                                     .fps = options.fps,
                                                     .quick = painter.quality().quick}));

  FilmReport report;
  // The tolerance ensures that a last frame exactly at the end of the film is drawn despite
  // rounding errors.
  report.frames = static_cast<int>(std::floor((end - begin) * options.fps + 1e-6)) + 1;
  report.duration = (report.frames - 1) / options.fps;
  const std::vector<render::PlantRecording>& plants = recordings.front().plants;
  report.car = plants.front().plant();
  for (std::size_t i = 1; i < plants.size(); ++i) {
    report.ghosts.push_back(plants[i].plant());
  }

  render::Image image;
  for (int frame = 0; frame < report.frames; ++frame) {
    const double time = begin + frame / options.fps;
    painter.Paint(time, image);
    film.Add(image);
    if (progress) {
      try {
        progress((frame + 1.0) / report.frames);
      } catch (...) {
        film.Keep();
        throw;
      }
    }
  }
  film.Finish();
  return report;
}

void RenderPicture(const fs::path& run_folder, const fs::path& output, double time,
                   const FilmOptions& options) {
  if (output.extension() != ".png") {
    throw InputError(Problem{.file = output.string(), .message = "a picture is made as .png"});
  }
  CheckOptions(options, false);
  const MujocoErrorScope errors;
  std::vector<render::Recording> recordings = ReadRecordings(run_folder, options.plants);
  CheckTime("time", time, RecordedTimes(recordings));
  render::Image image;
  render::Painter(recordings, options).Paint(time, image);
  MakeParent(output);
  WriteFileAtomically(output, render::EncodePng(image));
}

}  // namespace trackbed
