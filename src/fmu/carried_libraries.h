#pragma once

#include <filesystem>
#include <map>
#include <string>

namespace trackbed::fmu {

/// Returns the files of all shared libraries that `library` needs, directly or through others,
/// under the names by which they are needed (sonames). Leaves out the libraries of the C and C++
/// runtime, which every system has. The dynamic loader finds the files: `library` is loaded for the
/// time of the call. Throws RunError if `library` cannot be loaded.
std::map<std::string, std::filesystem::path> CarriedLibraries(const std::filesystem::path& library);

}  // namespace trackbed::fmu
