#pragma once

#include <mujoco/mujoco.h>

#include <cstdint>
#include <memory>
#include <vector>

#include "render/gl_choice.h"
#include "render/image.h"

namespace trackbed::render {

/// MuJoCo's renderer without a display.
///
/// The renderer's OpenGL context is current in this thread during its lifetime, so there is at most
/// one per thread.
class Offscreen {
 public:
  /// Allocates buffers for pictures of the given size [px]. Each pixel is the mean of
  /// `supersampling` squared samples. The constructor sets the sizes in `model.vis` to those of the
  /// buffers. Throws RunError if MuJoCo cannot draw in the context.
  Offscreen(mjModel& model, int width, int height, int supersampling,
            std::unique_ptr<GlContext> gl = MakeGlContext("auto"));
  ~Offscreen();
  Offscreen(const Offscreen&) = delete;
  Offscreen& operator=(const Offscreen&) = delete;

  /// Renders the scene with the scene's own camera. Rendering takes 60 to 290 ms at 1280x720.
  void Render(mjvScene& scene, Image& image) { Render(scene, image, width_, height_); }
  /// Renders the scene in a size [px] of at most that of the buffers.
  void Render(mjvScene& scene, Image& image, int width, int height);

  /// The part of Render done by MuJoCo: draws the scene and reads its samples back.
  void Draw(mjvScene& scene) { Draw(scene, width_, height_); }

  /// Image of a printable ASCII character in MuJoCo's largest font, white on black. The glyph's
  /// `width` is the advance; every glyph has the same height.
  Image Glyph(char character);

 private:
  void MakeMujocoContext(const mjModel& model);
  void Draw(mjvScene& scene, int width, int height);

  int width_;
  int height_;
  int supersampling_;
  std::unique_ptr<GlContext> gl_;
  mjrContext context_;
  std::vector<std::uint8_t> upside_down_;  // samples as OpenGL stores them, with rows from the
                                           // bottom
};

}  // namespace trackbed::render
