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
  std::string summary;  ///< One-line summary.
};

/// All cameras, the default first.
std::vector<FilmChoice> Cameras();

/// The insets that are not cameras. An inset is a small picture in the picture.
std::vector<FilmChoice> FlatInsets();

/// All overlays.
std::vector<FilmChoice> Overlays();

/// The names of the overlays that films show by default.
std::vector<std::string> DefaultOverlays();

/// Options of a film. The defaults are those of `trackbed run --video`.
struct FilmOptions {
  int width = 1280;              ///< Width [px], 64 to 7680; an even number for a video.
  int height = 720;              ///< Height [px], 64 to 4320; an even number for a video.
  double fps = 30.0;             ///< Frames per second of the run, 1 to 240.
  std::string camera = "chase";  ///< A name of Cameras().
  /// The quality. "draft" has one sample per pixel and a painted shadow under the car. "film" has
  /// four samples, for smooth edges, and the shadows cast by the model's lamps; it takes about four
  /// times as long.
  std::string quality = "draft";
  /// The OpenGL library: "osmesa", "egl" or "auto". With "auto", the environment variable MUJOCO_GL
  /// selects the library. If that is not set, the library is EGL if the program links EGL, else
  /// OSMesa if it is installed, else EGL.
  std::string gl = "auto";
  /// Inset: another camera, or a name of FlatInsets(). Empty: no inset.
  std::string inset{};
  std::vector<std::string> overlays = DefaultOverlays();  ///< Names of Overlays().
  /// Plants of the run to show side by side, each alone in a separate part of the picture, as the
  /// car. If empty, a single picture shows the car, and the other plants as ghosts.
  std::vector<std::string> plants{};
  std::string title{};  ///< Title in the caption; empty: the run folder's name.
  std::string note{};   ///< Note under the title; empty: a remark on the vehicle, if any.
  /// Time in the run at which the film begins [s]; nullopt: at the first recorded time.
  std::optional<double> from{};
  /// Time in the run at which the film ends [s], at least `from`; nullopt: at the last recorded
  /// time.
  std::optional<double> to{};
};

/// Contents of a film.
struct FilmReport {
  int frames = 0;
  double duration = 0.0;            ///< Duration in the run, from the first to the last frame [s].
  std::string car;                  ///< Leftmost plant shown as the car.
  std::vector<std::string> ghosts;  ///< Plants shown as translucent cars.
};

/// The video encoder, such as "H.264 (libavcodec 59.37.100)", or "off" in a build without one.
std::string VideoEncoder();

/// InputError if RenderFilm cannot make a film of that name for any run: for an unknown extension,
/// or for a video in a build without an encoder.
void CheckFilmName(const std::filesystem::path& output);

/// InputError if `gl` is not a value of FilmOptions::gl, or is "auto" while MUJOCO_GL is set to
/// something other than egl or osmesa. RunError if MuJoCo already uses another library in this
/// process.
void CheckGl(const std::string& gl);

/// Films a finished run, using only the files in its folder. Filming needs no display and no GPU,
/// and repeats no simulation.
///
/// The folder holds `model.xml` and, per plant, `<plant>.state.csv` and `<plant>.csv`. The file
/// `plan.csv` is optional. The file `scenario.resolved.yaml` is optional if the world is flat, calm
/// and uniform. The file `<plant>.plan.csv` exists if the plant adopted new plans during the run.
/// The car is the first plant whose name begins with "mujoco", else the first by name; every other
/// plant is a translucent ghost. With `plants`, each of these plants has a separate picture without
/// ghosts. The film shows the recorded world with its friction patches, and the `overlays`. When
/// the car adopts a new plan, that plan gets a distinct color, and earlier plans become faint and
/// narrow. New plans of ghosts are not shown. Frame k shows the run at `from` + k / fps, with
/// states interpolated linearly. The last frame is at or before `to`, or the end of the longest
/// recording. A plant whose recording ends earlier stays at its last pose.
///
/// The function `progress`, which may be empty, is called after every frame with the finished
/// fraction, in (0, 1]. An exception of `progress` ends the film and is rethrown.
///
/// The extension of `output` selects the format; its folder is created if it is missing:
///   * `.mp4`: a video (H.264, yuv420p), playable while still loading. Videos are not available in
///     a build without an encoder. The file is either unchanged or a complete film, even after an
///     exception.
///   * `.webp`, `.apng`: an animated picture that repeats, also unchanged or complete.
///   * `.png`: one picture per frame. `frames/f.png` gives `frames/f_00000.png`,
///     `frames/f_00001.png`, ... Each file is either unchanged or complete; after an exception the
///     frames written so far remain. After the last frame, removes surplus frames of an older,
///     longer film of the same name.
///
/// Guarantees: the same folder, options and OpenGL library give the same bytes. A separate thread
/// encodes and writes pictures, up to three behind the drawing. That thread has ended when
/// RenderFilm returns or throws. RenderFilm must not run on two threads at a time. One process must
/// not draw with both OSMesa and EGL, because MuJoCo's table of OpenGL functions is global.
/// RenderFilm silences libav's log permanently. Afterwards, the caller's context is current again
/// with EGL; with OSMesa, no context is current. Errors: InputError for a folder that is missing,
/// incomplete or inconsistent, for an unknown extension and for options out of range; RunError when
/// the film cannot be drawn, encoded or written. Cost per frame of 1280x720, on two shared cores:
/// 0.1 to 0.15 s for draft and 0.3 to 0.6 s for film. Overlays and caption take a fifth of the time
/// of a draft frame. Memory: the recordings, and a few pictures for any length of film.
FilmReport RenderFilm(const std::filesystem::path& run_folder, const std::filesystem::path& output,
                      const FilmOptions& options,
                      const std::function<void(double fraction)>& progress = {});

/// Renders one picture of a film, which shows the run at `time` [s]. Writes it to `output`, a
/// `.png`, whose folder is created if it is missing. Ignores the options fps, from and to.
/// Otherwise works as RenderFilm. InputError for a time outside of the run.
void RenderPicture(const std::filesystem::path& run_folder, const std::filesystem::path& output,
                   double time, const FilmOptions& options);

}  // namespace trackbed
