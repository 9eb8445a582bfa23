#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "render/gl_context.h"

namespace trackbed::render {

/// Properties of the process that determine the OpenGL library if FilmOptions::gl is "auto".
struct GlSurroundings {
  std::string mujoco_gl{};  ///< Value of the environment variable MUJOCO_GL; empty if unset.
  /// Library whose OpenGL functions MuJoCo uses in this process. MuJoCo looks for the functions of
  /// EGL first, then for those of OSMesa, and loads the functions only once. The loaded OpenGL
  /// library is nullopt if the process has the symbols of neither EGL nor OSMesa.
  std::optional<GlLibrary> in_process{};
};

/// Reads the environment variable MUJOCO_GL and finds the loaded OpenGL library of this process.
GlSurroundings ReadGlSurroundings();

/// Returns the OpenGL libraries to try, in the order of the attempts. `gl` is the value of the
/// option FilmOptions::gl. Throws InputError for an unknown name in `gl` or MUJOCO_GL. Throws
/// RunError if the process cannot draw with the requested library.
std::vector<GlLibrary> ChooseGl(const std::string& gl, const GlSurroundings& surroundings);

/// Makes an OpenGL context with the first library that can create an OpenGL context. Throws
/// RunError if none of the libraries can create an OpenGL context.
std::unique_ptr<GlContext> MakeGlContext(const std::vector<GlLibrary>& libraries,
                                         const GlFiles& files = {});

/// Makes an OpenGL context with the library determined by `gl`, the value of FilmOptions::gl, and
/// by the environment of this process.
std::unique_ptr<GlContext> MakeGlContext(const std::string& gl);

}  // namespace trackbed::render
