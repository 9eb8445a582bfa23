#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace trackbed {

/// A camera, inset or overlay that a film can use, with its name.
struct FilmChoice {
  std::string name;
  std::string summary;  ///< One-line summary.
};

/// Returns all cameras, beginning with the default.
std::vector<FilmChoice> Cameras();

/// Returns the insets that are not cameras. An inset is a small picture inside the picture.
std::vector<FilmChoice> FlatInsets();

/// Returns all overlays.
std::vector<FilmChoice> Overlays();

/// Returns the names of the overlays that films show by default.
std::vector<std::string> DefaultOverlays();

/// Options of a film. The defaults are those of `trackbed run --video`.
struct FilmOptions {
  int width = 1280;              ///< Width [px], 64 to 7680; an even number for a video.
  int height = 720;              ///< Height [px], 64 to 4320; an even number for a video.
  double fps = 30.0;             ///< Frames per second of simulated time, 1 to 240.
  std::string camera = "chase";  ///< Name of the camera, one of Cameras().
  /// Quality of the pictures, "draft" or "film". A draft has one sample per pixel, and a dark patch
  /// under the car instead of a shadow. The quality "film" has four samples per pixel, for smooth
  /// edges, and the shadows of the model's lamps. Rendering with "film" takes about four times as
  /// long.
  std::string quality = "draft";
  /// The OpenGL library: "osmesa", "egl" or "auto". With "auto", the environment variable MUJOCO_GL
  /// selects the library. If MUJOCO_GL is not set, the library is EGL if the program links EGL,
  /// else OSMesa if it is installed, else EGL.
  std::string gl = "auto";
  /// Name of the inset, from Cameras() or FlatInsets(); empty: no inset.
  std::string inset{};
  std::vector<std::string> overlays = DefaultOverlays();  ///< Names of the overlays, from
                                                          ///< Overlays().
  /// Plants of the run to show side by side, each in a separate part of the picture. If empty, a
  /// single picture shows one plant as the car and the other plants as ghosts.
  std::vector<std::string> plants{};
  std::string title{};  ///< Title in the caption; empty: the run folder's name.
  std::string note{};   ///< Note under the title; empty: a remark on the vehicle, if any.
  /// Time in the run at which the film begins [s]; nullopt: at the first recorded time.
  std::optional<double> from{};
  /// Time in the run at which the film ends [s], at least `from`; nullopt: at the last recorded
  /// time.
  std::optional<double> to{};
};

/// Contents of a finished film.
struct FilmReport {
  int frames = 0;
  double duration = 0.0;            ///< Simulated time from the first to the last frame [s].
  std::string car;                  ///< Plant that is shown as the car; with several plants side by
                                    ///< side, the leftmost.
  std::vector<std::string> ghosts;  ///< Plants shown as translucent cars.
};

/// Returns the name of the video encoder, such as "H.264 (libavcodec 59.37.100)"; "off" in a build
/// without an encoder.
std::string VideoEncoder();

/// Throws InputError if RenderFilm can never write a file of this name: if the extension is
/// unknown, or if the extension is that of a video and the build has no encoder.
void CheckFilmName(const std::filesystem::path& output);

/// Throws InputError if `gl` is not a value of FilmOptions::gl, or if `gl` is "auto" and MUJOCO_GL
/// is set to a value other than egl or osmesa. Throws RunError if MuJoCo already uses another
/// OpenGL library in this process.
void CheckGl(const std::string& gl);

/// Makes a film of a finished run from the files in its folder. No display, GPU or new simulation
/// is needed.
///
/// The folder must contain `model.xml` and, for each plant, `<plant>.state.csv` and `<plant>.csv`.
/// The file `plan.csv` is optional. The file `scenario.resolved.yaml` is optional if the world is
/// flat, calm and uniform. The file `<plant>.plan.csv` exists if the plant adopted new plans during
/// the run. The first plant whose name begins with "mujoco", else the first plant by name, is shown
/// as the car; every other plant is a translucent ghost. If FilmOptions::plants is not empty, each
/// of these plants has a separate picture without ghosts. The film shows the recorded world with
/// its friction patches, and the overlays of FilmOptions::overlays. When the car adopts a new plan,
/// that plan gets a distinct color, and earlier plans become faint and narrow. New plans of ghosts
/// are not shown. Frame k shows the run at `from` + k / fps, with states interpolated linearly. The
/// last frame is at or before `to`, or the end of the longest recording if `to` is not given. A
/// plant whose recording ends earlier stays at its last pose.
///
/// The function `progress`, which may be empty, is called after every frame with the finished
/// fraction, in (0, 1]. If `progress` throws an exception, filming ends and the exception is
/// rethrown.
///
/// The extension of `output` selects the format. The folder of `output` is created if it is
/// missing.
///   * `.mp4`: a video (H.264, yuv420p) that can be played while it is still loading. A build
///     without an encoder cannot write videos. The file is either unchanged or a complete film,
///     even after an exception.
///   * `.webp`, `.apng`: an animated picture that repeats. The file is either unchanged or
///     complete.
///   * `.png`: one file per frame. The name `frames/f.png` gives `frames/f_00000.png`,
///     `frames/f_00001.png`, ... Each file is either unchanged or complete; after an exception, the
///     frames written so far remain. Surplus frames of an older, longer film of the same name are
///     removed.
///
/// Guarantees: the same folder, options and OpenGL library give the same bytes. A separate thread
/// encodes and writes pictures, and is at most three pictures behind the drawing. The thread has
/// ended when RenderFilm returns or throws. RenderFilm must not run on two threads at a time. One
/// process must not draw with both OSMesa and EGL, because MuJoCo's table of OpenGL functions is
/// global. RenderFilm silences libav's log permanently. Afterwards, the caller's context is current
/// again with EGL; with OSMesa, no context is current. Errors: InputError for a folder that is
/// missing, incomplete or inconsistent, for an unknown extension and for options out of range;
/// RunError if the film cannot be drawn, encoded or written. On two shared cores, a frame of
/// 1280x720 takes 0.1 to 0.15 s with the quality "draft", and 0.3 to 0.6 s with "film". Overlays
/// and caption take a fifth of the time of a draft frame. The memory holds the recordings and a few
/// pictures, regardless of the film's length.
FilmReport RenderFilm(const std::filesystem::path& run_folder, const std::filesystem::path& output,
                      const FilmOptions& options,
                      const std::function<void(double fraction)>& progress = {});

/// Renders one picture of a film, which shows the run at `time` [s]. Writes the picture to
/// `output`, a `.png` file whose folder is created if it is missing. The options fps, from and to
/// are ignored. Otherwise RenderPicture works like RenderFilm. Throws InputError for a time outside
/// the run.
void RenderPicture(const std::filesystem::path& run_folder, const std::filesystem::path& output,
                   double time, const FilmOptions& options);

}  // namespace trackbed
