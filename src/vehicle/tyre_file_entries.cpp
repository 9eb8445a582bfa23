#include "src/vehicle/tyre_file_entries.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <system_error>

#include "trackbed/core/error.h"
#include "trackbed/core/foreign_content.h"
#include "trackbed/vehicle/tyre_file.h"

namespace trackbed {
namespace {

constexpr std::string_view kBlanks = " \t\r\v\f";

std::string_view WithoutBlanks(std::string_view text) {
  const std::size_t begin = text.find_first_not_of(kBlanks);
  return begin == std::string_view::npos
             ? std::string_view{}
             : text.substr(begin, text.find_last_not_of(kBlanks) - begin + 1);
}

/// Returns the part of a tyre file's line before its comment. In a tyre file, a comment begins with
/// $ or ! outside of quotes. An apostrophe opens a quoted text only at the start of a value,
/// because the text of other lines may contain apostrophes.
std::string_view WithoutComment(std::string_view line) {
  char quote = '\0';
  bool at_start_of_value = false;
  for (std::size_t i = 0; i < line.size(); ++i) {
    const char c = line[i];
    if (quote != '\0') {
      quote = c == quote ? '\0' : quote;
    } else if (c == '$' || c == '!') {
      return line.substr(0, i);
    } else if (at_start_of_value && (c == '\'' || c == '"')) {
      quote = c;
    }
    at_start_of_value =
        c == '=' || (at_start_of_value && kBlanks.find(c) != std::string_view::npos);
  }
  return line;
}

/// Returns the finite number that `token` states; nullopt if it states none. Accepts the exponents
/// of Fortran, such as 1.5D+03.
std::optional<double> NumberIn(std::string_view token) {
  std::string text(token);
  std::replace(text.begin(), text.end(), 'D', 'e');
  std::replace(text.begin(), text.end(), 'd', 'e');
  const std::size_t skipped = text.starts_with('+') ? 1 : 0;
  double value = 0.0;
  const char* end = text.data() + text.size();
  const auto [read_to, error] = std::from_chars(text.data() + skipped, end, value);
  const bool is_number = error == std::errc() && read_to == end && std::isfinite(value);
  return is_number ? std::optional(value) : std::nullopt;
}

/// Whether a line of a tyre file has only numbers, like the row of a table.
bool IsRowOfNumbers(std::string_view content) {
  while (!content.empty()) {
    const std::size_t end = content.find_first_of(kBlanks);
    if (!NumberIn(content.substr(0, end))) {
      return false;
    }
    content =
        end == std::string_view::npos ? std::string_view{} : WithoutBlanks(content.substr(end));
  }
  return true;
}

/// Splits the lines of a tyre property file.
class Splitter {
 public:
  Splitter(const std::string& name, ProblemList& problems) : name_(name), problems_(problems) {}

  void Take(std::string_view line, int number) {
    line_ = number;
    const std::string_view content = WithoutBlanks(WithoutComment(line));
    if (content.empty()) {
      return;
    }
    if (content.front() == '[') {
      TakeSection(content);
      return;
    }
    if (content.front() == '{' || IsRowOfNumbers(content)) {
      return;  // skips the row of a table, such as the table of the tyre's shape
    }
    const std::size_t equal = content.find('=');
    if (equal != std::string_view::npos) {
      TakeEntry(WithoutBlanks(content.substr(0, equal)), WithoutBlanks(content.substr(equal + 1)));
    } else {
      Fail("", fmt::format("'{}' is neither [SECTION] nor KEY = value", Excerpt(content)));
    }
  }

  std::vector<TyreFileEntry> entries;

 private:
  static std::string_view Excerpt(std::string_view text) { return text.substr(0, 60); }

  void Fail(std::string_view key, std::string message) {
    problems_.Add({.file = name_,
                   .line = line_,
                   .key = std::string(Excerpt(key)),
                   .message = std::move(message)});
  }

  void TakeSection(std::string_view content) {
    const std::size_t end = content.find(']');
    if (end == std::string_view::npos) {
      Fail("", fmt::format("'{}' has no closing bracket; must be [SECTION]", Excerpt(content)));
      return;
    }
    section_ = InCapitals(WithoutBlanks(content.substr(1, end - 1)));
  }

  void TakeEntry(std::string_view key, std::string_view value) {
    if (key.empty() || key.find_first_of(kBlanks) != std::string_view::npos) {
      Fail("", fmt::format("'{}' is no key; a key is one word, as in FNOMIN = 4000", Excerpt(key)));
      return;
    }
    if (value.empty()) {
      return;
    }
    TyreFileEntry entry{
        .section = section_, .key = InCapitals(key), .text{}, .line = line_, .number{}};
    if (value.front() == '\'' || value.front() == '"') {
      const std::size_t end = value.find(value.front(), 1);
      if (end == std::string_view::npos) {
        Fail(key, fmt::format("the text {} has no closing quote", Excerpt(value)));
        return;
      }
      entry.text = WithoutBlanks(value.substr(1, end - 1));
    } else {
      // Text after the number of an entry counts as a comment whose $ is missing. Two numbers in
      // one entry of a tyre file are an error.
      const std::size_t end = value.find_first_of(kBlanks);
      entry.text = value.substr(0, end);
      entry.number = NumberIn(entry.text);
      const std::string_view rest =
          end == std::string_view::npos ? std::string_view{} : WithoutBlanks(value.substr(end));
      if (entry.number && NumberIn(rest.substr(0, rest.find_first_of(kBlanks)))) {
        Fail(key, fmt::format("'{}' has two numbers; must be one", Excerpt(value)));
        return;
      }
    }
    if (!entry.text.empty()) {
      entries.push_back(std::move(entry));
    }
  }

  const std::string& name_;
  ProblemList& problems_;
  std::string section_;
  int line_ = 0;
};

}  // namespace

std::string InCapitals(std::string_view text) {
  std::string capitals(text);
  for (char& c : capitals) {
    c = c >= 'a' && c <= 'z' ? static_cast<char>(c - 'a' + 'A') : c;
  }
  return capitals;
}

std::vector<TyreFileEntry> SplitTyreFile(std::string_view text, const std::string& name,
                                         ProblemList& problems) {
  if (text.starts_with("\xEF\xBB\xBF")) {
    text.remove_prefix(3);
  }
  if (const std::string foreign = text.empty() ? "" : ForeignContent(text); !foreign.empty()) {
    problems.Add(
        {.file = name,
         .message = foreign + "; a tyre property file is a text of lines such as PCX1 = 1.6"});
    return {};
  }
  Splitter splitter(name, problems);
  int line = 0;
  while (!text.empty()) {
    const std::size_t end = text.find('\n');
    splitter.Take(text.substr(0, end), ++line);
    text = end == std::string_view::npos ? std::string_view{} : text.substr(end + 1);
    if (splitter.entries.size() > kMaxTyreFileEntries) {
      problems.Add({.file = name,
                    .line = line,
                    .message = fmt::format("has more than {} entries; a tyre has about 300",
                                           kMaxTyreFileEntries)});
      return {};
    }
  }
  return std::move(splitter.entries);
}

}  // namespace trackbed
