#pragma once

#include <fmt/format.h>
#include <tinyxml2.h>

#include <limits>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "trackbed/core/error.h"
#include "trackbed/core/table.h"

/// Reads attributes of XML elements as numbers and collects all problems.
namespace trackbed {

/// Range of the permitted values of an attribute.
struct Bounds {
  double min = -1e9;
  double max = 1e9;
};

/// Collects the problems of an XML file, each with its line number.
class XmlProblems {
 public:
  explicit XmlProblems(std::string file) : file_(std::move(file)) {}

  void Add(int line, std::string key, std::string message) {
    problems_.Add({file_, line, 0, std::move(key), std::move(message)});
  }
  /// Adds a flaw, which is a mistake that does not affect other parts of the XML file. Flaws of an
  /// XML file are reported as notes, not as errors.
  void AddFlaw(int line, const std::string& key, const std::string& message) {
    AddFlaw(fmt::format("line {}: {}: {}", line, key, message));
  }
  void AddFlaw(std::string flaw) { flaws_.push_back(std::move(flaw)); }
  /// Adds the problems of `part`, a part of the XML file that is left out, as flaws.
  void AddFlaws(const XmlProblems& part);
  /// Adds the problems and the flaws that were found in `part` of the file.
  void Append(const XmlProblems& part);

  [[nodiscard]] bool empty() const { return problems_.empty(); }
  void ThrowIfAny() const { problems_.ThrowIfAny(); }
  [[nodiscard]] const std::string& file() const { return file_; }
  [[nodiscard]] const std::vector<std::string>& flaws() const { return flaws_; }
  /// Returns the first problem with its line, as a text; empty if there are no problems.
  [[nodiscard]] std::string First() const;

 private:
  [[nodiscard]] std::vector<Problem> All() const;

  std::string file_;
  ProblemList problems_;
  std::vector<std::string> flaws_;
};

/// Reads the attributes of an XML element. In error messages, the element is named by the text
/// `where`, such as "road[3].planView.geometry[0]".
class XmlFields {
 public:
  XmlFields(const tinyxml2::XMLElement& element, std::string where, XmlProblems& problems)
      : element_(element), where_(std::move(where)), problems_(problems) {}

  [[nodiscard]] const tinyxml2::XMLElement& element() const { return element_; }
  [[nodiscard]] const std::string& where() const { return where_; }
  [[nodiscard]] int line() const { return element_.GetLineNum(); }
  [[nodiscard]] XmlProblems& problems() const { return problems_; }

  /// Reads an attribute as a number within bounds. If the attribute is invalid, returns the value
  /// within the bounds that is nearest to 0.
  [[nodiscard]] double Number(const char* name, Bounds bounds = {}) const;
  /// Reads an XML attribute as a number within bounds; returns `missing` if the attribute is
  /// absent.
  [[nodiscard]] double Number(const char* name, Bounds bounds, double missing) const;
  /// Reads an XML attribute as an integer; returns 0 if it is invalid.
  [[nodiscard]] int Integer(const char* name) const;
  /// Reads an XML attribute as a non-empty text; returns "" if it is missing or empty.
  [[nodiscard]] std::string Text(const char* name) const;
  /// Reads an attribute as a text; returns "" if the attribute is absent.
  [[nodiscard]] std::string OptionalText(const char* name) const;

  void AddError(const char* name, std::string message) const;

  /// Returns the child element with this name, or null if there is none; reports an error if
  /// several children have this name.
  [[nodiscard]] const tinyxml2::XMLElement* Child(const char* name) const;

 private:
  const tinyxml2::XMLElement& element_;
  std::string where_;
  XmlProblems& problems_;
};

/// Calls `take(element, index)` for each child element with the given name.
template <typename Take>
void ForEachChild(const tinyxml2::XMLElement* parent, const char* name, const Take& take) {
  if (parent == nullptr) {
    return;
  }
  std::size_t index = 0;
  for (const tinyxml2::XMLElement* child = parent->FirstChildElement(name); child != nullptr;
       child = child->NextSiblingElement(name)) {
    take(*child, index++);
  }
}

}  // namespace trackbed
