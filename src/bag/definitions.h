#pragma once

#include <string>
#include <vector>

namespace trackbed {

/// Returns the definition of a type of ROS 2, such as "geometry_msgs/Pose", in the format ros2msg;
/// null if Trackbed has no built-in definition of the type. The returned message definition does
/// not include the definitions of nested message types.
const char* BuiltInDefinition(const std::string& type);
std::vector<std::string> BuiltInTypes();

}  // namespace trackbed
