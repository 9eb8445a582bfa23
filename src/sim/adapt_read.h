#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "trackbed/sim/adapt.h"
#include "trackbed/sim/mujoco_handles.h"

namespace trackbed::adapt {

/// The model of another program, compiled by MuJoCo with all its geoms.
struct FoundModel {
  std::string file;  ///< Name of the model file, for messages.
  bool is_urdf = false;
  MujocoModel model;
  MujocoData data;  ///< State of the model in its initial configuration qpos0, after mj_forward.
  std::vector<std::string> notes;
};

/// Reads and compiles an MJCF or URDF file. If bodies have no mass, or inertias that no body can
/// have, MuJoCo's remedies (boundmass, boundinertia, balanceinertia) are used, with a note. Throws
/// InputError if the file is neither MJCF nor URDF, or if MuJoCo cannot compile it.
FoundModel ReadFound(const std::filesystem::path& file, const AdaptOptions& options);

}  // namespace trackbed::adapt
