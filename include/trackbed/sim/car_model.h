#pragma once

#include <Eigen/Core>
#include <array>
#include <optional>
#include <span>
#include <string>
#include <variant>
#include <vector>

#include "trackbed/sim/mujoco_handles.h"
#include "trackbed/sim/scene.h"
#include "trackbed/vehicle/magic_formula.h"
#include "trackbed/vehicle/params.h"
#include "trackbed/vehicle/state.h"

namespace trackbed {

/// The wheels of a car, in the order of every per-wheel array and column.
inline constexpr std::array<const char*, 4> kWheels{"fl", "fr", "rl", "rr"};

/// The tyre parameters in a car's file.
struct CarTyres {
  std::array<MagicFormula, 2> axle;  ///< Magic Formula of the front and rear tyres.
  /// Camber of the left wheel, to the left, per meter of upward spring travel, front and rear
  /// [rad/m]; the right wheel's camber is mirrored.
  std::array<double, 2> camber_gain{};
  double vertical_stiffness = 0.0;  ///< Vertical stiffness [N/m].
  double vertical_damping = 0.0;    ///< Vertical damping [N s/m].
};

inline constexpr double kAirDensity = 1.225;  ///< Air density by ISO 2533 at sea level [kg/m^3].

/// Aerodynamic force on the car, longitudinal and lateral: 1/2 rho |v| v times an area. There is no
/// force if the areas are 0.
struct CarAerodynamics {
  double drag_area = 0.0;                      ///< Area C_d A [m^2] for wind along x.
  double side_area = 0.0;                      ///< Area C_s A [m^2] for wind along y.
  std::array<double, 2> center_of_pressure{};  ///< x and z of the force's point of application [m].
};

/// Indices, in the compiled model, of the parts that all vehicles have. The MJCF names of the parts
/// are in docs/models.md.
struct ChassisParts {
  int chassis = -1;       ///< Index of the body.
  int chassis_qpos = -1;  ///< Index of the free joint's coordinates.
  int chassis_dof = -1;
  double cg_height = 0.0;  ///< Height of the center of gravity [m].
  CarAerodynamics aerodynamics;
};

/// Indices of the parts of a car with steered front wheels.
struct CarParts : ChassisParts {
  std::array<int, 4> tyre{};     ///< Collision geom of each wheel.
  std::array<int, 4> wheel{};    ///< Body of each wheel.
  std::array<int, 4> carrier{};  ///< Body on which each wheel spins.
  std::array<int, 4> spin_qpos{};
  std::array<int, 4> spin_dof{};
  std::array<int, 2> steer_qpos{};  ///< Front left and right.
  std::array<int, 2> steer_dof{};
  int rack_qpos = -1;
  int rack_dof = -1;
  int steer_actuator = -1;  ///< Index into ctrl.
  int steer_state = -1;     ///< Index into act.
  int drive_actuator = -1;
  double drive_limit = 0.0;         ///< Largest drive torque of both wheels together [N m].
  double drive_power = 0.0;         ///< Largest drive power [W]; 0: no limit.
  double brake_torque_front = 0.0;  ///< Largest brake torque per front wheel [N m].
  double brake_torque_rear = 0.0;   ///< Largest brake torque per rear wheel [N m].
  /// Moment of inertia about the axis of each wheel [kg m^2].
  std::array<double, 4> spin_inertia{};
  /// Height of the wheel centers at rest, in the car's frame [m].
  std::array<double, 4> hub_height{};
  std::optional<CarTyres> tyres;  ///< Tyre parameters; none if the file has no coefficients.
};

/// Indices of the parts of a vehicle with differential drive. The order of the wheels is left,
/// right.
struct WheelPairParts : ChassisParts {
  std::array<int, 2> tyre{};   ///< Collision geom of each wheel.
  std::array<int, 2> wheel{};  ///< Body of each wheel.
  std::array<int, 2> spin_qpos{};
  std::array<int, 2> spin_dof{};
  std::array<int, 2> actuator{};  ///< Index into ctrl.
  double wheel_speed = 0.0;       ///< Largest wheel speed [rad/s].
  double servo_slack = 0.0;    ///< Speed error at which a motor reaches its maximum torque [rad/s].
  double integral_time = 0.0;  ///< Integral time of a servo's PI controller [s].
  double brake_torque = 0.0;   ///< Largest brake torque per wheel [N m].
};

/// A compiled vehicle with its scene. The object is immutable, and threads may share it.
///
/// The model is compiled without visual geoms (MuJoCo's `discardvisual`): only scene() contains
/// geoms that have no collisions and no references in the MJCF. Masses and motion equal those of
/// the complete model to the last bit, and a step takes less time. Exception: in a model with a
/// density of the medium, ellipsoid fluid forces on such geoms are lost.
///
/// Errors: InputError naming the file and all problems together. Problems are an MJCF that does not
/// compile, a missing name, and a part that violates docs/models.md.
class CarModel {
 public:
  CarModel(Scene scene, std::string name_for_messages);
  CarModel(CarModel&&) noexcept;
  CarModel& operator=(CarModel&&) noexcept;
  ~CarModel();

