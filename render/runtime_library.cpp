#include "render/runtime_library.h"

#include <dlfcn.h>

#include <utility>

#include "trackbed/core/error.h"

namespace trackbed::render {

RuntimeLibrary::RuntimeLibrary(std::string file, std::string package, Symbols symbols)
    : file_(std::move(file)),
      package_(std::move(package)),
      handle_(dlopen(file_.c_str(),
                     RTLD_NOW | (symbols == Symbols::kGlobal ? RTLD_GLOBAL : RTLD_LOCAL))) {
  if (handle_ == nullptr) {
    Fail();
  }
}

void* RuntimeLibrary::Address(const char* name) const {
  void* address = dlsym(handle_, name);
  if (address == nullptr) {
    Fail();
  }
  return address;
}

void RuntimeLibrary::Fail() const {
  const char* reason = dlerror();
  throw RunError(fmt::format("cannot load {} (Debian's package {}): {}", file_, package_,
                             reason == nullptr ? "unknown reason" : reason));
}

}  // namespace trackbed::render
