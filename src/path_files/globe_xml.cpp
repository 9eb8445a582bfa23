#include <fmt/format.h>
#include <tinyxml2.h>

#include <cstring>
#include <functional>
#include <optional>
#include <string>
#include <string_view>

#include "src/path_files/formats.h"
#include "trackbed/core/foreign_content.h"
#include "trackbed/core/text_table.h"
#include "trackbed/core/timestamp.h"
#include "trackbed/path_files/globe_names.h"

// Reads GPX (1.0 and 1.1) and KML (2.2 with Google's extensions, 2.3).
// 1. tinyxml2 parses the text; names of elements are compared without their prefix.
// 2. A track of GPX consists of segments; a route is one line.
// 3. In KML, lines are LineString, LinearRing and Track elements, in any folder.
// 4. GlobeProblem (globe.h) checks each position: range, and swapped latitude and longitude.
namespace trackbed {
namespace {

using tinyxml2::XMLElement;

std::string_view LocalName(const XMLElement& element) {
  const std::string_view name = element.Name();
  const std::size_t colon = name.find(':');
  return colon == std::string_view::npos ? name : name.substr(colon + 1);
}

std::string Trimmed(const char* text) {
  std::string_view trimmed = text == nullptr ? "" : text;
  constexpr std::string_view kSpaces = " \t\r\n";
  trimmed.remove_prefix(std::min(trimmed.find_first_not_of(kSpaces), trimmed.size()));
  return std::string(trimmed.substr(0, trimmed.find_last_not_of(kSpaces) + 1));
}

/// Calls `take` for each child element whose local name is `name`; each child if `name` is empty.
void EachChild(const XMLElement& parent, std::string_view name,
               const std::function<void(const XMLElement&)>& take) {
  for (const XMLElement* child = parent.FirstChildElement(); child != nullptr;
       child = child->NextSiblingElement()) {
    if (name.empty() || LocalName(*child) == name) {
      take(*child);
    }
  }
}

std::string ChildText(const XMLElement& parent, std::string_view name) {
  std::string text;
  EachChild(parent, name, [&](const XMLElement& child) {
    text = text.empty() ? Trimmed(child.GetText()) : text;
  });
  return text;
}

class XmlLines {
 public:
  XmlLines(const std::filesystem::path& path, const std::string& text) : file_(path) {
    if (document_.Parse(text.data(), text.size()) != tinyxml2::XML_SUCCESS) {
      Refuse(file_, "", XmlProblem(text, document_.ErrorName()), document_.ErrorLineNum());
    }
  }

  GlobeFile Read() {
    const XMLElement* root = document_.RootElement();
    if (root == nullptr) {
      Refuse(file_, "", "has no root element", 1);
    }
    if (LocalName(*root) == "gpx") {
      found_.format = "GPX";
      ReadGpx(*root);
    } else if (LocalName(*root) == "kml" || LocalName(*root) == "Document" ||
               LocalName(*root) == "Placemark") {
      found_.format = "KML";
      ReadKml(*root, "", 0);
    } else {
      Refuse(file_, "", fmt::format("the root element is {}; must be gpx or kml", root->Name()),
             root->GetLineNum());
    }
    return std::move(found_);
  }

 private:
  double Number(const std::string& text, const char* key, int line) const {
    const std::optional<double> number = CellNumber(text);
    if (!number) {
      Refuse(file_, key, NumberProblem(text), line);
    }
    return *number;
  }

  void Add(GlobeLine& line, GlobePoint point) {
    if (const std::string problem = GlobeProblem(point.position); !problem.empty()) {
      Refuse(file_, line.name, problem, point.line);
    }
    if (++points_ > kMaxPathPoints) {
      Refuse(file_, "", fmt::format("more than {} points", kMaxPathPoints), point.line);
    }
    line.points.push_back(point);
  }

  void Finish(GlobeLine line) {
    if (!line.points.empty()) {
      found_.lines.push_back(std::move(line));
    }
  }

  std::optional<double> Time(const std::string& text, const char* key, int line) const {
    if (text.empty()) {
      return std::nullopt;
    }
    const std::optional<double> time = TimestampSeconds(text);
    if (!time) {
      Refuse(file_, key,
             fmt::format("'{}' is not a time such as 2024-05-01T12:30:00Z", text.substr(0, 40)),
             line);
    }
    return time;
  }

  void AddGpxPoint(GlobeLine& line, const XMLElement& element) {
    GlobePoint point{.position = {}, .time = {}, .height = {}, .line = element.GetLineNum()};
    for (const auto& [name, degrees] : {std::pair("lat", &point.position.latitude),
                                        std::pair("lon", &point.position.longitude)}) {
      const char* text = element.Attribute(name);
      if (text == nullptr) {
        Refuse(file_, name, fmt::format("missing in {}", element.Name()), point.line);
      }
      *degrees = Number(Trimmed(text), name, point.line);
    }
    point.height = CellNumber(ChildText(element, "ele"));
    point.time = Time(ChildText(element, "time"), "time", point.line);
    Add(line, point);
  }

