#include "trackbed/core/spelling.h"

#include <fmt/ranges.h>

#include <algorithm>
#include <numeric>

namespace trackbed {
namespace {

/// Returns the Levenshtein distance between two words. Only one row of the distance matrix is
/// stored at a time.
std::size_t EditDistance(std::string_view a, std::string_view b) {
  std::vector<std::size_t> row(b.size() + 1);
  std::iota(row.begin(), row.end(), std::size_t{0});
  for (std::size_t i = 1; i <= a.size(); ++i) {
    std::size_t diagonal = row[0];
    row[0] = i;
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const std::size_t above = row[j];
      const std::size_t replaced = diagonal + (a[i - 1] == b[j - 1] ? 0 : 1);
      row[j] = std::min({replaced, above + 1, row[j - 1] + 1});
      diagonal = above;
    }
  }
  return row[b.size()];
}

}  // namespace

std::string NearestSpelling(std::string_view word, const std::vector<std::string>& known) {
  std::string nearest;
  // Ignore candidates that differ from the word in all letters, because such a word is not a
  // misspelling of the candidate.
  std::size_t fewest = std::min(std::max<std::size_t>(2, word.size() / 3) + 1, word.size());
  for (const std::string& candidate : known) {
    const std::size_t edits = EditDistance(word, candidate);
    if (edits < fewest) {
      fewest = edits;
      nearest = candidate;
    }
  }
  return nearest;
}

std::string UnknownName(std::string_view word, const std::vector<std::string>& known) {
  const std::string nearest = NearestSpelling(word, known);
  if (!nearest.empty()) {
    return fmt::format("'{}'; did you mean '{}'?", word, nearest);
  }
  return fmt::format("'{}'; allowed: {}", word, fmt::join(known, ", "));
}

}  // namespace trackbed
