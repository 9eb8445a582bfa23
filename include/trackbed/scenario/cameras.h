#pragma once

#include <string>
#include <vector>

namespace trackbed {

/// A camera that videos can use, with the name that the key render.camera of a scenario selects.
struct CameraName {
  std::string name;
  std::string summary;  ///< Summary of the camera for users, on one line.
};

/// Returns all cameras, beginning with the default camera. render/camera.cpp defines the position
/// of each camera.
const std::vector<CameraName>& CameraNames();

}  // namespace trackbed
