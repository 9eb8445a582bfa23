#include "src/sim/wheel_pair_parts.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "src/sim/contact_friction.h"
#include "src/sim/parts_reader.h"

// Reads the parts and parameters of a vehicle with differential drive from its compiled model.
// 1. The functions Find and Joint look up the required names; all problems are collected before one
//    error is thrown.
// 2. The limits of speed and acceleration are computed from the speed servos of the two wheels, and
//    the steering limit from the turning radius.
// 3. Supports such as caster wheels are the other round geoms that touch the ground at qpos0; the
//    positions of the supports bound the braking and driving forces.
namespace trackbed {
namespace {

/// Parameters of a wheel's speed servo, as described by its actuator.
struct Servo {
  double gain = 0.0;    ///< Torque of the wheel's speed servo per unit of speed error [N m s/rad].
  double torque = 0.0;  ///< Maximum torque of the wheel's speed servo [N m].
  double speed = 0.0;   ///< Largest wheel speed of the servo [rad/s].
};

class WheelPairReader final : private PartsReader {
 public:
  WheelPairReader(const mjModel& model, const std::string& file) : PartsReader(model, file) {}

  VehicleDescription Read() {
    FindNames();
    ThrowIfAnything();
    FindAddresses();
    ReadChassis(free_);
    params_.kind = VehicleKind::kDifferential;
    ReadWheels();
    ReadServos();
    ReadLimits();
    ReadFootprint(footprint_);
    ReadAerodynamics();
    ThrowIfAnything();
    ReadPerformance();
    static_cast<ChassisParts&>(parts_) = chassis_;
    return {parts_, params_};
  }

 private:
  void FindNames() {
    chassis_.chassis = Find(mjOBJ_BODY, "body", "chassis");
    free_ = Joint("chassis", mjJNT_FREE, "free joint");
    Find(mjOBJ_GEOM, "colliding geom", "ground");
    for (std::size_t w = 0; w < kDrivenWheels.size(); ++w) {
      const std::string wheel = kDrivenWheels[w];
      parts_.tyre[w] = Find(mjOBJ_GEOM, "colliding geom", "tyre_" + wheel);
      spin_[w] = Joint("spin_" + wheel, mjJNT_HINGE, "hinge joint");
      parts_.actuator[w] = Find(mjOBJ_ACTUATOR, "actuator", "drive_" + wheel);
    }
    footprint_ = Find(mjOBJ_SITE, "box site", "footprint");
    turning_radius_ = Number("turning_radius");
    params_.steering_rate = Number("steering_rate");
    parts_.integral_time = Number("integral_time");
    parts_.brake_torque = Number("brake_torque");
  }

  void FindAddresses() {
    for (std::size_t w = 0; w < kDrivenWheels.size(); ++w) {
      parts_.spin_qpos[w] = m_.jnt_qposadr[spin_[w]];
      parts_.spin_dof[w] = m_.jnt_dofadr[spin_[w]];
      parts_.wheel[w] = m_.jnt_bodyid[spin_[w]];
    }
  }

  void ReadWheels() {
    for (std::size_t w = 0; w < kDrivenWheels.size(); ++w) {
      CheckWheel(kDrivenWheels[w], spin_[w], parts_.tyre[w], parts_.tyre[0], "both");
    }
    params_.wheel_radius = m_.geom_size[3 * parts_.tyre[0]];
    const double left = Place(parts_.wheel[0], 1);
    const double right = Place(parts_.wheel[1], 1);
    params_.track_rear = left - right;
    params_.wheelbase = params_.track_rear;
    CheckOrigin("the axle of the driven wheels", "they", parts_.wheel[0], parts_.wheel[1]);
    if (!(left > 0.0 && std::abs(left + right) <= kExact)) {
      AddError("chassis", fmt::format("the driven wheels must be at equal distances left and right "
                                      "of y = 0; found y = {:.4g} and {:.4g} m",
                                      left, right));
    }
  }