  [[nodiscard]] const VehicleParams& params() const { return params_; }
  /// Parameters without the scene's payload, for planners and controllers. Equal to params()
  /// without a payload.
  [[nodiscard]] const VehicleParams& unladen() const { return unladen_; }
  /// The parts that all kinds of vehicles have.
  [[nodiscard]] const ChassisParts& chassis() const;
  /// The parts of a car with steered front wheels. InternalError for other vehicles.
  [[nodiscard]] const CarParts& parts() const;
  /// The parts of a vehicle with differential drive. InternalError for other vehicles.
  [[nodiscard]] const WheelPairParts& wheel_pair() const;
  /// The collision geoms of the wheels, four or two, in the order of the vehicle's parts.
  [[nodiscard]] std::span<const int> tyres() const;
  /// The bodies of the wheels, in the order of tyres().
  [[nodiscard]] std::span<const int> wheels() const;
  [[nodiscard]] const Scene& scene() const { return scene_; }
  /// The car's file, as messages name it.
  [[nodiscard]] const std::string& file() const { return file_; }
  [[nodiscard]] const mjModel_* get() const { return model_.get(); }
  [[nodiscard]] double timestep() const;

  /// Column names of a configuration: "x_m,y_m,z_m,qw,qx,qy,qz" of the free joint, then every other
  /// joint by name with its unit.
  [[nodiscard]] std::vector<std::string> configuration_columns() const;

  /// Extracts a configuration from a full qpos.
  [[nodiscard]] std::vector<double> ExtractConfiguration(std::span<const double> qpos) const;

  /// The qpos of the car standing on `ground`, with its rear-axle center at `pose` as seen from
  /// above. The wheels are at the bicycle angle `steering` and rotated by `spin` [rad], which is
  /// empty or has one value for each of wheels(). The frame V lies on the plane that best fits the
  /// heights under the four wheels. The plane is raised until no wheel penetrates the ground. A
  /// payload on the springs then displaces the car by its weight. With differential drive, the
  /// front corners of the footprint replace the front wheels.
  [[nodiscard]] std::vector<double> StandingPosition(const Pose2& pose, double steering,
                                                     const std::vector<double>& spin,
                                                     const Ground& ground) const;

  /// The unit vector, in the world, along the ground in the direction in which a standing car
  /// points. The x axis of a laden car is tilted relative to this vector.
  [[nodiscard]] Eigen::Vector3d AheadOnGround(const Pose2& pose, const Ground& ground) const;

  /// A configuration of the car standing on its scene's ground, computed as in StandingPosition.
  [[nodiscard]] std::vector<double> FlatConfiguration(const Pose2& pose, double steering,
                                                      const std::vector<double>& spin) const;

  /// The qpos of the car standing on the plane z = 0.
  [[nodiscard]] std::vector<double> FlatPosition(const Pose2& pose, double steering,
                                                 const std::vector<double>& spin) const;

 private:
  Scene scene_;
  std::string file_;
  MujocoModel model_;
  VehicleParams params_;
  VehicleParams unladen_;
  int laden_keyframe_ = -1;  // Keyframe of the car with its payload; -1: no payload.
  std::variant<CarParts, WheelPairParts> parts_;
};

/// Speeds of CarModel::wheels() [m/s], without heap memory.
using WheelSpeeds = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, kWheels.size(), 1>;

/// Speed of each wheel along its direction, without slip. The car's rear axle moves at `speed`, and
/// the wheels are at `steering`.
WheelSpeeds RollingSpeeds(const VehicleParams& params, double speed, double steering);

/// The version of the physics, such as "MuJoCo 2.2.2". InternalError if the library does not match
/// the headers.
std::string PhysicsVersion();

}  // namespace trackbed
