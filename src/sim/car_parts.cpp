#include "src/sim/car_parts.h"

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "src/sim/contact_friction.h"
#include "src/sim/mujoco_compat.h"
#include "src/sim/parts_reader.h"
#include "src/sim/steering_response_reader.h"
#include "src/sim/trailer_parts.h"
#include "src/sim/vehicle_limits.h"
#include "src/sim/wheel_pair_parts.h"
#include "trackbed/core/error.h"

// Reads the parts and parameters of a car with steered front wheels from its compiled model. First,
// all parts of the car are looked up by name; if parts are missing, only the missing parts are
// reported. After this lookup, the types, positions, axes and ranges of the parts are checked
// against docs/models.md. Finally, the parameters of the car are computed: masses, steering, tyres
// and acceleration limits. Positions are evaluated in the model's initial configuration qpos0. All
// problems of the car's parts are collected and thrown as one InputError.
namespace trackbed {
namespace {

class CarReader final : private PartsReader {
 public:
  CarReader(const mjModel& model, const std::string& file) : PartsReader(model, file) {}

  VehicleDescription Read() {
    FindNames();
    ExplainForeignModel();
    ThrowIfAnything();
    FindAddresses();
    ReadChassis(free_);
    CheckDrive();
    ReadWheels();
    ReadSteering();
    ReadFootprint(footprint_);
    ReadTyres();
    ReadAerodynamics();
    ThrowIfAnything();
    ReadLimits();
    static_cast<ChassisParts&>(parts_) = chassis_;
    return {parts_, params_};
  }

 private:
  void FindNames() {
    chassis_.chassis = Find(mjOBJ_BODY, "body", "chassis");
    free_ = Joint("chassis", mjJNT_FREE, "free joint");
    rack_ = Joint("rack", mjJNT_HINGE, "hinge joint");
    Find(mjOBJ_GEOM, "colliding geom", "ground");
    for (std::size_t w = 0; w < kWheels.size(); ++w) {
      const std::string wheel = kWheels[w];
      parts_.tyre[w] = Find(mjOBJ_GEOM, "colliding geom", "tyre_" + wheel);
      spin_[w] = Joint("spin_" + wheel, mjJNT_HINGE, "hinge joint");
      if (w < steer_.size()) {
        steer_[w] = Joint("steer_" + wheel, mjJNT_HINGE, "hinge joint");
      }
    }
    footprint_ = Find(mjOBJ_SITE, "box site", "footprint");
    parts_.steer_actuator = Find(mjOBJ_ACTUATOR, "actuator", "steer");
    parts_.drive_actuator = Find(mjOBJ_ACTUATOR, "actuator", "drive");
    parts_.brake_torque_front = Number("brake_torque_front");
    parts_.brake_torque_rear = Number("brake_torque_rear");
    params_.steering_ratio = Number("steering_ratio");
  }

  /// Adds hints for the user to the list of missing names of parts. If the base body of the car has
  /// no free joint, a hint names the joints that move this body. If the model has no wheel with a
  /// required name, a hint explains how to make a car file.
  void ExplainForeignModel() {
    const int body = chassis_.chassis;
    if (free_ < 0 && body >= 0 && m_.body_jntnum[body] > 0) {
      std::string joints;
      for (int joint = m_.body_jntadr[body]; joint < m_.body_jntadr[body] + m_.body_jntnum[body];
           ++joint) {
        joints += (joints.empty() ? "" : ", ") + QuotedName(mjOBJ_JOINT, joint);
      }
      if (m_.jnt_type[m_.body_jntadr[body]] != mjJNT_FREE) {
        AddError("chassis",
                 fmt::format("moves by {} instead of a free joint; with a planar base, the tyres "
                             "would carry no load",
                             joints));
      }
    }
    const auto none = [](const auto& ids) {
      return std::all_of(ids.begin(), ids.end(), [](int id) { return id < 0; });
    };
    if (none(spin_) && none(parts_.tyre)) {
      AddError("", fmt::format("a model that was written for another program? `trackbed model {} "
                               "--adapt -o car.xml` proposes a car file",
                               file_));
    }
  }

