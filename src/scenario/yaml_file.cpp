#include "src/scenario/yaml_file.h"

#include <fmt/format.h>
#include <yaml-cpp/eventhandler.h>

#include <algorithm>
#include <boost/locale/utf.hpp>
#include <optional>
#include <sstream>
#include <string_view>
#include <unordered_map>
#include <vector>

#include "trackbed/core/error.h"
#include "trackbed/core/file.h"

// Loads YAML and explains syntax errors to the user. In a first pass, EventTracker receives the
// events of yaml-cpp's parser, tracks open collections and quotes, and limits nesting and the
// number of values. If the first pass fails, Explain() converts yaml-cpp's message and position to
// an explanation that helps the user. Explain() recognizes errors such as a missing colon, wrong
// indentation, a tab, an unclosed bracket and an unquoted special character. A second pass detects
// unclosed quotes, because yaml-cpp often takes the rest of the text as part of the quoted value.
// Finally, if the text is valid, yaml-cpp loads the text as a tree of nodes.
namespace trackbed {
namespace {

constexpr std::size_t kMaxDepth = 64;
constexpr std::size_t kMaxValues = 100000;
constexpr std::size_t kMaxTextBytes = std::size_t{16} << 20U;
// The size limit of a YAML text allows 40 bytes for each of kMaxValues values. The size is limited
// because the parser yaml-cpp reads only about a megabyte per second.
constexpr std::size_t kMaxYamlBytes = std::size_t{4} << 20U;

[[noreturn]] void Fail(const std::string& file, const YAML::Mark& mark, std::string message) {
  throw InputError(Problem{file, mark.line + 1, mark.column + 1, "", std::move(message)});
}

/// Returns whether YAML allows this character.
bool IsPrintable(boost::locale::utf::code_point c) {
  return c == '\t' || c == '\n' || c == '\r' || c == 0x85 || (c >= 0x20 && c < 0x7f) || c >= 0xa0;
}

void RejectInvalidText(const std::string& text, const std::string& file) {
  using Utf8 = boost::locale::utf::utf_traits<char>;
  // Current position in the text; the column counts bytes and not characters, as in yaml-cpp.
  YAML::Mark mark;
  for (auto at = text.begin(); at != text.end();) {
    const auto begin = at;
    const boost::locale::utf::code_point c = Utf8::decode(at, text.end());
    if (c == boost::locale::utf::illegal || c == boost::locale::utf::incomplete) {
      Fail(file, mark,
           fmt::format("byte 0x{:02X} is not valid UTF-8", static_cast<unsigned char>(*begin)));
    }
    if (!IsPrintable(c)) {
      Fail(file, mark, fmt::format("control character U+{:04X} is not allowed", c));
    }
    mark.column = c == '\n' ? 0 : mark.column + static_cast<int>(at - begin);
    mark.line += c == '\n' ? 1 : 0;
  }
}

/// Tracks the collections that the YAML parser has opened, so that error messages can refer to
/// these collections. EventTracker also limits nesting and repetition, because YAML anchors can
/// expand a small file to an enormous tree.
class EventTracker : public YAML::EventHandler {
 public:
  explicit EventTracker(std::string file) : file_(std::move(file)) {}

  void OnDocumentStart(const YAML::Mark& mark) override {
    if (++documents_ > 1) {
      Fail(file_, mark, "second YAML document; must be one per file");
    }
  }
  void OnDocumentEnd() override {}
  void OnNull(const YAML::Mark& mark, YAML::anchor_t anchor) override { Value(mark, "", anchor); }
  void OnScalar(const YAML::Mark& mark, const std::string& tag, YAML::anchor_t anchor,
                const std::string& /*value*/) override {
    Value(mark, tag, anchor);
  }
  void OnSequenceStart(const YAML::Mark& mark, const std::string& /*tag*/, YAML::anchor_t anchor,
                       YAML::EmitterStyle::value /*style*/) override {
    Open(mark, anchor);
  }
  void OnMapStart(const YAML::Mark& mark, const std::string& /*tag*/, YAML::anchor_t anchor,
                  YAML::EmitterStyle::value /*style*/) override {
    Open(mark, anchor);
  }
  void OnSequenceEnd() override { Close(); }
  void OnMapEnd() override { Close(); }
  void OnAlias(const YAML::Mark& mark, YAML::anchor_t anchor) override {
    const auto found = sizes_.find(anchor);
    if (found == sizes_.end()) {
      Fail(file_, mark, "the alias ('*') refers to a value that contains it");
    }
    Count(mark, found->second);
  }

