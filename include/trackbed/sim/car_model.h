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

/// The wheels of a car. All arrays and columns with a value per wheel have this order.
inline constexpr std::array<const char*, 4> kWheels{"fl", "fr", "rl", "rr"};

/// The tyre parameters in a car's file.
struct CarTyres {
  std::array<MagicFormula, 2> axle;  ///< Magic Formula coefficients of the front and rear tyres.
  /// Change of the left wheel's camber per upward spring travel, front and rear [rad/m]. Camber is
  /// positive if the wheel leans to the left; for the right wheel, the sign is reversed.
  std::array<double, 2> camber_gain{};
  double vertical_stiffness = 0.0;  ///< Vertical stiffness of a tyre [N/m].
  double vertical_damping = 0.0;    ///< Vertical damping of a tyre [N s/m].
};

inline constexpr double kAirDensity = 1.225;  ///< Air density by ISO 2533 at sea level [kg/m^3].

/// Aerodynamic force on the car, computed from the relative wind velocity v as 1/2 rho |v| v times
/// an area. The longitudinal and the lateral force have separate areas; an area of 0 means no
/// force.
struct CarAerodynamics {
  double drag_area = 0.0;                      ///< Area C_d A for wind along x [m^2].
  double side_area = 0.0;                      ///< Area C_s A for wind along y [m^2].
  std::array<double, 2> center_of_pressure{};  ///< Position x and z of the point where the force
                                               ///< acts [m].
};

/// Indices, in the compiled model, of the parts that every vehicle has. The MJCF names of the parts
/// are listed in docs/models.md.
struct ChassisParts {
  int chassis = -1;       ///< Index of the chassis body.
  int chassis_qpos = -1;  ///< Index of the free joint's coordinates in qpos.
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
  std::array<int, 2> steer_qpos{};  ///< Indices in qpos of the front left and right steering angle.
  std::array<int, 2> steer_dof{};
  int rack_qpos = -1;
  int rack_dof = -1;
  int steer_actuator = -1;  ///< Index of the steering control in ctrl.
  int steer_state = -1;     ///< Index of the steering actuator's state in act.
  int drive_actuator = -1;
  double drive_limit = 0.0;         ///< Largest drive torque on all driven wheels together [N m].
  double drive_power = 0.0;         ///< Largest drive power [W]; 0: no limit.
  double brake_torque_front = 0.0;  ///< Largest brake torque per front wheel [N m].
  double brake_torque_rear = 0.0;   ///< Largest brake torque per rear wheel [N m].
  /// Moment of inertia of each wheel about its spin axis [kg m^2].
  std::array<double, 4> spin_inertia{};
  /// Height of each wheel center in the car's frame, at rest [m].
  std::array<double, 4> hub_height{};
  std::optional<CarTyres> tyres;  ///< Tyre parameters; nullopt if the file has no coefficients.
};

/// Indices of the parts of a vehicle with differential drive. The left wheel comes before the right
/// wheel.
struct WheelPairParts : ChassisParts {
  std::array<int, 2> tyre{};   ///< Collision geom of each wheel.
  std::array<int, 2> wheel{};  ///< Body of each wheel.
  std::array<int, 2> spin_qpos{};
  std::array<int, 2> spin_dof{};
  std::array<int, 2> actuator{};  ///< Index of each wheel's control in ctrl.
  double wheel_speed = 0.0;       ///< Largest wheel speed [rad/s].
  double servo_slack = 0.0;    ///< Speed error at which a motor reaches its maximum torque [rad/s].
  double integral_time = 0.0;  ///< Integral time of a servo's PI controller [s].
  double brake_torque = 0.0;   ///< Largest brake torque per wheel [N m].
};

/// A compiled vehicle with its scene. A CarModel is immutable, and several threads may share it.
///
/// The model is compiled without visual geoms (MuJoCo's `discardvisual`). Geoms without collisions
/// that no other element of the MJCF refers to are only in scene(). The masses and the motion equal
/// those of the complete model to the last bit, and a step takes less time. Exception: if the model
/// has a density of the medium, MuJoCo's ellipsoid fluid forces on visual geoms are lost.
///
/// Errors: InputError, which names the file and all problems together, if the MJCF does not
/// compile, a named part is missing, or a part violates docs/models.md.
class CarModel {
 public:
  CarModel(Scene scene, std::string name_for_messages);
  CarModel(CarModel&&) noexcept;
  CarModel& operator=(CarModel&&) noexcept;
  ~CarModel();

