#pragma once

#include <filesystem>

namespace trackbed::fmu {

/// A shared library that is loaded as long as the object exists. The symbols of the loaded library
/// are not visible to other libraries.
class SharedLibrary {
 public:
  /// Loads the library; throws RunError with the message of the dynamic loader if that fails.
  explicit SharedLibrary(const std::filesystem::path& file);
  SharedLibrary(const SharedLibrary&) = delete;
  SharedLibrary& operator=(const SharedLibrary&) = delete;
  ~SharedLibrary();

  [[nodiscard]] void* handle() const { return handle_; }

  /// Returns the function `name` of the library. Throws RunError if the library has no
  /// function of this name.
  template <typename Function>
  [[nodiscard]] Function* Find(const char* name) const {
    return reinterpret_cast<Function*>(Address(name));
  }

 private:
  [[nodiscard]] void* Address(const char* name) const;

  std::filesystem::path file_;
  void* handle_;
};

/// Returns the file of the program or shared library that contains the code of OwnFile.
std::filesystem::path OwnFile();

}  // namespace trackbed::fmu
