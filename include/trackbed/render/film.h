#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace trackbed {

/// A camera, inset or overlay that can be selected for a video, and its name.
struct FilmChoice {
  std::string name;
  std::string summary;  ///< One-line summary.
};

/// Returns all cameras, beginning with the default camera.
std::vector<FilmChoice> Cameras();

/// Returns the insets that are not views of a camera. An inset is a small picture inside each frame
/// of the video.
std::vector<FilmChoice> FlatInsets();

/// Returns all overlays.
std::vector<FilmChoice> Overlays();

/// Returns the names of the overlays that videos show by default.
std::vector<std::string> DefaultOverlays();

/// Options of a video. The defaults are the same as those of `trackbed run --video`.
struct FilmOptions {
  /// Width of the frames [px], 64 to 7680; must be even for the format `.mp4`.
  int width = 1280;
  /// Height of the frames [px], 64 to 4320; must be even for the format `.mp4`.
  int height = 720;
  double fps = 30.0;             ///< Number of frames per second of simulated time, 1 to 240.
  std::string camera = "chase";  ///< Name of the camera, one of the names from Cameras().
  /// Quality of the frames, "draft" or "film". With the quality "draft", frames have one sample per
  /// pixel, and a dark patch under the car instead of a shadow. With the quality "film", frames
  /// have four samples per pixel, for smooth edges, and shadows from the model's lamps. Rendering
  /// with the quality "film" takes about four times as long as with "draft".
  std::string quality = "draft";
  /// The OpenGL library for rendering: "osmesa", "egl" or "auto". With "auto", the environment
  /// variable MUJOCO_GL selects the OpenGL library. If MUJOCO_GL is not set, "auto" selects EGL if
  /// the program is linked with EGL; otherwise OSMesa if OSMesa is installed; otherwise EGL.
  std::string gl = "auto";
  /// Name of the inset, one of Cameras() or FlatInsets(); empty: no inset.
  std::string inset{};
  /// Names of the overlays to show, from the list Overlays().
  std::vector<std::string> overlays = DefaultOverlays();
  /// Plants of the run to show side by side, each in a separate part of the frame. If the list is
  /// empty, one plant is shown as the car and all other plants as translucent cars (ghosts).
  std::vector<std::string> plants{};
  /// Title in the video's caption; if empty, the name of the run folder is the title.
  std::string title{};
  /// Note under the video's title; if the note is empty, the video shows the remark on the vehicle,
  /// if any.
  std::string note{};
  /// Time in the run at which the video begins [s]; nullopt: the first recorded time.
  std::optional<double> from{};
  /// Time in the run at which the video ends [s], at least `from`; nullopt: the last recorded time.
  std::optional<double> to{};
};

/// Contents of a finished video.
struct FilmReport {
  int frames = 0;
  double duration = 0.0;  ///< Simulated time from the first to the last frame [s].
  /// Name of the plant that is shown as the car; if several plants are shown side by side, the
  /// leftmost plant.
  std::string car;
  std::vector<std::string> ghosts;  ///< Names of the plants that are shown as translucent cars.
};

/// Returns the name of the video encoder, such as "H.264 (libavcodec 59.37.100)", or "off" in a
/// build without an encoder.
std::string VideoEncoder();

/// Checks the extension of a file name for RenderFilm. Throws InputError if the extension is
/// unknown, or if a build without a video encoder is asked for an extension other than `.png`.
void CheckFilmName(const std::filesystem::path& output);

/// Throws InputError if `gl` is not a value of FilmOptions::gl, or if `gl` is "auto" and MUJOCO_GL
/// is set to a value other than egl or osmesa. Throws RunError if MuJoCo already uses another
/// OpenGL library in this process.
void CheckGl(const std::string& gl);

