#include "render/gl_context.h"

#include <fmt/format.h>

namespace trackbed::render {

const char* NameOf(GlLibrary library) {
  return library == GlLibrary::kOsmesa ? "OSMesa" : "EGL";
}

std::string GlContext::Version() const {
  using GetString = const unsigned char*(unsigned);
  constexpr unsigned kRenderer = 0x1F01;  // GL_RENDERER
  constexpr unsigned kVersion = 0x1F02;   // GL_VERSION
  auto* const get = reinterpret_cast<GetString*>(Function("glGetString"));
  const auto text = [get](unsigned name) -> std::string {
    const unsigned char* value = get == nullptr ? nullptr : get(name);
    return value == nullptr ? "unknown" : reinterpret_cast<const char*>(value);
  };
  return fmt::format("{}, {}", text(kVersion), text(kRenderer));
}

}  // namespace trackbed::render
