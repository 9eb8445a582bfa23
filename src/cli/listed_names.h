#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace trackbed::cli {

/// Names printed by `trackbed list KIND`, without descriptions. For "kinds", NamesOfKind returns
/// the names of the kinds. NamesOfKind returns nothing for an unknown kind.
std::vector<std::string> NamesOfKind(std::string_view kind);

}  // namespace trackbed::cli
