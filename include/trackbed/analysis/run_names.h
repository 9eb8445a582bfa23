#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace trackbed {

/// Returns short names of run folders, for use in results and pages. A short name is the last part
/// of the folder's path, preceded by as many parts as are needed to distinguish the path from the
/// other paths. The short names do not depend on links or on the spelling of a path, so different
/// paths to the same folder get the same name.
std::vector<std::string> ShortRunNames(const std::vector<std::filesystem::path>& folders);

}  // namespace trackbed
