#pragma once

#include <string>

namespace trackbed::render {

/// A shared library loaded on first use, not at program start. OSMesa with LLVM and FFmpeg are 140
/// libraries, which many programs do not need. The library is never unloaded.
class RuntimeLibrary {
 public:
  enum class Symbols {
    kLocal,
    kGlobal,  ///< symbols also visible to libraries that search the process, such as MuJoCo
  };

  /// Loads the library. Throws RunError naming the library and its Debian package `package` if the
  /// library cannot be loaded.
  RuntimeLibrary(std::string file, std::string package, Symbols symbols = Symbols::kLocal);

  /// The library's function with this name; throws RunError if the function is missing. `Function`
  /// is the type of the function.
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
