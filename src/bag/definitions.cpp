#include "src/bag/definitions.h"

#include <map>

// Definitions of ROS message types that vehicle recordings contain. SQLite bags before ROS 2 Iron
// need these built-in definitions, because the bags contain no message definitions. The built-in
// message definitions omit comments. Autoware types follow autoware_msgs 1.0 and
// autoware_auto_msgs.
namespace trackbed {
namespace {

const std::map<std::string, const char*>& Definitions() {
  static const std::map<std::string, const char*> definitions{
      {"builtin_interfaces/Time", "int32 sec\nuint32 nanosec"},
      {"builtin_interfaces/Duration", "int32 sec\nuint32 nanosec"},
      {"std_msgs/Header", "builtin_interfaces/Time stamp\nstring frame_id"},
      {"std_msgs/Float32", "float32 data"},
      {"std_msgs/Float64", "float64 data"},
      {"geometry_msgs/Point", "float64 x\nfloat64 y\nfloat64 z"},
      {"geometry_msgs/Vector3", "float64 x\nfloat64 y\nfloat64 z"},
      {"geometry_msgs/Quaternion", "float64 x\nfloat64 y\nfloat64 z\nfloat64 w"},
      {"geometry_msgs/Pose", "Point position\nQuaternion orientation"},
      {"geometry_msgs/PoseStamped", "std_msgs/Header header\nPose pose"},
      {"geometry_msgs/PoseWithCovariance", "Pose pose\nfloat64[36] covariance"},
      {"geometry_msgs/PoseWithCovarianceStamped",
       "std_msgs/Header header\nPoseWithCovariance pose"},
      {"geometry_msgs/Twist", "Vector3 linear\nVector3 angular"},
      {"geometry_msgs/TwistStamped", "std_msgs/Header header\nTwist twist"},
      {"geometry_msgs/TwistWithCovariance", "Twist twist\nfloat64[36] covariance"},
      {"geometry_msgs/TwistWithCovarianceStamped",
       "std_msgs/Header header\nTwistWithCovariance twist"},
      {"geometry_msgs/Accel", "Vector3 linear\nVector3 angular"},
      {"geometry_msgs/AccelStamped", "std_msgs/Header header\nAccel accel"},
      {"nav_msgs/Odometry",
       "std_msgs/Header header\nstring child_frame_id\ngeometry_msgs/PoseWithCovariance pose\n"
       "geometry_msgs/TwistWithCovariance twist"},
      {"nav_msgs/Path", "std_msgs/Header header\ngeometry_msgs/PoseStamped[] poses"},
      {"sensor_msgs/Imu",
       "std_msgs/Header header\ngeometry_msgs/Quaternion orientation\n"
       "float64[9] orientation_covariance\ngeometry_msgs/Vector3 angular_velocity\n"
       "float64[9] angular_velocity_covariance\ngeometry_msgs/Vector3 linear_acceleration\n"
       "float64[9] linear_acceleration_covariance"},
      {"sensor_msgs/NavSatStatus", "int8 status\nuint16 service"},
      {"sensor_msgs/NavSatFix",
       "std_msgs/Header header\nNavSatStatus status\nfloat64 latitude\nfloat64 longitude\n"
       "float64 altitude\nfloat64[9] position_covariance\nuint8 position_covariance_type"},
      {"ackermann_msgs/AckermannDrive",
       "float32 steering_angle\nfloat32 steering_angle_velocity\nfloat32 speed\n"
       "float32 acceleration\nfloat32 jerk"},
      {"ackermann_msgs/AckermannDriveStamped", "std_msgs/Header header\nAckermannDrive drive"},
      {"autoware_control_msgs/Lateral",
       "builtin_interfaces/Time stamp\nbuiltin_interfaces/Time control_time\n"
       "float32 steering_tire_angle\nfloat32 steering_tire_rotation_rate\n"
       "bool is_defined_steering_tire_rotation_rate"},
      {"autoware_control_msgs/Longitudinal",
       "builtin_interfaces/Time stamp\nbuiltin_interfaces/Time control_time\nfloat32 velocity\n"
       "float32 acceleration\nfloat32 jerk\nbool is_defined_acceleration\nbool is_defined_jerk"},
      {"autoware_control_msgs/Control",
       "builtin_interfaces/Time stamp\nbuiltin_interfaces/Time control_time\nLateral lateral\n"
       "Longitudinal longitudinal"},
      {"autoware_vehicle_msgs/VelocityReport",
       "std_msgs/Header header\nfloat32 longitudinal_velocity\nfloat32 lateral_velocity\n"
       "float32 heading_rate"},
      {"autoware_vehicle_msgs/SteeringReport",
       "builtin_interfaces/Time stamp\nfloat32 steering_tire_angle"},
      {"autoware_auto_control_msgs/AckermannLateralCommand",
       "builtin_interfaces/Time stamp\nfloat32 steering_tire_angle\n"
       "float32 steering_tire_rotation_rate"},
      {"autoware_auto_control_msgs/LongitudinalCommand",
       "builtin_interfaces/Time stamp\nfloat32 speed\nfloat32 acceleration\nfloat32 jerk"},
      {"autoware_auto_control_msgs/AckermannControlCommand",
       "builtin_interfaces/Time stamp\nAckermannLateralCommand lateral\n"
       "LongitudinalCommand longitudinal"},
      {"autoware_auto_vehicle_msgs/VelocityReport",
       "std_msgs/Header header\nfloat32 longitudinal_velocity\nfloat32 lateral_velocity\n"
       "float32 heading_rate"},
      {"autoware_auto_vehicle_msgs/SteeringReport",
       "builtin_interfaces/Time stamp\nfloat32 steering_tire_angle"},
  };
  return definitions;
}

}  // namespace

const char* BuiltInDefinition(const std::string& type) {
  const auto found = Definitions().find(type);
  return found == Definitions().end() ? nullptr : found->second;
}

std::vector<std::string> BuiltInTypes() {
  std::vector<std::string> types;
  for (const auto& [type, definition] : Definitions()) {
    types.push_back(type);
  }
  return types;
}

}  // namespace trackbed
