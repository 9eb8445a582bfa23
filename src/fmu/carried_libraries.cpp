#include "src/fmu/carried_libraries.h"

#include <dlfcn.h>
#include <fmt/format.h>
#include <link.h>

#include <algorithm>
#include <array>
#include <string_view>
#include <vector>

#include "src/fmu/shared_library.h"
#include "trackbed/core/error.h"

// Reads the names of needed libraries from the dynamic section of each library in memory. The
// dynamic loader has already searched for the files of the needed libraries.
namespace trackbed::fmu {

namespace fs = std::filesystem;

namespace {

/// Returns whether the library belongs to glibc or to the runtime of GCC. An FMU must not contain
/// runtime libraries: glibc must match the system's dynamic loader, and a process may have only one
/// C++ runtime.
bool IsOfRuntime(std::string_view name) {
  constexpr std::array<std::string_view, 11> kNames{
      "libc.so.",     "libm.so.",      "libdl.so.",   "libpthread.so.",
      "librt.so.",    "libresolv.so.", "libutil.so.", "libstdc++.so.",
      "libgcc_s.so.", "ld-linux",      "linux-vdso"};
  return std::any_of(kNames.begin(), kNames.end(),
                     [&](std::string_view own) { return name.starts_with(own); });
}

/// Returns the soname of a loaded library, and the names of the libraries that it needs.
struct Names {
  std::string own;
  std::vector<std::string> needed;
};

Names NamesIn(const link_map& library) {
  const char* texts = nullptr;
  for (const ElfW(Dyn)* entry = library.l_ld; entry->d_tag != DT_NULL; ++entry) {
    if (entry->d_tag == DT_STRTAB) {
      // The dynamic loader has already added the library's base address to this pointer of the
      // dynamic section.
      texts = reinterpret_cast<const char*>(entry->d_un.d_ptr);
    }
  }
  Names names{.own = fs::path(library.l_name).filename(), .needed = {}};
  for (const ElfW(Dyn)* entry = library.l_ld; texts != nullptr && entry->d_tag != DT_NULL;
       ++entry) {
    if (entry->d_tag == DT_NEEDED) {
      names.needed.emplace_back(texts + entry->d_un.d_val);
    } else if (entry->d_tag == DT_SONAME) {
      names.own = texts + entry->d_un.d_val;
    }
  }
  return names;
}

/// Returns all libraries that this process has loaded, by soname.
std::map<std::string, const link_map*> LoadedLibraries(const link_map& one) {
  const link_map* first = &one;
  while (first->l_prev != nullptr) {
    first = first->l_prev;
  }
  std::map<std::string, const link_map*> loaded;
  for (const link_map* library = first; library != nullptr; library = library->l_next) {
    // Skip the kernel's vDSO, which has no file and whose dynamic section contains addresses
    // without the base address.
    if (*library->l_name != '\0' && !IsOfRuntime(fs::path(library->l_name).filename().string())) {
      loaded.emplace(NamesIn(*library).own, library);
    }
  }
  return loaded;
}

}  // namespace

std::map<std::string, fs::path> CarriedLibraries(const fs::path& library) {
  const SharedLibrary opened(library);
  link_map* own = nullptr;
  if (dlinfo(opened.handle(), RTLD_DI_LINKMAP, static_cast<void*>(&own)) != 0) {
    throw RunError(fmt::format("cannot inspect {}: {}", library.string(), dlerror()));
  }
  const std::map<std::string, const link_map*> loaded = LoadedLibraries(*own);
  std::map<std::string, fs::path> carried;
  std::vector<const link_map*> left{own};
  while (!left.empty()) {
    const Names names = NamesIn(*left.back());
    left.pop_back();
    for (const std::string& name : names.needed) {
      const auto found = loaded.find(name);
      if (!IsOfRuntime(name) && found != loaded.end() &&
          carried.emplace(name, found->second->l_name).second) {
        left.push_back(found->second);
      }
    }
  }
  return carried;
}

}  // namespace trackbed::fmu
