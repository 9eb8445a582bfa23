#pragma once

#include <tinyxml2.h>

#include <initializer_list>
#include <string>
#include <string_view>

/// What composing a scene needs of XML.
namespace trackbed {

/// Reads a text that was composed before; InternalError when it is not XML.
void ParseComposed(const std::string& xml, tinyxml2::XMLDocument& document);

std::string Print(const tinyxml2::XMLDocument& document);

/// The value of an attribute: "1 0 0.5", each in the shortest form that reads back to itself.
std::string Numbers(std::initializer_list<double> values);

/// The first element of a kind ("body", "geom") and name in the worldbodies below `parent`, or
/// null.
tinyxml2::XMLElement* FindInWorld(tinyxml2::XMLElement& parent, std::string_view kind,
                                  std::string_view name);

/// The composed model without its looks: MuJoCo discards geoms that collide with nothing and that
/// nothing else in the model refers to. Lines of the text stay the same.
std::string DiscardLooks(const std::string& xml);

}  // namespace trackbed