  /// Returns the position of the start of the innermost list or section that is still open.
  [[nodiscard]] YAML::Mark open() const {
    return open_.empty() ? YAML::Mark::null_mark() : open_.back().mark;
  }
  /// Returns the position at which the last YAML value starts if this value is quoted, else the
  /// null mark.
  [[nodiscard]] YAML::Mark quoted() const { return quoted_; }

 private:
  struct Collection {
    YAML::Mark mark;
    YAML::anchor_t anchor;
    std::size_t begin;  // number of values in the text before the start of the collection
  };

  void Count(const YAML::Mark& mark, std::size_t values) {
    values_ += values;
    if (values_ > kMaxValues) {
      Fail(file_, mark, fmt::format("more than {} values, aliases ('*') expanded", kMaxValues));
    }
  }
  void Value(const YAML::Mark& mark, const std::string& tag, YAML::anchor_t anchor) {
    Count(mark, 1);
    sizes_[anchor] = 1;
    quoted_ = tag == "!" ? mark : YAML::Mark::null_mark();
  }
  void Open(const YAML::Mark& mark, YAML::anchor_t anchor) {
    Count(mark, 1);
    open_.push_back({mark, anchor, values_});
    if (open_.size() > kMaxDepth) {
      Fail(file_, mark, fmt::format("nested deeper than {} levels", kMaxDepth));
    }
  }
  void Close() {
    sizes_[open_.back().anchor] = values_ - open_.back().begin + 1;
    open_.pop_back();
  }

