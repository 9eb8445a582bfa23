#pragma once

#include <tinyxml2.h>

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "src/path_files/lanelets.h"
#include "trackbed/path_files/path_map.h"

/// Reads Lanelet2 maps (Poggenhans et al. 2018), XML files of OpenStreetMap.
namespace trackbed {

/// Keys and values of the tags of an element.
using OsmTags = std::map<std::string, std::string>;

struct OsmNode {
  const tinyxml2::XMLElement* element = nullptr;
  OsmTags tags;
  Vec2 place{0.0, 0.0};  ///< Place in the plane [m], if the node is part of a lanelet.
};

struct OsmWay {
  std::vector<std::string> nodes;
  OsmTags tags;
};

/// A bound of a lanelet: a way, from its first to its last node or back.
struct LaneletBound {
  std::string way;
  bool is_reversed = false;
  std::string first;  ///< Node at the start of the lanelet.
  std::string last;   ///< Node at the end of the lanelet.
  std::vector<Vec2> points;

  [[nodiscard]] LaneletBound Reversed() const;
};

struct LaneletBounds {
  LaneletBound left;
  LaneletBound right;
};

/// A lanelet with its bounds, in one direction.
struct DirectedLanelet {
  LaneletBound left;
  LaneletBound right;
  double limit = 0.0;  ///< Speed limit [m/s]; without a limit, the largest speed of path files.
  bool has_limit = false;
};

/// Returns the speed in a tag such as "50", "50 km/h", "30 mph" or "13.9 m/s" [m/s]; km/h without a
/// unit. Returns nullopt unless the text is a speed above 0 and at most 100 m/s.
std::optional<double> SpeedOfTag(const std::string& text);

class LaneletOrientation;

/// A map, and the lanelets on which cars drive. The map keeps a reference to the file's name.
class Lanelet2Map {
 public:
  /// Throws InputError if a lanelet's node has no position, or two lanelets have the same id.
  /// Leaves out lanelets whose ways or nodes are missing.
  Lanelet2Map(const std::filesystem::path& file, const tinyxml2::XMLElement& root,
              const PathMap& map);

  /// The lanelets for cars by their ids. A lanelet that is not one_way has a second entry for the
  /// other direction.
  [[nodiscard]] const Lanelets& lanelets() const { return lanelets_; }
  [[nodiscard]] const DirectedLanelet& Directed(const std::string& key) const {
    return directed_.at(key);
  }
  [[nodiscard]] const std::vector<std::string>& notes() const { return notes_; }

  /// Returns a lanelet's permitted directions of travel, each as a key of lanelets(). Throws
  /// InputError if `id` is no lanelet for cars; the message says why.
  [[nodiscard]] std::vector<std::string> DirectionsOf(const std::string& id) const;

  /// Lists some ids of lanelets, for messages.
  [[nodiscard]] std::string Some() const;

 private:
  [[nodiscard]] const OsmWay* WayOf(const tinyxml2::XMLElement& relation, const std::string& role,
                                    std::string& id, std::string& why) const;
  [[nodiscard]] double Coordinate(const OsmNode& node, const char* name, const std::string& text,
                                  double largest) const;
  void PlaceNodes(const std::vector<const tinyxml2::XMLElement*>& relations, const PathMap& map);
  [[nodiscard]] LaneletBound BoundOf(const std::string& id, const OsmWay& way) const;
  [[nodiscard]] std::optional<LaneletBounds> BoundsOf(const tinyxml2::XMLElement& relation,
                                                      std::string& why) const;
  void Add(const tinyxml2::XMLElement& relation, const LaneletOrientation& orientation);
  void Insert(const std::string& key, const DirectedLanelet& own, int line);
  void Link();

  const std::filesystem::path& file_;
  std::map<std::string, OsmNode> nodes_;
  std::map<std::string, OsmWay> ways_;
  std::map<std::string, DirectedLanelet> directed_;
  Lanelets lanelets_;
  std::map<std::string, std::string> left_out_;  // Reasons by id.
  std::vector<std::string> notes_;
};

}  // namespace trackbed
