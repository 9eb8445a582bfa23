#pragma once

#include <fmt/format.h>
#include <yaml-cpp/yaml.h>

#include <cstdint>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "src/scenario/yaml_field.h"
#include "trackbed/geometry/pose.h"

namespace trackbed {

/// The counterpart of YamlReader: writes the keys that a struct's Visit names, numbers in the
/// shortest form that reads back to the same value. Optional values that are not there are left
/// out.
class YamlWriter {
 public:
  explicit YamlWriter(YAML::Emitter& out) : out_(out) {}

  void Field(const Key& key, double& value, Need, Range = {}) {
    out_ << YAML::Key << key.name << YAML::Value << fmt::format("{}", value);
  }
  void Field(const Key& key, std::optional<double>& value, Range = {}) {
    if (value) {
      Field(key, *value, Need::kOptional);
    }
  }
  void Field(const Key& key, bool& value, Need) {
    out_ << YAML::Key << key.name << YAML::Value << value;
  }
  void Field(const Key& key, std::optional<bool>& value) {
    if (value) {
      out_ << YAML::Key << key.name << YAML::Value << *value;
    }
  }
  void Field(const Key& key, int& value, Need, Range = {}) {
    out_ << YAML::Key << key.name << YAML::Value << value;
  }
  void Field(const Key& key, std::uint64_t& value, Need) {
    out_ << YAML::Key << key.name << YAML::Value << value;
  }
  void Field(const Key& key, std::string& value, Need, const Names& = {}) {
    if (!value.empty()) {
      out_ << YAML::Key << key.name << YAML::Value << value;
    }
  }
  void Field(const Key& key, std::optional<std::string>& value) {
    if (value) {
      Field(key, *value, Need::kOptional);
    }
  }
  void Identifier(const Key& key, std::string& value) { Field(key, value, Need::kRequired); }
  void Field(const Key& key, std::vector<std::string>& value, Need, const Names&) {
    out_ << YAML::Key << key.name << YAML::Value << YAML::Flow << value;
  }
  void Field(const Key& key, std::vector<Vec2>& value, Need, const PairShape& = kPoint) {
    if (value.empty()) {
      return;
    }
    out_ << YAML::Key << key.name << YAML::Value << YAML::Flow << YAML::BeginSeq;
    for (const Vec2& point : value) {
      out_ << YAML::BeginSeq << fmt::format("{}", point.x()) << fmt::format("{}", point.y())
           << YAML::EndSeq;
    }
    out_ << YAML::EndSeq;
  }
  void Field(const Key& key, std::vector<double>& value, Need, Range = {}) {
    if (value.empty()) {
      return;
    }
    out_ << YAML::Key << key.name << YAML::Value << YAML::Flow << YAML::BeginSeq;
    for (const double number : value) {
      out_ << fmt::format("{}", number);
    }
    out_ << YAML::EndSeq;
  }
  void Pair(const Key& key, int& first, int& second, Range) {
    out_ << YAML::Key << key.name << YAML::Value << YAML::Flow << YAML::BeginSeq << first << second
         << YAML::EndSeq;
  }

  template <typename Enum>
  void Field(const Key& key, Enum& value, Need,
             const EnumNames<Enum>& names) requires std::is_enum_v<Enum> {
    for (const auto& [candidate, spelling] : names) {
      if (candidate == value) {
        out_ << YAML::Key << key.name << YAML::Value << spelling;
      }
    }
  }

  template <typename Struct>
  void Section(const Key& key, Struct& value, Need = Need::kOptional) {
    out_ << YAML::Key << key.name << YAML::Value << YAML::BeginMap;
    Visit(*this, value);
    out_ << YAML::EndMap;
  }

  template <typename Struct>
  void Section(const Key& key, std::optional<Struct>& value) {
    if (value) {
      Section(key, *value);
    }
  }

  template <typename Struct>
  void List(const Key& key, std::vector<Struct>& values) {
    if (values.empty()) {
      return;
    }
    out_ << YAML::Key << key.name << YAML::Value << YAML::BeginSeq;
    for (Struct& value : values) {
      out_ << YAML::BeginMap;
      Visit(*this, value);
      out_ << YAML::EndMap;
    }
    out_ << YAML::EndSeq;
  }

  template <typename Variant, typename Table, typename Rest>
  void Method(const Key& key, std::optional<Variant>& value, const Table& table, Need,
              const Rest& rest) {
    if (!value) {
      return;
    }
    out_ << YAML::Key << key.name << YAML::Value << YAML::BeginMap;
    for (const auto& entry : table) {
      if (entry.defaults.index() == value->index()) {
        out_ << YAML::Key << kMethod.name << YAML::Value << entry.name;
      }
    }
    std::visit([&](auto& options) { Visit(*this, options); }, *value);
    rest(*this);
    out_ << YAML::EndMap;
  }

 private:
  YAML::Emitter& out_;
};

}  // namespace trackbed
