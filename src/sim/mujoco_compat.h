#pragma once

#include <mujoco/mujoco.h>

#include <concepts>
#include <cstddef>
#include <cstdint>
#include <numeric>
#include <span>
#include <string>

/// Covers the differences between MuJoCo versions in the physics. Supported versions are 2.2.2, 3.3
/// and newer, and 4.0.1. If headers of two versions declare different members, templates test for
/// them with `requires`. Only templates may name a member that a version lacks. If the headers
/// declare different enumerators, the version number decides. docs/how-to/mujoco-versions.md lists
/// the differences, and render/mujoco_compat.h has those of drawing.
namespace trackbed::mj {

/// Adds a file to a virtual file system. AddFile returns 0 on success.
template <std::same_as<mjVFS> Vfs>
int AddToVfs(Vfs& vfs, const std::string& file, const std::string& content) {
  const auto size = static_cast<int>(content.size());
  if constexpr (requires { mj_addBufferVFS(&vfs, file.c_str(), content.data(), size); }) {
    return mj_addBufferVFS(&vfs, file.c_str(), content.data(), size);
  } else {
    if (const int status = mj_makeEmptyFileVFS(&vfs, file.c_str(), size); status != 0) {
      return status;
    }
    auto* copy = static_cast<char*>(vfs.filedata[mj_findFileVFS(&vfs, file.c_str())]);
    content.copy(copy, content.size());
    return 0;
  }
}

/// Size of the saved model [bytes]; negative if MuJoCo cannot save a model that large.
inline std::int64_t SizeOf(const mjModel& model) {
  return static_cast<std::int64_t>(mj_sizeModel(&model));
}

/// Disables an equality constraint. The flag of the constraint is in mjData since MuJoCo 3.0, and
/// in mjModel before.
template <std::same_as<mjModel> Model, std::same_as<mjData> Data>
void DisableEquality(Model& model, [[maybe_unused]] Data& data, int equality) {
  if constexpr (requires { model.eq_active0; }) {
    model.eq_active0[equality] = 0;
    data.eq_active[equality] = 0;
  } else {
    model.eq_active[equality] = 0;
  }
}

/// Whether each actuator has exactly one control. Before MuJoCo 3.17, every actuator had exactly
/// one control.
template <std::same_as<mjModel> Model>
bool HasOneControlEach(const Model& model) {
  if constexpr (requires { model.nactuator; }) {
    return model.nu == model.nactuator && model.nu == model.nout;
  } else {
    return true;
  }
}

/// Index into `act` of an actuator's state. -1 if the actuator has no state. Before MuJoCo 2.3, the
/// last actuators were those with a state, one number each.
template <std::same_as<mjModel> Model>
int ActivationAddress(const Model& model, int actuator) {
  if constexpr (requires { model.actuator_actadr; }) {
    return model.actuator_actadr[actuator];
  } else {
    const int stateless = model.nu - model.na;
    return actuator < stateless ? -1 : actuator - stateless;
  }
}

/// Moment of an actuator about a degree of freedom, after mj_transmission. The matrix of moments is
/// sparse since MuJoCo 3.2.5.
template <std::same_as<mjData> Data>
mjtNum ActuatorMoment([[maybe_unused]] const mjModel& model, const Data& data, int actuator,
                      int dof) {
  if constexpr (requires { data.moment_rownnz; }) {
    const int row = data.moment_rowadr[actuator];
    for (int i = row; i < row + data.moment_rownnz[actuator]; ++i) {
      if (data.moment_colind[i] == dof) {
        return data.actuator_moment[i];
      }
    }
    return 0.0;
  } else {
    return data.actuator_moment[static_cast<std::ptrdiff_t>(model.nv) * actuator + dof];
  }
}

/// Locks the joints `dofs` by an armature. The model must be at rest in its initial configuration.
///
/// The constraint solver scales its tolerance by the trace of the inertia matrix. Before MuJoCo
/// 3.17, the trace was that of the compiled model. Since MuJoCo 3.17, the trace includes the
/// armature. LockJoints reduces the tolerance by as much as the trace grows. With the larger
/// tolerance, contacts would be solved a thousand times less exactly.
inline void LockJoints(mjModel& model, std::span<const int> dofs, double armature) {
#if mjVERSION_HEADER >= 3017000
  const double trace = std::accumulate(model.dof_M0, model.dof_M0 + model.nv, 0.0);
  model.opt.tolerance *= trace / (trace + armature * static_cast<double>(dofs.size()));
#endif
  for (const int dof : dofs) {
    model.dof_armature[dof] = armature;
  }
}

/// Iterations of the constraint solver in the last step. MuJoCo counts iterations per island since
/// 3.0.
template <std::same_as<mjData> Data>
int SolverIterations(const Data& data) {
  if constexpr (requires { data.solver_niter; }) {
    return data.solver_niter[0];  // without islands, the first entry is for all constraints
  } else {
    return data.solver_iter;
  }
}

/// Text of a warning of MuJoCo's simulation; `info` was an int before 3.0.
inline const char* WarningText(int warning, int info) {
  return [&]<typename Info>(const char* (*text)(int, Info)) {
    return text(warning, static_cast<Info>(info));
  }(mju_warningText);
}

/// Sets the options under which all versions compute the same motion.
///
/// Islands (on by default since 3.3.6) are solved separately and stop separately. With islands, a
/// laden car creeps, and a run differs from 2.2.2 by millimeters instead of rounding. The mid-phase
/// of collision detection (since 2.3.3) takes a geom's bounding box from the compiled model.
/// RoadContact moves planes out of their boxes, so a car on contact tyres would fall through
/// terrain.
inline void SetCommonOptions([[maybe_unused]] mjModel& model) {
#if mjVERSION_HEADER >= 233
  model.opt.disableflags |= mjDSBL_MIDPHASE;
#endif
#if mjVERSION_HEADER >= 336
  model.opt.disableflags |= mjDSBL_ISLAND;
#elif mjVERSION_HEADER >= 300
  model.opt.enableflags &= ~mjENBL_ISLAND;
#endif
}

}  // namespace trackbed::mj
