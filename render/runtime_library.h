#pragma once

#include <string>

namespace trackbed::render {

/// A shared library that is loaded when something is drawn or encoded, and not at the start of a
/// program that may do neither: OSMesa with LLVM and FFmpeg are 140 libraries. It stays loaded.
class RuntimeLibrary {
 public:
  enum class Symbols {
    kLocal,
    kGlobal,  ///< also for libraries that look for them in the process, as MuJoCo does
  };

  /// RunError, naming the library and `package`, Debian's package of it, when it cannot be loaded.
  RuntimeLibrary(std::string file, std::string package, Symbols symbols = Symbols::kLocal);

  /// The function of this name; RunError when there is none. `Function` is its type.
  template <typename Function>
  [[nodiscard]] Function* Find(const char* name) const {
    return reinterpret_cast<Function*>(Address(name));
  }

 private:
  [[nodiscard]] void* Address(const char* name) const;
  [[noreturn]] void Fail() const;

  std::string file_;
  std::string package_;
  void* handle_;
};

}  // namespace trackbed::render
