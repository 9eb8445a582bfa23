#include "trackbed/sim/model_notes.h"

#include <fmt/format.h>
#include <mujoco/mujoco.h>

#include <algorithm>

#include "src/sim/object_name.h"
#include "trackbed/sim/mujoco_error.h"

namespace trackbed {
namespace {

/// Adds a note for each contact between a tyre and another geom of the car at qpos0.
void AddRubbingTyres(const CarModel& car, std::vector<std::string>& notes) {
  const mjModel& model = *car.get();
  const MujocoData data = MakeMujocoData(model);
  mj_fwdPosition(&model, data.get());
  const int root = model.body_rootid[car.chassis().chassis];
  for (int i = 0; i < data->ncon; ++i) {
    const int a = data->contact[i].geom1;
    const int b = data->contact[i].geom2;
    if (a < 0 || b < 0 || model.body_rootid[model.geom_bodyid[a]] != root ||
        model.body_rootid[model.geom_bodyid[b]] != root) {
      continue;
    }
    const auto is_tyre = [&](int geom) {
      return std::find(car.tyres().begin(), car.tyres().end(), geom) != car.tyres().end();
    };
    if (is_tyre(a) || is_tyre(b)) {
      const int tyre = is_tyre(a) ? a : b;
      const int other = is_tyre(a) ? b : a;
      notes.push_back(fmt::format(
          "{} touches the geom {} of the body {} at rest; give that geom contype=\"0\" and "
          "conaffinity=\"0\", or make it smaller",
          mj_id2name(&model, mjOBJ_GEOM, tyre), ObjectName(model, mjOBJ_GEOM, other),
          ObjectName(model, mjOBJ_BODY, model.geom_bodyid[other])));
    }
  }
}

/// Adds a note for each equality constraint that couples a steered wheel to another joint than the
/// rack.
void AddLeftoverCouplings(const CarModel& car, std::vector<std::string>& notes) {
  if (car.params().kind != VehicleKind::kSteered) {
    return;
  }
  const mjModel& model = *car.get();
  const int rack = mj_name2id(&model, mjOBJ_JOINT, "rack");
  const int left = mj_name2id(&model, mjOBJ_JOINT, "steer_fl");
  const int right = mj_name2id(&model, mjOBJ_JOINT, "steer_fr");
  for (int i = 0; i < model.neq; ++i) {
    const int a = model.eq_obj1id[i];
    const int b = model.eq_obj2id[i];
    const bool steers = a == left || a == right || b == left || b == right;
    if (model.eq_type[i] == mjEQ_JOINT && steers && a != rack && b != rack) {
      notes.push_back(fmt::format(
          "the equality constraint {} between the joints {} and {} works against Ackermann's "
          "linkage; remove it",
          ObjectName(model, mjOBJ_EQUALITY, i), ObjectName(model, mjOBJ_JOINT, a),
          b < 0 ? "none" : ObjectName(model, mjOBJ_JOINT, b)));
    }
  }
}

}  // namespace

std::vector<std::string> NotesOnModel(const CarModel& car) {
  const MujocoErrorScope errors;
  std::vector<std::string> notes;
  AddRubbingTyres(car, notes);
  AddLeftoverCouplings(car, notes);
  return notes;
}

}  // namespace trackbed
