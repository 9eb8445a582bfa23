#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "trackbed/core/text_table.h"

namespace trackbed {

/// Computes how the pass rate and each common output differ between two studies, before and after a
/// change. Rows of both studies with equal settings are compared as pairs (ComparePairs).
///
/// Throws InputError naming the files if the studies vary different keys, have equal settings in
/// several rows, or have no row in common.
nlohmann::ordered_json StudyDifference(const TextTable& before, const std::string& before_file,
                                       const TextTable& after, const std::string& after_file);

}  // namespace trackbed
