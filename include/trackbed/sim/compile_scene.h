#pragma once

#include <string>

#include "trackbed/sim/mujoco_handles.h"
#include "trackbed/sim/scene.h"

namespace trackbed {

/// Whether a model is compiled for drawing or only for simulation.
enum class Looks {
  kKept,
  kDiscarded,  ///< Geoms and meshes without contacts and mass are omitted.
};

/// Compiles a scene with MuJoCo. Messages call the scene `name`.
///
/// A scene that is not `trusted` is compiled, and stepped once, in a separate process. The reason
/// is that MuJoCo's readers of meshes, textures and composites do not validate their input and may
/// crash. The separate process cannot open files, and is limited to a minute of processor time and
/// 2 GB of memory (unlimited under the address sanitizer). The model compiled there is byte for
/// byte the same as a model compiled in this process.
///
/// Errors: InputError, with the line in the car's file, if the scene does not compile, if MuJoCo
/// crashes or does not finish, or if the model would need more than 1 GB. RunError if no process
/// can be started. Threads: only one thread compiles at a time, and other threads wait. Cost: 5 to
/// 200 ms for MuJoCo's compiler, plus 5 to 20 ms for a separate process.
MujocoModel CompileScene(const Scene& scene, const std::string& name, Looks looks);

}  // namespace trackbed
