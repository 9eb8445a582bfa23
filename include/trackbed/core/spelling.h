#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace trackbed {

/// The word of `known` that takes the fewest single-character edits to become `word`, or an empty
/// string when none is near (more than a third of the word, at least two, or all of it would have
/// to change). Ties go to the earlier word. Cost O(|word| x total length of known).
std::string NearestSpelling(std::string_view word, const std::vector<std::string>& known);

/// "'word'; did you mean 'near'?" or "'word'; allowed: a, b, c", for messages about unknown names.
std::string UnknownName(std::string_view word, const std::vector<std::string>& known);

}  // namespace trackbed
