#include "src/cli/shell_quote.h"

#include <regex>

#include "trackbed/core/error.h"

namespace trackbed::cli {
namespace {

bool IsQuotable(std::string_view word) {
  return word.find_first_of("\t\n") == std::string_view::npos && WithoutControls(word) == word;
}

/// Encloses `word` in the character `quote`. In the quoted word, each character listed in `special`
/// is replaced by `replacement`, in which "&" stands for that character.
std::optional<std::string> InQuotes(std::string_view word, char quote, std::string_view special,
                                    std::string_view replacement) {
  if (!IsQuotable(word)) {
    return std::nullopt;
  }
  std::string quoted(1, quote);
  for (const char c : word) {
    if (special.find(c) == std::string_view::npos) {
      quoted += c;
      continue;
    }
    for (const char r : replacement) {
      quoted += r == '&' ? c : r;
    }
  }
  return quoted + quote;
}

}  // namespace

std::optional<std::string> QuotedForSh(std::string_view word) {
  return InQuotes(word, '\'', "'", "'\\&'");
}

std::optional<std::string> QuotedForFish(std::string_view word) {
  return InQuotes(word, '\'', "\\'", "\\&");
}

std::optional<std::string> QuotedForSbatch(std::string_view word) {
  std::optional<std::string> quoted = InQuotes(word, '"', "\\\"", "\\&");
  if (quoted) {
    // Refuse the words "packjob" and "hetjob", because Slurm interprets any line with one of these
    // words as the start of another job's options.
    static const std::regex separator("(pack|het)(job)", std::regex::icase);
    quoted = std::regex_replace(*quoted, separator, "$1\\$2");
  }
  return quoted;
}

std::string AllQuoted(const std::vector<std::string>& words,
                      std::optional<std::string> (*quoted)(std::string_view word)) {
  std::string all;
  for (const std::string& word : words) {
    if (const std::optional<std::string> one = quoted(word)) {
      all += (all.empty() ? "" : " ") + *one;
    }
  }
  return all;
}

std::string Replaced(const std::string& text, std::string_view what, std::string_view by) {
  std::string result;
  std::size_t at = 0;
  for (std::size_t found = text.find(what); found != std::string::npos;
       found = text.find(what, at)) {
    result += text.substr(at, found - at);
    result += by;
    at = found + what.size();
  }
  return result + text.substr(at);
}

}  // namespace trackbed::cli
