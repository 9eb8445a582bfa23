#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace trackbed {

/// Something drawn over the recorded world that can be left out, or a point of view.
struct FilmChoice {
  std::string name;
  std::string summary;  ///< one line
};

/// Every camera there is, the default first.
std::vector<FilmChoice> Cameras();

/// What an inset may show beside another camera's picture.
std::vector<FilmChoice> FlatInsets();

/// Every overlay there is.
std::vector<FilmChoice> Overlays();

/// The names of the overlays of films that name none.
std::vector<std::string> DefaultOverlays();

/// How a film is taken. The defaults are what `trackbed run --video` makes.
struct FilmOptions {
  int width = 1280;              ///< [px], 64 to 7680, even for a video
  int height = 720;              ///< [px], 64 to 4320, even for a video
  double fps = 30.0;             ///< frames per second of the run, 1 to 240
  std::string camera = "chase";  ///< a name of Cameras()
  /// "draft": one sample a pixel and a painted shadow under the car. "film": four samples, for
  /// smooth edges, and the shadows that the model's lamps cast, for about four times the time.
  std::string quality = "draft";
  /// The library that draws: "osmesa", "egl" or "auto", which is that of the environment variable
  /// MUJOCO_GL, else EGL if the program links it, else OSMesa if it is installed, else EGL.
  std::string gl = "auto";
  /// Another camera, or a name of FlatInsets(), for a small picture in the picture; empty: none.
  std::string inset{};
  std::vector<std::string> overlays = DefaultOverlays();  ///< names of Overlays()
  /// Plants of the run, each with a part of the picture of its own, side by side, as the car and
  /// alone. None: one picture, the car and the other plants as its ghosts.
  std::vector<std::string> plants{};
  std::string title{};  ///< in the caption; empty: the run folder's name
  std::string note{};   ///< under the title; empty: what to know of the vehicle, if anything
  std::optional<double> from{};  ///< [s] of the run, where the film begins; none: at its first time
  std::optional<double> to{};    ///< [s], at least `from`, where it ends; none: at its last time
};

/// What was filmed.
struct FilmReport {
  int frames = 0;
  double duration = 0.0;            ///< [s] of the run, first to last frame
  std::string car;                  ///< the plant shown as the car, the leftmost one
  std::vector<std::string> ghosts;  ///< the plants shown as translucent cars
};

/// What encodes videos, such as "H.264 (libavcodec 59.37.100)", or "off" in a build without them.
std::string VideoEncoder();

/// InputError when RenderFilm could not make a film of that name, whatever the run: an unknown
/// extension, or a video in a build without.
void CheckFilmName(const std::filesystem::path& output);

/// InputError when there is no such FilmOptions::gl, or "auto" with a MUJOCO_GL other than egl,
/// osmesa or nothing; RunError when MuJoCo uses another library in this process.
void CheckGl(const std::string& gl);

/// Films a finished run from its folder alone: no display, no GPU, nothing is simulated again.
///
/// The folder holds `model.xml` and, per plant, `<plant>.state.csv` and `<plant>.csv`; `plan.csv`
/// may be absent, `scenario.resolved.yaml` too where the world is flat, calm and the same all over,
/// and `<plant>.plan.csv` is where a plant took up new plans on its way. The car is
/// the first plant whose name begins with "mujoco", else the first by name; every other plant is a
/// translucent ghost. With `plants`, each of them has a picture of its own, without ghosts. Shown
/// are the recorded world with its friction patches, and the `overlays`. From the moment when the
/// car takes up a new plan, that one is shown in a color of its own and those before it faint and
/// narrow; new plans of the ghosts are not shown. Frame k is the run at `from` + k / fps, states in
/// between interpolated linearly; the last frame is the last one not after `to`, or after the end
/// of the longest recording; a plant that ends before stays where it stopped.
///
/// `progress` (may be empty) is called after every frame with the fraction done, in (0, 1]. What it
/// throws ends the film and is passed on.
///
/// `output` says by its extension what is made; its folder is made if it is missing:
///  * `.mp4`: a video, H.264, yuv420p, playable while still loading; not in a build without. The
///    file is either what it was or a complete film, also after an exception.
///  * `.webp`, `.apng`: the same as an animated picture that repeats.
///  * `.png`: a picture per frame. `frames/f.png` asks for `frames/f_00000.png`,
///    `frames/f_00001.png`, ... Each file is either what it was or complete; after an exception
///    those written before stay. When the last one is written,
///    the frames that an older and longer film of the same name left beyond it are removed.
///
/// Guarantees: the same folder, options and OpenGL library give the same bytes. Pictures are
/// encoded and written in a thread of their own, up to three behind the drawing; it has ended when
/// this returns or throws. Does not: run on two threads at a time, or draw with OSMesa and with EGL
/// in one process (the table of OpenGL's functions that MuJoCo loads is global). Silences libav's
/// log for good. With EGL, the caller's own context is current again afterwards; with OSMesa, none
/// is. Errors: InputError for a folder that is missing, incomplete or inconsistent, for an unknown
/// extension and for options out of range; RunError when the film cannot be drawn, encoded or
/// written.
/// Cost: per frame of 1280x720, on two cores that others use too, draft 0.1 to 0.15 s and film 0.3
/// to 0.6 s; overlays and caption take a fifth of a draft frame. Memory: the recordings, and a few
/// pictures however long the film.
FilmReport RenderFilm(const std::filesystem::path& run_folder, const std::filesystem::path& output,
                      const FilmOptions& options,
                      const std::function<void(double fraction)>& progress = {});

/// One picture of such a film: the run at `time` [s], written to `output`, a `.png`, whose folder
/// is made if it is missing. Of the options fps, from and to have no meaning here. Otherwise as
/// RenderFilm; InputError, too, for a time outside of the run.
void RenderPicture(const std::filesystem::path& run_folder, const std::filesystem::path& output,
                   double time, const FilmOptions& options);

}  // namespace trackbed
