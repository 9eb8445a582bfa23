#pragma once

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "trackbed/options/key_visitor.h"
#include "trackbed/scenario/keys.h"

namespace trackbed {

/// Lists the keys that the function Visit of a struct declares. The default value of each key is
/// taken from the given instance of the struct.
class KeyLister final : public KeyVisitor {
 public:
  KeyLister(std::vector<KeySection>& sections, KeySection own)
      : sections_(sections), index_(sections.size()) {
    sections_.push_back(std::move(own));
  }

  [[nodiscard]] Mode mode() const override { return Mode::kList; }

  using KeyVisitor::Field;
  void Field(const Key& key, double& value, Need need, Range range = {}) override {
    Add(key, "number", need, fmt::format("{:.6g}", value), AllowedBy(WithinReason(key, range)));
  }
  void Field(const Key& key, std::optional<double>&, Range range = {}) override {
    Add(key, "number", Need::kOptional, "", AllowedBy(WithinReason(key, range)));
  }
  void Field(const Key& key, std::optional<bool>&) override {
    Add(key, "true or false", Need::kOptional, "", "");
  }
  void Field(const Key& key, bool& value, Need need) override {
    Add(key, "true or false", need, value ? "true" : "false", "");
  }
  void Field(const Key& key, int& value, Need need, Range range = {}) override {
    Add(key, "whole number", need, fmt::format("{}", value), AllowedBy(range));
  }
  void Field(const Key& key, std::uint64_t& value, Need need) override {
    Add(key, "whole number", need, fmt::format("{}", value), AllowedBy({.min = 0.0}));
  }
  void Field(const Key& key, std::string& value, Need need, const Names& allowed = {}) override {
    Add(key, "name", need, value, Joined(allowed));
  }
  void Field(const Key& key, std::optional<std::string>&) override {
    Add(key, "name", Need::kOptional, "", "");
  }
  void Identifier(const Key& key, std::string&) override {
    Add(key, "name", Need::kRequired, "", "letters, digits, '_', '-', '.'");
  }
  void Field(const Key& key, std::vector<std::string>& value, Need need,
             const Names& allowed) override {
    Add(key, "list of names", need, value.empty() ? "" : fmt::format("[{}]", Joined(value)),
        Joined(allowed));
  }
  void Field(const Key& key, std::vector<Vec2>&, Need need,
             const PairShape& shape = kPoint) override {
    Add(key, fmt::format("list of {}", shape.many), need, "", "");
  }
  void Field(const Key& key, std::vector<double>&, Need need, Range range = {}) override {
    Add(key, "list of numbers", need, "", AllowedBy(WithinReason(key, range)));
  }
  void Pair(const Key& key, int& first, int& second, Range range) override {
    Add(key, "two whole numbers", Need::kOptional, fmt::format("[{}, {}]", first, second),
        AllowedBy(range));
  }
  template <typename Read>
  void Custom(const Key& key, const char* type, const Read&) {
    Add(key, type, Need::kOptional, "", "");
  }

  void Mention(const Key& key, const char* type) override {
    Add(key, type, Need::kOptional, "", "");
  }

 protected:
  bool VisitSection(const Key& key, Need need, bool, const Inside& inside) override {
    Add(key, "section", need, "", "");
    KeyLister inner(sections_, {Dotted(key), "", key.text, {}});
    inside(inner);
    return false;
  }

  void VisitList(const Key& key, std::size_t size, const std::function<void(std::size_t size)>&,
                 const std::function<void(KeyVisitor& keys, std::size_t i)>& visit) override {
    Add(key, "list of sections", Need::kOptional, "", "");
    KeyLister inner(sections_, {Dotted(key) + "[N]", "", key.text, {}});
    visit(inner, size);
  }

  void VisitMethod(const Key& key, Need need, const Methods& methods) override {
    Names names;
    for (const Methods::Entry& entry : methods.entries) {
      names.emplace_back(entry.name);
    }
    Add(key, "section", need,
        methods.selected ? fmt::format("{{{}: {}}}", kMethod.name, names[*methods.selected]) : "",
        "");
    KeyLister inner(sections_, {Dotted(key), "", key.text, {}});
    inner.Add(kMethod, "name", Need::kRequired, "", Joined(names));
    methods.rest(inner);
    for (std::size_t i = 0; i < methods.entries.size(); ++i) {
      KeyLister own(sections_,
                    {Dotted(key), methods.entries[i].name, methods.entries[i].summary, {}});
      methods.visit_defaults(i, own);
    }
  }

 private:
  /// Adds a key with the given description to the current section.
  void Add(const Key& key, std::string type, Need need, std::string fallback, std::string allowed) {
    const bool required = need == Need::kRequired;
    sections_[index_].keys.push_back({key.name, std::move(type), key.unit,
                                      required ? "" : std::move(fallback), std::move(allowed),
                                      key.text, required});
  }

  static std::string Joined(const Names& names) {
    return fmt::format("{}", fmt::join(names, ", "));
  }

  [[nodiscard]] std::string Dotted(const Key& key) const {
    const std::string& own = sections_[index_].key;
    return own.empty() ? key.name : own + "." + key.name;
  }

  std::vector<KeySection>& sections_;
  // Index of the present section; a reference would become invalid when the vector of sections
  // grows.
  std::size_t index_;
};

}  // namespace trackbed
