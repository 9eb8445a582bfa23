#include "trackbed/render/film.h"

#include <array>
#include <cmath>
#include <memory>
#include <string_view>
#include <utility>

#include "render/camera.h"
#include "render/caption.h"
#include "render/handles.h"
#include "render/offscreen.h"
#include "render/output.h"
#include "render/recording.h"
#include "render/scene.h"
#include "render/shadow.h"
#include "trackbed/core/error.h"
#include "trackbed/core/spelling.h"

namespace trackbed {
namespace {

namespace fs = std::filesystem;

/// MuJoCo asks its shadow map once per pixel, however many samples a pixel has: multisampling
/// leaves a shadow's edge as stairs. Supersampling smooths it too and costs the same here (0.29 s
/// against 0.31 s for a picture of 1280x720 with shadows).
struct Quality {
  const char* name;
  int supersampling;  // samples per pixel, along each side
  bool shadows;
};
constexpr std::array<Quality, 2> kQualities{{{"draft", 1, false}, {"film", 2, true}}};

const Quality& FindQuality(const std::string& name) {
  std::vector<std::string> names;
  for (const Quality& quality : kQualities) {
    if (quality.name == name) {
      return quality;
    }
    names.emplace_back(quality.name);
  }
  throw InputError(
      Problem{.key = "quality", .message = "unknown quality " + UnknownName(name, names)});
}

void CheckSide(std::vector<Problem>& problems, const char* key, int value, int most, bool even) {
  constexpr int kLeast = 64;
  if (value < kLeast || value > most) {
    problems.push_back(
        {.file = "",
         .key = key,
         .message = fmt::format("{} px; allowed are {} to {}", value, kLeast, most)});
  } else if (even && value % 2 != 0) {
    problems.push_back(
        {.file = "",
         .key = key,
         .message = fmt::format(
             "{} px; must be even, because the film stores colour for 2x2 pixels", value)});
  }
}

void CheckOptions(const FilmOptions& options, const render::FilmFormat& format) {
  std::vector<Problem> problems;
  CheckSide(problems, "width", options.width, 7680, format.even_sides);
  CheckSide(problems, "height", options.height, 4320, format.even_sides);
  if (!(options.fps >= 1.0 && options.fps <= 240.0)) {
    problems.push_back({.file = "",
                        .key = "fps",
                        .message = fmt::format("{}; allowed are 1 to 240", options.fps)});
  }
  if (!problems.empty()) {
    throw InputError(std::move(problems));
  }
}

render::Font ReadFont(render::Offscreen& offscreen) {
  std::vector<render::Image> glyphs;
  for (char character = render::Font::kFirst; character <= render::Font::kLast; ++character) {
    glyphs.push_back(offscreen.Glyph(character));
  }
  return render::Font(std::move(glyphs));
}

std::vector<render::LegendEntry> Legend(const render::Recording& recording) {
  std::vector<render::LegendEntry> legend;
  if (!recording.plan.empty()) {
    legend.push_back({render::kPlanColor, "planned path"});
  }
  for (std::size_t car = 0; car < recording.plants.size(); ++car) {
    const std::string& plant = recording.plants[car].plant();
    legend.push_back({render::CarColor(car), car == 0 ? plant : plant + " (ghost)"});
  }
  return legend;
}

}  // namespace

std::vector<CameraSummary> Cameras() {
  std::vector<CameraSummary> cameras;
  for (const render::Camera& camera : render::CameraTable()) {
    cameras.push_back({std::string(camera.name), std::string(camera.summary)});
  }
  return cameras;
}

FilmReport RenderFilm(const fs::path& run_folder, const fs::path& output,
                      const FilmOptions& options,
                      const std::function<void(double fraction)>& progress) {
  const render::FilmFormat& format = render::FormatOf(output);
  CheckOptions(options, format);
  const Quality& quality = FindQuality(options.quality);
  const render::Camera& camera = render::FindCamera(options.camera);
  const render::MuJoCoErrorsAsExceptions guard;
  render::Recording recording = render::ReadRecording(run_folder);

  // The file first: a folder that cannot be written is known before any work is done.
  const std::unique_ptr<render::FilmOutput> film =
      format.open(output, options.width, options.height, options.fps);
  const render::CameraSubject subject(recording);
  const double aspect = static_cast<double>(options.width) / options.height;
  if (quality.shadows) {
    render::FitShadowMap(*recording.model, camera.pose(subject, recording.begin(), aspect));
  }
  render::Offscreen offscreen(*recording.model, options.width, options.height,
                              quality.supersampling);
  render::Font font = ReadFont(offscreen);
  render::FilmScene scene(recording, quality.shadows);
  const std::vector<render::LegendEntry> legend = Legend(recording);

  FilmReport report;
  // The small surplus keeps a last frame that falls on the end but for rounding.
  report.frames =
      static_cast<int>(std::floor((recording.end() - recording.begin()) * options.fps + 1e-6)) + 1;
  report.duration = (report.frames - 1) / options.fps;
  report.car = recording.plants.front().plant();
  for (std::size_t i = 1; i < recording.plants.size(); ++i) {
    report.ghosts.push_back(recording.plants[i].plant());
  }

  render::Image image;
  for (int frame = 0; frame < report.frames; ++frame) {
    const double time = recording.begin() + frame / options.fps;
    offscreen.Render(scene.At(time, camera.pose(subject, time, aspect)), image);
    render::DrawCaption(image, font, recording.name, legend,
                        recording.plants.front().ReadingsAt(time));
    film->Add(image);
    if (progress) {
      progress((frame + 1.0) / report.frames);
    }
  }
  film->Finish();
  return report;
}

}  // namespace trackbed
