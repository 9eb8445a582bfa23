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
#include "trackbed/vehicle/trailer.h"

namespace trackbed {

/// Names of the wheels of a car. All arrays and columns with one value per wheel are in the order
/// of kWheels.
inline constexpr std::array<const char*, 4> kWheels{"fl", "fr", "rl", "rr"};

/// The tyre parameters that a car's file specifies.
struct CarTyres {
  std::array<MagicFormula, 2> axle;  ///< Magic Formula coefficients of the front and rear tyres.
  /// Change of the left wheel's camber per upward spring travel, for the front and the rear axle
  /// [rad/m]. Camber is positive if the wheel leans to the left. For the right wheel, the change of
  /// camber has the opposite sign.
  std::array<double, 2> camber_gain{};
  double vertical_stiffness = 0.0;  ///< Vertical stiffness of a tyre [N/m].
  double vertical_damping = 0.0;    ///< Vertical damping of a tyre [N s/m].
};

/// Density of air at sea level, from ISO 2533 [kg/m^3].
inline constexpr double kAirDensity = 1.225;

/// Aerodynamic force on the car, computed from the relative wind velocity v as 1/2 rho |v| v times
/// an area, with the air density rho. The longitudinal and the lateral aerodynamic force have
/// separate areas; an area of 0 means no force.
struct CarAerodynamics {
  double drag_area = 0.0;  ///< Effective area C_d A for wind along x [m^2].
  double side_area = 0.0;  ///< Effective area C_s A for wind along y [m^2].
  /// Position (x, z) of the point at which the aerodynamic force acts [m].
  std::array<double, 2> center_of_pressure{};
};

/// Indices, in the compiled MuJoCo model, of the parts that every vehicle has. The MJCF names of
/// the parts are listed in docs/models.md.
struct ChassisParts {
  int chassis = -1;       ///< Index of the chassis body.
  int chassis_qpos = -1;  ///< Index in qpos of the coordinates of the free joint.
  int chassis_dof = -1;
  double cg_height = 0.0;  ///< Height of the vehicle's center of gravity [m].
  CarAerodynamics aerodynamics;
};

/// Indices, in the compiled MuJoCo model, of the parts of a car with steered front wheels.
struct CarParts : ChassisParts {
  std::array<int, 4> tyre{};   ///< Index of the collision geom of each wheel.
  std::array<int, 4> wheel{};  ///< Index of the body of each wheel.
  /// Index of the body that carries each wheel and on which the wheel spins.
  std::array<int, 4> carrier{};
  std::array<int, 4> spin_qpos{};
  std::array<int, 4> spin_dof{};
  /// Indices in qpos of the steering angles of the front left and the front right wheel.
  std::array<int, 2> steer_qpos{};
  std::array<int, 2> steer_dof{};
  int rack_qpos = -1;
  int rack_dof = -1;
  int steer_actuator = -1;  ///< Index of the steering control in MuJoCo's ctrl.
  int steer_state = -1;     ///< Index of the steering actuator's state in MuJoCo's act.
  int drive_actuator = -1;
  double drive_limit = 0.0;  ///< Largest total drive torque on all driven wheels together [N m].
  double drive_power = 0.0;  ///< Largest power of the drive [W]; 0: no limit.
  double brake_torque_front = 0.0;  ///< Largest brake torque per front wheel [N m].
  double brake_torque_rear = 0.0;   ///< Largest brake torque per rear wheel [N m].
  /// Moment of inertia of each wheel about its spin axis [kg m^2].
  std::array<double, 4> spin_inertia{};
  /// Height of each wheel center in the car's frame, at rest [m].
  std::array<double, 4> hub_height{};
  /// Tyre parameters; nullopt if the car's file has no tyre coefficients.
  std::optional<CarTyres> tyres;
};

/// Indices, in the compiled MuJoCo model, of the parts of a vehicle with differential drive. In all
/// arrays, the left wheel comes before the right wheel.
struct WheelPairParts : ChassisParts {
  std::array<int, 2> tyre{};   ///< Index of the collision geom of each wheel.
  std::array<int, 2> wheel{};  ///< Index of the body of each wheel.
  std::array<int, 2> spin_qpos{};
  std::array<int, 2> spin_dof{};
  std::array<int, 2> actuator{};  ///< Index of each wheel's control in MuJoCo's ctrl.
  double wheel_speed = 0.0;       ///< Largest angular speed of a wheel [rad/s].
  /// Error of the wheel speed at which the servo commands the motor's maximum torque [rad/s].
  double servo_slack = 0.0;
  double integral_time = 0.0;  ///< Integral time of the PI controller of a wheel servo [s].
  double brake_torque = 0.0;   ///< Largest brake torque per wheel [N m].
};

/// Indices, in the compiled MuJoCo model, of the parts that WithTrailer adds to a car. In all
/// arrays, the left wheel comes before the right wheel.
struct TrailerParts {
  TrailerParams params;
  int body = -1;  ///< Index of the trailer's body, which the hitch moves.
  /// Indices of the coordinates of the hitch: yaw, pitch and roll of the trailer relative to the
  /// car, in this order.
  std::array<int, 3> hitch_qpos{};
  std::array<int, 3> hitch_dof{};
  std::array<int, 2> tyre{};     ///< Index of the collision geom of each wheel.
  std::array<int, 2> wheel{};    ///< Index of the body of each wheel.
  std::array<int, 2> carrier{};  ///< Index of the body on which each wheel spins.
  std::array<int, 2> spin_qpos{};
  std::array<int, 2> spin_dof{};
  std::array<double, 2> spin_inertia{};  ///< Inertia of each wheel about its spin axis [kg m^2].
  double hub_height = 0.0;               ///< Height of the trailer's wheel centers, at rest [m].
};

/// A vehicle compiled by MuJoCo, with its scene. A CarModel is immutable, so several threads may
/// share a CarModel.
///
/// The model is compiled without visual geoms (MuJoCo's `discardvisual`). Visual geoms (without
/// collisions, and not referenced by other elements of the MJCF) are only in scene(). Without
/// visual geoms, a simulation step takes less time, and masses and motion are bit for bit the same.
/// Without visual geoms, the motion differs only if the model specifies the density of a medium,
/// because MuJoCo's ellipsoid fluid forces on visual geoms are then missing.
///
/// Errors: throws InputError if the MJCF does not compile, if a named part is missing, or if a part
/// does not follow the rules in docs/models.md. The error message lists the file and all problems.
class CarModel {
 public:
  CarModel(Scene scene, std::string name_for_messages);
  CarModel(CarModel&&) noexcept;
  CarModel& operator=(CarModel&&) noexcept;
  ~CarModel();

