#pragma once

#include <Eigen/Core>

struct mjModel_;
struct mjData_;

namespace trackbed {

/// Adds the generalized forces of a force [N] that acts on `body` at a point, and of a moment [N
/// m], to qfrc_applied. All vectors passed to AddForce are in the world frame. The added
/// generalized forces equal those of MuJoCo's mj_applyFT. AddForce visits only the joints between
/// the body and the world, so it takes about 200 instructions instead of the 2000 of mj_applyFT.
void AddForce(const mjModel_& model, mjData_& data, int body, const Eigen::Vector3d& point_W,
              const Eigen::Vector3d& force_W,
              const Eigen::Vector3d& moment_W = Eigen::Vector3d::Zero());

}  // namespace trackbed