  void ReadGpx(const XMLElement& root) {
    EachChild(root, "wpt", [&](const XMLElement&) { ++found_.single_points; });
    std::size_t tracks = 0;
    std::size_t routes = 0;
    EachChild(root, "", [&](const XMLElement& element) {
      const bool is_track = LocalName(element) == "trk";
      if (!is_track && LocalName(element) != "rte") {
        return;
      }
      const std::string name = ChildText(element, "name").substr(0, 60);
      std::string shown =
          is_track ? fmt::format("track {}", ++tracks) : fmt::format("route {}", ++routes);
      shown += name.empty() ? "" : fmt::format(" ({})", name);
      ++track_;
      if (!is_track) {
        GlobeLine line{.name = shown, .track = track_, .points = {}};
        EachChild(element, "rtept", [&](const XMLElement& point) { AddGpxPoint(line, point); });
        Finish(std::move(line));
        return;
      }
      std::size_t segments = 0;
      EachChild(element, "trkseg", [&](const XMLElement& segment) {
        GlobeLine line{.name = fmt::format("{}, segment {}", shown, ++segments),
                       .track = track_,
                       .points = {}};
        EachChild(segment, "trkpt", [&](const XMLElement& point) { AddGpxPoint(line, point); });
        Finish(std::move(line));
      });
    });
  }

  /// Adds the position of a KML tuple: longitude, latitude and, optionally, the height.
  void AddTuple(GlobeLine& line, std::string_view tuple, char separator, int at,
                std::optional<double> time) {
    const std::string_view whole = tuple;
    std::vector<std::string> parts;
    while (true) {
      const std::size_t end = tuple.find(separator);
      parts.emplace_back(tuple.substr(0, end));
      if (end == std::string_view::npos) {
        break;
      }
      tuple.remove_prefix(end + 1);
    }
    if (parts.size() < 2 || parts.size() > 3 || parts[0].empty() || parts[1].empty()) {
      Refuse(file_, "coordinates",
             fmt::format("'{}' is no tuple; must be longitude,latitude or "
                         "longitude,latitude,height without spaces and with decimal points",
                         whole.substr(0, 60)),
             at);
    }
    GlobePoint point{.position = {}, .time = time, .height = {}, .line = at};
    point.position.longitude = Number(parts[0], "coordinates", at);
    point.position.latitude = Number(parts[1], "coordinates", at);
    if (parts.size() == 3) {
      point.height = CellNumber(parts[2]);
    }
    Add(line, point);
  }

  void ReadCoordinates(const XMLElement& element, GlobeLine line) {
    EachChild(element, "coordinates", [&](const XMLElement& list) {
      std::string_view text = list.GetText() == nullptr ? "" : list.GetText();
      constexpr std::string_view kSpaces = " \t\r\n";
      int at = list.GetLineNum();
      while (true) {
        const std::size_t begin = std::min(text.find_first_not_of(kSpaces), text.size());
        at += static_cast<int>(
            std::count(text.begin(), text.begin() + static_cast<long>(begin), '\n'));
        text.remove_prefix(begin);
        if (text.empty()) {
          break;
        }
        const std::size_t end = std::min(text.find_first_of(kSpaces), text.size());
        AddTuple(line, text.substr(0, end), ',', at, std::nullopt);
        text.remove_prefix(end);
      }
    });
    Finish(std::move(line));
  }

  /// Reads a Track, which has as many times (when) as positions (coord); positions may be empty.
  void ReadTrack(const XMLElement& element, GlobeLine line) {
    std::vector<std::optional<double>> times;
    EachChild(element, "when", [&](const XMLElement& when) {
      times.push_back(Time(Trimmed(when.GetText()), "when", when.GetLineNum()));
    });
    std::size_t count = 0;
    EachChild(element, "coord", [&](const XMLElement& coord) {
      const std::string text = Trimmed(coord.GetText());
      const std::optional<double> time = count < times.size() ? times[count] : std::nullopt;
      ++count;
      if (!text.empty()) {
        AddTuple(line, text, ' ', coord.GetLineNum(), time);
      }
    });
    if (!times.empty() && times.size() != count) {
      Refuse(file_, line.name,
             fmt::format("{} times (when) for {} positions (coord); must be equally many",
                         times.size(), count),
             element.GetLineNum());
    }
    Finish(std::move(line));
  }

  void ReadKml(const XMLElement& element, const std::string& name, int depth) {
    if (depth > kMaxDepth) {
      Refuse(file_, "", fmt::format("nested deeper than {} levels", kMaxDepth),
             element.GetLineNum());
    }
    const std::string_view kind = LocalName(element);
    const std::string own = ChildText(element, "name").substr(0, 60);
    const auto line = [&](const char* what) {
      return GlobeLine{.name = fmt::format("{} {}{}", what, ++lines_,
                                           name.empty() ? "" : fmt::format(" ({})", name)),
                       .track = in_multi_track_ ? track_ : ++track_,
                       .points = {}};
    };
    if (kind == "LineString" || kind == "LinearRing") {
      ReadCoordinates(element, line("line string"));
      return;
    }
    if (kind == "Track") {
      ReadTrack(element, line("track"));
      return;
    }
    if (kind == "Point") {
      ++found_.single_points;
    }
    const bool is_multi_track = kind == "MultiTrack";
    if (is_multi_track) {
      ++track_;
      in_multi_track_ = true;
    }
    EachChild(element, "", [&](const XMLElement& child) {
      if (LocalName(child) != "Polygon") {
        ReadKml(child, own.empty() ? name : own, depth + 1);
      }
    });
    in_multi_track_ = in_multi_track_ && !is_multi_track;
  }

  std::filesystem::path file_;
  tinyxml2::XMLDocument document_;
  GlobeFile found_;
  std::size_t points_ = 0;
  std::size_t track_ = 0;
  std::size_t lines_ = 0;
  bool in_multi_track_ = false;
};

}  // namespace

GlobeFile ReadGlobeXml(const std::filesystem::path& file, const std::string& text) {
  if (text.starts_with("PK\x03\x04")) {
    Refuse(file, "",
           "a KMZ archive, which is a compressed folder; unpack it (unzip FILE) and give the file "
           "doc.kml of it");
  }
  return XmlLines(file, text).Read();
}

}  // namespace trackbed
