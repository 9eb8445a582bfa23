#include "trackbed/road_network/open_drive.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <tinyxml2.h>

#include <algorithm>
#include <utility>

#include "src/road_network/road_reader.h"
#include "src/road_network/xml_fields.h"
#include "trackbed/core/error.h"
#include "trackbed/core/file.h"

namespace trackbed {
namespace {

using tinyxml2::XMLElement;

/// Largest number of XML elements in an OpenDRIVE file. A document with more elements would take
/// gigabytes of memory.
constexpr std::ptrdiff_t kMaxElements = 4000000;

void CheckVersion(const XMLElement& root, RoadNetwork& network, XmlProblems& problems) {
  const XmlFields fields(root, "OpenDRIVE", problems);
  const XMLElement* header = fields.Child("header");
  if (header == nullptr) {
    fields.AddError("header", "missing");
    return;
  }
  const XmlFields own(*header, "header", problems);
  const int major = own.Integer("revMajor");
  const int minor = own.Integer("revMinor");
  if (problems.empty() && major != 1) {
    own.AddError("revMajor", fmt::format("version {}.{}; must be 1.4 to 1.7", major, minor));
  } else if (minor < 4 || minor > 7) {
    network.notes.push_back(
        fmt::format("version {}.{} is read as if it were 1.4 to 1.7", major, minor));
  }
}

Junction ReadJunction(const XmlFields& fields) {
  Junction junction{.id = fields.OptionalText("id"), .connections = {}};
  ForEachChild(&fields.element(), "connection", [&](const XMLElement& element, std::size_t index) {
    const XmlFields own(element, fmt::format("{}.connection[{}]", fields.where(), index),
                        fields.problems());
    JunctionConnection connection;
    connection.line = own.line();
    connection.incoming = own.OptionalText("incomingRoad");
    // A direct junction (since OpenDRIVE 1.6) links two roads directly, without a connecting road
    // between them.
    const bool direct = element.Attribute("linkedRoad") != nullptr;
    connection.connecting = direct ? own.Text("linkedRoad") : own.OptionalText("connectingRoad");
    if (connection.incoming.empty() || connection.connecting.empty()) {
      return;  // skip a virtual connection, because cars do not use virtual connections
    }
    connection.contact = ReadContactPoint(own);
    ForEachChild(&element, "laneLink", [&](const XMLElement& link, std::size_t) {
      const XmlFields lanes(link, own.where() + ".laneLink", fields.problems());
      connection.lane_links.emplace_back(lanes.Integer("from"), lanes.Integer("to"));
    });
    junction.connections.push_back(std::move(connection));
  });
  return junction;
}

/// Adds a road or junction to a map whose keys are ids; reports an error if the map already
/// contains the id.
template <typename Part>
void AddById(Part part, int line, const char* kind, std::map<std::string, Part, std::less<>>& parts,
             XmlProblems& problems) {
  const std::string id = part.id;
  if (!id.empty() && !parts.emplace(id, std::move(part)).second) {
    problems.Add(line, fmt::format("{}[{}].id", kind, id), "there are two of this id");
  }
}

void NoteUnreadHeights(RoadNetwork& network) {
  std::map<std::string, std::vector<std::string>> roads;
  for (const auto& [id, road] : network.roads) {
    for (const std::string& what : road.unread_heights) {
      roads[what].push_back(id);
    }
  }
  constexpr std::size_t kMaxListed = 5;
  for (auto& [what, ids] : roads) {
    const std::size_t more = ids.size() > kMaxListed ? ids.size() - kMaxListed : 0;
    ids.resize(ids.size() - more);
    network.notes.push_back(fmt::format("{} is not read: road {}{}", what, fmt::join(ids, ", "),
                                        more > 0 ? fmt::format(" and {} more", more) : ""));
  }
}

[[noreturn]] void Refuse(const std::string& name, int line, std::string message) {
  throw InputError(Problem{name, line, 0, "", std::move(message)});
}

/// Refuses a document with entity declarations, because tinyxml2 does not expand the entities that
/// a document declares.
void CheckDeclarations(const tinyxml2::XMLDocument& document, const std::string& name) {
  for (const tinyxml2::XMLNode* node = document.FirstChild(); node != nullptr;
       node = node->NextSibling()) {
    if (node->ToUnknown() != nullptr) {
      Refuse(name, node->GetLineNum(), "document type declarations (<!...>) are not read");
    }
  }
}

}  // namespace

RoadNetwork ParseOpenDrive(std::string_view xml, const std::string& name) {
  if (std::count(xml.begin(), xml.end(), '<') > kMaxElements) {
    Refuse(name, 0, fmt::format("more than {} XML tags", kMaxElements));
  }
  tinyxml2::XMLDocument document;
  if (document.Parse(xml.data(), xml.size()) != tinyxml2::XML_SUCCESS) {
    const bool deep = document.ErrorID() == tinyxml2::XML_ELEMENT_DEPTH_EXCEEDED;
    Refuse(name, document.ErrorLineNum(),
           deep ? "elements are nested too deeply"
           : document.ErrorID() == tinyxml2::XML_ERROR_EMPTY_DOCUMENT ? "the file is empty"
                                                                      : "not XML");
  }
  CheckDeclarations(document, name);
  const XMLElement* root = document.RootElement();
  if (root == nullptr || std::string_view(root->Name()) != "OpenDRIVE") {
    Refuse(name, root == nullptr ? 1 : root->GetLineNum(),
           fmt::format("expected an <OpenDRIVE> element{}",
                       root == nullptr ? "" : fmt::format("; found <{}>", root->Name())));
  }
  RoadNetwork network;
  XmlProblems problems(name);
  CheckVersion(*root, network, problems);
  ForEachChild(root, "road", [&](const XMLElement& element, std::size_t) {
    AddById(ReadRoad(element, problems), element.GetLineNum(), "road", network.roads, problems);
  });
  ForEachChild(root, "junction", [&](const XMLElement& element, std::size_t) {
    const XmlFields unnamed(element, "junction", problems);
    const XmlFields fields(element, fmt::format("junction[{}]", unnamed.Text("id")), problems);
    AddById(ReadJunction(fields), element.GetLineNum(), "junction", network.junctions, problems);
  });
  if (network.roads.empty() && problems.empty()) {
    problems.Add(root->GetLineNum(), "road", "missing; a network needs at least one road");
  }
  if (problems.empty()) {
    CheckLinks(network, problems);
  }
  problems.ThrowIfAny();
  NoteUnreadHeights(network);
  return network;
}

RoadNetwork ReadOpenDrive(const std::filesystem::path& file) {
  return ReadOpenDriveFile(file).network;
}

OpenDriveFile ReadOpenDriveFile(const std::filesystem::path& file) {
  OpenDriveFile read{.text = ReadFile(file, kMaxOpenDriveBytes), .network = {}};
  read.network = ParseOpenDrive(read.text, file.string());
  return read;
}

}  // namespace trackbed
