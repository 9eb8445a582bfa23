#pragma once

#include <string>

#include "trackbed/sim/mujoco_handles.h"
#include "trackbed/sim/scene.h"

namespace trackbed {

/// Whether a model will be drawn or only stepped.
enum class Looks {
  kKept,
  kDiscarded,  ///< Omits geoms and meshes without contacts and mass.
};

/// Compiles a scene with MuJoCo. `name` is the scene's name in messages.
///
/// A scene that is not `trusted` is compiled, and stepped once, in a separate process, because
/// MuJoCo's readers of meshes, textures and composites do not validate their input and may crash.
/// That process can open no files and has a minute of processor time and 2 GB of memory (no limit
/// under the address sanitizer). The compiled model that it returns is byte for byte the same as
/// one compiled in this process.
///
/// Errors: InputError with the line in the car's file if the scene does not compile, if MuJoCo
/// crashes or does not finish, and if the model would need more than 1 GB. RunError if no process
/// can be started. Threads: only one thread compiles at a time; other threads wait. Cost: 5 to 200
/// ms for MuJoCo's compiler, and 5 to 20 ms for a separate process.
MujocoModel CompileScene(const Scene& scene, const std::string& name, Looks looks);

}  // namespace trackbed