  void FindAddresses() {
    parts_.rack_qpos = m_.jnt_qposadr[rack_];
    parts_.rack_dof = m_.jnt_dofadr[rack_];
    for (std::size_t w = 0; w < kWheels.size(); ++w) {
      parts_.spin_qpos[w] = m_.jnt_qposadr[spin_[w]];
      parts_.spin_dof[w] = m_.jnt_dofadr[spin_[w]];
      parts_.wheel[w] = m_.jnt_bodyid[spin_[w]];
      parts_.carrier[w] = m_.body_parentid[parts_.wheel[w]];
      // The wheel's inertia about its spin axis is the largest of its principal moments of inertia.
      const mjtNum* inertia = m_.body_inertia + 3 * parts_.wheel[w];
      parts_.spin_inertia[w] = *std::max_element(inertia, inertia + 3);
      parts_.hub_height[w] = Wheel(w, 2);
    }
    for (std::size_t w = 0; w < steer_.size(); ++w) {
      parts_.steer_qpos[w] = m_.jnt_qposadr[steer_[w]];
      parts_.steer_dof[w] = m_.jnt_dofadr[steer_[w]];
    }
    parts_.steer_state = mj::ActivationAddress(m_, parts_.steer_actuator);
  }

  [[nodiscard]] double Wheel(std::size_t w, std::size_t axis) const {
    return Place(parts_.wheel[w], axis);
  }

  void CheckDrive() {
    const mjtNum* range = m_.actuator_ctrlrange + 2 * parts_.drive_actuator;
    parts_.drive_limit = range[1];
    if (!m_.actuator_ctrllimited[parts_.drive_actuator]) {
      AddError("drive", "must be ctrllimited: ctrlrange is the maximum drive torque");
    } else if (!(range[1] > 0.0)) {
      AddError("drive", fmt::format("ctrlrange {:.4g} {:.4g}: the upper limit is the maximum drive "
                                    "torque [N m]; must be above 0",
                                    range[0], range[1]));
    }
    numerics_.Read("drive_power", parts_.drive_power);
    if (!(parts_.drive_power >= 0.0)) {
      AddError("drive_power",
               fmt::format("must not be negative, found {:.4g}", parts_.drive_power));
    }
    if (!(parts_.brake_torque_front >= 0.0 && parts_.brake_torque_rear >= 0.0 &&
          parts_.brake_torque_front + parts_.brake_torque_rear > 0.0)) {
      AddError("brake_torque_front", "brake torques must not be negative or both zero");
    }
  }

  void ReadWheels() {
    for (std::size_t w = 0; w < kWheels.size(); ++w) {
      CheckWheel(kWheels[w], spin_[w], parts_.tyre[w], parts_.tyre[0], "all four");
    }
    params_.wheel_radius = m_.geom_size[3 * parts_.tyre[0]];
    params_.wheelbase = 0.5 * (Wheel(0, 0) + Wheel(1, 0)) - 0.5 * (Wheel(2, 0) + Wheel(3, 0));
    params_.track_front = Wheel(0, 1) - Wheel(1, 1);
    params_.track_rear = Wheel(2, 1) - Wheel(3, 1);
    CheckOrigin("the rear axle", "the rear wheels", parts_.wheel[2], parts_.wheel[3]);
    if (!(params_.wheelbase > 0.0)) {
      AddError("chassis", fmt::format("the front wheels must be ahead of the rear wheels (x "
                                      "forward); they are {:.4g} m behind",
                                      -params_.wheelbase));
    }
    CheckTrack("front", "fl", "fr", params_.track_front);
    CheckTrack("rear", "rl", "rr", params_.track_rear);
  }

  void CheckTrack(const char* axle, const char* left, const char* right, double track) {
    if (!(track > 0.0)) {
      AddError(
          "chassis",
          fmt::format("{} axle: wheel {} must be left of {} (y left); it is {:.4g} m to the right",
                      axle, left, right, -track));
    }
  }

