#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace trackbed {

/// The word of `known` with the smallest edit distance to `word`. Empty if that distance is more
/// than a third of the word (at least two edits are allowed), or would change all of it. Ties go to
/// the earlier word. Cost O(|word| x total length of known).
std::string NearestSpelling(std::string_view word, const std::vector<std::string>& known);

/// "'word'; did you mean 'near'?" or "'word'; allowed: a, b, c", for messages about unknown names.
std::string UnknownName(std::string_view word, const std::vector<std::string>& known);

}  // namespace trackbed
