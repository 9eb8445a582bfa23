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

#include "src/scenario/reader_context.h"
#include "trackbed/core/error.h"
#include "trackbed/options/key_visitor.h"
#include "trackbed/scenario/keys.h"

namespace trackbed {

/// Reads a YAML mapping into a struct; the function `Visit` of the struct declares the keys of the
/// mapping (key_visitor.h). Finish reports unknown and duplicate keys.
class YamlReader final : public KeyVisitor {
 public:
  YamlReader(ReaderContext& context, const YAML::Node& node, std::string key);

  [[nodiscard]] Mode mode() const override { return Mode::kRead; }

  using KeyVisitor::Field;
  void Field(const Key& key, double& value, Need need, Range range = {}) override;
  void Field(const Key& key, std::optional<double>& value, Range range = {}) override;
  void Field(const Key& key, std::optional<bool>& value) override;
  void Field(const Key& key, bool& value, Need need) override;
  void Field(const Key& key, int& value, Need need, Range range = {}) override;
  void Field(const Key& key, std::uint64_t& value, Need need) override;
  void Field(const Key& key, std::string& value, Need need, const Names& allowed = {}) override;
  void Field(const Key& key, std::optional<std::string>& value) override;
  void Field(const Key& key, std::vector<std::string>& value, Need need,
             const Names& allowed) override;
  void Field(const Key& key, std::vector<Vec2>& value, Need need,
             const PairShape& shape = kPoint) override;
  void Field(const Key& key, std::vector<double>& value, Need need, Range range = {}) override;
  void Identifier(const Key& key, std::string& value) override;
  void Pair(const Key& key, int& first, int& second, Range range) override;
  [[nodiscard]] bool HasAny(const char* key, const Names& inner) const override;

  /// Visits a key whose value the function `read` parses. The function `read` also receives the
  /// dotted key of the value.
  template <typename Read>
  void Custom(const Key& key, const char* type, const Read& read) {
    const auto node = Take(key.name, Need::kOptional);
    if (node && node->IsNull()) {
      AddError(*node, Dotted(key.name), fmt::format("expected a {}, found nothing", type));
    } else if (node) {
      read(*node, Dotted(key.name));
    }
  }

  void Finish();

 protected:
  bool VisitSection(const Key& key, Need need, bool present, const Inside& inside) override;
  void VisitList(const Key& key, std::size_t size,
                 const std::function<void(std::size_t size)>& resize,
                 const std::function<void(KeyVisitor& keys, std::size_t i)>& visit) override;
  void VisitMethod(const Key& key, Need need, const Methods& methods) override;

 private:
  /// Reports the unknown keys of a section whose method is missing or unknown. The keys of all
  /// methods are known.
  void FinishWithoutMethod(const Methods& methods);
  /// Reports the unknown keys of this mapping and of the mappings inside. `section` is the dotted
  /// key of this mapping in `sections`. No value is read.
  void CheckNames(const std::vector<KeySection>& sections, const std::string& section);
  void ReadMap(const YAML::Node& node, const std::string& dotted, const Inside& inside);
  [[nodiscard]] std::string Dotted(const char* key) const;
  std::optional<YAML::Node> Take(const char* key, Need need);
  bool CheckMap(const YAML::Node& node, const std::string& dotted);
  /// Returns the default value of a number whose key is missing in the file.
  [[nodiscard]] double DefaultOf(const Key& key, Range range, double value) const;
  bool ReadFlag(const YAML::Node& node, const std::string& dotted, bool& value);
  bool ReadNumber(const YAML::Node& node, const std::string& dotted, Range range, double& value);
  void AddError(const YAML::Node& node, const std::string& dotted, std::string message);

  ReaderContext& context_;
  YAML::Node node_;
  std::string key_;
  Names known_;
  bool method_is_known_ = true;
  YAML::Mark last_key_mark_;  // position in the file of the key that was read last
};

}  // namespace trackbed
