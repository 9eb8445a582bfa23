#pragma once

#include <mujoco/mujoco.h>

#include <cstdint>
#include <memory>
#include <vector>

#include "render/gl_choice.h"
#include "render/image.h"

namespace trackbed::render {

/// Renders MuJoCo scenes without a display.
///
/// The renderer's OpenGL context is current in the renderer's thread during its lifetime, so a
/// thread can have at most one renderer.
class Offscreen {
 public:
  /// Allocates buffers for images of the given size [px]. Each pixel of an image is the mean of a
  /// square of `supersampling` by `supersampling` samples. The constructor of Offscreen sets the
  /// buffer sizes in `model.vis`. Throws RunError if MuJoCo cannot draw in the OpenGL context.
  Offscreen(mjModel& model, int width, int height, int supersampling,
            std::unique_ptr<GlContext> gl = MakeGlContext("auto"));
  ~Offscreen();
  Offscreen(const Offscreen&) = delete;
  Offscreen& operator=(const Offscreen&) = delete;

  /// Renders the scene with the camera stored in the scene. Rendering an image of 1280x720 takes 60
  /// to 290 ms.
  void Render(mjvScene& scene, Image& image) { Render(scene, image, width_, height_); }
  /// Renders the scene with the given size [px], which must not exceed the size of the buffers.
  void Render(mjvScene& scene, Image& image, int width, int height);

  /// Draws the scene with MuJoCo and reads back the samples, without averaging them into pixels.
  void Draw(mjvScene& scene) { Draw(scene, width_, height_); }

  /// Returns the image of a printable ASCII character in MuJoCo's largest font, white on black. The
  /// width of a character's image is the character's advance; the images of all characters have the
  /// same height.
  Image Glyph(char character);

 private:
  void MakeMujocoContext(const mjModel& model);
  void Draw(mjvScene& scene, int width, int height);

  int width_;
  int height_;
  int supersampling_;
  std::unique_ptr<GlContext> gl_;
  mjrContext context_;
  // samples of the image in OpenGL's order, which begins with the bottom row
  std::vector<std::uint8_t> upside_down_;
};

}  // namespace trackbed::render
