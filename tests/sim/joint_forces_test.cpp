#include "src/sim/joint_forces.h"

#include <gtest/gtest.h>
#include <mujoco/mujoco.h>

#include <Eigen/Geometry>
#include <vector>

#include "tests/tolerance.h"
#include "trackbed/sim/car_model.h"

namespace trackbed {
namespace {

using Eigen::Vector3d;

TEST(AddForce, IsWhatMujocoApplies) {
  const CarModel car(ComposeScene(FindModel("prius", ""), {}), "prius");
  const MujocoModel model = CopyMujocoModel(*car.get());
  const MujocoData data = MakeMujocoData(*model);
  const auto qpos = car.StandingPosition({30.0, -20.0, 1.0}, 0.3, {}, {});
  std::copy(qpos.begin(), qpos.end(), data->qpos);
  mj_step1(model.get(), data.get());
  const Vector3d point(31.0, -19.0, 0.4);
  const Vector3d force(300.0, -200.0, 4000.0);
  const Vector3d moment(10.0, 20.0, -30.0);
  for (int body = 0; body < model->nbody; ++body) {
    std::vector<double> expected(static_cast<std::size_t>(model->nv));
    mj_applyFT(model.get(), data.get(), force.data(), moment.data(), point.data(), body,
               expected.data());
    std::fill_n(data->qfrc_applied, model->nv, 0.0);
    AddForce(*model, *data, body, point, force, moment);
    for (int dof = 0; dof < model->nv; ++dof) {
      // Rounding of moments of up to 4000 N times 40 m from the origin.
      EXPECT_NEAR(data->qfrc_applied[dof], expected[static_cast<std::size_t>(dof)], Tolerance(1e-9))
          << "body " << body << ", degree of freedom " << dof;
    }
  }
}

}  // namespace
}  // namespace trackbed
