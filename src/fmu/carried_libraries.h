#pragma once

#include <filesystem>
#include <map>
#include <string>

namespace trackbed::fmu {

/// Returns the files of all shared libraries that `library` needs directly or indirectly, keyed by
/// their sonames. Omits the libraries of the C and C++ runtime, which every system has.
/// CarriedLibraries loads `library` during the call, so that the dynamic loader finds the needed
/// files. Throws RunError if `library` cannot be loaded.
std::map<std::string, std::filesystem::path> CarriedLibraries(const std::filesystem::path& library);

}  // namespace trackbed::fmu
