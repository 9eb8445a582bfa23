#include "src/sim/scene_xml.h"

#include <fmt/format.h>

#include <set>

#include "trackbed/core/error.h"
#include "trackbed/vehicle/magic_formula.h"

namespace trackbed {

using tinyxml2::XMLElement;

void ParseComposed(const std::string& xml, tinyxml2::XMLDocument& document) {
  TRACKBED_CHECK(document.Parse(xml.c_str()) == tinyxml2::XML_SUCCESS,
                 "a composed scene does not parse");
}

std::string Print(const tinyxml2::XMLDocument& document) {
  tinyxml2::XMLPrinter printer;
  document.Print(&printer);
  return printer.CStr();
}

std::string Numbers(std::initializer_list<double> values) {
  return fmt::format("{}", fmt::join(values, " "));
}

XMLElement* FindInWorld(XMLElement& parent, std::string_view kind, std::string_view name) {
  for (XMLElement* child = parent.FirstChildElement(); child != nullptr;
       child = child->NextSiblingElement()) {
    const std::string_view child_kind = child->Name();
    if (child_kind == kind && child->Attribute("name") != nullptr &&
        child->Attribute("name") == name) {
      return child;
    }
    if (child_kind == "body" || child_kind == "worldbody") {
      if (XMLElement* found = FindInWorld(*child, kind, name)) {
        return found;
      }
    }
  }
  return nullptr;
}

namespace {

/// Whether an MJCF element is a joint or contains a joint.
bool HasJoint(const XMLElement& element) {
  const std::string_view kind = element.Name();
  if (kind == "joint" || kind == "freejoint") {
    return true;
  }
  for (const XMLElement* child = element.FirstChildElement(); child != nullptr;
       child = child->NextSiblingElement()) {
    if (HasJoint(*child)) {
      return true;
    }
  }
  return false;
}

/// Whether the elements in `parent` (a body, a frame or the world) contain only bodies with an
/// <inertial> element, and no element that makes further bodies. The mass of a body that is fixed
/// to the world has no effect; `is_fixed` states whether `parent` is fixed.
bool ContainsOnlyGivenMasses(const XMLElement& parent, bool is_fixed) {
  for (const XMLElement* child = parent.FirstChildElement(); child != nullptr;
       child = child->NextSiblingElement()) {
    const std::string_view kind = child->Name();
    if (is_fixed && kind == "body" && !HasJoint(*child)) {
      continue;
    }
    if (kind == "body" && child->FirstChildElement("inertial") == nullptr) {
      return false;
    }
    if ((kind == "body" || kind == "frame" || kind == "replicate") &&
        !ContainsOnlyGivenMasses(*child, is_fixed && kind != "body")) {
      return false;
    }
    if (kind == "composite" || kind == "flexcomp" || kind == "attach") {
      return false;
    }
  }
  return true;
}

}  // namespace

bool GivesAllMasses(const std::string& xml) {
  tinyxml2::XMLDocument document;
  ParseComposed(xml, document);
  for (const XMLElement* child = document.RootElement()->FirstChildElement(); child != nullptr;
       child = child->NextSiblingElement()) {
    const std::string_view kind = child->Name();
    // The attribute inertiafromgeom may tell MuJoCo to ignore <inertial> elements.
    if (kind == "compiler" && child->Attribute("inertiafromgeom") != nullptr) {
      return false;
    }
    if (kind == "worldbody" && !ContainsOnlyGivenMasses(*child, true)) {
      return false;
    }
  }
  return true;
}

std::string DiscardLooks(const std::string& xml) {
  tinyxml2::XMLDocument document;
  ParseComposed(xml, document);
  // The element is added at the end, because MuJoCo uses the last <compiler> element that sets an
  // attribute.
  document.RootElement()->InsertNewChildElement("compiler")->SetAttribute("discardvisual", true);
  return Print(document);
}

void SetTyreNumbers(XMLElement& root, const std::vector<std::pair<std::string, double>>& numbers) {
  std::set<std::string> replaced;
  for (const auto& [name, value] : numbers) {
    replaced.insert(name);
  }
  for (const MagicFormulaField& field : MagicFormulaFields()) {
    for (const char* suffix : {"", "_front", "_rear"}) {
      replaced.insert(std::string(field.name) + suffix);
    }
  }
  for (XMLElement* part = root.FirstChildElement("custom"); part != nullptr;
       part = part->NextSiblingElement("custom")) {
    for (XMLElement* element = part->FirstChildElement("numeric"); element != nullptr;) {
      XMLElement* next = element->NextSiblingElement("numeric");
      const char* name = element->Attribute("name");
      if (name != nullptr && replaced.count(name) > 0) {
        part->DeleteChild(element);
      }
      element = next;
    }
  }
  XMLElement* custom = root.InsertNewChildElement("custom");
  for (const auto& [name, value] : numbers) {
    XMLElement* numeric = custom->InsertNewChildElement("numeric");
    numeric->SetAttribute("name", name.c_str());
    numeric->SetAttribute("data", Numbers({value}).c_str());
  }
}

}  // namespace trackbed
