#pragma once

#include <string>
#include <vector>

namespace trackbed {

/// Returns the definition of a type of ROS 2, such as "geometry_msgs/Pose", in the format ros2msg;
/// null if the type is not built in. The definition does not contain the definitions of the types
/// of the fields.
const char* BuiltInDefinition(const std::string& type);
std::vector<std::string> BuiltInTypes();

}  // namespace trackbed
