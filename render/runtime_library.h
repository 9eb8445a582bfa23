#pragma once

#include <string>

namespace trackbed::render {

/// A shared library that is loaded on first use, not at program start. Loading on first use saves
/// time in many programs, since OSMesa, LLVM and FFmpeg together load 140 shared libraries. The
/// shared library is never unloaded.
class RuntimeLibrary {
 public:
  enum class Symbols {
    kLocal,
    /// Makes the library's symbols visible also to libraries that search the whole process, such as
    /// MuJoCo.
    kGlobal,
  };

  /// Loads the library. Throws RunError, naming the library and its Debian package `package`, if
  /// the library cannot be loaded.
  RuntimeLibrary(std::string file, std::string package, Symbols symbols = Symbols::kLocal);

  /// Returns the library's function with this name and the type `Function`. Throws RunError if the
  /// library has no function with this name.
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
