#include "trackbed/options/key_visitor.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string_view>
#include <utility>

#include "trackbed/core/error.h"
#include "trackbed/options/number_visitor.h"

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

/// Throws an error for the first option value that is NaN or out of range.
class RangeChecker final : public NumberVisitor {
 public:
  explicit RangeChecker(std::string owner) : owner_(std::move(owner)) {}

 protected:
  void Number(const Key& key, double& value, const Range& range) override {
    const bool allowed =
        std::isfinite(value) && value >= range.min && value <= range.max && !(value <= range.above);
    TRACKBED_REQUIRE(allowed, "{}: {}{}{} is {}; must be finite{}{}", owner_, place(),
                     place().empty() ? "" : ".", key.name, value,
                     AllowedBy(range).empty() ? "" : ", ", AllowedBy(range));
  }
  void Pairs(const Key& key, std::vector<Vec2>& pairs, const PairShape& shape) override {
    for (Vec2& pair : pairs) {
      Number(key, pair.x(), shape.first);
      Number(key, pair.y(), shape.second);
    }
  }

 private:
  std::string owner_;
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
