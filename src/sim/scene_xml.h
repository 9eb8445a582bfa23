#pragma once

#include <tinyxml2.h>

#include <initializer_list>
#include <string>
#include <string_view>

/// XML helpers for composing a scene.
namespace trackbed {

/// Parses the text of a composed scene. ParseComposed throws InternalError if the text is not XML.
void ParseComposed(const std::string& xml, tinyxml2::XMLDocument& document);

std::string Print(const tinyxml2::XMLDocument& document);

/// Formats numbers for an attribute, such as "1 0 0.5". Each number has its shortest form that
/// reads back exactly.
std::string Numbers(std::initializer_list<double> values);

/// The first element of a kind ("body", "geom") and name in the worldbodies below `parent`; null if
/// it is missing.
tinyxml2::XMLElement* FindInWorld(tinyxml2::XMLElement& parent, std::string_view kind,
                                  std::string_view name);

/// The composed model without visual geoms. MuJoCo discards geoms that collide with nothing and
/// that no other element refers to. Discarding visual geoms keeps the line numbers.
std::string DiscardLooks(const std::string& xml);

}  // namespace trackbed
