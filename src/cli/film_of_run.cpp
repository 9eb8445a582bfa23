#include "src/cli/film_of_run.h"

#include "src/cli/interruption.h"
#include "src/cli/progress_bar.h"
#include "trackbed/core/error.h"

namespace trackbed::cli {

namespace fs = std::filesystem;

void AddGlOption(const Command& command, std::string& gl) {
  command
      .AddOption("--gl", gl,
                 "Library that draws the film: osmesa (software), egl (the graphics card, else "
                 "software), or auto (the environment variable MUJOCO_GL, else osmesa, else egl)")
      .TypeName("auto|egl|osmesa")
      .ShowDefault();
}

void FilmRun(const fs::path& folder, const fs::path& output, const FilmOptions& options,
             bool quiet) {
  ProgressBar bar("film", quiet);
  RenderFilm(folder, output, options, [&](double fraction) {
    if (interrupted) {
      throw RunError(output.extension() == ".png" ? "interrupted; the frames so far were written"
                                                  : "interrupted; no film was written");
    }
    bar.Show(fraction);
  });
}

FilmOptions FilmOptionsOf(const RenderSpec& render, const std::string& gl) {
  return {.width = render.width,
          .height = render.height,
          .fps = render.fps,
          .camera = render.camera,
          .gl = gl};
}

}  // namespace trackbed::cli
