#pragma once

#include <unistd.h>

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <string>

#include "trackbed/core/error.h"

/// Entry point of every fuzz target; libFuzzer calls it with an input. Invalid input may cause an
/// error of the user or of the environment; every other exception is a finding.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size);

namespace trackbed::fuzz {

inline std::string Text(const std::uint8_t* data, std::size_t size) {
  return {data, data + size};
}

/// Calls the reader and ignores the errors that invalid input may cause.
template <typename Read>
int Expect(const Read& read) {
  try {
    read();
  } catch (const InputError&) {
  } catch (const RunError&) {
  }
  return 0;
}

/// A temporary folder of this process, in memory if possible, removed when the process ends.
class ProcessFolder {
 public:
  ProcessFolder() {
    const std::filesystem::path memory = "/dev/shm";
    std::error_code ignored;
    const std::filesystem::path parent = std::filesystem::is_directory(memory, ignored)
                                             ? memory
                                             : std::filesystem::temp_directory_path();
    path_ = parent / ("trackbed_fuzz_" + std::to_string(::getpid()));
    std::filesystem::create_directories(path_);
  }
  ProcessFolder(const ProcessFolder&) = delete;
  ProcessFolder& operator=(const ProcessFolder&) = delete;
  ~ProcessFolder() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
  }

  [[nodiscard]] const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

inline const std::filesystem::path& Folder() {
  static const ProcessFolder folder;
  return folder.path();
}

inline std::filesystem::path Write(const std::string& name, const std::string& content) {
  const std::filesystem::path file = Folder() / name;
  std::ofstream(file, std::ios::binary) << content;
  return file;
}

}  // namespace trackbed::fuzz
