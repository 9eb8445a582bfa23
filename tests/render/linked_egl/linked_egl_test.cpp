#define EGL_NO_X11
#include <EGL/egl.h>
#include <EGL/eglext.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>

#include "render/gl_choice.h"
#include "tests/render/decode_png.h"
#include "tests/render/environment_variable.h"
#include "tests/render/run_folder.h"
#include "tests/support/temp_folder.h"
#include "trackbed/core/error.h"
#include "trackbed/core/file.h"
#include "trackbed/render/film.h"

/// Tests a program that links EGL for its own pictures and also makes films with Trackbed.
namespace trackbed::render {
namespace {

/// A current EGL context of the program under test.
class OwnContext {
 public:
  OwnContext()
      : display_(
            eglGetPlatformDisplay(EGL_PLATFORM_SURFACELESS_MESA, EGL_DEFAULT_DISPLAY, nullptr)) {
    constexpr std::array<EGLint, 5> kWanted{EGL_SURFACE_TYPE, EGL_PBUFFER_BIT, EGL_RENDERABLE_TYPE,
                                            EGL_OPENGL_BIT, EGL_NONE};
    constexpr std::array<EGLint, 5> kSize{EGL_WIDTH, 16, EGL_HEIGHT, 8, EGL_NONE};
    EGLConfig config = nullptr;
    EGLint count = 0;
    ready_ = eglInitialize(display_, nullptr, nullptr) == EGL_TRUE &&
             eglBindAPI(EGL_OPENGL_API) == EGL_TRUE &&
             eglChooseConfig(display_, kWanted.data(), &config, 1, &count) == EGL_TRUE &&
             count == 1;
    if (ready_) {
      surface_ = eglCreatePbufferSurface(display_, config, kSize.data());
      context_ = eglCreateContext(display_, config, EGL_NO_CONTEXT, nullptr);
      ready_ = eglMakeCurrent(display_, surface_, surface_, context_) == EGL_TRUE;
    }
  }
  ~OwnContext() {
    eglMakeCurrent(display_, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
    eglDestroySurface(display_, surface_);
    eglDestroyContext(display_, context_);
  }
  OwnContext(const OwnContext&) = delete;
  OwnContext& operator=(const OwnContext&) = delete;

  [[nodiscard]] bool ready() const { return ready_; }
  [[nodiscard]] bool IsCurrent() const {
    return eglGetCurrentContext() == context_ && eglGetCurrentDisplay() == display_ &&
           eglGetCurrentSurface(EGL_DRAW) == surface_ && eglGetCurrentSurface(EGL_READ) == surface_;
  }
  /// Clears the surface to a color and returns the color read back.
  [[nodiscard]] std::array<unsigned char, 4> Cleared(float red, float green, float blue) const {
    using ClearColor = void(float, float, float, float);
    using Clear = void(unsigned);
    using ReadPixels = void(int, int, int, int, unsigned, unsigned, void*);
    std::array<unsigned char, 4> pixel{};
    reinterpret_cast<ClearColor*>(eglGetProcAddress("glClearColor"))(red, green, blue, 1.0F);
    reinterpret_cast<Clear*>(eglGetProcAddress("glClear"))(0x4000);  // GL_COLOR_BUFFER_BIT
    reinterpret_cast<ReadPixels*>(eglGetProcAddress("glReadPixels"))(
        3, 3, 1, 1, 0x1908, 0x1401, pixel.data());  // GL_RGBA, GL_UNSIGNED_BYTE
    return pixel;
  }

 private:
  EGLDisplay display_;
  EGLSurface surface_ = EGL_NO_SURFACE;
  EGLContext context_ = EGL_NO_CONTEXT;
  bool ready_ = false;
};

class LinkedEgl : public testing::Test {
 protected:
  void SetUp() override {
    if (!own_.ready()) {
      GTEST_SKIP() << "EGL makes no context here: it needs libegl-mesa0 and libgl1-mesa-dri";
    }
    CopyPrius(folder_.path());
    WritePlant(folder_.path(), "mujoco", 1.0, [](double time) {
      return CarPlace{3.0 * time, 0.0, 0.0};
    });
  }

  [[nodiscard]] Image Picture(const std::string& gl) const {
    const std::filesystem::path file = folder_.path() / "picture.png";
    RenderPicture(folder_.path(), file, 0.5,
                  {.width = 320, .height = 180, .gl = gl, .overlays = {}});
    return DecodePng(ReadFile(file));
  }

  const EnvironmentVariable mujoco_gl_{"MUJOCO_GL", nullptr};
  const OwnContext own_;
  TempFolder folder_;
};

TEST_F(LinkedEgl, GetsPictures) {
  const Image picture = Picture("auto");
  ASSERT_EQ(picture.width, 320);
  // In light, the red of orange paint exceeds its blue by at least a quarter of the full range.
  // Without overlays, this holds for nothing else in the picture. The car is 1.76 m wide, 1.5 m
  // high and 8 to 15 m away, so at least 1 % of the picture is paint despite windows and shade.
  int orange = 0;
  for (std::size_t i = 0; i < picture.rgb.size(); i += 3) {
    orange += picture.rgb[i] > picture.rgb[i + 2] + 64 ? 1 : 0;
  }
  EXPECT_GT(orange, 320 * 180 / 100);
  EXPECT_EQ(Picture("egl").rgb, picture.rgb);
}

TEST_F(LinkedEgl, KeepsItsOwnContext) {
  EXPECT_THAT(own_.Cleared(1.0F, 0.0F, 0.0F), testing::ElementsAre(255, 0, 0, 255));
  eglBindAPI(EGL_OPENGL_ES_API);
  static_cast<void>(Picture("auto"));
  EXPECT_EQ(eglQueryAPI(), static_cast<EGLenum>(EGL_OPENGL_ES_API));
  eglBindAPI(EGL_OPENGL_API);
  static_cast<void>(Picture("auto"));
  EXPECT_EQ(eglQueryAPI(), static_cast<EGLenum>(EGL_OPENGL_API));
  EXPECT_TRUE(own_.IsCurrent());
  EXPECT_THAT(own_.Cleared(0.0F, 1.0F, 0.0F), testing::ElementsAre(0, 255, 0, 255));
}

TEST_F(LinkedEgl, IsToldWhyOsmesaCannotDraw) {
  for (const bool by_variable : {false, true}) {
    const EnvironmentVariable variable("MUJOCO_GL", by_variable ? "osmesa" : nullptr);
    try {
      static_cast<void>(Picture(by_variable ? "auto" : "osmesa"));
      ADD_FAILURE() << "no error";
    } catch (const RunError& error) {
      EXPECT_THAT(error.what(), testing::StartsWith("cannot draw with OSMesa: this program links "
                                                    "EGL or has drawn with it"));
    }
  }
  EXPECT_TRUE(own_.IsCurrent());
}

TEST_F(LinkedEgl, TriesEglAfterAMissingOsmesa) {
  const auto context = MakeGlContext({GlLibrary::kOsmesa, GlLibrary::kEgl},
                                     {.osmesa = "libNoOsmesa.so.8", .egl = GlFiles{}.egl});
  EXPECT_EQ(context->library(), GlLibrary::kEgl);
}

}  // namespace
}  // namespace trackbed::render
