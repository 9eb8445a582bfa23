#pragma once

#include <memory>
#include <span>
#include <string>
#include <vector>

#include "render/camera.h"
#include "render/canvas.h"
#include "render/insets.h"
#include "render/offscreen.h"
#include "render/overlay.h"
#include "render/recording.h"
#include "render/scene.h"
#include "trackbed/render/film.h"

namespace trackbed::render {

/// Settings that trade quality against rendering time.
struct Quality {
  const char* name;
  int supersampling;  ///< number of supersampling samples along each side of a pixel
  bool shadows;
  bool quick;  ///< whether the film is encoded quickly; see FilmPictures::quick
};

/// Draws the frames of a film, with the recorded worlds, overlays and captions.
class Painter {
 public:
  /// A painter keeps references to the recordings and changes the visual settings of their models.
  /// At least one recording is required, and all recordings must have the same model. The
  /// recordings are shown side by side in parts of the frame, from left to right. The argument
  /// `options` determines the size, cameras, quality and overlays of the film. Throws InputError
  /// for unknown names in `options`, and RunError if there is no off-screen OpenGL.
  Painter(std::span<Recording> recordings, const FilmOptions& options);
  ~Painter();
  Painter(const Painter&) = delete;
  Painter& operator=(const Painter&) = delete;

  /// Draws the frame for the simulated time `time` [s].
  void Paint(double time, Image& image);

  /// Returns the scene of the first recording at `time` [s], as drawn by Paint with the main
  /// camera, but without two-dimensional overlays. The returned scene is valid until the next call
  /// of SceneAt or Paint.
  mjvScene& SceneAt(double time);
  [[nodiscard]] Offscreen& offscreen() { return offscreen_; }
  [[nodiscard]] const Quality& quality() const { return quality_; }

 private:
  struct Part;

  void Paint(Part& part, double time, Image& image);
  void PaintInset(Part& part, const PictureContext& context);

  FilmOptions options_;
  const Quality& quality_;
  const Camera& camera_;
  Inset inset_;
  Offscreen offscreen_;
  Font font_;
  std::vector<std::unique_ptr<Part>> parts_;
  Image part_image_;
  Image inset_image_;
};

}  // namespace trackbed::render
