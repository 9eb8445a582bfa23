#pragma once

#include <mujoco/mujoco.h>

#include <cstdint>
#include <memory>
#include <vector>

#include "render/gl_choice.h"
#include "render/image.h"

namespace trackbed::render {

/// MuJoCo's renderer without a display: scenes in, pictures out.
///
/// Its OpenGL context stays current in this thread as long as it lives: one at a time per thread.
class Offscreen {
 public:
  /// Buffers for pictures of the given size [px], each pixel the mean of `supersampling` squared
  /// samples. Changes `model.vis` accordingly. RunError when MuJoCo cannot draw in the context.
  Offscreen(mjModel& model, int width, int height, int supersampling,
            std::unique_ptr<GlContext> gl = MakeGlContext("auto"));
  ~Offscreen();
  Offscreen(const Offscreen&) = delete;
  Offscreen& operator=(const Offscreen&) = delete;

  /// The scene from its own camera. 60 to 290 ms at 1280x720.
  void Render(mjvScene& scene, Image& image) { Render(scene, image, width_, height_); }
  /// The same in a size [px] that is at most the one of the buffers.
  void Render(mjvScene& scene, Image& image, int width, int height);

  /// MuJoCo's part of Render alone: draws the scene and reads its samples back.
  void Draw(mjvScene& scene) { Draw(scene, width_, height_); }

  /// A printable ASCII character of MuJoCo's big font at its largest, white on black. `width` is
  /// the pen's advance; every glyph has the same height.
  Image Glyph(char character);

 private:
  void MakeMujocoContext(const mjModel& model);
  void Draw(mjvScene& scene, int width, int height);

  int width_;
  int height_;
  int supersampling_;
  std::unique_ptr<GlContext> gl_;
  mjrContext context_;
  std::vector<std::uint8_t> upside_down_;  // OpenGL's rows begin at the bottom
};

}  // namespace trackbed::render
