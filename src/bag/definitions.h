#pragma once

#include <string>
#include <vector>

namespace trackbed {

/// Returns the definition of a type of ROS 2 in the format ros2msg, without those of its fields'
/// types, such as of "geometry_msgs/Pose"; null if it is not built in.
const char* BuiltInDefinition(const std::string& type);
std::vector<std::string> BuiltInTypes();

}  // namespace trackbed
