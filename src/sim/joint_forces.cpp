#include "src/sim/joint_forces.h"

#include <mujoco/mujoco.h>

#include <Eigen/Geometry>

namespace trackbed {

using Eigen::Vector3d;

void AddForce(const mjModel& model, mjData& data, int body, const Vector3d& point_W,
              const Vector3d& force_W, const Vector3d& moment_W) {
  int moved = body;  // the nearest body with joints in the body tree: `body` itself or one of its
                     // ancestors
  while (moved > 0 && model.body_dofnum[moved] == 0) {
    moved = model.body_parentid[moved];
  }
  if (moved == 0) {
    return;
  }
  // MuJoCo's mjData::cdof has the motion axis of each joint (rotation, then translation), with the
  // center of mass of the kinematic tree as reference point.
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
