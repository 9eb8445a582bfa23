#pragma once

#include <string>
#include <vector>

namespace trackbed {

/// The name of a camera of films, for the key render.camera.
struct CameraName {
  std::string name;
  std::string summary;  ///< One-line summary for users.
};

/// Returns the names of all cameras, beginning with the default. render/camera.cpp places each of
/// them.
const std::vector<CameraName>& CameraNames();

}  // namespace trackbed
