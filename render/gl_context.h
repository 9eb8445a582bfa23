#pragma once

#include <memory>
#include <string>

namespace trackbed::render {

/// Libraries that create OpenGL contexts without a display.
enum class GlLibrary { kOsmesa, kEgl };

/// Name of a library: "OSMesa" or "EGL".
const char* NameOf(GlLibrary library);

/// An OpenGL context without a display. An OpenGL context is current in its thread from
/// construction to destruction, so there is at most one per thread.
class GlContext {
 public:
  GlContext() = default;
  virtual ~GlContext() = default;
  GlContext(const GlContext&) = delete;
  GlContext& operator=(const GlContext&) = delete;

  [[nodiscard]] virtual GlLibrary library() const = 0;
  /// The OpenGL function with this name, or a null pointer.
  [[nodiscard]] virtual void* Function(const char* name) const = 0;

  /// OpenGL's version and renderer: "4.5 (Compatibility Profile) Mesa 22.3.6, llvmpipe (LLVM 15)".
  [[nodiscard]] std::string Version() const;
};

/// Library file names passed to the dynamic loader.
struct GlFiles {
  std::string osmesa = "libOSMesa.so.8";
  std::string egl = "libEGL.so.1";
};

/// Makes a context of Mesa's software renderer, without a window system. Adds the library's symbols
/// to the process, where MuJoCo looks for them. Throws RunError if the library is missing or
/// creates no context.
std::unique_ptr<GlContext> MakeOsmesaContext(const std::string& file);

/// Makes a context of the first graphics card whose driver creates one, else of Mesa's software
/// renderer. MakeEglContext otherwise behaves like MakeOsmesaContext. The context's destructor
/// restores the context that was current before.
std::unique_ptr<GlContext> MakeEglContext(const std::string& file);

}  // namespace trackbed::render
