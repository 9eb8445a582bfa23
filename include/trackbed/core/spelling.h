#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace trackbed {

/// Returns the word of `known` with the smallest edit distance to `word`. If several words have the
/// smallest edit distance, returns the first of these words. Returns an empty text if the smallest
/// distance is more than two edits and more than a third of the length of `word`, or if the edits
/// would change every letter. The cost is O(length of `word` x total length of all words in
/// `known`).
std::string NearestSpelling(std::string_view word, const std::vector<std::string>& known);

/// Formats a message about an unknown name `word`: "'word'; did you mean 'near'?" if a known name
/// is similar, else "'word'; allowed: a, b, c".
std::string UnknownName(std::string_view word, const std::vector<std::string>& known);

}  // namespace trackbed
