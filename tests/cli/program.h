#pragma once

#include <filesystem>
#include <string>

#include "tests/support/shell.h"
#include "tests/support/temp_folder.h"

namespace trackbed {

/// Runs the program in `folder` through the shell.
inline Outcome Trackbed(const TempFolder& folder, const std::string& arguments) {
  return Shell(folder, TRACKBED_PROGRAM " " + arguments);
}

inline std::string ScenarioFile(const std::string& name) {
  return (std::filesystem::path(TRACKBED_SOURCE_DIR) / "scenarios" / (name + ".yaml")).string();
}

/// Whether the program was built with video.
inline bool HasVideo(const TempFolder& folder) {
  return Trackbed(folder, "--version").output.find("\nvideo off\n") == std::string::npos;
}

}  // namespace trackbed
