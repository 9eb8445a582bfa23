#pragma once

#include <string>
#include <vector>

#include "render/camera.h"
#include "render/caption.h"
#include "render/offscreen.h"
#include "render/recording.h"
#include "render/scene.h"
#include "trackbed/render/film.h"

namespace trackbed::render {

struct Quality;

/// What the colours of a film of `recording` stand for.
std::vector<LegendEntry> LegendOf(const Recording& recording);

/// Makes the pictures of a film: the recorded world, what is drawn over it, and the caption.
class Painter {
 public:
  /// Borrows the recording, and its model's visual settings, for its lifetime. Size, camera and
  /// quality are those of `options`. InputError for names that there are none of; RunError when
  /// there is no off-screen OpenGL.
  Painter(Recording& recording, const FilmOptions& options);

  /// The picture at `time` [s].
  void Paint(double time, Image& image);

  /// What Paint draws at `time` [s], without the caption, and where; valid until the next call.
  mjvScene& SceneAt(double time);
  [[nodiscard]] Offscreen& offscreen() { return offscreen_; }

 private:
  Recording& recording_;
  const Quality& quality_;
  const Camera& camera_;
  CameraSubject subject_;
  double aspect_;
  Offscreen offscreen_;
  Font font_;
  FilmScene scene_;
  std::vector<LegendEntry> legend_;
};

}  // namespace trackbed::render
