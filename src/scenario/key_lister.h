#pragma once

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cstdint>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "src/scenario/yaml_field.h"
#include "trackbed/geometry/pose.h"
#include "trackbed/scenario/keys.h"

namespace trackbed {

/// The third archive beside YamlReader and YamlWriter: lists the keys that a struct's Visit names,
/// with the struct's own values as the defaults.
class KeyLister {
 public:
  KeyLister(std::vector<KeySection>& sections, KeySection own)
      : sections_(sections), index_(sections.size()) {
    sections_.push_back(std::move(own));
  }

  void Field(const Key& key, double& value, Need need, Range range = {}) {
    Add(key, "number", need, fmt::format("{:.6g}", value), AllowedBy(range));
  }
  void Field(const Key& key, std::optional<double>&, Range range = {}) {
    Add(key, "number", Need::kOptional, "", AllowedBy(range));
  }
  void Field(const Key& key, std::optional<bool>&) {
    Add(key, "true or false", Need::kOptional, "", "");
  }
  void Field(const Key& key, bool& value, Need need) {
    Add(key, "true or false", need, value ? "true" : "false", "");
  }
  void Field(const Key& key, int& value, Need need, Range range = {}) {
    Add(key, "whole number", need, fmt::format("{}", value), AllowedBy(range));
  }
  void Field(const Key& key, std::uint64_t& value, Need need) {
    Add(key, "whole number", need, fmt::format("{}", value), AllowedBy({.min = 0.0}));
  }
  void Field(const Key& key, std::string& value, Need need, const Names& allowed = {}) {
    Add(key, "name", need, value, Joined(allowed));
  }
  void Field(const Key& key, std::optional<std::string>&) {
    Add(key, "name", Need::kOptional, "", "");
  }
  void Identifier(const Key& key, std::string&) {
    Add(key, "name", Need::kRequired, "", "letters, digits, '_', '-', '.'");
  }
  void Field(const Key& key, std::vector<std::string>& value, Need need, const Names& allowed) {
    Add(key, "list of names", need, value.empty() ? "" : fmt::format("[{}]", Joined(value)),
        Joined(allowed));
  }
  void Field(const Key& key, std::vector<Vec2>&, Need need, const PairShape& shape = kPoint) {
    Add(key, fmt::format("list of {}", shape.many), need, "", "");
  }
  void Field(const Key& key, std::vector<double>&, Need need, Range range = {}) {
    Add(key, "list of numbers", need, "", AllowedBy(range));
  }
  void Pair(const Key& key, int& first, int& second, Range range) {
    Add(key, "two whole numbers", Need::kOptional, fmt::format("[{}, {}]", first, second),
        AllowedBy(range));
  }
  template <typename Read>
  void Custom(const Key& key, const char* type, const Read&) {
    Add(key, type, Need::kOptional, "", "");
  }

  template <typename Enum>
  void Field(const Key& key, Enum& value, Need need,
             const EnumNames<Enum>& names) requires std::is_enum_v<Enum> {
    std::string fallback;
    Names allowed;
    for (const auto& [candidate, spelling] : names) {
      fallback = candidate == value ? spelling : fallback;
      allowed.emplace_back(spelling);
    }
    Add(key, "name", need, fallback, Joined(allowed));
  }

  template <typename Struct>
  void Section(const Key& key, Struct& value, Need need = Need::kOptional) {
    Add(key, "section", need, "", "");
    KeyLister inner(sections_, {Dotted(key), "", key.text, {}});
    Visit(inner, value);
  }

  template <typename Struct>
  void Section(const Key& key, std::optional<Struct>&) {
    Struct value;
    Section(key, value);
  }

  template <typename Struct>
  void List(const Key& key, std::vector<Struct>&) {
    Add(key, "list of sections", Need::kOptional, "", "");
    KeyLister inner(sections_, {Dotted(key) + "[N]", "", key.text, {}});
    Struct element;
    Visit(inner, element);
  }

  template <typename Variant, typename Table, typename Rest>
  void Method(const Key& key, std::optional<Variant>& value, const Table& table, Need need,
              const Rest& rest) {
    std::string fallback;
    Names names;
    for (const auto& entry : table) {
      const bool own = value && entry.defaults.index() == value->index();
      fallback = own ? fmt::format("{{{}: {}}}", kMethod.name, entry.name) : fallback;
      names.emplace_back(entry.name);
    }
    Add(key, "section", need, fallback, "");
    KeyLister inner(sections_, {Dotted(key), "", key.text, {}});
    inner.Add(kMethod, "name", Need::kRequired, "", Joined(names));
    rest(inner);
    for (const auto& entry : table) {
      KeyLister own(sections_, {Dotted(key), entry.name, entry.summary, {}});
      Variant defaults = entry.defaults;
      std::visit([&](auto& options) { Visit(own, options); }, defaults);
    }
  }

  /// A key that is described by what is written about it alone.
  void Add(const Key& key, std::string type, Need need, std::string fallback, std::string allowed) {
    const bool required = need == Need::kRequired;
    sections_[index_].keys.push_back({key.name, std::move(type), key.unit,
                                      required ? "" : std::move(fallback), std::move(allowed),
                                      key.text, required});
  }

 private:
  static std::string Joined(const Names& names) {
    return fmt::format("{}", fmt::join(names, ", "));
  }

  [[nodiscard]] std::string Dotted(const Key& key) const {
    const std::string& own = sections_[index_].key;
    return own.empty() ? key.name : own + "." + key.name;
  }

  std::vector<KeySection>& sections_;
  std::size_t index_;  // not a reference: the list grows
};

}  // namespace trackbed