  [[nodiscard]] const VehicleParams& params() const { return params_; }
  /// Returns the parameters of the vehicle without its payload. Planners and controllers use the
  /// parameters without payload. If the scene has no payload, the returned parameters equal
  /// params().
  [[nodiscard]] const VehicleParams& unladen() const { return unladen_; }
  /// Returns the indices of the parts that every vehicle has.
  [[nodiscard]] const ChassisParts& chassis() const;
  /// Returns the indices of the parts of a car with steered front wheels. Throws InternalError if
  /// the vehicle has no steered front wheels.
  [[nodiscard]] const CarParts& parts() const;
  /// Returns the indices of the parts of a vehicle with differential drive. Throws InternalError if
  /// the vehicle has no differential drive.
  [[nodiscard]] const WheelPairParts& wheel_pair() const;
  /// Returns the trailer of the car; nullopt without a trailer. The parameters of the car (params,
  /// unladen) do not include the trailer, except for the limits of acceleration and the top speed.
  [[nodiscard]] const std::optional<TrailerParts>& trailer() const { return trailer_; }
  /// Returns the collision geoms of the wheels (four for a car, two for a differential drive), in
  /// the order of CarParts or WheelPairParts. The returned geoms do not include the wheels of a
  /// trailer.
  [[nodiscard]] std::span<const int> tyres() const;
  /// Returns the indices of the wheels' bodies, in the same order as tyres().
  [[nodiscard]] std::span<const int> wheels() const;
  [[nodiscard]] const Scene& scene() const { return scene_; }
  /// Returns the name of the car's file, for use in messages.
  [[nodiscard]] const std::string& file() const { return file_; }
  [[nodiscard]] const mjModel_* get() const { return model_.get(); }
  [[nodiscard]] double timestep() const;

