#pragma once

#include <string>

#include "trackbed/sim/mujoco_handles.h"
#include "trackbed/sim/scene.h"

namespace trackbed {

/// Whether a model is to be drawn or only stepped.
enum class Looks {
  kKept,
  kDiscarded,  ///< geoms and meshes that touch nothing and weigh nothing are left out
};

/// Compiles a scene with MuJoCo. `name` stands for it in messages.
///
/// A scene that is not `trusted` is compiled, and computed once, in a process of its own that can
/// open no file and has 2 GB of memory and a minute of processor time (under the address sanitizer
/// without a limit of memory): MuJoCo's readers of meshes, textures and composites trust what they
/// read, and may crash. The compiled model comes back from there; it is the same, byte for byte, as
/// one that this process compiles.
///
/// Errors: InputError with the line in the car's file when the scene does not compile, when MuJoCo
/// crashes or finds no end, and when the model would take more than 1 GB. RunError when no process
/// can be started.
/// Threads: one compilation at a time, others wait.
/// Cost: MuJoCo's, 5 to 200 ms; of a process of its own, 5 to 20 ms more.
MujocoModel CompileScene(const Scene& scene, const std::string& name, Looks looks);

}  // namespace trackbed
