#pragma once

#include <map>
#include <string>

namespace trackbed::fmu {

/// Returns the text that identifies an FMU: a hash of the names and contents of its resources, in
/// the form of a GUID, which FMI 2 requires.
std::string TokenOf(const std::map<std::string, std::string>& resources);

}  // namespace trackbed::fmu
