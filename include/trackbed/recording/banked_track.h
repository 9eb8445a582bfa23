#pragma once

#include <cstddef>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "trackbed/track/track.h"
#include "trackbed/world/terrain.h"

/// The ground along a closed or open track with bank and grade, on which recorded drives are
/// replayed.
///
/// Symbols: s is the station along the track's center line [m], d the offset from the center line,
/// positive to the left [m], beta(s) the bank, positive if the road rises to the left [rad], and
/// z(s) the height of the center line [m]. The height of the road at the offset d is z(s) + d
/// tan(beta(s)), with the center line's height z(s) and the bank beta(s).
namespace trackbed {

struct BankedTrack {
  /// Points of the center line with the track's widths; Track::kMinPoints or more.
  std::vector<TrackPoint> points;
  /// Bank at each point of the center line [rad], between -pi/4 and pi/4.
  std::vector<double> banks;
  std::vector<double> heights;  ///< Height at each point of the center line [m].
  bool closed = true;  ///< Whether the center line continues from the last to the first point.
};

/// Returns whether points form a closed line, for track files that do not state whether the track
/// is closed. In a closed line, the gap between the last and the first point is at most twice the
/// largest distance between neighboring points. Across the gap between its last and first point, a
/// closed line turns by at most 30 degrees plus its turns at the second and the second-to-last
/// point.
bool IsClosedLine(const std::vector<TrackPoint>& points);

/// Returns the reason why points cannot form an open line, as a text for users; empty if the points
/// form an open line.
std::string OpenLineProblem(const std::vector<TrackPoint>& points);

class GroundLine;

/// Makes terrains along one center line, for any banks and heights.
///
/// From edge to edge of the track and 1.5 m beyond the edges, the terrain is the banked road,
/// interpolated from points every 0.5 m. Between 1.5 m and 9.5 m beyond the track's edges, the
/// terrain blends into smooth ground. Bank and height of the road are smoothed in the same way as
/// the center line (Track). Where parts of the track are close to each other, the road of each part
/// keeps its own height. The ground between neighboring parts of the track has the mean of the
/// parts' heights, weighted by proximity. On the inside of bends, the road ends at 0.9 of the
/// bend's radius from the center line. Beyond its ends, an open road continues straight, with the
/// slope and the bank at the end. An open road blends into smooth ground between 1.5 m and 9.5 m
/// from its ends.
class BankedGround {
 public:
  /// Throws InputError if the track spreads over more than 4 km along x or y, or if the track is
  /// open and has an OpenLineProblem. Computing time: 0.3 s per kilometer of track.
  explicit BankedGround(std::vector<TrackPoint> points, bool closed = true);

  [[nodiscard]] const std::vector<TrackPoint>& points() const;
  [[nodiscard]] bool closed() const;
  /// Returns the length of the center line [m].
  [[nodiscard]] double length() const;
  [[nodiscard]] double StationOf(std::size_t point) const;

  /// Returns the terrain for the bank [rad] and the height [m] at each point of the center line.
  /// Throws PreconditionError unless `banks` and `heights` have a number for each point. Computing
  /// time: 0.1 s per kilometer of track.
  [[nodiscard]] std::shared_ptr<const Terrain> With(const std::vector<double>& banks,
                                                    const std::vector<double>& heights) const;

 private:
  /// A point of the ground in the coordinates of one part of the track: station and offset.
  struct Place {
    double s = 0.0;
    double d = 0.0;
    // Weight of the place by its proximity; the weights of all places of a node add up to 1.
    double weight = 0.0;
  };
  /// A node of the terrain, with its place relative to each nearby part of the track.
  struct Node {
    std::vector<Place> places{};
    // Weight of the road's height at the node; the coarse ground has the weight 1 - share.
    double share = 0.0;
  };
  struct Block {
    int column = 0;
    int row = 0;
    std::vector<Node> nodes{};  // Nodes in the order in which Terrain::Refine uses them.
  };

  void FindNodes();
  [[nodiscard]] Node NodeAt(const Vec2& point, const std::vector<std::size_t>& near) const;
  [[nodiscard]] std::vector<std::size_t> NearestOfRuns(const Vec2& point,
                                                       const std::vector<std::size_t>& near) const;
  [[nodiscard]] std::vector<double> Coarse(const std::vector<double>& heights, double base) const;

  std::shared_ptr<const GroundLine> line_;
  Terrain::Size size_;
  std::vector<PathPoint> samples_;  // Samples of the center line.
  std::vector<double> stations_;    // Stations of the samples [m].
  // Largest distance from the center line at which the road changes the ground [m].
  double reach_ = 0.0;
  std::vector<Block> blocks_;
};

/// Returns the terrain of a banked track. Throws the same errors as BankedGround.
std::shared_ptr<const Terrain> MakeTerrain(const BankedTrack& track);

/// The points of a center line, and whether it is closed.
struct CenterPoints {
  std::vector<TrackPoint> points;
  bool closed = true;
  std::vector<int> lines{};  ///< Line number of each point in the track file.
};

/// Reads the points of a track file (track/track_file.h), which may be open. In a file with a
/// column `closed`, the line is open if the column contains 0. In a track file without a column
/// `closed`, the line is open unless it has the shape of a closed line (IsClosedLine). A file
/// without columns of track widths is read as the log of a drive. The path of a logged drive, with
/// points 0.5 m or more apart, becomes the center line of an open road 10 m wide. Throws InputError
/// in the same cases as ReadTrackFile, and if the line is open and has an OpenLineProblem.
CenterPoints ReadCenterPoints(const std::filesystem::path& file);

/// Reads a track file with the column `bank_rad`, `z_m`, or both; a missing column counts as 0.
/// Throws InputError in the same cases as ReadCenterPoints, and if both `bank_rad` and `z_m` are
/// missing or a number is out of range.
BankedTrack ReadBankedTrack(const std::filesystem::path& file);

/// The file name of a banked track in a run folder and in the folder of an identification.
inline constexpr const char* kBankCsv = "bank.csv";

/// Formats a banked track as a file from which ReadBankedTrack reads equal numbers.
std::string BankedTrackCsv(const BankedTrack& track);

}  // namespace trackbed
