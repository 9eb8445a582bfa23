#include "trackbed/road_network/open_drive.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <tinyxml2.h>

#include <algorithm>
#include <set>
#include <utility>

#include "src/road_network/road_reader.h"
#include "src/road_network/xml_fields.h"
#include "trackbed/core/error.h"
#include "trackbed/core/file.h"
#include "trackbed/core/foreign_content.h"

namespace trackbed {
namespace {

using tinyxml2::XMLElement;

/// Largest number of XML elements in an OpenDRIVE file. An XML document with more than 4 million
/// elements would take gigabytes of memory.
constexpr std::ptrdiff_t kMaxElements = 4000000;

/// Rejects OpenDRIVE files whose major version is not 1. A missing header or version is only noted
/// as a flaw, and the roads are read as roads of OpenDRIVE 1.4 to 1.7.
void CheckVersion(const XMLElement& root, RoadNetwork& network, XmlProblems& problems) {
  XmlProblems flaws(problems.file());
  const XmlFields fields(root, "OpenDRIVE", flaws);
  const XMLElement* header = fields.Child("header");
  if (header == nullptr) {
    network.notes.emplace_back("the file has no header; it is read as version 1.4 to 1.7");
    return;
  }
  const XmlFields own(*header, "header", flaws);
  const int major = own.Integer("revMajor");
  const bool has_major = flaws.empty();
  const int minor = own.Integer("revMinor");
  if (has_major && major != 1) {
    XmlFields(*header, "header", problems)
        .AddError("revMajor", fmt::format("version {}.{}; must be 1.4 to 1.7", major, minor));
  } else if (!flaws.empty()) {
    network.notes.push_back(flaws.First() + "; the file is read as version 1.4 to 1.7");
  } else if (minor < 4 || minor > 7) {
    network.notes.push_back(
        fmt::format("version {}.{} is read as if it were 1.4 to 1.7", major, minor));
  }
}

/// Reads the coordinate offset in the header of the file. An invalid header offset does not make
/// the roads unusable, so it is treated as missing.
void ReadOffset(const XMLElement& root, OpenDriveFile& file) {
  XmlProblems ignored("");
  const XMLElement* header = root.FirstChildElement("header");
  const XMLElement* offset = header == nullptr ? nullptr : header->FirstChildElement("offset");
  if (offset == nullptr) {
    return;
  }
  constexpr Bounds kOffset{-1e8, 1e8};  // Bounds of a coordinate [m].
  const XmlFields fields(*offset, "header.offset", ignored);
  const Vec2 place(fields.Number("x", kOffset, 0.0), fields.Number("y", kOffset, 0.0));
  const double heading = fields.Number("hdg", {}, 0.0);
  if (ignored.empty()) {
    file.offset = place;
    file.offset_heading = heading;
  }
}

/// Reads a junction. Connections with an error are left out of the junction.
Junction ReadJunction(const XmlFields& fields, RoadNetwork& network) {
  Junction junction{.id = fields.OptionalText("id"), .connections = {}};
  ForEachChild(&fields.element(), "connection", [&](const XMLElement& element, std::size_t index) {
    XmlProblems problems(fields.problems().file());
    const XmlFields own(element, fmt::format("{}.connection[{}]", fields.where(), index), problems);
    JunctionConnection connection;
    connection.line = own.line();
    connection.incoming = own.OptionalText("incomingRoad");
    // A direct junction (since OpenDRIVE 1.6) links two roads directly, without a connecting road
    // between them.
    const bool direct = element.Attribute("linkedRoad") != nullptr;
    connection.connecting = direct ? own.Text("linkedRoad") : own.OptionalText("connectingRoad");
    if (connection.incoming.empty() || (!direct && connection.connecting.empty())) {
      return;  // skip a virtual connection of a junction, because cars do not use virtual
               // connections
    }
    connection.contact = ReadContactPoint(own);
    ForEachChild(&element, "laneLink", [&](const XMLElement& link, std::size_t) {
      const XmlFields lanes(link, own.where() + ".laneLink", problems);
      connection.lane_links.emplace_back(lanes.Integer("from"), lanes.Integer("to"));
    });
    if (problems.empty()) {
      junction.connections.push_back(std::move(connection));
      return;
    }
    fields.problems().AddFlaws(problems);
    network.broken.emplace(fmt::format("junction {} connection", junction.id), problems.First());
  });
  return junction;
}

/// Collects the roads (or the junctions) of a file in a map, and leaves out those with problems.
template <typename Part>
class Parts {
 public:
  Parts(const char* kind, std::map<std::string, Part, std::less<>>& parts, RoadNetwork& network,
        XmlProblems& left_out)
      : kind_(kind), parts_(parts), network_(network), left_out_(left_out) {}