  /// Returns the names of the components of a configuration vector. The names are x_m, y_m, z_m,
  /// qw, qx, qy, qz for the free joint, followed by the name of every other joint with its unit.
  [[nodiscard]] std::vector<std::string> configuration_columns() const;

  /// Returns the configuration vector of the vehicle, taken from MuJoCo's full position vector
  /// qpos.
  [[nodiscard]] std::vector<double> ExtractConfiguration(std::span<const double> qpos) const;

  /// Returns the position vector qpos of the car at rest on `ground`, with its rear-axle center at
  /// `pose` as seen from above. The argument `steering` is the steering angle of the bicycle model
  /// [rad]. The argument `spin` is the rotation angle of each wheel [rad], with one value for each
  /// of wheels(); if `spin` is empty, all angles are 0. The x and y axes of the vehicle frame V lie
  /// in the plane that best fits the heights of the ground under the four wheels. StandingPosition
  /// raises the vehicle until no wheel penetrates the ground. If the car has a payload, its springs
  /// are compressed by the weight of the payload. For a vehicle with differential drive,
  /// StandingPosition uses the front corners of the footprint instead of front wheels. A trailer
  /// stands on the ground at the hitch angle `hitch_angle` [rad].
  [[nodiscard]] std::vector<double> StandingPosition(const Pose2& pose, double steering,
                                                     const std::vector<double>& spin,
                                                     const Ground& ground,
                                                     double hitch_angle = 0.0) const;

  /// Returns the direction in which a car at rest points, as a unit vector along the ground in
  /// world coordinates. The x axis of a car with payload is tilted relative to the returned
  /// direction.
  [[nodiscard]] Eigen::Vector3d AheadOnGround(const Pose2& pose, const Ground& ground) const;

  /// Returns the configuration vector of the car at rest on the ground of its scene, computed as in
  /// StandingPosition.
  [[nodiscard]] std::vector<double> FlatConfiguration(const Pose2& pose, double steering,
                                                      const std::vector<double>& spin,
                                                      double hitch_angle = 0.0) const;

  /// Returns the position vector qpos of the car at rest on the plane z = 0.
  [[nodiscard]] std::vector<double> FlatPosition(const Pose2& pose, double steering,
                                                 const std::vector<double>& spin) const;

 private:
  Scene scene_;
  std::string file_;
  MujocoModel model_;
  VehicleParams params_;
  VehicleParams unladen_;
  // Index of the keyframe with the position of the car with payload; -1: no payload.
  int laden_keyframe_ = -1;
  std::variant<CarParts, WheelPairParts> parts_;
  std::optional<TrailerParts> trailer_;
};

/// Vector of the speeds of CarModel::wheels() [m/s], stored without heap memory.
using WheelSpeeds = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, kWheels.size(), 1>;

/// Returns the speed of each wheel along its rolling direction [m/s], assuming that the wheels do
/// not slip. The car's rear axle moves at `speed` [m/s], and the steering angle of the bicycle
/// model is `steering` [rad].
WheelSpeeds RollingSpeeds(const VehicleParams& params, double speed, double steering);

/// Returns the version of the physics engine, such as "MuJoCo 2.2.2". Throws InternalError if
/// MuJoCo's library and headers have different versions.
std::string PhysicsVersion();

}  // namespace trackbed
