#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "render/gl_context.h"

namespace trackbed::render {

/// The environment that determines the library for FilmOptions::gl "auto".
struct GlSurroundings {
  std::string mujoco_gl{};  ///< Value of the environment variable MUJOCO_GL; empty if unset.
  /// The library whose OpenGL functions MuJoCo uses in this process. MuJoCo looks for EGL first,
  /// then for OSMesa, and loads the functions once. There is no such library if the symbols of the
  /// process contain neither EGL nor OSMesa.
  std::optional<GlLibrary> in_process{};
};

/// The present environment of this process.
GlSurroundings ReadGlSurroundings();

/// The OpenGL libraries to try, in order. `gl` is FilmOptions::gl. Throws InputError for an unknown
/// name in `gl` or MUJOCO_GL. Throws RunError if the process cannot draw with the requested
/// library.
std::vector<GlLibrary> ChooseGl(const std::string& gl, const GlSurroundings& surroundings);

/// Makes a context of the first library that can create one. Throws RunError if no library can
/// create a context.
std::unique_ptr<GlContext> MakeGlContext(const std::vector<GlLibrary>& libraries,
                                         const GlFiles& files = {});

/// Makes a context by FilmOptions::gl and the environment of this process.
std::unique_ptr<GlContext> MakeGlContext(const std::string& gl);

}  // namespace trackbed::render
