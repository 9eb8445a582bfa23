#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace trackbed {

/// Short names of run folders for results and pages: the last part of each path, with as many
/// preceding parts as distinguish it from the other paths. The names do not depend on the spelling
/// of a path or on links. Two paths of one folder get the same name.
std::vector<std::string> ShortRunNames(const std::vector<std::filesystem::path>& folders);

}  // namespace trackbed
