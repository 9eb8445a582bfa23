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
/// Symbols: s is the station along the track's center line [m], d the offset from it, positive to
/// the left [m], beta(s) the bank, positive if the road rises to the left [rad], and z(s) the
/// height of the center line [m]. The height of the road is z(s) + d tan(beta(s)).
namespace trackbed {

struct BankedTrack {
  std::vector<TrackPoint> points;  ///< Center line and widths; Track::kMinPoints or more.
  std::vector<double> banks;       ///< Bank at each point [rad], between -pi/4 and pi/4.
  std::vector<double> heights;     ///< Height at each point [m].
  bool closed = true;              ///< Whether the last point is followed by the first one.
};

/// Returns whether points are a closed line. The gap between the last and the first point must be
/// at most twice the largest distance between neighboring points. The directions of the first and
/// the last chord must differ by at most 30 degrees more than the line turns at its second and its
/// last but one point. Files of tracks do not say whether they are closed.
bool IsClosedLine(const std::vector<TrackPoint>& points);

/// Returns why points cannot be an open line, for people; empty if they can.
std::string OpenLineProblem(const std::vector<TrackPoint>& points);

class GroundLine;

/// Makes terrains along one center line, for any banks.
///
/// Between the edges of the track and 1.5 m beyond the edges, the terrain is the banked road,
/// interpolated from points every 0.5 m. Further outside, the terrain blends into smooth ground
/// within 8 m. Bank and height are smoothed as the center line is (Track). Where parts of the track
/// are close to each other, each part keeps its height on the road, and the ground in between is
/// their mean, weighted by proximity. On the inside of bends, the road ends at 0.9 of the bend's
/// radius. An open road continues straight beyond its ends, with the slope and the bank that it has
/// there. The road blends into smooth ground between 1.5 m and 9.5 m from its ends.
class BankedGround {
 public:
  /// Throws InputError if the track spreads over more than 4 km along x or y, or if it is open and
  /// has an OpenLineProblem. Cost: 0.3 s per kilometer.
  explicit BankedGround(std::vector<TrackPoint> points, bool closed = true);

  [[nodiscard]] const std::vector<TrackPoint>& points() const;
  [[nodiscard]] bool closed() const;
  /// Returns the length of the center line [m].
  [[nodiscard]] double length() const;
  [[nodiscard]] double StationOf(std::size_t point) const;

  /// Returns the terrain for the bank [rad] and the height [m] at each point of the center line.
  /// Throws PreconditionError unless there is a number for each point. Cost: 0.1 s per kilometer.
  [[nodiscard]] std::shared_ptr<const Terrain> With(const std::vector<double>& banks,
                                                    const std::vector<double>& heights) const;

 private:
  /// A place of the ground on one part of the track.
  struct Place {
    double s = 0.0;
    double d = 0.0;
    double weight = 0.0;  // by proximity, the sum over the parts is 1
  };
  /// A node of the terrain: its places on all parts of the track nearby.
  struct Node {
    std::vector<Place> places{};
    double share = 0.0;  // weight of the road against the coarse ground
  };
  struct Block {
    int column = 0;
    int row = 0;
    std::vector<Node> nodes{};  // in the order in which Terrain::Refine asks for them
  };

  void FindNodes();
  [[nodiscard]] Node NodeAt(const Vec2& point, const std::vector<std::size_t>& near) const;
  [[nodiscard]] std::vector<std::size_t> NearestOfRuns(const Vec2& point,
                                                       const std::vector<std::size_t>& near) const;
  [[nodiscard]] std::vector<double> Coarse(const std::vector<double>& heights, double base) const;

  std::shared_ptr<const GroundLine> line_;
  Terrain::Size size_;
  std::vector<PathPoint> samples_;  // of the center line
  std::vector<double> stations_;    // of the samples
  double reach_ = 0.0;              // largest distance of changed ground from the center line
  std::vector<Block> blocks_;
};

/// Returns the terrain of a banked track. Throws the same errors as BankedGround.
std::shared_ptr<const Terrain> MakeTerrain(const BankedTrack& track);

/// The points of a center line, and whether it is closed.
struct CenterPoints {
  std::vector<TrackPoint> points;
  bool closed = true;
  std::vector<int> lines{};  ///< Line of each point in its file.
};

/// Reads the points of a track file (track/track_file.h), which may be open. The file is open if it
/// has a column `closed` of zeros, or no such column and not the shape of a closed line
/// (IsClosedLine). A file without columns of widths is the log of a drive. The path of this drive,
/// with points 0.5 m or more apart, is the middle of an open road of 10 m. Throws InputError in the
/// same cases as ReadTrackFile, and if the line is open and has an OpenLineProblem.
CenterPoints ReadCenterPoints(const std::filesystem::path& file);

/// Reads a track file with the column `bank_rad`, `z_m`, or both; a missing column counts as 0.
/// Throws InputError in the same cases as ReadCenterPoints, and if both columns are missing or a
/// number is out of range.
BankedTrack ReadBankedTrack(const std::filesystem::path& file);

/// The file name of a banked track in a run folder and in the folder of an identification.
inline constexpr const char* kBankCsv = "bank.csv";

/// Formats a banked track as a file from which ReadBankedTrack reads equal numbers.
std::string BankedTrackCsv(const BankedTrack& track);

}  // namespace trackbed
