#include "src/sim/joint_forces.h"

#include <mujoco/mujoco.h>

#include <Eigen/Geometry>

namespace trackbed {

using Eigen::Vector3d;

void AddForce(const mjModel& model, mjData& data, int body, const Vector3d& point_W,
              const Vector3d& force_W, const Vector3d& moment_W) {
  int moved = body;  // nearest body with joints: `body` itself or an ancestor
  while (moved > 0 && model.body_dofnum[moved] == 0) {
    moved = model.body_parentid[moved];
  }
  if (moved == 0) {
    return;
  }
  // In mjData::cdof, MuJoCo stores the motion of a joint (rotation, then translation) at the center
  // of mass of the kinematic tree.
  const Vector3d center_W(data.subtree_com + 3 * model.body_rootid[body]);
  const Vector3d about_center = moment_W + (point_W - center_W).cross(force_W);
  for (int dof = model.body_dofadr[moved] + model.body_dofnum[moved] - 1; dof >= 0;
       dof = model.dof_parentid[dof]) {
    const mjtNum* motion = data.cdof + 6 * dof;
    data.qfrc_applied[dof] +=
        Vector3d(motion).dot(about_center) + Vector3d(motion + 3).dot(force_W);
  }
}

}  // namespace trackbed
