// The files of the project, as the tests of its structure read them.
#pragma once

#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>

// The root of the project.
inline const std::filesystem::path kRoot = TRACKBED_SOURCE_DIR;

inline std::string ReadText(const std::filesystem::path& file) {
  std::ostringstream text;
  text << std::ifstream(file).rdbuf();
  return text.str();
}