/// Makes a video of a finished run from the files in the run folder. RenderFilm needs no display
/// and no GPU, and does not repeat the simulation.
///
/// The run folder must contain `model.xml` and, for each plant, `<plant>.state.csv` and
/// `<plant>.csv`. The file `plan.csv` is optional. The file `scenario.resolved.yaml` is optional if
/// the world is flat, calm and uniform. The file `<plant>.plan.csv` is read if the plant adopted
/// new plans during the run. The first plant whose name begins with "mujoco" is shown as the car.
/// If no plant's name begins with "mujoco", the first plant in alphabetical order is shown as the
/// car. Every other plant is shown as a translucent car (ghost). If FilmOptions::plants is not
/// empty, each of these plants is instead shown in a separate part of the frame, without ghosts.
/// The video shows the recorded world with its friction patches, and the overlays of
/// FilmOptions::overlays. When the car adopts a new plan, that plan gets a distinct color, and
/// earlier plans become faint and narrow. New plans of the plants that are shown as ghosts are not
/// drawn. Frame k shows the run at the time `from` + k / fps, with linear interpolation between
/// recorded states. The last frame shows a time at or before `to`; if `to` is not set, a time at or
/// before the end of the longest recording. A plant whose recording ends before the end of the
/// video stays at the last recorded pose.
///
/// The function `progress`, which may be empty, is called after every frame with the finished
/// fraction of the frames, in (0, 1]. If `progress` throws an exception, RenderFilm stops and
/// rethrows the exception.
///
/// The extension of `output` selects the format. RenderFilm creates the folder of `output` if the
/// folder is missing. The format `.mp4` is a video (H.264, yuv420p) that a player can start to play
/// before the file is loaded completely. A build without a video encoder can only write `.png`
/// files. Even after an exception, the `.mp4` file is either unchanged or a complete video. The
/// formats `.webp` and `.apng` are an animated picture that repeats. Even after an exception, the
/// `.webp` or `.apng` file is either unchanged or complete. The format `.png` has one file per
/// frame. For example, the name `frames/f.png` produces `frames/f_00000.png`, `frames/f_00001.png`,
/// ... Each `.png` file is either unchanged or complete. If `progress` throws an exception, the
/// frames written so far remain. After any other exception, the frames written so far remain only
/// if there was no earlier video of the same name. Additional `.png` frames of an older, longer
/// video with the same name are removed.
///
/// Guarantees: the same run folder, options and OpenGL library always produce the same bytes. A
/// separate thread encodes and writes the frames, at most three frames after they are drawn. The
/// encoding thread has ended when RenderFilm returns or throws. RenderFilm must not run on two
/// threads at a time. A process must not draw with both OSMesa and EGL, because MuJoCo's table of
/// OpenGL functions is global. RenderFilm silences libav's log permanently. After RenderFilm with
/// EGL, the OpenGL context of the caller is current again; after RenderFilm with OSMesa, no context
/// is current. Throws InputError if the run folder is missing, incomplete or inconsistent, if the
/// extension is unknown, or if an option is out of range. Throws RunError if the video cannot be
/// drawn, encoded or written. On two shared cores, a frame of 1280x720 takes 0.1 to 0.15 s with the
/// quality "draft", and 0.3 to 0.6 s with "film". Overlays and caption take a fifth of the time for
/// a frame of the quality "draft". RenderFilm keeps the recordings and a few frames in memory,
/// regardless of the video's length.
FilmReport RenderFilm(const std::filesystem::path& run_folder, const std::filesystem::path& output,
                      const FilmOptions& options,
                      const std::function<void(double fraction)>& progress = {});

/// Renders a single frame of a video, which shows the run at `time` [s]. Writes the frame to the
/// `.png` file `output`, and creates the folder of this file if the folder is missing.
/// RenderPicture ignores the options `fps`, `from` and `to`, and otherwise works like RenderFilm.
/// Throws InputError if `time` is outside the run.
void RenderPicture(const std::filesystem::path& run_folder, const std::filesystem::path& output,
                   double time, const FilmOptions& options);

}  // namespace trackbed
