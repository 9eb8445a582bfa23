#include <array>
#include <cstdint>

#include "render/gl_context.h"
#include "render/runtime_library.h"
#include "trackbed/core/error.h"

namespace trackbed::render {
namespace {

// Mesa 25.1 removed OSMesa and its header <GL/osmesa.h>. The declarations of <GL/osmesa.h> are
// repeated here, so that the same build works with and without OSMesa.
struct OsmesaState;
using OsmesaCreate = OsmesaState*(unsigned format, int depth_bits, int stencil_bits, int accum_bits,
                                  OsmesaState* share);
using OsmesaMakeCurrent = unsigned char(OsmesaState*, void* buffer, unsigned type, int width,
                                        int height);
using OsmesaDestroy = void(OsmesaState*);
using OsmesaGetProcAddress = void*(const char* name);
constexpr unsigned kRgba = 0x1908;          // OSMESA_RGBA
constexpr unsigned kUnsignedByte = 0x1401;  // GL_UNSIGNED_BYTE

class OsmesaContext final : public GlContext {
 public:
  explicit OsmesaContext(const std::string& file)
      : OsmesaContext(file, RuntimeLibrary(file, kPackage)) {}
  ~OsmesaContext() override {
    make_current_(nullptr, nullptr, kUnsignedByte, 0, 0);
    destroy_(state_);
  }

  [[nodiscard]] GlLibrary library() const override { return GlLibrary::kOsmesa; }
  [[nodiscard]] void* Function(const char* name) const override { return get_address_(name); }

 private:
  static constexpr const char* kPackage = "libosmesa6, up to Debian 13; newer ones draw with egl";
  static constexpr int kWindowSize = 64;

  OsmesaContext(const std::string& file, const RuntimeLibrary& library)
      : make_current_(library.Find<OsmesaMakeCurrent>("OSMesaMakeCurrent")),
        destroy_(library.Find<OsmesaDestroy>("OSMesaDestroyContext")),
        get_address_(library.Find<OsmesaGetProcAddress>("OSMesaGetProcAddress")),
        state_(library.Find<OsmesaCreate>("OSMesaCreateContextExt")(kRgba, 24, 8, 0, nullptr)) {
    if (state_ == nullptr ||
        make_current_(state_, window_.data(), kUnsignedByte, kWindowSize, kWindowSize) == 0) {
      if (state_ != nullptr) {
        destroy_(state_);
      }
      throw RunError("OSMesa makes no OpenGL context");
    }
    // Makes OSMesa's symbols visible in the whole process, where MuJoCo searches for them.
    const RuntimeLibrary global(file, kPackage, RuntimeLibrary::Symbols::kGlobal);
  }

  OsmesaMakeCurrent* make_current_;
  OsmesaDestroy* destroy_;
  OsmesaGetProcAddress* get_address_;
  // Buffer for the window's pixels, which OSMesa requires but MuJoCo does not use.
  std::array<std::uint8_t, std::size_t{4} * kWindowSize * kWindowSize> window_{};
  OsmesaState* state_;
};

}  // namespace

std::unique_ptr<GlContext> MakeOsmesaContext(const std::string& file) {
  return std::make_unique<OsmesaContext>(file);
}

}  // namespace trackbed::render
