#include "trackbed/analysis/json_file.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>

#include "trackbed/analysis/run_folder.h"
#include "trackbed/core/file.h"

// Reads JSON files of results, which a user may have edited or truncated.
// 1. ParseJson limits the size and the depth of a file, and converts errors of nlohmann::json to an
//    InputError with file, line and column.
// 2. JsonValue refers to a value in the document and knows its path, such as plants[0].end.
// 3. Each getter of JsonValue checks the type of the value, and otherwise throws an InputError that
//    names the file and the path.
namespace trackbed {

using nlohmann::ordered_json;

namespace {

/// Converts the position of a byte in a text to a line and a column. Position counts bytes, lines
/// and columns from 1.
std::pair<int, int> Position(std::string_view text, std::size_t byte) {
  const std::string_view before = text.substr(0, byte == 0 ? 0 : byte - 1);
  // For a byte in the first line of the text, rfind returns npos, so that `line_begin` becomes npos
  // + 1 = 0.
  const std::size_t line_begin = before.rfind('\n') + 1;
  return {1 + static_cast<int>(std::count(before.begin(), before.end(), '\n')),
          1 + static_cast<int>(before.size() - line_begin)};
}

/// Returns the part of an nlohmann::json error message that follows the text `mark`. After()
/// removes the error number and the position from a message such as
/// "[json.exception.parse_error.101] parse error at line 1, column 2: unexpected end of input".
std::string_view After(std::string_view mark, std::string_view said) {
  const std::size_t place = said.find(mark);
  return place == std::string_view::npos ? said : said.substr(place + mark.size());
}

}  // namespace

ordered_json ParseJson(const std::filesystem::path& file) {
  constexpr std::size_t kMaxJsonBytes = std::size_t{16} << 20U;
  return ParseJsonOf(file.string(), ReadFile(file, kMaxJsonBytes));
}

ordered_json ParseJsonOf(const std::string& file, std::string_view text) {
  constexpr int kMaxDepth = 64;
  try {
    return ordered_json::parse(text, [&](int depth, ordered_json::parse_event_t /*event*/,
                                         const ordered_json& /*parsed*/) {
      if (depth > kMaxDepth) {
        throw InputError(Problem{
            .file = file, .message = fmt::format("nested deeper than {} levels", kMaxDepth)});
      }
      return true;
    });
  } catch (const nlohmann::json::parse_error& error) {
    const auto [line, column] = Position(text, error.byte);
    throw InputError(
        Problem{file, line, column, "", fmt::format("not JSON: {}", After(": ", error.what()))});
  } catch (const nlohmann::json::exception& error) {
    // nlohmann::json throws this exception type for a number beyond the range of a double.
    throw InputError(
        Problem{.file = file, .message = fmt::format("not JSON: {}", After("] ", error.what()))});
  }
}

std::string JsonText(const ordered_json& json) {
  return json.dump(2, ' ', false, ordered_json::error_handler_t::replace) + "\n";
}

namespace {

/// Describes a JSON value for an error message.
std::string Describe(const ordered_json& json) {
  constexpr std::size_t kMaxShownLength = 60;
  if (json.is_object()) {
    return "a section";
  }
  if (json.is_array()) {
    return fmt::format("a list of {}", json.size());
  }
  const std::string text = json.dump();
  return text.size() <= kMaxShownLength ? text : text.substr(0, kMaxShownLength) + "...";
}

}  // namespace

JsonValue::JsonValue(ordered_json json, std::string file, std::string key)
    : document_(std::make_shared<const ordered_json>(std::move(json))),
      json_(document_.get()),
      file_(std::make_shared<const std::string>(std::move(file))),
      key_(std::move(key)) {}

JsonValue::JsonValue(const JsonValue& parent, const ordered_json& json, std::string key)
    : document_(parent.document_), json_(&json), file_(parent.file_), key_(std::move(key)) {}

std::string JsonValue::KeyOf(const std::string& name) const {
  return key_.empty() ? name : key_ + "." + name;
}

void JsonValue::Refuse(std::string_view allowed) const {
  throw InputError(
      Problem{.file = *file_,
              .key = key_,
              .message = fmt::format("expected {}, found {}; not as Trackbed writes it", allowed,
                                     Describe(*json_))});
}

JsonValue JsonValue::At(const std::string& name) const {
  if (std::optional<JsonValue> member = Find(name)) {
    return *std::move(member);
  }
  throw InputError(
      Problem{.file = *file_, .key = KeyOf(name), .message = "missing; not as Trackbed writes it"});
}

std::optional<JsonValue> JsonValue::Find(const std::string& name) const {
  if (!json_->is_object()) {
    Refuse("a section");
  }
  const auto found = json_->find(name);
  return found == json_->end() ? std::nullopt
                               : std::optional(JsonValue(*this, *found, KeyOf(name)));
}

std::vector<std::pair<std::string, JsonValue>> JsonValue::Members() const {
  if (!json_->is_object()) {
    Refuse("a section");
  }
  std::vector<std::pair<std::string, JsonValue>> members;
  for (const auto& [name, value] : json_->items()) {
    members.emplace_back(name, JsonValue(*this, value, KeyOf(name)));
  }
  return members;
}

std::vector<JsonValue> JsonValue::Elements() const {
  if (!json_->is_array()) {
    Refuse("a list");
  }
  std::vector<JsonValue> elements;
  for (const ordered_json& element : *json_) {
    elements.push_back(JsonValue(*this, element, fmt::format("{}[{}]", key_, elements.size())));
  }
  return elements;
}

std::vector<JsonValue> JsonValue::Elements(std::size_t count) const {
  std::vector<JsonValue> elements = Elements();
  if (elements.size() != count) {
    Refuse(fmt::format("a list of {}", count));
  }
  return elements;
}

std::string JsonValue::Text() const {
  if (!json_->is_string()) {
    Refuse("a text");
  }
  return json_->get<std::string>();
}

std::string JsonValue::OneOf(const std::vector<std::string>& allowed) const {
  std::string text = Text();
  if (std::find(allowed.begin(), allowed.end(), text) == allowed.end()) {
    Refuse(fmt::format("one of {}", fmt::join(allowed, ", ")));
  }
  return text;
}

double JsonValue::Number() const {
  if (!json_->is_number()) {
    Refuse("a number");
  }
  return json_->get<double>();
}

std::optional<double> JsonValue::NumberOrNull() const {
  if (!json_->is_number() && !json_->is_null()) {
    Refuse("a number or null");
  }
  return json_->is_null() ? std::nullopt : std::optional(json_->get<double>());
}

std::uint64_t JsonValue::Count(std::uint64_t max) const {
  // Reject negative numbers; nlohmann::json stores a negative integer as a signed number and a
  // positive integer as an unsigned number.
  if (!json_->is_number_integer() ||
      (!json_->is_number_unsigned() && json_->get<std::int64_t>() < 0) ||
      json_->get<std::uint64_t>() > max) {
    Refuse(fmt::format("a whole number from 0 to {}", max));
  }
  return json_->get<std::uint64_t>();
}

bool JsonValue::Flag() const {
  if (!json_->is_boolean()) {
    Refuse("true or false");
  }
  return json_->get<bool>();
}

std::vector<std::string> JsonValue::Texts() const {
  if (!json_->is_array()) {
    Refuse("a list of texts");
  }
  std::vector<std::string> texts;
  for (const ordered_json& element : *json_) {
    if (!element.is_string()) {
      JsonValue(*this, element, fmt::format("{}[{}]", key_, texts.size())).Refuse("a text");
    }
    texts.push_back(element.get<std::string>());
  }
  return texts;
}

bool JsonValue::IsNull() const {
  return json_->is_null();
}

bool JsonValue::IsSection() const {
  return json_->is_object();
}

const ordered_json& JsonValue::Scalar() const {
  if (json_->is_structured()) {
    Refuse("a single value");
  }
  return *json_;
}

const ordered_json& JsonValue::Scalars() const {
  for (const auto& [name, value] : Members()) {
    static_cast<void>(value.Scalar());
  }
  return *json_;
}

JsonValue ReadJson(const std::filesystem::path& file) {
  return {ParseJson(run_folder::RequireFile(file)), file.string()};
}

std::vector<std::vector<Vec2>> GateCones(const JsonValue& plan) {
  std::vector<std::vector<Vec2>> gates;
  if (const std::optional<JsonValue> list = plan.Find("gates")) {
    for (const JsonValue& gate : list->Elements()) {
      std::vector<Vec2>& cones = gates.emplace_back();
      for (const JsonValue& cone : gate.At("cones_m").Elements()) {
        const std::vector<JsonValue> point = cone.Elements(2);
        cones.emplace_back(point[0].Number(), point[1].Number());
      }
    }
  }
  return gates;
}

}  // namespace trackbed
