#include "trackbed/options/key_visitor.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string_view>
#include <utility>

#include "trackbed/core/error.h"

namespace trackbed {
namespace {

/// Formats a number for error messages; large numbers are written with an exponent.
std::string Number(double number) {
  constexpr double kMaxPlainNumber = 1e9;
  return std::abs(number) <= kMaxPlainNumber ? fmt::format("{}", number)
                                             : fmt::format("{:g}", number);
}

}  // namespace

Range WithinReason(const Key& key, Range range) {
  struct Bound {
    std::string_view unit;
    double largest;
  };
  constexpr std::array kBounds{Bound{"m", 1e5},     Bound{"s", 1e6},   Bound{"m/s", 1e3},
                               Bound{"m/s^2", 1e3}, Bound{"rad", 1e3}, Bound{"rad/s", 1e3},
                               Bound{"1/s", 1e4}};
  const auto* found = std::find_if(kBounds.begin(), kBounds.end(),
                                   [&](const Bound& bound) { return bound.unit == key.unit; });
  const double largest = found == kBounds.end() ? 1e12 : found->largest;
  if (!std::isfinite(range.max)) {
    range.max = largest;
  }
  if (!std::isfinite(range.above) && !std::isfinite(range.min)) {
    range.min = -largest;
  }
  return range;
}

std::string AllowedBy(Range range) {
  std::vector<std::string> parts;
  if (std::isfinite(range.above)) {
    parts.push_back(fmt::format("above {}", range.above));
  }
  if (std::isfinite(range.min)) {
    parts.push_back("at least " + Number(range.min));
  }
  if (std::isfinite(range.max)) {
    parts.push_back("at most " + Number(range.max));
  }
  return fmt::format("{}", fmt::join(parts, " and "));
}

namespace {

class NumberFinder final : public KeyVisitor {
 public:
  explicit NumberFinder(const std::string& key) : key_(key) {}

  [[nodiscard]] const std::optional<double>& found() const { return found_; }

  [[nodiscard]] Mode mode() const override { return Mode::kList; }
  void Field(const Key& key, double& value, Need, Range) override {
    if (key.name == key_) {
      found_ = value;
    }
  }
  void Field(const Key&, std::optional<double>&, Range) override {}
  void Field(const Key&, std::optional<bool>&) override {}
  void Field(const Key&, bool&, Need) override {}
  void Field(const Key&, int&, Need, Range) override {}
  void Field(const Key&, std::uint64_t&, Need) override {}
  void Field(const Key&, std::string&, Need, const Names&) override {}
  void Field(const Key&, std::optional<std::string>&) override {}
  void Field(const Key&, std::vector<std::string>&, Need, const Names&) override {}
  void Field(const Key&, std::vector<Vec2>&, Need, const PairShape&) override {}
  void Field(const Key&, std::vector<double>&, Need, Range) override {}
  void Identifier(const Key&, std::string&) override {}
  void Pair(const Key&, int&, int&, Range) override {}

 protected:
  bool VisitSection(const Key&, Need, bool, const Inside&) override { return false; }
  void VisitList(const Key&, std::size_t, const std::function<void(std::size_t)>&,
                 const std::function<void(KeyVisitor&, std::size_t)>&) override {}
  void VisitMethod(const Key&, Need, const Methods&) override {}

 private:
  std::string key_;
  std::optional<double> found_;
};

/// Throws an error for the first number that is NaN or out of range.
class RangeChecker final : public KeyVisitor {
 public:
  explicit RangeChecker(std::string owner) : owner_(std::move(owner)) {}

  [[nodiscard]] Mode mode() const override { return Mode::kWrite; }
  void Field(const Key& key, double& value, Need, Range range) override {
    CheckNumber(key, value, range);
  }
  void Field(const Key& key, std::optional<double>& value, Range range) override {
    if (value) {
      CheckNumber(key, *value, range);
    }
  }
  void Field(const Key&, std::optional<bool>&) override {}
  void Field(const Key&, bool&, Need) override {}
  void Field(const Key& key, int& value, Need, Range range) override {
    CheckNumber(key, value, range);
  }
  void Field(const Key&, std::uint64_t&, Need) override {}
  void Field(const Key&, std::string&, Need, const Names&) override {}
  void Field(const Key&, std::optional<std::string>&) override {}
  void Field(const Key&, std::vector<std::string>&, Need, const Names&) override {}
  void Field(const Key& key, std::vector<Vec2>& value, Need, const PairShape& shape) override {
    for (const Vec2& pair : value) {
      CheckNumber(key, pair.x(), shape.first);
      CheckNumber(key, pair.y(), shape.second);
    }
  }
  void Field(const Key& key, std::vector<double>& value, Need, Range range) override {
    for (const double number : value) {
      CheckNumber(key, number, range);
    }
  }
  void Identifier(const Key&, std::string&) override {}
  void Pair(const Key& key, int& first, int& second, Range range) override {
    CheckNumber(key, first, range);
    CheckNumber(key, second, range);
  }

 protected:
  bool VisitSection(const Key& key, Need, bool present, const Inside& inside) override {
    if (present) {
      Within(key.name, inside);
    }
    return present;
  }
  void VisitList(const Key& key, std::size_t size, const std::function<void(std::size_t)>&,
                 const std::function<void(KeyVisitor&, std::size_t)>& visit) override {
    for (std::size_t i = 0; i < size; ++i) {
      Within(fmt::format("{}[{}]", key.name, i), [&](KeyVisitor& keys) { visit(keys, i); });
    }
  }
  void VisitMethod(const Key& key, Need, const Methods& methods) override {
    if (methods.selected) {
      Within(key.name, methods.visit_selected);
      Within(key.name, methods.rest);
    }
  }

 private:
  void Within(const std::string& key, const Inside& inside) {
    const std::string outside = prefix_;
    prefix_ += key + ".";
    inside(*this);
    prefix_ = outside;
  }

  void CheckNumber(const Key& key, double value, Range range) const {
    const bool allowed =
        std::isfinite(value) && value >= range.min && value <= range.max && !(value <= range.above);
    TRACKBED_REQUIRE(allowed, "{}: {}{} is {}; must be finite{}{}", owner_, prefix_, key.name,
                     value, AllowedBy(range).empty() ? "" : ", ", AllowedBy(range));
  }

  std::string owner_;
  std::string prefix_;  // section name that precedes each visited key, with a dot at the end
};

}  // namespace

void RequireInRange(const std::string& owner, const KeyVisitor::Inside& visit) {
  RangeChecker checker(owner);
  visit(checker);
}

std::optional<double> FindNumber(const std::string& key, const KeyVisitor::Inside& visit) {
  NumberFinder finder(key);
  visit(finder);
  return finder.found();
}

}  // namespace trackbed
