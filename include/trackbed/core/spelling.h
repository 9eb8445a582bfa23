#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace trackbed {

/// Returns the word of `known` with the smallest edit distance to `word`; of several equally near
/// words, the first. The result is empty if the distance is more than a third of the word's length
/// (two edits are always allowed), or if the edits would change every letter. Cost O(|word| x total
/// length of known).
std::string NearestSpelling(std::string_view word, const std::vector<std::string>& known);

/// Formats a message about an unknown name: "'word'; did you mean 'near'?" or "'word'; allowed: a,
/// b, c".
std::string UnknownName(std::string_view word, const std::vector<std::string>& known);

}  // namespace trackbed