  void ReadSteering() {
    const int steer = parts_.steer_actuator;
    const mjtNum* rate = m_.actuator_ctrlrange + 2 * steer;
    const mjtNum* angle = m_.actuator_actrange + 2 * steer;
    params_.steering_rate = rate[1];
    params_.steering_limit = angle[1];
    if (!(params_.steering_ratio > 0.0)) {
      AddError("steering_ratio",
               fmt::format("must be above 0, found {:.4g}", params_.steering_ratio));
    }
    if (m_.actuator_dyntype[steer] != mjDYN_INTEGRATOR || !m_.actuator_ctrllimited[steer] ||
        !m_.actuator_actlimited[steer]) {
      AddError("steer",
               "must be an <intvelocity> with ctrllimited and actlimited: ctrlrange is the "
               "steering rate, actrange the steering angle");
      return;
    }
    if (m_.actuator_trntype[steer] != mjTRN_JOINT || m_.actuator_trnid[2 * steer] != rack_) {
      AddError("steer", "must act on the joint 'rack'");
    }
    // When the command of the steering servo changes at a constant rate, the joint follows with a
    // constant lag time. This lag time is the total damping of the joints that the servo turns,
    // divided by the servo's stiffness.
    double damping = m_.dof_damping[m_.jnt_dofadr[rack_]];
    for (const int joint : steer_) {
      damping += m_.dof_damping[m_.jnt_dofadr[joint]];
    }
    params_.steering_lag = damping / m_.actuator_gainprm[mjNGAIN * steer];
    params_.steering_response = ReadSteeringResponse(numerics_, angle[1]);
    CheckSymmetric("ctrlrange", "steering rate [rad/s]", rate);
    CheckSymmetric("actrange", "steering angle [rad]", angle);
    if (!(angle[1] < 1.5)) {
      AddError("steer",
               fmt::format("actrange {:.4g} {:.4g} is in radians; must be below 1.5 ({:.4g} "
                           "degrees are {:.4g} rad)",
                           angle[0], angle[1], angle[1], angle[1] * std::numbers::pi / 180.0));
      return;
    }
    CheckJointRange(rack_, "rack", angle[0], angle[1]);
    const FrontAngles left = AckermannAngles(params_, angle[1]);
    const FrontAngles right = AckermannAngles(params_, angle[0]);
    CheckJointRange(steer_[0], "steer_fl", right.left, left.left);
    CheckJointRange(steer_[1], "steer_fr", right.right, left.right);
    for (std::size_t w = 0; w < steer_.size(); ++w) {
      const mjtNum* axis_W = data_->xaxis + 3 * steer_[w];
      if (!(axis_W[2] > kUpright)) {
        AddError(std::string("steer_") + kWheels[w],
                 fmt::format("axis must point up (positive steers left), found {}", Text(axis_W)));
      }
    }
  }

  void CheckSymmetric(const char* attribute, const char* meaning, const mjtNum* range) {
    if (!(std::abs(range[0] + range[1]) <= kExact * std::abs(range[1]))) {
      AddError("steer",
               fmt::format("{} {:.4g} {:.4g}: {} must be equal to the left and to the right",
                           attribute, range[0], range[1], meaning));
    }
  }

  /// Rejects a joint range that is narrower than the steering range; such a range usually results
  /// from wrong units in the model file.
  void CheckJointRange(int joint, const char* name, double lowest, double highest) {
    const mjtNum* range = m_.jnt_range + 2 * joint;
    if (!m_.jnt_limited[joint]) {
      return;
    }
    if (range[0] > lowest + kExact || range[1] < highest - kExact) {
      AddError(name, fmt::format(
                         "range {:.4g} to {:.4g} rad does not cover the {:.4g} to {:.4g} rad of "
                         "the steering; without <compiler angle=\"radian\"/> ranges are in degrees",
                         range[0], range[1], lowest, highest));
    } else if (range[0] < -std::numbers::pi || range[1] > std::numbers::pi) {
      AddError(name, fmt::format("range {:.4g} to {:.4g} rad exceeds half a turn; with <compiler "
                                 "angle=\"radian\"/> ranges are in radians",
                                 range[0], range[1]));
    }
  }