  std::string file_;
  int documents_ = 0;
  std::size_t values_ = 0;
  // For each YAML anchor, the number of values that an alias of the anchor repeats.
  std::unordered_map<YAML::anchor_t, std::size_t> sizes_;
  std::vector<Collection> open_;
  YAML::Mark quoted_ = YAML::Mark::null_mark();
};

void Follow(const std::string& text, EventTracker& tracker) {
  std::istringstream stream(text);
  YAML::Parser parser(stream);
  while (parser.HandleNextDocument(tracker)) {
  }
}

std::vector<std::string_view> Lines(std::string_view text) {
  std::vector<std::string_view> lines;
  for (std::size_t begin = 0; begin <= text.size();) {
    const std::size_t end = std::min(text.find('\n', begin), text.size());
    std::string_view line = text.substr(begin, end - begin);
    line.remove_suffix(line.ends_with('\r') ? 1 : 0);
    lines.push_back(line);
    begin = end + 1;
  }
  return lines;
}

std::string_view Trimmed(std::string_view line) {
  const std::size_t begin = std::min(line.find_first_not_of(" \t"), line.size());
  return line.substr(begin, line.find_last_not_of(" \t") + 1 - begin);
}

bool HasColon(std::string_view line) {
  return line.find(": ") != std::string_view::npos || line.ends_with(':');
}

YAML::Mark MarkAt(int line, std::size_t column) {
  YAML::Mark mark;
  mark.line = line;
  mark.column = static_cast<int>(column);
  return mark;
}

/// Position of a syntax error in the text, and the error message for the user.
struct SyntaxError {
  YAML::Mark mark;
  std::string message;
};

/// Explains the syntax error that yaml-cpp reports for a key at an unexpected place; most often,
/// the actual error is in the line before the key.
SyntaxError ExplainKey(const std::vector<std::string_view>& lines, const YAML::Mark& mark) {
  const auto here = static_cast<std::size_t>(mark.line);
  const std::string_view line = lines[here];
  if (HasColon(line.substr(0, static_cast<std::size_t>(mark.column)))) {
    return {mark, "second ':' on one line; put text that contains ': ' in quotes"};
  }
  for (std::size_t i = here; i-- > 0;) {
    const std::string_view before = Trimmed(lines[i]);
    if (before.empty() || before.starts_with('#')) {
      continue;
    }
    if (!HasColon(before)) {
      return {
          MarkAt(static_cast<int>(i), lines[i].find(before)),
          fmt::format("expected 'key: value', found '{}'; is a ':' or the space after it missing?",
                      before)};
    }
    break;
  }
  return {MarkAt(mark.line, line.find(Trimmed(line))),
          "indented under a line that already has a value"};
}

/// Explains the syntax error that yaml-cpp reports if a value ends although the indentation
/// requires that the value continues.
SyntaxError ExplainEnd(const std::vector<std::string_view>& lines, const YAML::Mark& mark) {
  const std::string_view line = lines[static_cast<std::size_t>(mark.line)];
  const std::string_view rest = Trimmed(line.substr(static_cast<std::size_t>(mark.column)));
  if (rest != Trimmed(line)) {
    return {mark, fmt::format("unexpected '{}' after the end of a value", rest)};
  }
  if (rest.starts_with("- ")) {
    return {mark, "list item among 'key: value' lines"};
  }
  if (!HasColon(rest)) {
    return {mark, fmt::format("expected 'key: value', found '{}'; is a ':' missing?", rest)};
  }
  return {mark, "the indentation matches no section above"};
}

SyntaxError Explain(const std::string& text, const YAML::Exception& error,
                    const EventTracker& tracker) {
  namespace Says = YAML::ErrorMsg;
  const std::vector<std::string_view> lines = Lines(text);
  YAML::Mark mark = error.mark;
  if (mark.line < 0 || static_cast<std::size_t>(mark.line) >= lines.size()) {
    mark = MarkAt(static_cast<int>(lines.size()) - 1, lines.back().size());
  }
  const std::string& said = error.msg;
  const std::string_view line = lines[static_cast<std::size_t>(mark.line)];
  mark.column = std::min(mark.column, static_cast<int>(line.size()));
  const std::string_view here = line.substr(static_cast<std::size_t>(mark.column), 1);

  const std::size_t indentation = std::min(line.find_first_not_of(" \t"), line.size());
  const std::size_t tab = line.find('\t');
  const bool in_brackets = said == Says::END_OF_SEQ_FLOW || said == Says::END_OF_MAP_FLOW;
  if (tab < indentation && !in_brackets) {
    return {MarkAt(mark.line, tab), "tab in the indentation; YAML requires spaces"};
  }
  if (in_brackets) {
    const char bracket = said == Says::END_OF_SEQ_FLOW ? '[' : '{';
    const bool at_end = static_cast<std::size_t>(error.mark.pos) >= text.size();
    return {tracker.open().is_null() ? mark : tracker.open(),
            at_end
                ? fmt::format("'{}' is not closed", bracket)
                : fmt::format("'{}' is not closed, or a ',' is missing before line {}, column {}",
                              bracket, mark.line + 1, mark.column + 1)};
  }
  if (said == Says::FLOW_END) {
    return {mark, fmt::format("unmatched '{}'", here)};
  }
  if (said == Says::MAP_VALUE) {
    return ExplainKey(lines, mark);
  }
  if (said == Says::END_OF_MAP || said == Says::END_OF_SEQ) {
    return ExplainEnd(lines, mark);
  }
  if (said == Says::BLOCK_ENTRY) {
    return {mark, "list item ('- ') is not allowed here"};
  }
  if (said == Says::UNKNOWN_TOKEN) {
    return {mark, fmt::format("text that starts with '{}' must be in quotes", here)};
  }
  if (said.starts_with(Says::INVALID_ESCAPE)) {
    const std::size_t backslash = line.rfind('\\', static_cast<std::size_t>(mark.column));
    return {backslash == std::string_view::npos ? mark : MarkAt(mark.line, backslash),
            R"(a '\' in double quotes must be doubled: '\\')"};
  }
  if (said == Says::ALIAS_NOT_FOUND || said == Says::ANCHOR_NOT_FOUND ||
      said == Says::CHAR_IN_ALIAS || said == Says::CHAR_IN_ANCHOR) {
    return {mark, "text that starts with '*' or '&' must be in quotes"};
  }
  if (said == Says::CHAR_IN_BLOCK || said == Says::ZERO_INDENT_IN_BLOCK) {
    return {mark, "text that starts with '|' or '>' must be in quotes"};
  }
  if (said == Says::MAP_KEY) {
    return {mark, "text that starts with '? ' must be in quotes"};
  }
  // Newer versions of yaml-cpp append the name of the anchor to the message about an unknown
  // anchor.
  if (said.starts_with(Says::UNKNOWN_ANCHOR)) {
    return {mark, "the alias ('*') has no anchor ('&') above"};
  }
  return {mark, "not YAML: " + said};
}

/// Returns whether a quote is still open at the end of the text. yaml-cpp reports an open quote
/// only if no line feed follows the quote. If a line feed follows an unclosed quote, yaml-cpp
/// treats the rest of the text as the quoted value.
bool EndsInQuotes(const std::string& text) {
  if (text.find_first_of("'\"") == std::string::npos) {
    return false;
  }
  EventTracker tracker("");
  try {
    Follow(text.substr(0, text.find_last_not_of(" \t\r\n") + 1), tracker);
  } catch (const YAML::Exception& error) {
    return error.msg == YAML::ErrorMsg::EOF_IN_SCALAR;
  }
  return false;
}

}  // namespace

std::string ReadInput(const std::filesystem::path& file) {
  try {
    return ReadFile(file, kMaxTextBytes);
  } catch (const RunError& error) {
    throw InputError(Problem{.message = error.what()});
  }
}

YAML::Node LoadYamlValue(const std::string& text, const std::string& file) {
  if (text.size() > kMaxYamlBytes) {
    throw InputError(Problem{
        .file = file,
        .message = fmt::format("has {} bytes of YAML; must be at most {}: keep long tables in CSV "
                               "files that the YAML file names",
                               text.size(), kMaxYamlBytes)});
  }
  RejectInvalidText(text, file);
  // Add a line feed, so that the parser treats a value at the end of the text as complete.
  const std::string lines = text + "\n";
  EventTracker tracker(file);
  std::optional<SyntaxError> syntax_error;
  try {
    Follow(lines, tracker);
  } catch (const YAML::Exception& error) {
    syntax_error = Explain(text, error, tracker);
  }
  if (EndsInQuotes(text)) {
    if (!tracker.quoted().is_null()) {
      syntax_error = {tracker.quoted(), "the quotes opened here are not closed"};
    } else {
      syntax_error = {syntax_error ? syntax_error->mark : YAML::Mark(),
                      "quotes after this are not closed"};
    }
  }
  if (syntax_error) {
    Fail(file, syntax_error->mark, syntax_error->message);
  }
  return YAML::Load(lines);
}

YAML::Node LoadYaml(const std::string& text, const std::string& file, const char* what) {
  YAML::Node root = LoadYamlValue(text, file);
  if (!root.IsMap()) {
    throw InputError(
        Problem{file, 1, 1, "", fmt::format("{} must be a section of 'key: value' lines", what)});
  }
  return root;
}

YAML::Node NodeAt(const YAML::Node& root, const std::string& key) {
  YAML::Node node(root);
  for (std::size_t begin = 0; begin < key.size();) {
    const std::size_t end = std::min(key.find_first_of(".[", begin + 1), key.size());
    const bool is_index = key[begin] == '[';
    const std::size_t skip = is_index || key[begin] == '.' ? 1 : 0;
    const std::string step = key.substr(begin + skip, end - begin - skip - (is_index ? 1 : 0));
    if (is_index ? !node.IsSequence() : !node.IsMap()) {
      break;
    }
    const YAML::Node next = is_index ? node[std::stoul(step)] : node[step];
    if (!next) {
      break;
    }
    node.reset(next);
    begin = end;
  }
  return node;
}

}  // namespace trackbed
