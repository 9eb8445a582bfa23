#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "render/gl_context.h"

namespace trackbed::render {

/// The environment that determines FilmOptions::gl "auto".
struct GlSurroundings {
  std::string mujoco_gl{};  ///< the environment variable MUJOCO_GL; empty if unset
  /// The library whose functions MuJoCo uses in this process: it looks for EGL first, then for
  /// OSMesa, and loads the functions once. None if neither is among the symbols of the process.
  std::optional<GlLibrary> in_process{};
};

/// The present environment of this process.
GlSurroundings ReadGlSurroundings();

/// The libraries to try, in order. `gl` is FilmOptions::gl. InputError for an unknown name there or
/// in MUJOCO_GL; RunError if the process cannot draw with the requested library.
std::vector<GlLibrary> ChooseGl(const std::string& gl, const GlSurroundings& surroundings);

/// A context of the first library that can create one. RunError if none can.
std::unique_ptr<GlContext> MakeGlContext(const std::vector<GlLibrary>& libraries,
                                         const GlFiles& files = {});

/// A context by FilmOptions::gl and the environment of this process.
std::unique_ptr<GlContext> MakeGlContext(const std::string& gl);

}  // namespace trackbed::render