  void ReadServos() {
    const Servo left = ReadServo(0);
    const Servo right = ReadServo(1);
    const bool readable = left.gain > 0.0 && right.gain > 0.0;
    if (readable &&
        (left.gain != right.gain || left.torque != right.torque || left.speed != right.speed)) {
      AddError("drive_right", "kv, ctrlrange and forcerange must equal those of drive_left");
    }
    parts_.wheel_speed = left.speed;
    parts_.servo_slack = left.torque / left.gain;
    servo_torque_ = left.torque;
  }

  Servo ReadServo(std::size_t w) {
    const std::string name = std::string("drive_") + kDrivenWheels[w];
    const int a = parts_.actuator[w];
    if (m_.actuator_trntype[a] != mjTRN_JOINT || m_.actuator_trnid[2 * a] != spin_[w]) {
      AddError(name, fmt::format("must act on the joint 'spin_{}'", kDrivenWheels[w]));
    }
    const double gain = m_.actuator_gainprm[mjNGAIN * a];
    const mjtNum* bias = m_.actuator_biasprm + mjNBIAS * a;
    const mjtNum* speed = m_.actuator_ctrlrange + 2 * a;
    const mjtNum* torque = m_.actuator_forcerange + 2 * a;
    const bool limited = m_.actuator_ctrllimited[a] && m_.actuator_forcelimited[a];
    const bool is_velocity = m_.actuator_dyntype[a] == mjDYN_NONE && gain > 0.0 &&
                             m_.actuator_biastype[a] == mjBIAS_AFFINE && bias[1] == 0.0 &&
                             bias[2] == -gain && m_.actuator_gear[6 * a] == 1.0;
    if (!limited || !is_velocity) {
      AddError(name,
               "must be a <velocity> of gear 1 with ctrllimited and forcelimited: ctrlrange is the "
               "maximum wheel speed, forcerange the maximum torque");
      return {};
    }
    CheckSymmetric(name, "ctrlrange", "maximum wheel speed [rad/s]", speed);
    CheckSymmetric(name, "forcerange", "maximum torque [N m]", torque);
    if (!(torque[1] / gain < speed[1])) {
      AddError(name,
               fmt::format("kv {:.4g} is too small: forcerange/kv, the speed error at maximum "
                           "torque, is {:.4g} rad/s; must be below the ctrlrange of {:.4g} rad/s",
                           gain, torque[1] / gain, speed[1]));
    }
    return {gain, torque[1], speed[1]};
  }

  void CheckSymmetric(const std::string& name, const char* attribute, const char* meaning,
                      const mjtNum* range) {
    if (!(range[1] > 0.0 && std::abs(range[0] + range[1]) <= kExact * range[1])) {
      AddError(name,
               fmt::format("{} {:.4g} {:.4g}: {} must be equal in both directions and above 0",
                           attribute, range[0], range[1], meaning));
    }
  }

  void ReadLimits() {
    // If the turning radius is half the track width, the inner wheel does not move.
    if (!(turning_radius_ >= 0.5 * params_.track_rear)) {
      AddError("turning_radius", fmt::format("must be at least half the track, {:.4g} m, so that "
                                             "the inner wheel does not reverse; found {:.4g}",
                                             0.5 * params_.track_rear, turning_radius_));
    }
    params_.steering_limit = std::atan(params_.wheelbase / turning_radius_);
    CheckAboveZero("steering_rate", params_.steering_rate);
    CheckAboveZero("integral_time", parts_.integral_time);
    CheckAboveZero("brake_torque", parts_.brake_torque);
  }

