#include "src/fmu/shared_library.h"

#include <dlfcn.h>
#include <fmt/format.h>
#include <link.h>

#include "trackbed/core/error.h"

namespace trackbed::fmu {

namespace fs = std::filesystem;

SharedLibrary::SharedLibrary(const fs::path& file)
    : file_(file), handle_(dlopen(file.c_str(), RTLD_NOW | RTLD_LOCAL)) {
  if (handle_ == nullptr) {
    throw RunError(fmt::format("cannot load {}: {}", file.string(), dlerror()));
  }
}

SharedLibrary::~SharedLibrary() {
  dlclose(handle_);
}

void* SharedLibrary::Address(const char* name) const {
  void* const found = dlsym(handle_, name);
  if (found == nullptr) {
    throw RunError(fmt::format("{} has no function {}", file_.string(), name));
  }
  return found;
}

fs::path OwnFile() {
  Dl_info info{};
  link_map* map = nullptr;
  const int found = dladdr1(reinterpret_cast<const void*>(&OwnFile), &info,
                            reinterpret_cast<void**>(&map), RTLD_DL_LINKMAP);
  TRACKBED_CHECK(found != 0, "the code of the exporter is in no file");
  // Use /proc/self/exe for the program itself, which has no name in the list of loaded files.
  return fs::canonical(map == nullptr || *map->l_name == '\0' ? "/proc/self/exe" : map->l_name);
}

}  // namespace trackbed::fmu
