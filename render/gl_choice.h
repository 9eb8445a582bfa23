#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "render/gl_context.h"

namespace trackbed::render {

/// The environment of FilmOptions::gl "auto".
struct GlSurroundings {
  std::string mujoco_gl{};  ///< the environment variable MUJOCO_GL; empty if it is not set
  /// The library whose functions MuJoCo uses in this process: it looks for EGL first, then for
  /// OSMesa, and loads the functions once. None: neither has added its symbols to the process.
  std::optional<GlLibrary> in_process{};
};

/// The surroundings of this process now.
GlSurroundings ReadGlSurroundings();

/// The libraries to try, in this order. `gl` is FilmOptions::gl. InputError for an unknown name
/// there or in MUJOCO_GL; RunError if the process cannot draw with the library that is asked for.
std::vector<GlLibrary> ChooseGl(const std::string& gl, const GlSurroundings& surroundings);

/// A context of the first of these libraries that makes one. RunError if none does.
std::unique_ptr<GlContext> MakeGlContext(const std::vector<GlLibrary>& libraries,
                                         const GlFiles& files = {});

/// A context as FilmOptions::gl asks for, in the surroundings of this process.
std::unique_ptr<GlContext> MakeGlContext(const std::string& gl);

}  // namespace trackbed::render