  void ReadTyres() {
    parts_.tyres = trackbed::ReadTyres(numerics_);
    if (!parts_.tyres) {
      return;
    }
    double& stiffness = parts_.tyres->vertical_stiffness;
    if (!(stiffness >= 0.0)) {
      AddError("tyre_vertical_stiffness",
               fmt::format("must not be negative, found {:.4g}", stiffness));
    }
    if (!(parts_.tyres->vertical_damping >= 0.0)) {
      AddError("tyre_vertical_damping",
               fmt::format("must not be negative, found {:.4g}", parts_.tyres->vertical_damping));
    }
    if (stiffness == 0.0) {
      // static deflection of a tyre as a fraction of its radius, a typical value at nominal
      // pressure
      constexpr double kDeflection = 0.06;
      const int payload = mj_name2id(&m_, mjOBJ_BODY, kPayloadBody);
      const double mass = params_.mass - (payload < 0 ? 0.0 : m_.body_mass[payload]);
      stiffness = 0.25 * mass * std::abs(m_.opt.gravity[2]) / (kDeflection * params_.wheel_radius);
    }
    const double load = 0.5 * params_.mass * std::abs(m_.opt.gravity[2]) / params_.wheelbase;
    params_.cornering_stiffness_front =
        2.0 * CorneringStiffness(parts_.tyres->axle[0], load * params_.cg_to_rear);
    params_.cornering_stiffness_rear =
        2.0 * CorneringStiffness(parts_.tyres->axle[1], load * params_.cg_to_front());
  }

  void ReadLimits() {
    const double weight = params_.mass * std::abs(m_.opt.gravity[2]);
    const std::array<double, 2> share{params_.cg_to_rear / params_.wheelbase,
                                      params_.cg_to_front() / params_.wheelbase};
    double rolling = 0.0;  // rolling and bearing resistance of the whole car [N]
    TyreFriction friction{ContactFriction(m_, parts_.tyre[0]), ContactFriction(m_, parts_.tyre[0])};
    std::array<double, 2> wheel_mass{};
    for (std::size_t w = 0; w < kWheels.size(); ++w) {
      const std::size_t axle = w / 2;
      const double load = 0.5 * weight * share[axle];
      TyreFriction own{ContactFriction(m_, parts_.tyre[w]), ContactFriction(m_, parts_.tyre[w])};
      if (parts_.tyres) {
        const MagicFormula& tyre = parts_.tyres->axle[axle];
        const TyreFriction peak = PeakFriction(tyre, load);
        own = {std::min(own.longitudinal, peak.longitudinal), std::min(own.lateral, peak.lateral)};
        rolling += tyre.rolling_resistance * load;
      }
      friction = {std::min(friction.longitudinal, own.longitudinal),
                  std::min(friction.lateral, own.lateral)};
      rolling += m_.dof_frictionloss[parts_.spin_dof[w]] / params_.wheel_radius;
      wheel_mass[axle] += parts_.spin_inertia[w] / (params_.wheel_radius * params_.wheel_radius);
    }
    params_.friction_longitudinal = friction.longitudinal;
    params_.friction_lateral = friction.lateral;
    double rolling_mass = params_.mass + wheel_mass[0] + wheel_mass[1];
    const Towed towed = ReadTowed();
    rolling_mass += towed.rolling_mass;
    rolling += towed.rolling;
    // The factor `ahead` is the sign of the change of the front axle's load: 1 for braking, -1 for
    // driving.
    const auto limit = [&](double front_force, double ahead, double force) {
      AccelerationLimit own{.by_force = force / rolling_mass, .axles = {}};
      const std::array<double, 2> pushed{front_force, 1.0 - front_force};
      const std::array<double, 2> transfer{
          ahead * (chassis_.cg_height / params_.wheelbase + towed.transfer[0]),
          -ahead * (chassis_.cg_height / params_.wheelbase + towed.transfer[1])};
      for (std::size_t axle = 0; axle < pushed.size(); ++axle) {
        const double on_road = pushed[axle] * rolling_mass - wheel_mass[axle];
        own.axles.push_back({.weight = share[axle] + towed.weight[axle],
                             .force = std::max(0.0, on_road / params_.mass),
                             .transfer = transfer[axle]});
      }
      return own;
    };
    const double brakes = parts_.brake_torque_front + parts_.brake_torque_rear;
    const double force = parts_.drive_limit / params_.wheel_radius - rolling;
    params_.braking =
        limit(parts_.brake_torque_front / brakes, 1.0, 2.0 * brakes / params_.wheel_radius);
    params_.driving = limit(FrontDrive(), -1.0, force);
    params_.max_deceleration = params_.braking.At(friction.longitudinal);
    params_.max_acceleration = params_.driving.At(friction.longitudinal);
    params_.top_speed = TopSpeed({.force = force,
                                  .power = parts_.drive_power,
                                  .rolling = rolling,
                                  .drag_area = chassis_.aerodynamics.drag_area});
  }

