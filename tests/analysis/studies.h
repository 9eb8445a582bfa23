#pragma once

#include <string>
#include <vector>

#include "tests/support/temp_folder.h"
#include "trackbed/core/error.h"
#include "trackbed/scenario/study_points.h"
#include "trackbed/scenario/study_reader.h"

namespace trackbed {

/// A study of scenarios/winding.yaml with these keys.
inline Study MakeStudy(const TempFolder& folder, const std::string& keys,
                       const std::vector<Override>& overrides = {}) {
  const std::string text =
      "schema: 1\nname: study\nscenario: " TRACKBED_SOURCE_DIR "/scenarios/winding.yaml\n" + keys;
  return ReadStudy(folder.Write("study.yaml", text), overrides);
}

inline std::vector<StudyPoint> AllPoints(const StudyPoints& points) {
  std::vector<StudyPoint> all;
  for (std::size_t i = 0; i < points.size(); ++i) {
    all.push_back(points.Read(i));
  }
  return all;
}

/// The error of a call, without the folder's name.
template <typename Call>
std::string ErrorMessage(const TempFolder& folder, const Call& call) {
  try {
    call();
  } catch (const InputError& error) {
    std::string message = error.what();
    const std::string name = folder.path().string() + "/";
    for (std::size_t at = 0; (at = message.find(name)) != std::string::npos;) {
      message.erase(at, name.size());
    }
    return message;
  }
  return "no error";
}

}  // namespace trackbed
