#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "trackbed/core/text_table.h"

namespace trackbed {

/// How the rows of a study differ from those of another one, before a change, that set the same: of
/// the pass rate and of each output that both have, the paired differences (ComparePairs).
///
/// InputError naming the files when they vary different keys, set the same in several rows, or have
/// no row in common.
nlohmann::ordered_json StudyDifference(const TextTable& before, const std::string& before_file,
                                       const TextTable& after, const std::string& after_file);

}  // namespace trackbed
