#pragma once

#include <memory>
#include <string>

namespace trackbed::render {

/// The libraries that make OpenGL contexts without a display.
enum class GlLibrary { kOsmesa, kEgl };

/// "OSMesa" or "EGL".
const char* NameOf(GlLibrary library);

/// An OpenGL context without a display. Stays current in the thread that made it until it is
/// destroyed there: one at a time per thread.
class GlContext {
 public:
  GlContext() = default;
  virtual ~GlContext() = default;
  GlContext(const GlContext&) = delete;
  GlContext& operator=(const GlContext&) = delete;

  [[nodiscard]] virtual GlLibrary library() const = 0;
  /// The function of this name, or a null pointer.
  [[nodiscard]] virtual void* Function(const char* name) const = 0;

  /// OpenGL's version and renderer: "4.5 (Compatibility Profile) Mesa 22.3.6, llvmpipe (LLVM 15)".
  [[nodiscard]] std::string Version() const;
};

/// The files that the dynamic loader looks for.
struct GlFiles {
  std::string osmesa = "libOSMesa.so.8";
  std::string egl = "libEGL.so.1";
};

/// Mesa's software renderer, without a window system. Adds the library's symbols to the process,
/// where MuJoCo looks for them. RunError if the library is missing or makes no context.
std::unique_ptr<GlContext> MakeOsmesaContext(const std::string& file);

/// The first graphics card whose driver makes a context, else Mesa's software renderer. Otherwise
/// as MakeOsmesaContext. Makes the context current again that was current before, as it ends.
std::unique_ptr<GlContext> MakeEglContext(const std::string& file);

}  // namespace trackbed::render
