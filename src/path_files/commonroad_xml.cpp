#include "src/path_files/commonroad_xml.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "src/path_files/formats.h"
#include "trackbed/core/foreign_content.h"
#include "trackbed/core/text_table.h"

namespace trackbed {

using tinyxml2::XMLElement;

const XMLElement& ParseCommonRoadXml(tinyxml2::XMLDocument& document, const std::string& text,
                                     const std::filesystem::path& file) {
  if (document.Parse(text.data(), text.size()) != tinyxml2::XML_SUCCESS) {
    Refuse(file, "", XmlProblem(text, document.ErrorName()), document.ErrorLineNum());
  }
  const XMLElement* root = document.RootElement();
  if (root == nullptr) {
    Refuse(file, "", "the root element is missing; must be CommonRoadSolution or commonRoad", 1);
  }
  return *root;
}

double NumberIn(const XMLElement& element, const CommonRoadReading& reading) {
  const char* text = element.GetText();
  std::string trimmed = text == nullptr ? "" : text;
  trimmed.erase(0, std::min(trimmed.find_first_not_of(" \t\r\n"), trimmed.size()));
  trimmed.erase(trimmed.find_last_not_of(" \t\r\n") + 1);
  const std::optional<double> number = CellNumber(trimmed);
  if (!number) {
    Refuse(reading.file, element.Name(),
           fmt::format("'{}' is not a finite number", trimmed.substr(0, 40)), element.GetLineNum());
  }
  if (std::abs(*number) > reading.largest) {
    Refuse(reading.file, element.Name(),
           fmt::format("{} is out of range; must be between {} and {}", *number, -reading.largest,
                       reading.largest),
           element.GetLineNum());
  }
  return *number;
}

std::optional<double> NumberOfChild(const XMLElement& parent, const char* name,
                                    const CommonRoadReading& reading) {
  const XMLElement* element = parent.FirstChildElement(name);
  return element == nullptr ? std::nullopt : std::optional(NumberIn(*element, reading));
}

const XMLElement& RequiredChild(const XMLElement& parent, const char* name,
                                const CommonRoadReading& reading) {
  const XMLElement* element = parent.FirstChildElement(name);
  if (element == nullptr) {
    Refuse(reading.file, name, fmt::format("missing in {}", parent.Name()), parent.GetLineNum());
  }
  return *element;
}

double RequiredNumber(const XMLElement& parent, const char* name,
                      const CommonRoadReading& reading) {
  return NumberIn(RequiredChild(parent, name, reading), reading);
}

std::optional<CommonRoadInterval> IntervalOfChild(const XMLElement& parent, const char* name,
                                                  const CommonRoadReading& reading) {
  const XMLElement* element = parent.FirstChildElement(name);
  if (element == nullptr) {
    return std::nullopt;
  }
  if (const XMLElement* exact = element->FirstChildElement("exact")) {
    const double value = NumberIn(*exact, reading);
    return CommonRoadInterval{value, value};
  }
  if (element->FirstChildElement() == nullptr) {
    const double value = NumberIn(*element, reading);
    return CommonRoadInterval{value, value};
  }
  const CommonRoadInterval interval{RequiredNumber(*element, "intervalStart", reading),
                                    RequiredNumber(*element, "intervalEnd", reading)};
  if (interval.from > interval.to) {
    Refuse(
        reading.file, name,
        fmt::format("the interval begins at {} and ends before, at {}", interval.from, interval.to),
        element->GetLineNum());
  }
  return interval;
}

Vec2 PointIn(const XMLElement& element, const CommonRoadReading& reading) {
  return Vec2(RequiredNumber(element, "x", reading), RequiredNumber(element, "y", reading)) -
         reading.origin;
}

}  // namespace trackbed
