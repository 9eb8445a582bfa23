#pragma once

#include <string>

#include "trackbed/sim/mujoco_handles.h"
#include "trackbed/sim/scene.h"

namespace trackbed {

/// The purpose for which a model is compiled: drawing, or only simulation.
enum class Looks {
  kKept,
  /// For simulation only: geoms and meshes that have neither contacts nor mass are omitted. If
  /// MuJoCo would discard mass together with visual geoms, all geoms are kept. With kDiscarded, the
  /// masses, inertias and centers of mass of all bodies are the same as with kKept.
  kDiscarded,
};

/// Compiles a scene with MuJoCo. Error messages use the name `name` for the scene.
///
/// A scene that is not `trusted` is compiled, and stepped once, in a separate process. A separate
/// process is needed because MuJoCo's readers of meshes, textures and composites do not validate
/// their input and may crash. The separate process cannot open files, and is limited to a minute of
/// processor time and 2 GB of memory (unlimited under the address sanitizer). The model compiled in
/// the separate process is byte for byte the same as if it had been compiled in the calling
/// process.
///
/// Errors: throws InputError, naming the line in the car's file, if the scene does not compile.
/// Throws InputError if MuJoCo crashes or does not finish, or if the model would need more than 1
/// GB of memory. Throws RunError if the separate process cannot be started. Threads: only one
/// thread compiles a scene at a time, and other threads wait. CompileScene takes 5 to 200 ms in
/// MuJoCo's compiler, and another 5 to 20 ms for a separate process. These times double with
/// kDiscarded if a body has no <inertial> element.
MujocoModel CompileScene(const Scene& scene, const std::string& name, Looks looks);

}  // namespace trackbed
