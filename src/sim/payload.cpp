#include "trackbed/sim/payload.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <mujoco/mujoco.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <string>

#include "src/sim/car_parts.h"
#include "src/sim/scene_xml.h"
#include "trackbed/core/error.h"
#include "trackbed/sim/mujoco_error.h"
#include "trackbed/sim/mujoco_handles.h"

namespace trackbed {
namespace {

using tinyxml2::XMLDocument;
using tinyxml2::XMLElement;

/// Simulates a car with locked brakes until it has settled on its springs.
class Settling {
 public:
  explicit Settling(const CarModel& car)
      : car_(car), model_(CopyMujocoModel(*car.get())), data_(MakeMujocoData(*model_)) {
    const auto start = car.FlatPosition({}, 0.0, {});
    std::copy(start.begin(), start.end(), data_->qpos);
    for (std::size_t w = 0; w < kWheels.size(); ++w) {
      model_->dof_frictionloss[car.parts().spin_dof[w]] +=
          w < 2 ? car.parts().brake_torque_front : car.parts().brake_torque_rear;
    }
  }

  /// Simulates the car until it is at rest. Run returns false if the car is not at rest after 30 s
  /// of simulated time.
  bool Run() {
    const MujocoErrorScope errors;
    // Maximum simulated time until the car must be at rest [s].
    constexpr double kMaxSettlingTime = 30.0;
    // On springs with a natural frequency of at least 1 Hz, a car slower than kRestSpeed is less
    // than a micrometer from its equilibrium. Speed below which a joint is considered at rest
    // [m/s], [rad/s].
    constexpr double kRestSpeed = 1e-6;
    constexpr double kCheckInterval = 0.5;
    // The largest speed within an interval is checked, since an oscillating car is also slow at its
    // turning points.
    double fastest = 0.0;
    for (double next = kCheckInterval; data_->time < kMaxSettlingTime;) {
      mj_step(model_.get(), data_.get());
      if (std::any_of(std::begin(data_->warning), std::end(data_->warning),
                      [](const mjWarningStat& warning) { return warning.number > 0; })) {
        return false;
      }
      for (int dof = 0; dof < model_->nv; ++dof) {
        fastest = std::max(fastest, std::abs(data_->qvel[dof]));
      }
      if (data_->time > next) {
        if (fastest < kRestSpeed) {
          return true;
        }
        fastest = 0.0;
        next += kCheckInterval;
      }
    }
    return false;
  }

  /// Returns MuJoCo's configuration qpos of the settled car, moved to the origin, with its heading
  /// along x and straight wheels.
  [[nodiscard]] std::vector<double> Position() const {
    std::vector<double> qpos(data_->qpos, data_->qpos + model_->nq);
    const auto chassis = static_cast<std::size_t>(car_.parts().chassis_qpos);
    qpos[chassis] = 0.0;
    qpos[chassis + 1] = 0.0;
    const Eigen::Quaterniond turn(qpos[chassis + 3], qpos[chassis + 4], qpos[chassis + 5],
                                  qpos[chassis + 6]);
    const Eigen::Vector3d ahead = turn * Eigen::Vector3d::UnitX();
    const Eigen::Quaterniond straight =
        Eigen::AngleAxisd(-std::atan2(ahead.y(), ahead.x()), Eigen::Vector3d::UnitZ()) * turn;
    qpos[chassis + 3] = straight.w();
    qpos[chassis + 4] = straight.x();
    qpos[chassis + 5] = straight.y();
    qpos[chassis + 6] = straight.z();
    const CarParts& parts = car_.parts();
    for (const int address :
         {parts.spin_qpos[0], parts.spin_qpos[1], parts.spin_qpos[2], parts.spin_qpos[3],
          parts.steer_qpos[0], parts.steer_qpos[1], parts.rack_qpos}) {
      qpos[static_cast<std::size_t>(address)] = 0.0;
    }
    return qpos;
  }

  [[nodiscard]] bool OnAllWheels() const {
    const std::vector<double> qpos = Position();
    const auto chassis = static_cast<std::size_t>(car_.parts().chassis_qpos);
    const Eigen::Quaterniond turn(qpos[chassis + 3], qpos[chassis + 4], qpos[chassis + 5],
                                  qpos[chassis + 6]);
    constexpr double kUpright = 0.9;
    return (turn * Eigen::Vector3d::UnitZ()).z() > kUpright &&
           std::all_of(car_.parts().tyre.begin(), car_.parts().tyre.end(), [&](int tyre) {
             return std::any_of(data_->contact, data_->contact + data_->ncon,
                                [&](const mjContact& contact) {
                                  return contact.geom1 == tyre || contact.geom2 == tyre;
                                });
           });
  }

 private:
  const CarModel& car_;
  MujocoModel model_;
  MujocoData data_;
};

}  // namespace

Scene WithPayload(const CarModel& car, const Payload& payload) {
  static_cast<void>(SteeredParts(car, "disturb.payload"));
  const double mass = payload.mass ? *payload.mass : *payload.share * car.params().mass;
  XMLDocument document;
  ParseComposed(car.scene().xml, document);
  XMLElement& root = *document.RootElement();
  XMLElement* chassis = FindInWorld(root, "body", "chassis");
  TRACKBED_CHECK(chassis != nullptr, "the car has no body 'chassis'");
  XMLElement* body = chassis->InsertNewChildElement("body");
  body->SetAttribute("name", kPayloadBody);
  body->SetAttribute(
      "pos", Numbers({payload.x, payload.y, payload.z.value_or(car.parts().cg_height)}).c_str());
  XMLElement* inertial = body->InsertNewChildElement("inertial");
  inertial->SetAttribute("pos", "0 0 0");
  inertial->SetAttribute("mass", Numbers({mass}).c_str());
  inertial->SetAttribute("diaginertia", "0 0 0");
  Scene scene = car.scene();
  scene.lines.clear();
  scene.xml = Print(document);

  const CarModel laden(scene, car.file());
  Settling settling(laden);
  if (!settling.Run() || !settling.OnAllWheels()) {
    throw InputError(
        Problem{.file = car.file(),
                .message = fmt::format("{} does not come to rest on four wheels with a payload of "
                                       "{:.4g} kg at x = {:.4g} m, y = {:.4g} m",
                                       car.params().name, mass, payload.x, payload.y)});
  }
  XMLElement* key = root.InsertNewChildElement("keyframe")->InsertNewChildElement("key");
  key->SetAttribute("name", kLadenKeyframe);
  key->SetAttribute("qpos", fmt::format("{}", fmt::join(settling.Position(), " ")).c_str());
  scene.xml = Print(document);
  return scene;
}

}  // namespace trackbed
