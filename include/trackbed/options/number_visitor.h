#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "trackbed/options/key_visitor.h"

namespace trackbed {

/// Base of the classes that visit the numbers of a struct. Visits the numbers that are set,
/// including numbers in sections, in lists and in the options of the selected method. A
/// NumberVisitor ignores all values that are not numbers.
class NumberVisitor : public KeyVisitor {
 public:
  [[nodiscard]] Mode mode() const override { return Mode::kWrite; }

  using KeyVisitor::Field;
  void Field(const Key& key, double& value, Need need, Range range) override;
  void Field(const Key& key, std::optional<double>& value, Range range) override;
  void Field(const Key&, std::optional<bool>&) override {}
  void Field(const Key&, bool&, Need) override {}
  void Field(const Key& key, int& value, Need need, Range range) override;
  void Field(const Key&, std::uint64_t&, Need) override {}
  void Field(const Key&, std::string&, Need, const Names&) override {}
  void Field(const Key&, std::optional<std::string>&) override {}
  void Field(const Key&, std::vector<std::string>&, Need, const Names&) override {}
  void Field(const Key& key, std::vector<Vec2>& value, Need need, const PairShape& shape) override;
  void Field(const Key& key, std::vector<double>& value, Need need, Range range) override;
  void Identifier(const Key&, std::string&) override {}
  void Pair(const Key& key, int& first, int& second, Range range) override;

 protected:
  /// Visits a number, which may be an element of a list. An override of the function Number may
  /// change a floating-point number. For a whole number (int), `value` is a copy, so that changes
  /// have no effect.
  virtual void Number(const Key& key, double& value, const Range& range) = 0;
  /// Visits a list of pairs of numbers. An override of the function Pairs may change the pairs.
  virtual void Pairs(const Key& key, std::vector<Vec2>& pairs, const PairShape& shape) = 0;

  /// Returns the dotted key of the section that is being visited, such as "world.obstacles[0]"; ""
  /// at the top level.
  [[nodiscard]] const std::string& place() const { return place_; }
  /// Visits keys inside the section `key`.
  void Within(const std::string& key, const Inside& inside);

  bool VisitSection(const Key& key, Need need, bool present, const Inside& inside) override;
  void VisitList(const Key& key, std::size_t size, const std::function<void(std::size_t)>& resize,
                 const std::function<void(KeyVisitor&, std::size_t)>& visit) override;
  void VisitMethod(const Key& key, Need need, const Methods& methods) override;

 private:
  std::string place_;
};

}  // namespace trackbed