  /// Adds a road or junction to the map; `problems` are those of this part. A road or junction with
  /// problems is left out, and so are all parts with the same id.
  void Add(Part part, int line, XmlProblems& problems) {
    const std::string id = part.id;
    const std::string name = fmt::format("{} {}", kind_, id);
    if (problems.empty() && !ids_.insert(id).second) {
      problems.Add(line, fmt::format("{}[{}].id", kind_, id), "there are two of this id");
    }
    if (problems.empty()) {
      parts_.emplace(id, std::move(part));
    } else {
      ids_.insert(id);
      parts_.erase(id);
      network_.broken.emplace(name, problems.First());
      network_.notes.push_back(fmt::format("{} is left out: {}", name, problems.First()));
    }
    left_out_.Append(problems);
  }

 private:
  const char* kind_;
  std::map<std::string, Part, std::less<>>& parts_;
  RoadNetwork& network_;
  XmlProblems& left_out_;
  std::set<std::string> ids_;
};

/// Keeps only the first few notes after the index `from`, and replaces the remaining notes by a
/// note with their number.
void Shorten(std::vector<std::string>& notes, std::size_t from, const char* what) {
  constexpr std::size_t kMaxListed = 5;
  const std::size_t count = notes.size() - from;
  if (count > kMaxListed) {
    notes.resize(from + kMaxListed);
    notes.push_back(fmt::format("and {} more {}", count - kMaxListed, what));
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

/// Rejects an XML document with entity declarations, because tinyxml2 does not expand the entities
/// that a document declares.
void CheckDeclarations(const tinyxml2::XMLDocument& document, const std::string& name) {
  for (const tinyxml2::XMLNode* node = document.FirstChild(); node != nullptr;
       node = node->NextSibling()) {
    if (node->ToUnknown() != nullptr) {
      Refuse(name, node->GetLineNum(), "document type declarations (<!...>) are not read");
    }
  }
}

}  // namespace

OpenDriveFile ParseOpenDriveFile(std::string text, const std::string& name, const Vec2& origin) {
  const std::string_view xml = text;
  if (std::count(xml.begin(), xml.end(), '<') > kMaxElements) {
    Refuse(name, 0, fmt::format("more than {} XML tags", kMaxElements));
  }
  tinyxml2::XMLDocument document;
  if (document.Parse(xml.data(), xml.size()) != tinyxml2::XML_SUCCESS) {
    const bool deep = document.ErrorID() == tinyxml2::XML_ELEMENT_DEPTH_EXCEEDED;
    Refuse(name, document.ErrorLineNum(),
           deep ? "elements are nested too deeply" : XmlProblem(xml, document.ErrorName()));
  }
  CheckDeclarations(document, name);
  const XMLElement* root = document.RootElement();
  if (root == nullptr || std::string_view(root->Name()) != "OpenDRIVE") {
    Refuse(name, root == nullptr ? 1 : root->GetLineNum(),
           fmt::format("expected an <OpenDRIVE> element{}",
                       root == nullptr ? "" : fmt::format("; found <{}>", root->Name())));
  }
  OpenDriveFile file;
  RoadNetwork& network = file.network;
  XmlProblems problems(name);
  CheckVersion(*root, network, problems);
  problems.ThrowIfAny();
  const std::size_t first_note = network.notes.size();
  Parts<Road> roads("road", network.roads, network, problems);
  ForEachChild(root, "road", [&](const XMLElement& element, std::size_t) {
    XmlProblems own(name);
    Road road = ReadRoad(element, origin, own, network);
    roads.Add(std::move(road), element.GetLineNum(), own);
  });
  Parts<Junction> junctions("junction", network.junctions, network, problems);
  ForEachChild(root, "junction", [&](const XMLElement& element, std::size_t) {
    XmlProblems own(name);
    const XmlFields unnamed(element, "junction", own);
    const XmlFields fields(element, fmt::format("junction[{}]", unnamed.Text("id")), own);
    Junction junction = ReadJunction(fields, network);
    junctions.Add(std::move(junction), element.GetLineNum(), own);
  });
  if (network.roads.empty()) {
    problems.ThrowIfAny();
    Refuse(name, root->GetLineNum(), "no <road>; a network needs at least one road");
  }
  Shorten(network.notes, first_note, "parts are left out");
  CheckLinks(network, problems);
  const std::size_t first_flaw = network.notes.size();
  network.notes.insert(network.notes.end(), problems.flaws().begin(), problems.flaws().end());
  Shorten(network.notes, first_flaw, "flaws");
  NoteUnreadHeights(network);
  ReadOffset(*root, file);
  file.text = std::move(text);
  return file;
}

RoadNetwork ParseOpenDrive(std::string_view xml, const std::string& name) {
  return ParseOpenDriveFile(std::string(xml), name).network;
}

RoadNetwork ReadOpenDrive(const std::filesystem::path& file) {
  return ReadOpenDriveFile(file).network;
}

OpenDriveFile ReadOpenDriveFile(const std::filesystem::path& file) {
  return ParseOpenDriveFile(ReadFile(file, kMaxOpenDriveBytes), file.string());
}

}  // namespace trackbed