  [[nodiscard]] const VehicleParams& params() const { return params_; }
  /// Returns the parameters of the vehicle without its payload, which planners and controllers use.
  /// If the scene has no payload, they equal params().
  [[nodiscard]] const VehicleParams& unladen() const { return unladen_; }
  /// Returns the parts that every vehicle has.
  [[nodiscard]] const ChassisParts& chassis() const;
  /// Returns the parts of a car with steered front wheels. Throws InternalError for other vehicles.
  [[nodiscard]] const CarParts& parts() const;
  /// Returns the parts of a vehicle with differential drive. Throws InternalError for other
  /// vehicles.
  [[nodiscard]] const WheelPairParts& wheel_pair() const;
  /// Returns the collision geoms of the wheels (four for a car, two for a differential drive), in
  /// the order of CarParts or WheelPairParts.
  [[nodiscard]] std::span<const int> tyres() const;
  /// Returns the bodies of the wheels, in the order of tyres().
  [[nodiscard]] std::span<const int> wheels() const;
  [[nodiscard]] const Scene& scene() const { return scene_; }
  /// Returns the name of the car's file, as used in messages.
  [[nodiscard]] const std::string& file() const { return file_; }
  [[nodiscard]] const mjModel_* get() const { return model_.get(); }
  [[nodiscard]] double timestep() const;

  /// Returns the column names of a configuration: x_m, y_m, z_m, qw, qx, qy, qz for the free joint,
  /// then the name of every other joint with its unit.
  [[nodiscard]] std::vector<std::string> configuration_columns() const;

  /// Extracts the configuration of the vehicle from MuJoCo's full vector qpos.
  [[nodiscard]] std::vector<double> ExtractConfiguration(std::span<const double> qpos) const;

  /// Returns the qpos of the car standing on `ground`, with its rear-axle center at `pose` as seen
  /// from above. The front wheels are steered by `steering`, the angle of the bicycle model [rad].
  /// Each wheel is rotated by `spin` [rad], which is empty or has one value for each of wheels().
  /// The vehicle frame V lies on the plane that best fits the heights of the ground under the four
  /// wheels. The plane is raised until no wheel penetrates the ground. If the car has a payload,
  /// its weight then displaces the car on its springs. For a vehicle with differential drive, the
  /// front corners of the footprint replace the front wheels.
  [[nodiscard]] std::vector<double> StandingPosition(const Pose2& pose, double steering,
                                                     const std::vector<double>& spin,
                                                     const Ground& ground) const;

  /// Returns the direction in which a standing car points, as a unit vector along the ground in the
  /// world frame. The x axis of a laden car is tilted relative to this vector.
  [[nodiscard]] Eigen::Vector3d AheadOnGround(const Pose2& pose, const Ground& ground) const;

  /// Returns the configuration of the car standing on the ground of its scene, computed as in
  /// StandingPosition.
  [[nodiscard]] std::vector<double> FlatConfiguration(const Pose2& pose, double steering,
                                                      const std::vector<double>& spin) const;

  /// Returns the qpos of the car standing on the plane z = 0.
  [[nodiscard]] std::vector<double> FlatPosition(const Pose2& pose, double steering,
                                                 const std::vector<double>& spin) const;

 private:
  Scene scene_;
  std::string file_;
  MujocoModel model_;
  VehicleParams params_;
  VehicleParams unladen_;
  int laden_keyframe_ = -1;  // Index of the keyframe of the car with its payload; -1: no payload.
  std::variant<CarParts, WheelPairParts> parts_;
};

/// Speeds of CarModel::wheels() [m/s], in a vector without heap memory.
using WheelSpeeds = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, kWheels.size(), 1>;

/// Returns the speed of each wheel along its rolling direction [m/s], if the wheels do not slip.
/// The car's rear axle moves at `speed` [m/s], and the steering angle of the bicycle model is
/// `steering` [rad].
WheelSpeeds RollingSpeeds(const VehicleParams& params, double speed, double steering);

/// Returns the version of the physics engine, such as "MuJoCo 2.2.2". Throws InternalError if the
/// versions of library and headers differ.
std::string PhysicsVersion();

}  // namespace trackbed
