#pragma once

#include <mujoco/mujoco.h>

#include <concepts>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <numeric>
#include <span>
#include <string>

/// Hides the API differences between MuJoCo versions from the simulation code. The supported MuJoCo
/// versions are 2.2.2, 3.3 and newer, and 4.0.1. If a struct member exists only in some MuJoCo
/// versions, a template tests for the member with `requires`, since only a template may name a
/// missing member. If enumerators differ between versions, preprocessor conditions select the code.
namespace trackbed::mj {

/// Adds a file to MuJoCo's virtual file system. AddToVfs returns 0 if the file was added.
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

/// Returns the size of the model in saved form [bytes]; negative if the model is too large for
/// MuJoCo to save.
inline std::int64_t SizeOf(const mjModel& model) {
  return static_cast<std::int64_t>(mj_sizeModel(&model));
}

/// Disables an equality constraint. The flag that enables an equality constraint is in mjData since
/// MuJoCo 3.0, and was in mjModel before.
template <std::same_as<mjModel> Model, std::same_as<mjData> Data>
void DisableEquality(Model& model, [[maybe_unused]] Data& data, int equality) {
  if constexpr (requires { model.eq_active0; }) {
    model.eq_active0[equality] = 0;
    data.eq_active[equality] = 0;
  } else {
    model.eq_active[equality] = 0;
  }
}

/// Whether each actuator has exactly one control. Before MuJoCo 3.17, an actuator always had
/// exactly one control.
template <std::same_as<mjModel> Model>
bool HasOneControlEach(const Model& model) {
  if constexpr (requires { model.nactuator; }) {
    return model.nu == model.nactuator && model.nu == model.nout;
  } else {
    return true;
  }
}

/// Returns the index of an actuator's state in mjData::act; -1 if the actuator has no state. Before
/// MuJoCo 2.3, the actuators with a state were the last actuators in the model, and each had a
/// single state variable.
template <std::same_as<mjModel> Model>
int ActivationAddress(const Model& model, int actuator) {
  if constexpr (requires { model.actuator_actadr; }) {
    return model.actuator_actadr[actuator];
  } else {
    const int stateless = model.nu - model.na;
    return actuator < stateless ? -1 : actuator - stateless;
  }
}

/// Returns the largest torque that all actuators together may exert on a joint; infinite without a
/// limit. Models can contain a torque limit of a joint since MuJoCo 2.3.7.
template <std::same_as<mjModel> Model>
mjtNum JointForceLimit([[maybe_unused]] const Model& model, [[maybe_unused]] int joint) {
  if constexpr (requires { model.jnt_actfrclimited; }) {
    if (model.jnt_actfrclimited[joint] != 0) {
      return model.jnt_actfrcrange[2 * joint + 1];
    }
  }
  return std::numeric_limits<mjtNum>::infinity();
}

/// Returns the moment arm of an actuator about a degree of freedom, as computed by mj_transmission.
/// MuJoCo stores the moment arms in a sparse matrix since version 3.2.5.
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

/// Locks the joints `dofs` by giving them a large armature inertia. LockJoints requires a model at
/// rest in its initial configuration.
///
/// MuJoCo's constraint solver scales its tolerance by the trace of the inertia matrix. Since MuJoCo
/// 3.17, the trace of the inertia matrix includes an armature inertia that is set after
/// compilation; in earlier versions, the trace excludes this inertia. To compensate for the larger
/// trace, LockJoints divides the solver's tolerance by the factor by which the inertia matrix's
/// trace grows. Without this correction of the tolerance, contacts would be solved a thousand times
/// less accurately.
inline void LockJoints(mjModel& model, std::span<const int> dofs, double armature) {
#if mjVERSION_HEADER >= 3017000
  const double trace = std::accumulate(model.dof_M0, model.dof_M0 + model.nv, 0.0);
  model.opt.tolerance *= trace / (trace + armature * static_cast<double>(dofs.size()));
#endif
  for (const int dof : dofs) {
    model.dof_armature[dof] = armature;
  }
}

/// Returns the number of iterations that the constraint solver needed in the last step. Since
/// MuJoCo 3.0, iterations are counted separately for each constraint island.
template <std::same_as<mjData> Data>
int SolverIterations(const Data& data) {
  if constexpr (requires { data.solver_niter; }) {
    // with constraint islands disabled, the first entry of solver_niter is the count for all
    // constraints
    return data.solver_niter[0];
  } else {
    return data.solver_iter;
  }
}

/// Returns the text of a warning from MuJoCo's simulation. The parameter `info` of mju_warningText
/// had the type int before MuJoCo 3.0.
inline const char* WarningText(int warning, int info) {
  return [&]<typename Info>(const char* (*text)(int, Info)) {
    return text(warning, static_cast<Info>(info));
  }(mju_warningText);
}

/// Sets options such that all MuJoCo versions compute the same motion.
///
/// Constraint islands, which are on by default since MuJoCo 3.3.6, are disabled. With constraint
/// islands, the constraint solver stops iterating separately for each island. With constraint
/// islands, a laden car at rest would creep, and runs would differ from those of MuJoCo 2.2.2 by
/// millimeters instead of rounding errors. The mid-phase of collision detection, introduced in
/// MuJoCo 2.3.3, is also disabled. The mid-phase uses the bounding boxes of the compiled model; as
/// RoadContact moves planes out of these boxes, a car on contact tyres would fall through terrain.
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
