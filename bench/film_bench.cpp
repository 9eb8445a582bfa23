#include <benchmark/benchmark.h>
#include <mujoco/mujoco.h>

#include <algorithm>
#include <filesystem>

#include "bench/in_turn.h"
#include "bench/temp_folder.h"
#include "render/painter.h"
#include "render/recording.h"
#include "trackbed/analysis/run.h"
#include "trackbed/core/error.h"
#include "trackbed/render/film.h"
#include "trackbed/sim/mujoco_error.h"

namespace trackbed::bench {
namespace {

constexpr int kFrames = 24;

/// One frame per second. Successive frames differ more than in a typical film, which makes encoding
/// more expensive.
FilmOptions Options(const char* quality) {
  return {.width = 1280, .height = 720, .fps = 1.0, .camera = "chase", .quality = quality};
}

/// A run of both plants up to the second turn of three_turns, kFrames seconds long.
class RunFolder {
 public:
  RunFolder() {
    Scenario scenario = ReadScenario(DataFolder() / "scenarios" / "three_turns.yaml");
    scenario.drive.time_limit = kFrames;
    WriteRunFolder(RunScenario(scenario), run());
  }
  [[nodiscard]] std::filesystem::path run() const { return folder_.path() / "run"; }
  [[nodiscard]] std::filesystem::path film() const { return folder_.path() / "film.mp4"; }

 private:
  TempFolder folder_;
};

/// Times a film from its first picture (earlier work does not grow with the film) until the file is
/// complete. The baseline draws the same scenes with MuJoCo, with the same overlays, shadows and
/// samples, and reads the pictures back. Both use the OpenGL library that MUJOCO_GL selects.
void Film(benchmark::State& state, const char* quality, double limit) {
  if (VideoEncoder() == "off") {
    state.SkipWithError("built without video");
    return;
  }
  const RunFolder folder;
  const double ours = CompareInTurn(
      state, limit,
      [&] {
        Stopwatch stopwatch;
        bool begun = false;
        const auto progress = [&](double /*fraction*/) {
          if (!begun) {
            stopwatch = Stopwatch();
            begun = true;
          }
        };
        const FilmReport report =
            RenderFilm(folder.run(), folder.film(), Options(quality), progress);
        const double seconds = stopwatch.Seconds();
        TRACKBED_CHECK(report.frames == kFrames + 1, "{} frames", report.frames);
        return seconds;
      },
      [&] {
        const MujocoErrorScope errors;
        render::Recording recording = render::ReadRecording(folder.run());
        render::Painter painter({&recording, 1}, Options(quality));
        painter.offscreen().Draw(painter.SceneAt(0.0));
        double seconds = 0.0;
        for (int frame = 1; frame <= kFrames; ++frame) {
          mjvScene& scene = painter.SceneAt(frame);
          const Stopwatch stopwatch;
          painter.offscreen().Draw(scene);
          seconds += stopwatch.Seconds();
        }
        return seconds;
      });
  state.counters["frames_per_s"] = kFrames / ours;
}

/// Compares drawing a picture of draft quality with and without overlays.
void DraftOverlays(benchmark::State& state) {
  const RunFolder folder;
  const MujocoErrorScope errors;
  render::Recording recording = render::ReadRecording(folder.run());
  render::Painter painter({&recording, 1}, Options("draft"));
  render::Image image;
  int frame = 0;
  CompareInTurn(
      state, 1.5,
      [&] {
        frame = frame % kFrames + 1;
        const Stopwatch stopwatch;
        painter.Paint(frame, image);
        return stopwatch.Seconds();
      },
      [&] {
        mjvScene& scene = painter.SceneAt(frame);
        // The overlays come after the geoms of the world. The first overlay is the first decorative
        // geom.
        const mjvGeom* overlays =
            std::find_if(scene.geoms, scene.geoms + scene.ngeom,
                         [](const mjvGeom& geom) { return geom.objtype == mjOBJ_UNKNOWN; });
        scene.ngeom = static_cast<int>(overlays - scene.geoms);
        const Stopwatch stopwatch;
        painter.offscreen().Render(scene, image);
        return stopwatch.Seconds();
      });
}

bool RegisterFilm() {
  for (const auto& [quality, limit] : {std::pair("film", 1.15), std::pair("draft", 1.5)}) {
    RegisterGuarded(std::string("Film/") + quality, Film, quality, limit)
        ->Iterations(3)
        ->UseManualTime()
        ->Unit(benchmark::kSecond);
  }
  RegisterGuarded("DraftOverlays", DraftOverlays)
      ->Iterations(2 * kFrames)
      ->UseManualTime()
      ->Unit(benchmark::kMillisecond);
  return true;
}
[[maybe_unused]] const bool film_registered = RegisterFilm();

}  // namespace
}  // namespace trackbed::bench
