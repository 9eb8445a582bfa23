#pragma once

#include <tinyxml2.h>

#include <filesystem>
#include <optional>
#include <string>

#include "trackbed/geometry/pose.h"

/// Reads values of the XML files of CommonRoad, both solutions and scenarios.
namespace trackbed {

/// How values are read: the file, for error messages, the largest magnitude, and the place that
/// becomes the origin of positions.
struct CommonRoadReading {
  const std::filesystem::path& file;
  double largest = 1e7;
  Vec2 origin{0.0, 0.0};
};

/// Parses `text` and returns its root element. Throws InputError if the text is not XML.
const tinyxml2::XMLElement& ParseCommonRoadXml(tinyxml2::XMLDocument& document,
                                               const std::string& text,
                                               const std::filesystem::path& file);

/// Returns the number that the element contains as text. Throws InputError unless the number is
/// finite and its magnitude is at most `reading.largest`.
double NumberIn(const tinyxml2::XMLElement& element, const CommonRoadReading& reading);

/// Returns the number in the child element `name`; nullopt if there is no such child.
std::optional<double> NumberOfChild(const tinyxml2::XMLElement& parent, const char* name,
                                    const CommonRoadReading& reading);

/// Returns the same as NumberOfChild, but throws InputError if there is no such child.
double RequiredNumber(const tinyxml2::XMLElement& parent, const char* name,
                      const CommonRoadReading& reading);

/// A closed interval of numbers.
struct CommonRoadInterval {
  double from = 0.0;
  double to = 0.0;

  [[nodiscard]] double middle() const { return 0.5 * (from + to); }
};

/// Returns the child element `name`, which contains the element `exact`, the elements
/// `intervalStart` and `intervalEnd`, or a number; nullopt if there is no such child. Throws
/// InputError if the child has no number or an empty interval.
std::optional<CommonRoadInterval> IntervalOfChild(const tinyxml2::XMLElement& parent,
                                                  const char* name,
                                                  const CommonRoadReading& reading);

/// Returns the point in the child elements `x` and `y`. Ignores the height `z`.
Vec2 PointIn(const tinyxml2::XMLElement& element, const CommonRoadReading& reading);

/// Returns the child element `name`. Throws InputError if the element has no child with this name.
const tinyxml2::XMLElement& RequiredChild(const tinyxml2::XMLElement& parent, const char* name,
                                          const CommonRoadReading& reading);

}  // namespace trackbed
