#include "src/road_network/xml_fields.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <string_view>
#include <utility>

namespace trackbed {
namespace {

std::string_view WithoutSpaces(std::string_view text) {
  constexpr std::string_view kSpaces = " \t\r\n";
  const std::size_t first = text.find_first_not_of(kSpaces);
  if (first == std::string_view::npos) {
    return {};
  }
  return text.substr(first, text.find_last_not_of(kSpaces) - first + 1);
}

/// Parses the whole text as a number; returns false if the text is not a number. A leading plus
/// sign is skipped, because std::from_chars rejects a plus sign.
template <typename Number_>
bool ParseAll(std::string_view text, Number_& number) {
  if (text.starts_with('+') && !text.starts_with("+-")) {
    text.remove_prefix(1);
  }
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  return error == std::errc{} && end == text.data() + text.size();
}

/// Returns a problem of the XML file as a text without the file name.
std::string Text(const Problem& problem) {
  return fmt::format("line {}: {}{}{}", problem.line, problem.key, problem.key.empty() ? "" : ": ",
                     problem.message);
}

}  // namespace

std::vector<Problem> XmlProblems::All() const {
  try {
    problems_.ThrowIfAny();
  } catch (const InputError& error) {
    return error.problems();
  }
  return {};
}

std::string XmlProblems::First() const {
  const std::vector<Problem> all = All();
  return all.empty() ? "" : Text(all.front());
}

void XmlProblems::AddFlaws(const XmlProblems& part) {
  for (const Problem& problem : part.All()) {
    flaws_.push_back(Text(problem));
  }
  flaws_.insert(flaws_.end(), part.flaws_.begin(), part.flaws_.end());
}

void XmlProblems::Append(const XmlProblems& part) {
  for (const Problem& problem : part.All()) {
    problems_.Add(problem);
  }
  flaws_.insert(flaws_.end(), part.flaws_.begin(), part.flaws_.end());
}

void XmlFields::AddError(const char* name, std::string message) const {
  problems_.Add(line(), *name == '\0' ? where_ : fmt::format("{}.{}", where_, name),
                std::move(message));
}

double XmlFields::Number(const char* name, Bounds bounds) const {
  const double nearest = std::clamp(0.0, bounds.min, bounds.max);
  const char* text = element_.Attribute(name);
  if (text == nullptr) {
    AddError(name, "missing");
    return nearest;
  }
  double number = 0.0;
  if (!ParseAll(WithoutSpaces(text), number) || !std::isfinite(number)) {
    AddError(name, fmt::format("'{}' is not a finite number", text));
    return nearest;
  }
  if (number < bounds.min || number > bounds.max) {
    AddError(name, fmt::format("{} is out of range; must be between {} and {}", number, bounds.min,
                               bounds.max));
    return nearest;
  }
  return number;
}

double XmlFields::Number(const char* name, Bounds bounds, double missing) const {
  return element_.Attribute(name) == nullptr ? missing : Number(name, bounds);
}

int XmlFields::Integer(const char* name) const {
  const char* text = element_.Attribute(name);
  if (text == nullptr) {
    AddError(name, "missing");
    return 0;
  }
  int number = 0;
  if (!ParseAll(WithoutSpaces(text), number)) {
    AddError(name, fmt::format("'{}' is not a whole number", text));
    return 0;
  }
  return number;
}

std::string XmlFields::Text(const char* name) const {
  std::string text = OptionalText(name);
  if (text.empty()) {
    AddError(name, "missing");
  }
  return text;
}

std::string XmlFields::OptionalText(const char* name) const {
  const char* text = element_.Attribute(name);
  return text == nullptr ? "" : text;
}

const tinyxml2::XMLElement* XmlFields::Child(const char* name) const {
  const tinyxml2::XMLElement* first = element_.FirstChildElement(name);
  if (first != nullptr) {
    if (const tinyxml2::XMLElement* second = first->NextSiblingElement(name)) {
      problems_.Add(second->GetLineNum(), where_, fmt::format("a second <{}>", name));
    }
  }
  return first;
}

}  // namespace trackbed
