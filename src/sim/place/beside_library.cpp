#include <dlfcn.h>

#include <filesystem>
#include <string>

#include "trackbed/core/error.h"

namespace trackbed {

const char* PlaceOfData();

/// Returns the data folder next to this shared library. The shared library and its data folder may
/// be moved together.
const char* PlaceOfData() {
  static const std::string kPlace = [] {
    namespace fs = std::filesystem;
    Dl_info library{};
    const int found = dladdr(reinterpret_cast<const void*>(&PlaceOfData), &library);
    TRACKBED_CHECK(found != 0, "the library of sim does not find its own file");
    const fs::path folder = fs::canonical(library.dli_fname).parent_path();
    return fs::weakly_canonical(folder / TRACKBED_DATA_FROM_LIBRARY).string();
  }();
  return kPlace.c_str();
}

}  // namespace trackbed
