#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "trackbed/core/text_table.h"

namespace trackbed {

/// Paired differences (ComparePairs) between two studies, before and after a change, of the rows
/// with equal settings: for the pass rate and each common output.
///
/// Throws InputError naming the files if they vary different keys, have equal settings in several
/// rows, or have no row in common.
nlohmann::ordered_json StudyDifference(const TextTable& before, const std::string& before_file,
                                       const TextTable& after, const std::string& after_file);

}  // namespace trackbed
