#include "render/gl_choice.h"

#include <dlfcn.h>

#include <algorithm>
#include <cctype>
#include <cstdlib>

#include "trackbed/core/error.h"
#include "trackbed/core/spelling.h"

namespace trackbed::render {
namespace {

/// Converts the value of MUJOCO_GL to lower case, as MuJoCo's Python package does.
std::string Lowered(std::string text) {
  std::transform(text.begin(), text.end(), text.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return text;
}

/// Returns the OpenGL library that the option `gl` requests; nullopt for "auto".
std::optional<GlLibrary> RequestedLibrary(const std::string& gl, const std::string& mujoco_gl) {
  if (gl == "egl" || gl == "osmesa") {
    return gl == "egl" ? GlLibrary::kEgl : GlLibrary::kOsmesa;
  }
  if (gl != "auto") {
    throw InputError(
        Problem{.key = "gl",
                .message = "unknown OpenGL library " + UnknownName(gl, {"auto", "egl", "osmesa"})});
  }
  const std::string wish = Lowered(mujoco_gl);
  if (wish == "egl" || wish == "osmesa") {
    return wish == "egl" ? GlLibrary::kEgl : GlLibrary::kOsmesa;
  }
  if (!wish.empty()) {
    throw InputError(Problem{
        .key = "MUJOCO_GL",
        .message = fmt::format("'{}'; films are drawn without a window: set this environment "
                               "variable to egl or osmesa, unset it, or pass --gl egl or "
                               "--gl osmesa",
                               mujoco_gl)});
  }
  return std::nullopt;
}

[[noreturn]] void RefuseSecondLibrary(GlLibrary requested, GlLibrary in_process) {
  throw RunError(fmt::format(
      "cannot draw with {}: this program links {} or has drawn with it, and MuJoCo uses one "
      "library "
      "for OpenGL in a process; choose {} or auto, or draw in another process",
      NameOf(requested), NameOf(in_process), in_process == GlLibrary::kEgl ? "egl" : "osmesa"));
}

}  // namespace

GlSurroundings ReadGlSurroundings() {
  GlSurroundings surroundings;
  if (const char* wish = std::getenv("MUJOCO_GL"); wish != nullptr) {
    surroundings.mujoco_gl = wish;
  }
  // Searches for the OpenGL functions in the same places and order as MuJoCo's render/glad/glad.c.
  void* const process = dlopen(nullptr, RTLD_NOW);
  if (process != nullptr) {
    if (dlsym(process, "eglGetProcAddress") != nullptr) {
      surroundings.in_process = GlLibrary::kEgl;
    } else if (dlsym(process, "OSMesaGetProcAddress") != nullptr) {
      surroundings.in_process = GlLibrary::kOsmesa;
    }
    dlclose(process);
  }
  return surroundings;
}

std::vector<GlLibrary> ChooseGl(const std::string& gl, const GlSurroundings& surroundings) {
  const std::optional<GlLibrary> requested = RequestedLibrary(gl, surroundings.mujoco_gl);
  if (surroundings.in_process) {
    if (requested && requested != surroundings.in_process) {
      RefuseSecondLibrary(*requested, *surroundings.in_process);
    }
    return {*surroundings.in_process};
  }
  if (requested) {
    return {*requested};
  }
  return {GlLibrary::kOsmesa, GlLibrary::kEgl};
}

std::unique_ptr<GlContext> MakeGlContext(const std::vector<GlLibrary>& libraries,
                                         const GlFiles& files) {
  std::string reasons;
  for (GlLibrary library : libraries) {
    try {
      return library == GlLibrary::kOsmesa ? MakeOsmesaContext(files.osmesa)
                                           : MakeEglContext(files.egl);
    } catch (const RunError& error) {
      if (libraries.size() == 1) {
        throw;
      }
      reasons += fmt::format("{}{}", reasons.empty() ? "" : "; ", error.what());
    }
  }
  throw RunError(
      "cannot draw without OSMesa or EGL; install libosmesa6 (Debian 12 and 13), or libegl1 and "
      "libgl1-mesa-dri (Debian 12, 13 and newer): " +
      reasons);
}

std::unique_ptr<GlContext> MakeGlContext(const std::string& gl) {
  return MakeGlContext(ChooseGl(gl, ReadGlSurroundings()));
}

}  // namespace trackbed::render
