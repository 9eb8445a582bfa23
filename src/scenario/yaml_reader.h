#pragma once

#include <fmt/format.h>
#include <yaml-cpp/yaml.h>

#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

#include "src/scenario/yaml_field.h"
#include "trackbed/core/error.h"
#include "trackbed/geometry/pose.h"

namespace trackbed {

/// What all readers of one file share.
struct ReaderContext {
  std::string file;
  std::vector<std::string> overridden;  // dotted keys that --set put in
  std::vector<Problem> problems;
  std::vector<std::string> unread;  // dotted keys whose value is not known for a problem of theirs

  /// Adds a problem of the key, placed at `mark`, or at --set if that is where the key comes from.
  void Complain(const YAML::Mark& mark, const std::string& dotted, std::string message);

  /// Whether the key, or some element of it if it is a list, is among what could not be read.
  [[nodiscard]] bool Read(std::string_view dotted) const;
};

/// Reads one YAML mapping into a struct. A struct names its keys once, in a `Visit(archive,
/// struct)`; this archive reads them, YamlWriter writes them. Unknown and repeated keys are
/// complained of when the reader goes out of use (Finish).
class YamlReader {
 public:
  YamlReader(ReaderContext& context, YAML::Node node, std::string key);

  void Field(const Key& key, double& value, Need need, Range range = {});
  void Field(const Key& key, std::optional<double>& value, Range range = {});
  void Field(const Key& key, std::optional<bool>& value);
  void Field(const Key& key, bool& value, Need need);
  void Field(const Key& key, int& value, Need need, Range range = {});
  void Field(const Key& key, std::uint64_t& value, Need need);
  void Field(const Key& key, std::string& value, Need need, const Names& allowed = {});
  void Field(const Key& key, std::optional<std::string>& value);
  /// A required name that can stand in a path: letters, digits, '_', '-', '.', none hidden.
  void Identifier(const Key& key, std::string& value);
  void Field(const Key& key, std::vector<std::string>& value, Need need, const Names& allowed);
  void Field(const Key& key, std::vector<Vec2>& value, Need need, const PairShape& shape = kPoint);
  void Field(const Key& key, std::vector<double>& value, Need need, Range range = {});
  void Pair(const Key& key, int& first, int& second, Range range);
  /// A key whose value `read` makes sense of, told its dotted key.
  template <typename Read>
  void Custom(const Key& key, const char* type, const Read& read) {
    const auto node = Take(key.name, Need::kOptional);
    if (node && node->IsNull()) {
      Complain(*node, Dotted(key.name), fmt::format("expected a {}, found nothing", type));
    } else if (node) {
      read(*node, Dotted(key.name));
    }
  }

  template <typename Enum>
  void Field(const Key& key, Enum& value, Need need,
             const EnumNames<Enum>& names) requires std::is_enum_v<Enum> {
    std::string name;
    for (const auto& [candidate, spelling] : names) {
      name = candidate == value ? spelling : name;
    }
    Names allowed;
    for (const auto& entry : names) {
      allowed.emplace_back(entry.second);
    }
    Field(key, name, need, allowed);
    for (const auto& [candidate, spelling] : names) {
      value = name == spelling ? candidate : value;
    }
  }

  template <typename Struct>
  void Section(const Key& key, Struct& value, Need need = Need::kOptional) {
    if (const auto node = Take(key.name, need)) {
      ReadMap(*node, Dotted(key.name), value);
    }
  }

  /// One whose absence says something.
  template <typename Struct>
  void Section(const Key& key, std::optional<Struct>& value) {
    if (const auto node = Take(key.name, Need::kOptional)) {
      ReadMap(*node, Dotted(key.name), value.emplace());
    }
  }

  template <typename Struct>
  void List(const Key& key, std::vector<Struct>& values) {
    const auto node = Take(key.name, Need::kOptional);
    if (!node) {
      return;
    }
    if (!node->IsSequence()) {
      Complain(*node, Dotted(key.name), fmt::format("expected a list, found {}", Describe(*node)));
      return;
    }
    values.clear();
    for (std::size_t i = 0; i < node->size(); ++i) {
      ReadMap((*node)[i], fmt::format("{}[{}]", Dotted(key.name), i), values.emplace_back());
    }
  }

  /// A section whose key `method` says which alternative's keys it has.
  template <typename Variant, typename Table, typename Rest>
  void Method(const Key& key, std::optional<Variant>& value, const Table& table, Need need,
              const Rest& rest) {
    const auto node = Take(key.name, need);
    if (!node) {
      return;
    }
    if (!CheckMap(*node, Dotted(key.name))) {
      return;
    }
    YamlReader inner(context_, *node, Dotted(key.name));
    Names names;
    for (const auto& entry : table) {
      names.emplace_back(entry.name);
    }
    std::string method;
    inner.Field(kMethod, method, Need::kRequired, names);
    for (const auto& entry : table) {
      if (method == entry.name) {
        value = entry.defaults;
        std::visit([&](auto& options) { Visit(inner, options); }, *value);
        rest(inner);
        inner.Finish();
        return;
      }
    }
    // Without a method there is no telling which keys are known: complain of the method alone.
  }

  /// Whether `key` is a section that has one of `inner` and no method of its own.
  [[nodiscard]] bool HasOneOf(const char* key, const Names& inner) const;

  /// Reads `key` only if it is there, as a section of its own.
  template <typename Struct>
  bool SectionIfThere(const std::string& key, Struct& value) {
    const auto node = Take(key.c_str(), Need::kOptional);
    if (node) {
      ReadMap(*node, Dotted(key.c_str()), value);
    }
    return node.has_value();
  }

  void Finish();

  /// "a section", "a list", "'word'", …
  static std::string Describe(const YAML::Node& node);

 private:
  template <typename Struct>
  void ReadMap(const YAML::Node& node, const std::string& dotted, Struct& value) {
    if (!CheckMap(node, dotted)) {
      return;
    }
    YamlReader inner(context_, node, dotted);
    Visit(inner, value);
    inner.Finish();
  }

  [[nodiscard]] std::string Dotted(const char* key) const;
  std::optional<YAML::Node> Take(const char* key, Need need);
  bool CheckMap(const YAML::Node& node, const std::string& dotted);
  bool ReadFlag(const YAML::Node& node, const std::string& dotted, bool& value);
  bool ReadNumber(const YAML::Node& node, const std::string& dotted, Range range, double& value);
  void Complain(const YAML::Node& node, const std::string& dotted, std::string message);
  /// Describes a value that is no T, with the way out if it only has quotes too many.
  template <typename T>
  static std::string DescribeNo(const YAML::Node& node);

  ReaderContext& context_;
  YAML::Node node_;
  std::string key_;
  Names known_;
  YAML::Mark taken_;  // where the key stands that was taken last
};

}  // namespace trackbed
