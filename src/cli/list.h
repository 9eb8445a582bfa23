#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace trackbed::cli {

/// Returns the names that `trackbed list KIND` prints, without descriptions. For the kind "kinds",
/// NamesOfKind returns the names of all kinds. NamesOfKind returns an empty list for an unknown
/// kind.
std::vector<std::string> NamesOfKind(std::string_view kind);

}  // namespace trackbed::cli