  /// Effect of the trailer on the acceleration limits of the car; all 0 without a trailer.
  struct Towed {
    double rolling_mass = 0.0;  // [kg]
    double rolling = 0.0;       // Rolling resistance [N].
    // Increase of the load fractions AxleGrip::weight of the front and the rear axle by the
    // trailer's nose load.
    std::array<double, 2> weight{};
    // Additional load transfer factors of the front and the rear axle due to the trailer, as
    // fractions of the car's mass; positive if the trailer increases the load transfer.
    std::array<double, 2> transfer{};
  };

  /// The simulated trailer has no brakes. While the car brakes with the deceleration a, the trailer
  /// of mass m_t pushes the hitch forward with the force m_t a. The nose of the trailer becomes
  /// heavier by m_t a (z_t
  /// - h)/l, with its center of gravity height z_t, the hitch height h and the tongue length l.
  Towed ReadTowed() {
    const std::optional<TrailerParts> trailer = FindTrailer(m_);
    if (!trailer) {
      return {};
    }
    const TrailerParams& own = trailer->params;
    const double gravity = std::abs(m_.opt.gravity[2]);
    const double share = own.mass / params_.mass;
    const double push = share * own.hitch_height / params_.wheelbase;
    const double nose = share * (own.cg_height - own.hitch_height) / own.tongue;
    const double behind = own.hitch / params_.wheelbase;
    const std::array<double, 2> loads = NoseLoads(own, params_.wheelbase, gravity);
    const double weight = params_.mass * gravity;
    Towed towed{.rolling_mass = RollingMass(*trailer),
                .weight = {loads[0] / weight, loads[1] / weight},
                .transfer = {push - nose * behind, push - nose * (1.0 + behind)}};
    if (parts_.tyres) {
      towed.rolling =
          parts_.tyres->axle[1].rolling_resistance * own.mass * gravity * (1.0 - own.nose_share());
    }
    return towed;
  }

  /// Returns the fraction of the drive torque that acts on the front wheels.
  double FrontDrive() {
    mj_tendon(&m_, data_.get());
    mj_transmission(&m_, data_.get());
    std::array<double, 2> axle{};
    for (std::size_t w = 0; w < kWheels.size(); ++w) {
      axle[w / 2] +=
          std::abs(mj::ActuatorMoment(m_, *data_, parts_.drive_actuator, parts_.spin_dof[w]));
    }
    const double all = axle[0] + axle[1];
    return all > 0.0 ? axle[0] / all : 0.0;
  }

  CarParts parts_;
  int free_ = -1;  // index of the chassis's free joint in the model
  int rack_ = -1;
  std::array<int, 4> spin_{};
  std::array<int, 2> steer_{};
  int footprint_ = -1;  // index of the site `footprint` in the model
};

}  // namespace

const CarParts& SteeredParts(const CarModel& car, std::string_view needed_by) {
  if (car.params().kind != VehicleKind::kSteered) {
    throw InputError(
        Problem{.file = car.file(),
                .message = fmt::format("{} has differential drive; {} needs steered front wheels",
                                       car.params().name, needed_by)});
  }
  return car.parts();
}

const CarTyres& RequireTyres(const CarModel& car, std::string_view needed_by) {
  const auto& tyres = SteeredParts(car, needed_by).tyres;
  if (!tyres) {
    throw InputError(Problem{
        .file = car.file(),
        .message =
            fmt::format("the model {} has no tyre coefficients; {} needs them in <custom>: {}",
                        car.params().name, needed_by, kNeededCoefficients)});
  }
  return *tyres;
}

VehicleDescription DescribeVehicle(const mjModel& model, const std::string& file) {
  return IsWheelPair(model) ? DescribeWheelPair(model, file) : CarReader(model, file).Read();
}

}  // namespace trackbed
