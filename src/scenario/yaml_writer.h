#pragma once

#include <fmt/format.h>
#include <yaml-cpp/yaml.h>

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "trackbed/core/classic_locale.h"
#include "trackbed/options/key_visitor.h"

namespace trackbed {

/// Writes a struct as YAML, with the keys that the function Visit of the struct declares, so that
/// YamlReader reads the same values back. Each number is written with the fewest digits from which
/// the same number is read back. YamlWriter omits optional values that are not set.
class YamlWriter final : public KeyVisitor {
 public:
  explicit YamlWriter(YAML::Emitter& out) : out_(out) {}

  [[nodiscard]] Mode mode() const override { return Mode::kWrite; }

  using KeyVisitor::Field;

  void Field(const Key& key, double& value, Need, Range = {}) override {
    out_ << YAML::Key << key.name << YAML::Value << fmt::format("{}", value);
  }
  void Field(const Key& key, std::optional<double>& value, Range = {}) override {
    if (value) {
      Field(key, *value, Need::kOptional);
    }
  }
  void Field(const Key& key, bool& value, Need) override {
    out_ << YAML::Key << key.name << YAML::Value << value;
  }
  void Field(const Key& key, std::optional<bool>& value) override {
    if (value) {
      out_ << YAML::Key << key.name << YAML::Value << *value;
    }
  }
  void Field(const Key& key, int& value, Need, Range = {}) override {
    out_ << YAML::Key << key.name << YAML::Value << value;
  }
  void Field(const Key& key, std::uint64_t& value, Need) override {
    out_ << YAML::Key << key.name << YAML::Value << value;
  }
  void Field(const Key& key, std::string& value, Need, const Names& = {}) override {
    if (!value.empty()) {
      out_ << YAML::Key << key.name << YAML::Value << value;
    }
  }
  void Field(const Key& key, std::optional<std::string>& value) override {
    if (value) {
      Field(key, *value, Need::kOptional);
    }
  }
  void Identifier(const Key& key, std::string& value) override {
    Field(key, value, Need::kRequired);
  }
  void Field(const Key& key, std::vector<std::string>& value, Need, const Names&) override {
    if (value.empty()) {
      return;
    }
    out_ << YAML::Key << key.name << YAML::Value << YAML::Flow << value;
  }
  void Field(const Key& key, std::vector<Vec2>& value, Need, const PairShape& = kPoint) override {
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
  void Field(const Key& key, std::vector<double>& value, Need, Range = {}) override {
    if (value.empty()) {
      return;
    }
    out_ << YAML::Key << key.name << YAML::Value << YAML::Flow << YAML::BeginSeq;
    for (const double number : value) {
      out_ << fmt::format("{}", number);
    }
    out_ << YAML::EndSeq;
  }
  void Pair(const Key& key, int& first, int& second, Range) override {
    out_ << YAML::Key << key.name << YAML::Value << YAML::Flow << YAML::BeginSeq << first << second
         << YAML::EndSeq;
  }

 protected:
  bool VisitSection(const Key& key, Need, bool present, const Inside& inside) override {
    if (present) {
      out_ << YAML::Key << key.name << YAML::Value << YAML::BeginMap;
      inside(*this);
      out_ << YAML::EndMap;
    }
    return present;
  }

  void VisitList(const Key& key, std::size_t size, const std::function<void(std::size_t size)>&,
                 const std::function<void(KeyVisitor& keys, std::size_t i)>& visit) override {
    if (size == 0) {
      return;
    }
    out_ << YAML::Key << key.name << YAML::Value << YAML::BeginSeq;
    for (std::size_t i = 0; i < size; ++i) {
      out_ << YAML::BeginMap;
      visit(*this, i);
      out_ << YAML::EndMap;
    }
    out_ << YAML::EndSeq;
  }

  void VisitMethod(const Key& key, Need, const Methods& methods) override {
    if (!methods.selected) {
      return;
    }
    out_ << YAML::Key << key.name << YAML::Value << YAML::BeginMap;
    out_ << YAML::Key << kMethod.name << YAML::Value << methods.entries[*methods.selected].name;
    methods.visit_selected(*this);
    methods.rest(*this);
    out_ << YAML::EndMap;
  }

 private:
  YAML::Emitter& out_;
  ClassicLocale locale_;  ///< yaml-cpp uses the global locale to write integers
};

}  // namespace trackbed
