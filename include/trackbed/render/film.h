#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace trackbed {

/// A named choice for films: a camera, an inset or an overlay.
struct FilmChoice {
  std::string name;
  std::string summary;  ///< one line
};

/// All cameras, the default first.
std::vector<FilmChoice> Cameras();

/// The insets that are not cameras, for a small picture in the picture.
std::vector<FilmChoice> FlatInsets();

/// All overlays.
std::vector<FilmChoice> Overlays();

/// The names of the overlays that films show by default.
std::vector<std::string> DefaultOverlays();

/// Options of a film. The defaults are those of `trackbed run --video`.
struct FilmOptions {
  int width = 1280;              ///< [px], 64 to 7680, even for a video
  int height = 720;              ///< [px], 64 to 4320, even for a video
  double fps = 30.0;             ///< frames per second of the run, 1 to 240
  std::string camera = "chase";  ///< a name of Cameras()
  /// "draft": one sample per pixel and a painted shadow under the car. "film": four samples, for
  /// smooth edges, and the shadows cast by the model's lamps, at about four times the time.
  std::string quality = "draft";
  /// The OpenGL library: "osmesa", "egl" or "auto", which is that of the environment variable
  /// MUJOCO_GL, else EGL if the program links it, else OSMesa if it is installed, else EGL.
  std::string gl = "auto";
  /// Another camera, or a name of FlatInsets(), for a small picture in the picture; empty: none.
  std::string inset{};
  std::vector<std::string> overlays = DefaultOverlays();  ///< names of Overlays()
  /// Plants of the run to show side by side, each alone in a separate part of the picture, as the
  /// car. Empty: a single picture with the car, and the other plants as its ghosts.
  std::vector<std::string> plants{};
  std::string title{};  ///< in the caption; empty: the run folder's name
  std::string note{};   ///< under the title; empty: a remark on the vehicle, if any
  /// Time in the run at which the film begins [s]; none: at its first time.
  std::optional<double> from{};
  /// Time in the run at which the film ends [s], at least `from`; none: at its last time.
  std::optional<double> to{};
};

/// Contents of a film.
struct FilmReport {
  int frames = 0;
  double duration = 0.0;            ///< [s] of the run, first to last frame
  std::string car;                  ///< the plant shown as the car, the leftmost one
  std::vector<std::string> ghosts;  ///< the plants shown as translucent cars
};

/// The video encoder, such as "H.264 (libavcodec 59.37.100)", or "off" in a build without one.
std::string VideoEncoder();

/// InputError when RenderFilm cannot make a film of that name for any run: an unknown extension, or
/// a video in a build without an encoder.
void CheckFilmName(const std::filesystem::path& output);

/// InputError when `gl` is not a value of FilmOptions::gl, or is "auto" while MUJOCO_GL is set to
/// something other than egl or osmesa; RunError when MuJoCo uses another library in this process.
void CheckGl(const std::string& gl);

/// Films a finished run from its folder alone: needs no display and no GPU, and repeats no
/// simulation.
///
/// The folder holds `model.xml` and, per plant, `<plant>.state.csv` and `<plant>.csv`. `plan.csv`
/// is optional; so is `scenario.resolved.yaml` if the world is flat, calm and uniform;
/// `<plant>.plan.csv` exists if the plant adopted new plans during the run. The car is the first
/// plant whose name begins with "mujoco", else the first by name; every other plant is a
/// translucent ghost. With `plants`, each of them has a separate picture without ghosts. Shows the
/// recorded world with its friction patches, and the `overlays`. When the car adopts a new plan,
/// that plan gets a distinct color, and earlier ones become faint and narrow; new plans of ghosts
/// are not shown. Frame k is the run at `from` + k / fps, with states interpolated linearly. The
/// last frame is the last one not after `to`, or not after the end of the longest recording; a
/// plant whose recording ends earlier stays at its last pose.
///
/// `progress` (may be empty) is called after every frame with the fraction done, in (0, 1]. An
/// exception from it ends the film and is rethrown.
///
/// The extension of `output` selects the format; its folder is made if it is missing:
///   * `.mp4`: a video, H.264, yuv420p, playable while still loading; not in a build without an
///     encoder. The file is either unchanged or a complete film, even after an exception.
///   * `.webp`, `.apng`: the same as an animated picture that repeats.
///   * `.png`: a picture per frame. `frames/f.png` gives `frames/f_00000.png`,
///     `frames/f_00001.png`, ... Each file is either unchanged or complete; after an exception the
///     frames written so far remain. After the last frame, removes surplus frames of an older,
///     longer film of the same name.
///
/// Guarantees: the same folder, options and OpenGL library give the same bytes. A separate thread
/// encodes and writes pictures, up to three behind the drawing; it has ended when this returns or
/// throws. Must not run on two threads at a time, nor draw with both OSMesa and EGL in one process
/// (the table of OpenGL's functions that MuJoCo loads is global). Silences libav's log permanently.
/// Afterwards, the caller's context is current again with EGL; with OSMesa, no context is. Errors:
/// InputError for a folder that is missing, incomplete or inconsistent, for an unknown extension
/// and for options out of range; RunError when the film cannot be drawn, encoded or written.
/// Cost: per frame of 1280x720, on two shared cores, draft 0.1 to 0.15 s and film 0.3 to 0.6 s;
/// overlays and caption take a fifth of a draft frame. Memory: the recordings, and a few pictures
/// for any length of film.
FilmReport RenderFilm(const std::filesystem::path& run_folder, const std::filesystem::path& output,
                      const FilmOptions& options,
                      const std::function<void(double fraction)>& progress = {});

/// Renders one picture of a film: the run at `time` [s], written to `output`, a `.png`, whose
/// folder is made if it is missing. Ignores the options fps, from and to. Otherwise as RenderFilm;
/// InputError also for a time outside of the run.
void RenderPicture(const std::filesystem::path& run_folder, const std::filesystem::path& output,
                   double time, const FilmOptions& options);

}  // namespace trackbed
