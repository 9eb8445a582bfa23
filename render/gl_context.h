#pragma once

#include <memory>
#include <string>

namespace trackbed::render {

/// Kinds of libraries that can create an OpenGL context without a display.
enum class GlLibrary { kOsmesa, kEgl };

/// Returns the name of a library: "OSMesa" or "EGL".
const char* NameOf(GlLibrary library);

/// An OpenGL context without a display. The OpenGL context is current in its thread from
/// construction to destruction, so a thread can have at most one GlContext.
class GlContext {
 public:
  GlContext() = default;
  virtual ~GlContext() = default;
  GlContext(const GlContext&) = delete;
  GlContext& operator=(const GlContext&) = delete;

  [[nodiscard]] virtual GlLibrary library() const = 0;
  /// Returns the address of the OpenGL function with the given name; null if the library has no
  /// function with this name.
  [[nodiscard]] virtual void* Function(const char* name) const = 0;

  /// Returns OpenGL's version and renderer, such as "4.5 (Compatibility Profile) Mesa 22.3.6,
  /// llvmpipe (LLVM 15)".
  [[nodiscard]] std::string Version() const;
};

/// File names of the OpenGL libraries, as passed to the dynamic loader.
struct GlFiles {
  std::string osmesa = "libOSMesa.so.8";
  std::string egl = "libEGL.so.1";
};

/// Makes an OpenGL context of Mesa's software renderer, without a window system. Adds OSMesa's
/// symbols to the process, where MuJoCo looks for OpenGL functions. Throws RunError if OSMesa is
/// missing or cannot create a context.
std::unique_ptr<GlContext> MakeOsmesaContext(const std::string& file);

/// Makes an OpenGL context with EGL on the first graphics card whose driver can create one, else
/// with Mesa's software renderer. In all other respects, MakeEglContext behaves like
/// MakeOsmesaContext. On destruction, the EGL context restores the context that was current before.
std::unique_ptr<GlContext> MakeEglContext(const std::string& file);

}  // namespace trackbed::render
