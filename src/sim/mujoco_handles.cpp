#include "trackbed/sim/mujoco_handles.h"

#include <mujoco/mujoco.h>

#include "trackbed/core/error.h"
#include "trackbed/sim/mujoco_error.h"

namespace trackbed {

void MujocoDeleter::operator()(mjModel_* model) const {
  mj_deleteModel(model);
}

void MujocoDeleter::operator()(mjData_* data) const {
  mj_deleteData(data);
}

MujocoModel CopyMujocoModel(const mjModel_& model) {
  const MujocoErrorScope errors;
  MujocoModel copy(mj_copyModel(nullptr, &model));
  if (!copy) {
    throw RunError("no memory for a copy of the MuJoCo model");
  }
  return copy;
}

MujocoData MakeMujocoData(const mjModel_& model) {
  const MujocoErrorScope errors;
  MujocoData data(mj_makeData(&model));
  if (!data) {
    throw RunError("no memory for the MuJoCo simulation");
  }
  return data;
}

MujocoData CopyMujocoData(const mjModel_& model, const mjData_& data) {
  const MujocoErrorScope errors;
  MujocoData copy(mj_copyData(nullptr, &model, &data));
  if (!copy) {
    throw RunError("no memory for a copy of the MuJoCo simulation");
  }
  return copy;
}

}  // namespace trackbed
