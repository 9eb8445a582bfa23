#include "src/scenario/yaml_value.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>

#include "trackbed/core/angle.h"
#include "trackbed/core/file_name.h"

namespace trackbed {
namespace {

/// Returns whether the value is a number that is too large for a double.
bool IsTooLarge(const YAML::Node& node) {
  if (!node.IsScalar() || IsQuoted(node)) {
    return false;
  }
  const ClassicLocale locale;
  char* end = nullptr;
  const std::string& text = node.Scalar();
  const double number = std::strtod(text.c_str(), &end);
  return !text.empty() && *end == '\0' && std::isinf(number);
}

}  // namespace

bool IsQuoted(const YAML::Node& node) {
  return node.IsScalar() && node.Tag() == "!";
}

std::string DescribeValue(const YAML::Node& node) {
  switch (node.Type()) {
    case YAML::NodeType::Map:
      return "a section";
    case YAML::NodeType::Sequence:
      return "a list";
    case YAML::NodeType::Scalar:
      return IsQuoted(node) ? fmt::format("the text \"{}\"", node.Scalar())
                            : fmt::format("'{}'", node.Scalar());
    default:
      return "nothing";
  }
}

std::string CountNumbers(std::size_t count) {
  return count == 0 ? "an empty list"
                    : fmt::format("{} {}", count, count == 1 ? "number" : "numbers");
}

std::string NumberProblem(double number, const Range& range) {
  if (!std::isfinite(number)) {
    return fmt::format("expected a finite number, found {}", number);
  }
  if (number < range.min || number > range.max || number <= range.above) {
    return fmt::format("{} is out of range; must be {}", number, AllowedBy(range));
  }
  return "";
}

std::string FolderNameProblem(const std::string& name) {
  return name.size() <= kMaxFileNameLength && IsFileName(name)
             ? ""
             : fmt::format(
                   "'{}' is not a valid folder name; must be up to 100 letters, digits, "
                   "'_', '-' and '.', not starting with '.'",
                   name);
}

std::string ParseNumber(const YAML::Node& node, Range range, double& value) {
  double number = 0.0;
  const bool is_number = Decode(node, number);
  if (range.min == range.max && (!is_number || number != range.min)) {
    return fmt::format("must be {}, found {}", range.min,
                       is_number ? fmt::format("{}", number) : DescribeWrong<double>(node));
  }
  if (!is_number && IsTooLarge(node)) {
    const std::string allowed = AllowedBy(range);
    return fmt::format("{} is out of range; must be {}", node.Scalar(),
                       allowed.empty() ? "representable as a double" : allowed);
  }
  if (!is_number) {
    return fmt::format("expected a number, found {}", DescribeWrong<double>(node));
  }
  if (!std::isfinite(number)) {
    return fmt::format("expected a finite number, found {}", DescribeValue(node));
  }
  if (std::string problem = NumberProblem(number, range); !problem.empty()) {
    return problem;
  }
  value = range.is_direction ? WrapAngle(number) : number;
  return "";
}

}  // namespace trackbed