  void ReadPerformance() {
    const double radius = params_.wheel_radius;
    double wheel_mass = 0.0;
    double rolling = 0.0;  // rolling resistance [N]
    for (std::size_t w = 0; w < kDrivenWheels.size(); ++w) {
      const mjtNum* inertia = m_.body_inertia + 3 * parts_.wheel[w];
      const int dof = parts_.spin_dof[w];
      wheel_mass +=
          (*std::max_element(inertia, inertia + 3) + m_.dof_armature[dof]) / (radius * radius);
      rolling += m_.dof_frictionloss[dof] / radius;
    }
    const double friction =
        std::min(ContactFriction(m_, parts_.tyre[0]), ContactFriction(m_, parts_.tyre[1]));
    params_.friction_longitudinal = friction;
    params_.friction_lateral = friction;
    const double rolling_mass = params_.mass + wheel_mass;
    const std::vector<double> supports = OtherSupports();
    const auto limit = [&](double direction, double force) {
      AccelerationLimit own{.by_force = force / rolling_mass, .axles = {}};
      for (const double ahead : supports) {
        own.axles.push_back({.weight = 1.0 - params_.cg_to_rear / ahead,
                             .force = 1.0,
                             .transfer = direction * chassis_.cg_height / ahead});
      }
      if (own.axles.empty()) {
        own.axles.push_back({.weight = 1.0, .force = 1.0, .transfer = 0.0});
      }
      return own;
    };
    const double force = 2.0 * servo_torque_ / radius;
    params_.braking = limit(-1.0, force);
    params_.driving = limit(1.0, force - rolling);
    params_.max_deceleration = params_.braking.At(friction);
    params_.max_acceleration = params_.driving.At(friction);
    params_.top_speed = (parts_.wheel_speed - parts_.servo_slack) * radius;
  }

  /// Returns the positions of all other supports that touch the ground in the configuration qpos0,
  /// such as caster wheels [m]; positions are measured forward from the driven wheels. Only
  /// spheres, ellipsoids and capsules are recognized as supports of the vehicle. The position of
  /// each support is used as if there were no other supports, because the distribution of the load
  /// among several supports would depend on springs.
  [[nodiscard]] std::vector<double> OtherSupports() const {
    constexpr double kMaxGroundGap = 1e-3;  // [m]
    std::vector<double> ahead;
    for (int geom = 0; geom < m_.ngeom; ++geom) {
      const bool collides = (m_.geom_contype[geom] | m_.geom_conaffinity[geom]) != 0;
      const bool is_tyre =
          std::find(parts_.tyre.begin(), parts_.tyre.end(), geom) != parts_.tyre.end();
      const bool own = m_.body_rootid[m_.geom_bodyid[geom]] == chassis_.chassis;
      const mjtNum* at = data_->geom_xpos + 3 * geom;
      if (collides && own && !is_tyre && std::abs(Offset(at, 0)) > kExact &&
          Offset(at, 2) - HalfHeight(geom) < kMaxGroundGap) {
        ahead.push_back(Offset(at, 0));
      }
    }
    return ahead;
  }

  /// Returns half the height of a round geom [m]; 0 for other types of geoms.
  [[nodiscard]] double HalfHeight(int geom) const {
    const mjtNum* size = m_.geom_size + 3 * geom;
    // components of the world's z axis in the frame of the geom
    const mjtNum* up = data_->geom_xmat + 9 * geom + 6;
    switch (m_.geom_type[geom]) {
      case mjGEOM_SPHERE:
        return size[0];
      case mjGEOM_CAPSULE:
        return size[0] + size[1] * std::abs(up[2]);
      case mjGEOM_ELLIPSOID:
        return std::hypot(size[0] * up[0], size[1] * up[1], size[2] * up[2]);
      default:
        return 0.0;
    }
  }

  void CheckAboveZero(const char* name, double value) {
    if (!(value > 0.0)) {
      AddError(name, fmt::format("must be above 0, found {:.4g}", value));
    }
  }

  WheelPairParts parts_;
  int free_ = -1;  // index of the chassis's free joint in the model
  std::array<int, 2> spin_{};
  int footprint_ = -1;           // Index of the site `footprint` in the model.
  double servo_torque_ = 0.0;    // Maximum torque of one motor [N m].
  double turning_radius_ = 0.0;  // Smallest turning radius of the vehicle [m].
};

}  // namespace

bool IsWheelPair(const mjModel& model) {
  const auto has = [&](const char* actuator) {
    return mj_name2id(&model, mjOBJ_ACTUATOR, actuator) >= 0;
  };
  return (has("drive_left") || has("drive_right")) && !has("steer");
}

VehicleDescription DescribeWheelPair(const mjModel& model, const std::string& file) {
  return WheelPairReader(model, file).Read();
}

}  // namespace trackbed
