#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace trackbed::cli {

/// What `trackbed list KIND` prints, without the texts; of "kinds" the kinds; empty if there is no
/// such kind.
std::vector<std::string> NamesOfKind(std::string_view kind);

}  // namespace trackbed::cli
