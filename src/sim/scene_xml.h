#pragma once

#include <tinyxml2.h>

#include <initializer_list>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

/// Helper functions that process XML when a scene is composed.
namespace trackbed {

/// Parses the XML text of a composed scene. Throws InternalError if the text is not valid XML.
void ParseComposed(const std::string& xml, tinyxml2::XMLDocument& document);

std::string Print(const tinyxml2::XMLDocument& document);

/// Formats numbers for an XML attribute, such as "1 0 0.5". Each number is printed as the shortest
/// text from which exactly the same number can be read back.
std::string Numbers(std::initializer_list<double> values);

/// Finds the first element of kind `kind` ("body", "geom", …) and name `name` in the <worldbody>
/// elements below `parent`; null if there is no such element.
tinyxml2::XMLElement* FindInWorld(tinyxml2::XMLElement& parent, std::string_view kind,
                                  std::string_view name);

/// Returns the composed model with the compiler option that makes MuJoCo discard visual geoms. The
/// option discardvisual discards geoms that collide with nothing and that no other element refers
/// to. DiscardLooks does not change the line numbers of the model.
/// Versions of MuJoCo before 3.16 also discard the masses of visual geoms, unless the body has an
/// <inertial> element.
std::string DiscardLooks(const std::string& xml);

/// Whether the composed model states the mass and inertia of each body in an <inertial> element.
/// If GivesAllMasses returns true, the mass of no body depends on its geoms. GivesAllMasses also
/// returns false if the model contains elements from which MuJoCo makes bodies itself, such as
/// <composite>.
bool GivesAllMasses(const std::string& xml);

/// Removes all tyre coefficients from the model, and adds `numbers` (names and values) under
/// <custom>. Of the model's other numbers, only those with a name in `numbers` are removed.
void SetTyreNumbers(tinyxml2::XMLElement& root,
                    const std::vector<std::pair<std::string, double>>& numbers);

}  // namespace trackbed
