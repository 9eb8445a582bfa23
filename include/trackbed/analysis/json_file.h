#pragma once

#include <cstdint>
#include <filesystem>
#include <limits>
#include <memory>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "trackbed/core/error.h"
#include "trackbed/geometry/pose.h"

/// Reads the JSON files of a run folder, as Trackbed writes them.
namespace trackbed {

/// Parses a JSON file. Throws InputError, with file, line and column, if the text is not JSON or is
/// nested deeper than 64 levels. Throws RunError if the file is larger than 16 MiB, or if ReadFile
/// throws RunError.
nlohmann::ordered_json ParseJson(const std::filesystem::path& file);

/// Parses `text`, which is the content of `file` or a part of it. Throws the same errors as
/// ParseJson.
nlohmann::ordered_json ParseJsonOf(const std::string& file, std::string_view text);

/// Formats a JSON value as the content of a file: indented, with a line feed at the end. Bytes that
/// are not UTF-8 are replaced by U+FFFD.
std::string JsonText(const nlohmann::ordered_json& json);

/// A value in a JSON file that Trackbed wrote, with its file and key for error messages. Code that
/// reads result files uses only the checked getters of JsonValue, because a user may have edited or
/// truncated a file.
///
/// Errors: every getter throws InputError if the value is not of the requested kind. The message
/// states the file, the key (such as "pairs[0].tolerances"), the value found and the allowed
/// values.
class JsonValue {
 public:
  /// Wraps the root value of a JSON document. `file` and `key` appear in error messages.
  JsonValue(nlohmann::ordered_json json, std::string file, std::string key = "");

  /// Returns a member of the section, which is a JSON object.
  [[nodiscard]] JsonValue At(const std::string& name) const;
  /// Returns a member of the section (a JSON object); nullopt if the member is absent.
  [[nodiscard]] std::optional<JsonValue> Find(const std::string& name) const;
  /// Returns all members of the section (a JSON object), in the order of the file.
  [[nodiscard]] std::vector<std::pair<std::string, JsonValue>> Members() const;
  /// Returns the elements of the JSON list.
  [[nodiscard]] std::vector<JsonValue> Elements() const;
  /// Returns the elements of the JSON list, which must have exactly `count` elements.
  [[nodiscard]] std::vector<JsonValue> Elements(std::size_t count) const;

  [[nodiscard]] std::string Text() const;
  /// Returns the value as text, which must be one of the texts in `allowed`.
  [[nodiscard]] std::string OneOf(const std::vector<std::string>& allowed) const;
  [[nodiscard]] double Number() const;
  /// Returns the value as a number; nullopt if the value is null, which represents a number that
  /// was not finite.
  [[nodiscard]] std::optional<double> NumberOrNull() const;
  /// Returns the value as a whole number, which must be from 0 to `max`.
  [[nodiscard]] std::uint64_t Count(std::uint64_t max = kMaxCount) const;
  [[nodiscard]] bool Flag() const;
  [[nodiscard]] std::vector<std::string> Texts() const;
  [[nodiscard]] bool IsNull() const;
  [[nodiscard]] bool IsSection() const;
  /// Returns the value unchanged, after checking that the value is a scalar (text, number, true,
  /// false or null).
  [[nodiscard]] const nlohmann::ordered_json& Scalar() const;
  /// Returns the value unchanged, after checking that the value is a section whose members are all
  /// scalars.
  [[nodiscard]] const nlohmann::ordered_json& Scalars() const;
  /// The name of the file that contains the value, used in messages.
  [[nodiscard]] const std::string& file() const { return *file_; }
  /// Returns the JSON value without checks, to be used only for copying and comparing.
  [[nodiscard]] const nlohmann::ordered_json& json() const { return *json_; }

  /// Throws InputError with the message "expected `allowed`, found …".
  [[noreturn]] void Refuse(std::string_view allowed) const;

  static constexpr std::uint64_t kMaxCount = 1'000'000'000;

 private:
  JsonValue(const JsonValue& parent, const nlohmann::ordered_json& json, std::string key);
  [[nodiscard]] std::string KeyOf(const std::string& name) const;

  std::shared_ptr<const nlohmann::ordered_json> document_;
  const nlohmann::ordered_json* json_;  // The wrapped JSON value, owned by the document.
  std::shared_ptr<const std::string> file_;
  std::string key_;
};

/// Reads a JSON file of a run folder. Throws InputError if run_folder::RequireFile or ParseJson
/// throws InputError.
JsonValue ReadJson(const std::filesystem::path& file);

/// Returns the positions of the cones of each gate in plan.json; empty if the plan has no gates.
std::vector<std::vector<Vec2>> GateCones(const JsonValue& plan);

}  // namespace trackbed
