#pragma once

#include <filesystem>
#include <regex>
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

/// Starts `watch` and sends it a signal when it has printed its address. Returns its output and
/// exit code.
inline Outcome Watched(const TempFolder& folder, const std::string& arguments,
                       const std::string& signal = "INT") {
  return Shell(folder, "rm -f said && mkfifo said && { " TRACKBED_PROGRAM " watch " + arguments +
                           " > said & } && { read line; echo \"$line\"; kill -" + signal +
                           " $!; cat; wait $!; } < said");
}

/// Output of `test` without durations: " (0.3 s)" and " in 1.2 s".
inline std::string WithoutDurations(const std::string& output) {
  static const std::regex duration(R"( \([0-9.]+ (s|min|h)[^)]*\)| in [0-9.]+ (s|min|h)[^:]*)");
  return std::regex_replace(output, duration, "");
}

/// Output of `test` without durations and without the notes on waypoints that a fillet misses.
inline std::string Verdicts(const std::string& output) {
  static const std::regex note(
      "; plan: waypoint [0-9]+ at [^;\n]*; plan\\.max_waypoint_miss [^;\n]*");
  return std::regex_replace(WithoutDurations(output), note, "");
}

/// Whether the program was built with video.
inline bool HasVideo(const TempFolder& folder) {
  return Trackbed(folder, "--version").output.find("\nvideo off\n") == std::string::npos;
}

}  // namespace trackbed
