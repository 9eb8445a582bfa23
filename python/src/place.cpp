#include <dlfcn.h>

#include <filesystem>
#include <string>
#include <system_error>

namespace trackbed {

const char* PlaceOfData();

/// Returns the folder with models/ and scenarios/: the folder `data` beside this module in a wheel,
/// otherwise the source tree.
const char* PlaceOfData() {
  static const std::string kPlace = [] {
    namespace fs = std::filesystem;
    Dl_info module{};
    std::error_code error;
    if (dladdr(reinterpret_cast<const void*>(&PlaceOfData), &module) != 0) {
      const fs::path data = fs::absolute(module.dli_fname, error).parent_path() / "data";
      if (!error && fs::is_directory(data / "models", error)) {
        return data.string();
      }
    }
    return std::string(TRACKBED_SOURCE_DIR);
  }();
  return kPlace.c_str();
}

}  // namespace trackbed
