#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace trackbed {

/// Returns short names of run folders for results and pages: the last part of each path, preceded
/// by as many parts as are needed to distinguish the path from the other paths. The names do not
/// depend on the spelling of a path or on links. Different paths to the same folder get the same
/// name.
std::vector<std::string> ShortRunNames(const std::vector<std::filesystem::path>& folders);

}  // namespace trackbed
