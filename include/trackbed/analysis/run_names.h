#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace trackbed {

/// Names of run folders for results and pages: the last part of each path, with as many parts
/// before it as distinguish it from the others. Independent of how a path is written and of links.
/// Paths of one folder get one name.
std::vector<std::string> ShortRunNames(const std::vector<std::filesystem::path>& folders);

}  // namespace trackbed
