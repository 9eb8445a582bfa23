// Defining EGL_NO_X11 keeps EGL's headers from including the X11 headers, which define macros such
// as None.
#define EGL_NO_X11
#include <EGL/egl.h>
#include <EGL/eglext.h>

#include <array>
#include <vector>

#include "render/gl_context.h"
#include "render/runtime_library.h"
#include "trackbed/core/error.h"

namespace trackbed::render {
namespace {

constexpr const char* kPackage = "libegl1, with libgl1-mesa-dri";

/// Pointers to the functions of EGL 1.5, in a shared library that is loaded on first use.
struct EglFunctions {
  explicit EglFunctions(const RuntimeLibrary& library)
      : get_address(library.Find<decltype(eglGetProcAddress)>("eglGetProcAddress")),
        get_error(library.Find<decltype(eglGetError)>("eglGetError")),
        get_display(library.Find<decltype(eglGetPlatformDisplay)>("eglGetPlatformDisplay")),
        initialize(library.Find<decltype(eglInitialize)>("eglInitialize")),
        choose_config(library.Find<decltype(eglChooseConfig)>("eglChooseConfig")),
        query_api(library.Find<decltype(eglQueryAPI)>("eglQueryAPI")),
        bind_api(library.Find<decltype(eglBindAPI)>("eglBindAPI")),
        create(library.Find<decltype(eglCreateContext)>("eglCreateContext")),
        destroy(library.Find<decltype(eglDestroyContext)>("eglDestroyContext")),
        make_current(library.Find<decltype(eglMakeCurrent)>("eglMakeCurrent")),
        current_context(library.Find<decltype(eglGetCurrentContext)>("eglGetCurrentContext")),
        current_display(library.Find<decltype(eglGetCurrentDisplay)>("eglGetCurrentDisplay")),
        current_surface(library.Find<decltype(eglGetCurrentSurface)>("eglGetCurrentSurface")) {}

  decltype(&eglGetProcAddress) get_address;
  decltype(&eglGetError) get_error;
  decltype(&eglGetPlatformDisplay) get_display;
  decltype(&eglInitialize) initialize;
  decltype(&eglChooseConfig) choose_config;
  decltype(&eglQueryAPI) query_api;
  decltype(&eglBindAPI) bind_api;
  decltype(&eglCreateContext) create;
  decltype(&eglDestroyContext) destroy;
  decltype(&eglMakeCurrent) make_current;
  decltype(&eglGetCurrentContext) current_context;
  decltype(&eglGetCurrentDisplay) current_display;
  decltype(&eglGetCurrentSurface) current_surface;
};

/// Returns EGL displays that need no screen, in the order to try: one for each device, as in
/// MuJoCo's Python package, then Mesa's surfaceless platform. EGL lists graphics cards before
/// software renderers.
std::vector<EGLDisplay> OffscreenDisplays(const EglFunctions& egl) {
  std::vector<EGLDisplay> displays;
  std::array<EGLDeviceEXT, 16> devices{};
  EGLint count = 0;
  auto* const query =
      reinterpret_cast<PFNEGLQUERYDEVICESEXTPROC>(egl.get_address("eglQueryDevicesEXT"));
  if (query != nullptr &&
      query(static_cast<EGLint>(devices.size()), devices.data(), &count) == EGL_TRUE) {
    for (std::size_t i = 0; i < static_cast<std::size_t>(count); ++i) {
      displays.push_back(egl.get_display(EGL_PLATFORM_DEVICE_EXT, devices[i], nullptr));
    }
  }
  displays.push_back(egl.get_display(EGL_PLATFORM_SURFACELESS_MESA, EGL_DEFAULT_DISPLAY, nullptr));
  return displays;
}

/// The OpenGL context, surfaces and display that are current in this thread, saved to be restored
/// later.
struct Current {
  explicit Current(const EglFunctions& egl)
      : api(egl.query_api()),
        display(egl.current_display()),
        draw(egl.current_surface(EGL_DRAW)),
        read(egl.current_surface(EGL_READ)),
        context(egl.current_context()) {}

  EGLenum api;
  EGLDisplay display;
  EGLSurface draw;
  EGLSurface read;
  EGLContext context;
};

class EglContext final : public GlContext {
 public:
  explicit EglContext(const std::string& file)
      : egl_(RuntimeLibrary(file, kPackage)), before_(egl_) {
    EGLint error = EGL_SUCCESS;
    for (EGLDisplay display : OffscreenDisplays(egl_)) {
      error = Start(display);
      if (error == EGL_SUCCESS) {
        // Makes EGL's symbols visible in the whole process, where MuJoCo searches for them.
        const RuntimeLibrary global(file, kPackage, RuntimeLibrary::Symbols::kGlobal);
        return;
      }
    }
    egl_.bind_api(before_.api);
    throw RunError(
        fmt::format("EGL makes no OpenGL context without a display (error {:#x}): install the EGL "
                    "driver of the graphics card, or Debian's packages libegl-mesa0 and "
                    "libgl1-mesa-dri",
                    error));
  }

  // The destructor does not terminate the display, because other code in the process may share it.
  ~EglContext() override {
    if (before_.context == EGL_NO_CONTEXT) {
      egl_.make_current(display_, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
    } else {
      egl_.make_current(before_.display, before_.draw, before_.read, before_.context);
    }
    egl_.destroy(display_, context_);
    egl_.bind_api(before_.api);
  }

  [[nodiscard]] GlLibrary library() const override { return GlLibrary::kEgl; }
  [[nodiscard]] void* Function(const char* name) const override {
    return reinterpret_cast<void*>(egl_.get_address(name));
  }

 private:
  /// Creates an OpenGL context on the display and makes the context current. Returns EGL_SUCCESS or
  /// an EGL error code.
  EGLint Start(EGLDisplay display) {
    constexpr std::array<EGLint, 5> kConfigAttributes{
        EGL_SURFACE_TYPE, EGL_PBUFFER_BIT, EGL_RENDERABLE_TYPE, EGL_OPENGL_BIT, EGL_NONE};
    EGLConfig config = nullptr;
    EGLint count = 0;
    if (egl_.initialize(display, nullptr, nullptr) != EGL_TRUE ||
        egl_.bind_api(EGL_OPENGL_API) != EGL_TRUE ||
        egl_.choose_config(display, kConfigAttributes.data(), &config, 1, &count) != EGL_TRUE) {
      return egl_.get_error();
    }
    if (count < 1) {
      return EGL_BAD_CONFIG;
    }
    // Without attributes, EGL creates a context with the compatibility profile, which MuJoCo needs.
    context_ = egl_.create(display, config, EGL_NO_CONTEXT, nullptr);
    if (context_ == EGL_NO_CONTEXT) {
      return egl_.get_error();
    }
    // The OpenGL context needs no surface, since MuJoCo draws into its own buffers.
    if (egl_.make_current(display, EGL_NO_SURFACE, EGL_NO_SURFACE, context_) != EGL_TRUE) {
      const EGLint error = egl_.get_error();
      egl_.destroy(display, context_);
      return error;
    }
    display_ = display;
    return EGL_SUCCESS;
  }

  EglFunctions egl_;
  Current before_;
  EGLDisplay display_ = EGL_NO_DISPLAY;
  EGLContext context_ = EGL_NO_CONTEXT;
};

}  // namespace

std::unique_ptr<GlContext> MakeEglContext(const std::string& file) {
  return std::make_unique<EglContext>(file);
}

}  // namespace trackbed::render
