#include "trackbed/recording/banked_track.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <boost/algorithm/string/predicate.hpp>
#include <charconv>
#include <cmath>
#include <numbers>
#include <optional>
#include <system_error>
#include <utility>

#include "src/recording/ground_line.h"
#include "trackbed/core/angle.h"
#include "trackbed/core/csv_rows.h"
#include "trackbed/core/error.h"
#include "trackbed/core/table.h"
#include "trackbed/track/track_file.h"

// Makes a terrain from a track with bank and grade. Each node of the terrain has a place (s, d) on
// each nearby part of the track: the station s and the lateral offset d. The samples of the center
// line within reach are split into runs of consecutive samples, and Newton's method refines the
// nearest sample of each run. As these places do not depend on the bank angle, they are computed
// once for many bank angles.

namespace trackbed {
namespace {

constexpr double kSampleSpacing = 1.0;  // Distance between samples of the center line [m].
constexpr double kSurfaceMargin = 1.5;  // Width by which the road extends beyond its edges [m].
constexpr double kBlendWidth = 8.0;     // Width of the transition to the coarse ground [m].
constexpr double kMargin = 128.0;       // Width of the terrain around the track [m].
constexpr double kLevelBorder = 24.0;   // Width of the level border of the terrain [m].
constexpr double kSlopeToBorder = 72.0;
// Height by which the level border lies below the lowest point of the road [m].
constexpr double kBorderDepth = 1.0;
constexpr double kMaxSide = 4000.0;  // Largest side length of the terrain [m].
// Column that states whether the center line in a file is closed.
constexpr const char* kClosedColumn = "closed";

/// Smooth step function that falls from 1 at u = 0 to 0 at u = 1, with zero first and second
/// derivative at both ends.
double Fade(double u) {
  const double v = 1.0 - std::clamp(u, 0.0, 1.0);
  return v * v * v * (10.0 - v * (15.0 - 6.0 * v));
}

}  // namespace

BankedGround::BankedGround(std::vector<TrackPoint> points, bool closed) {
  if (const std::string problem = closed ? "" : OpenLineProblem(points); !problem.empty()) {
    throw InputError(Problem{.message = problem});
  }
  line_ = std::make_shared<const GroundLine>(std::move(points), closed);
  Vec2 low = line_->points().front().position;
  Vec2 high = low;
  for (const TrackPoint& point : line_->points()) {
    low = low.cwiseMin(point.position);
    high = high.cwiseMax(point.position);
    reach_ = std::max({reach_, point.width_left, point.width_right});
  }
  reach_ += kSurfaceMargin + kBlendWidth;
  if ((high - low).maxCoeff() > kMaxSide) {
    throw InputError(Problem{
        .message = fmt::format("the track spreads over {:.4g} m; a track with bank may spread over "
                               "at most {:.4g} m along x and y",
                               (high - low).maxCoeff(), kMaxSide)});
  }
  size_.low = Terrain::kBlock * ((low.array() - kMargin) / Terrain::kBlock).floor();
  size_.columns =
      static_cast<int>(std::ceil((high.x() + kMargin - size_.low.x()) / Terrain::kBlock));
  size_.rows = static_cast<int>(std::ceil((high.y() + kMargin - size_.low.y()) / Terrain::kBlock));
  const double parts = std::ceil(line_->length() / kSampleSpacing);
  for (double i = 0.0; i < parts + (closed ? 0.0 : 1.0); i += 1.0) {
    stations_.push_back(line_->length() * i / parts);
    samples_.push_back(line_->At(stations_.back()));
  }
  FindNodes();
}

const std::vector<TrackPoint>& BankedGround::points() const {
  return line_->points();
}

bool BankedGround::closed() const {
  return line_->closed();
}

double BankedGround::length() const {
  return line_->length();
}

double BankedGround::StationOf(std::size_t point) const {
  return line_->StationOf(point);
}

void BankedGround::FindNodes() {
  for (int row = 0; row < size_.rows; ++row) {
    for (int column = 0; column < size_.columns; ++column) {
      const Vec2 low = size_.low + Terrain::kBlock * Vec2(column, row);
      const Vec2 middle = low + 0.5 * Terrain::kBlock * Vec2::Ones();
      // Half the diagonal of a block that is extended by one cell on each side.
      const double radius = std::numbers::sqrt2 * (0.5 * Terrain::kBlock + Terrain::kCell);
      std::vector<std::size_t> near;
      for (std::size_t i = 0; i < samples_.size(); ++i) {
        if ((samples_[i].pose.position() - middle).norm() < radius + reach_ + kSampleSpacing) {
          near.push_back(i);
        }
      }
      if (near.empty()) {
        continue;
      }
      Block block{.column = column, .row = row};
      for (int j = -1; j <= Terrain::kCells + 1; ++j) {
        for (int i = -1; i <= Terrain::kCells + 1; ++i) {
          block.nodes.push_back(NodeAt(low + Terrain::kCell * Vec2(i, j), near));
        }
      }
      blocks_.push_back(std::move(block));
    }
  }
}

BankedGround::Node BankedGround::NodeAt(const Vec2& point,
                                        const std::vector<std::size_t>& near) const {
  Node node;
  double sum = 0.0;
  const auto take = [&](std::size_t nearest) {
    double s = stations_[nearest];
    PathPoint at = samples_[nearest];
    double d = 0.0;
    double fold = 1.0;
    for (int i = 0; i < 3; ++i) {
      const Vec2 offset = point - at.pose.position();
      const Vec2 ahead = Direction(at.pose.yaw);
      d = offset.dot(LeftNormal(ahead));
      fold = 1.0 - at.curvature * d;
      s += offset.dot(ahead) / std::max(fold, 0.3);
      at = line_->At(s);
    }
    const TrackEdges edges = line_->EdgesAt(s);
    const double beside = std::max({0.0, d - edges.left, edges.right - d});
    // The road fades out while 1 - kappa d, with the lateral offset d, decreases from 0.5 to 0.1.
    const auto fade = [](double beyond) { return Fade((beyond - kSurfaceMargin) / kBlendWidth); };
    const double share = Fade((0.5 - fold) / 0.4) * fade(beside) * fade(line_->BeyondEnds(s));
    if (share <= 0.0) {
      return;
    }
    constexpr double kMinSquared = 1e-6;  // [m^2]
    const double square = beside * beside + kMinSquared;
    node.places.push_back({.s = s, .d = d, .weight = share / (square * square)});
    node.share = std::max(node.share, share);
    sum += node.places.back().weight;
  };
  for (const std::size_t nearest : NearestOfRuns(point, near)) {
    take(nearest);
  }
  for (Place& place : node.places) {
    place.weight /= sum;
  }
  return node;
}

/// Returns the nearest sample of each run of consecutive samples within reach of a point. A run may
/// continue across the start line.
std::vector<std::size_t> BankedGround::NearestOfRuns(const Vec2& point,
                                                     const std::vector<std::size_t>& near) const {
  struct Run {
    std::size_t first = 0;
    std::size_t last = 0;
    std::size_t nearest = 0;
    double square = 0.0;  // of the distance [m^2]
  };
  std::vector<Run> runs;
  for (const std::size_t i : near) {
    const double square = (samples_[i].pose.position() - point).squaredNorm();
    if (square > reach_ * reach_) {
      continue;
    }
    if (runs.empty() || i != runs.back().last + 1) {
      runs.push_back({i, i, i, square});
      continue;
    }
    runs.back().last = i;
    if (square < runs.back().square) {
      runs.back().nearest = i;
      runs.back().square = square;
    }
  }
  if (line_->closed() && runs.size() > 1 && runs.front().first == 0 &&
      runs.back().last + 1 == samples_.size()) {
    if (runs.back().square < runs.front().square) {
      runs.front() = runs.back();
    }
    runs.pop_back();
  }
  std::vector<std::size_t> nearest;
  for (const Run& run : runs) {
    nearest.push_back(run.nearest);
  }
  return nearest;
}

std::vector<double> BankedGround::Coarse(const std::vector<double>& heights, double base) const {
  // Computes the mean height of the points, weighted by proximity. The border of the terrain has
  // the height `base`.
  constexpr std::size_t kMaxPoints = 500;
  const std::vector<TrackPoint>& points = line_->points();
  const std::size_t stride = 1 + points.size() / kMaxPoints;
  std::vector<double> coarse;
  for (int row = 0; row < size_.CoarseRows(); ++row) {
    for (int column = 0; column < size_.CoarseColumns(); ++column) {
      const Vec2 at = size_.low + Terrain::kCoarseCell * Vec2(column, row);
      double sum = 0.0;
      double weights = 0.0;
      for (std::size_t i = 0; i < points.size(); i += stride) {
        const double square = (points[i].position - at).squaredNorm() + 1.0;
        sum += heights[i] / (square * square);
        weights += 1.0 / (square * square);
      }
      const int cells =
          std::min({column, row, size_.CoarseColumns() - 1 - column, size_.CoarseRows() - 1 - row});
      const double u =
          std::clamp((Terrain::kCoarseCell * cells - kLevelBorder) / kSlopeToBorder, 0.0, 1.0);
      coarse.push_back(std::lerp(base, sum / weights, u * u * (3.0 - 2.0 * u)));
    }
  }
  return coarse;
}

std::shared_ptr<const Terrain> BankedGround::With(const std::vector<double>& banks,
                                                  const std::vector<double>& heights) const {
  const std::size_t count = line_->points().size();
  TRACKBED_REQUIRE(banks.size() == count && heights.size() == count,
                   "BankedGround: {} banks, {} heights for {} points", banks.size(), heights.size(),
                   count);
  Eigen::MatrixXd values(static_cast<Eigen::Index>(count), 2);
  double steepest = 0.0;
  for (std::size_t i = 0; i < count; ++i) {
    const double slope = std::tan(banks[i]);
    values.row(static_cast<Eigen::Index>(i)) << slope, heights[i];
    steepest = std::max(steepest, std::abs(slope));
  }
  const GroundSurface surface = line_->SurfaceThrough(values);
  Terrain::Size size = size_;
  size.base = *std::min_element(heights.begin(), heights.end()) - steepest * reach_ - kBorderDepth;
  auto terrain = std::make_shared<Terrain>(size, Coarse(heights, size.base));
  for (const Block& block : blocks_) {
    auto node = block.nodes.begin();
    terrain->Refine(block.column, block.row, [&](const Vec2& /*point*/, double coarse) {
      double z = 0.0;
      for (const Place& place : node->places) {
        const Eigen::RowVectorXd at = surface.At(place.s);
        z += place.weight * (at[1] + place.d * at[0]);
      }
      const double share = (node++)->share;
      return share * (z - coarse);
    });
  }
  return terrain;
}

std::shared_ptr<const Terrain> MakeTerrain(const BankedTrack& track) {
  return BankedGround(track.points, track.closed).With(track.banks, track.heights);
}

bool IsClosedLine(const std::vector<TrackPoint>& points) {
  if (points.size() < Track::kMinPoints) {
    return false;
  }
  constexpr double kLargestGap =
      2.0;  // largest gap, as a multiple of the largest distance between neighboring points
  constexpr double kSameDirection = kPi / 6.0;
  const auto chord = [&](std::size_t i) -> Vec2 {
    return points[(i + 1) % points.size()].position - points[i].position;
  };
  const auto turn = [](const Vec2& from, const Vec2& to) {
    return std::abs(std::atan2(Cross(from, to), from.dot(to)));
  };
  double longest = 0.0;
  const std::size_t last = points.size() - 1;
  for (std::size_t i = 0; i < last; ++i) {
    longest = std::max(longest, chord(i).norm());
  }
  const double turns = turn(chord(0), chord(1)) + turn(chord(last - 2), chord(last - 1));
  return chord(last).norm() <= kLargestGap * longest &&
         turn(chord(last - 1), chord(0)) <= kSameDirection + turns;
}

std::string OpenLineProblem(const std::vector<TrackPoint>& points) {
  if (points.size() < Track::kMinPoints || points.size() > Track::kMaxPoints) {
    return fmt::format("the open line has {} points; must have {} to {}", points.size(),
                       Track::kMinPoints, Track::kMaxPoints);
  }
  constexpr double kSharpest = 150.0 * kPi / 180.0;
  for (std::size_t i = 1; i < points.size(); ++i) {
    const Vec2 to = points[i].position - points[i - 1].position;
    if (to.norm() <= 0.0) {
      return fmt::format("the open line repeats its point {} at {:.6g}, {:.6g}", i,
                         points[i].position.x(), points[i].position.y());
    }
    const Vec2 from = i > 1 ? Vec2(points[i - 1].position - points[i - 2].position) : to;
    if (std::abs(std::atan2(Cross(from, to), from.dot(to))) > kSharpest) {
      return fmt::format(
          "the open line turns back at its point {}, {:.6g}, {:.6g}; must turn by "
          "at most 150 degrees from point to point",
          i, points[i - 1].position.x(), points[i - 1].position.y());
    }
  }
  return "";
}

namespace {

/// Reads the column `closed` of a file; nullopt if the file has no such column.
std::optional<bool> ReadClosed(const std::filesystem::path& file) {
  std::optional<std::size_t> index;
  std::optional<bool> closed;
  ProblemList problems;
  ReadCsvTable(
      file, {.delimiter = kFindDelimiter}, problems,
      [&](const std::vector<std::string>& names, int /*line*/) {
        for (std::size_t i = 0; i < names.size(); ++i) {
          index = boost::iequals(names[i], kClosedColumn) ? i : index;
        }
      },
      [&](const std::vector<std::string>& cells, int line) {
        if (!index || *index >= cells.size()) {
          return;
        }
        const std::string& cell = cells[*index];
        if (cell != "0" && cell != "1") {
          problems.Add({file.string(), line, 0, kClosedColumn,
                        fmt::format("'{}'; must be 1 if the line is closed, 0 if not", cell)});
        }
        closed = closed.value_or(true) && cell != "0";
      });
  problems.ThrowIfAny();
  return closed;
}

}  // namespace

CenterPoints ReadCenterPoints(const std::filesystem::path& file) {
  constexpr double kLogSpacing = 0.5;    // [m]
  constexpr double kLogHalfWidth = 5.0;  // [m]
  TrackFilePoints read = ReadTrackPoints(file, kLogSpacing, kLogHalfWidth);
  CenterPoints line{
      .points = std::move(read.points), .closed = true, .lines = std::move(read.lines)};
  const std::optional<bool> closed = ReadClosed(file);
  line.closed = !read.is_log && closed.value_or(IsClosedLine(line.points));
  if (line.closed) {
    line.points = ReadTrackFile(file).track.points();
  } else if (std::string problem = OpenLineProblem(line.points); !problem.empty()) {
    throw InputError(Problem{.file = file.string(), .message = std::move(problem)});
  }
  return line;
}

BankedTrack ReadBankedTrack(const std::filesystem::path& file) {
  CenterPoints line = ReadCenterPoints(file);
  BankedTrack track{
      .points = std::move(line.points), .banks = {}, .heights = {}, .closed = line.closed};
  constexpr double kMaxBank = 0.25 * std::numbers::pi;
  constexpr double kMaxHeight = 1e4;  // [m]
  struct Column {
    const char* name;
    double most;
    std::vector<double>& numbers;
    std::optional<std::size_t> index{};
  };
  std::array<Column, 2> columns{
      {{"bank_rad", kMaxBank, track.banks}, {"z_m", kMaxHeight, track.heights}}};
  ProblemList problems;
  ReadCsvTable(
      file, {.delimiter = kFindDelimiter}, problems,
      [&](const std::vector<std::string>& names, int row) {
        for (Column& column : columns) {
          for (std::size_t i = 0; i < names.size(); ++i) {
            column.index = boost::iequals(names[i], column.name) ? i : column.index;
          }
        }
        if (!columns[0].index && !columns[1].index) {
          problems.Add({.file = file.string(),
                        .line = row,
                        .message = "no column 'bank_rad' and no column 'z_m'; add the bank of the "
                                   "road at each point, positive if it rises to the left"});
        }
      },
      [&](const std::vector<std::string>& cells, int row) {
        // Skip rows without a point: rows of a log between the points, and a last row that repeats
        // the first point.
        if (track.banks.size() >= line.lines.size() || line.lines[track.banks.size()] != row) {
          return;
        }
        for (Column& column : columns) {
          double number = 0.0;
          if (column.index) {
            const std::string& cell = cells[*column.index];
            const auto [end, error] =
                std::from_chars(cell.data(), cell.data() + cell.size(), number);
            if (error != std::errc{} || end != cell.data() + cell.size() ||
                !(std::abs(number) <= column.most)) {
              problems.Add({file.string(), row, 0, column.name,
                            fmt::format("'{}'; must be a number between {:.4g} and {:.4g}", cell,
                                        -column.most, column.most)});
              number = 0.0;
            }
          }
          column.numbers.push_back(number);
        }
      });
  problems.ThrowIfAny();
  TRACKBED_CHECK(track.banks.size() == track.points.size(), "{}: {} banks for {} points",
                 file.string(), track.banks.size(), track.points.size());
  return track;
}

std::string BankedTrackCsv(const BankedTrack& track) {
  std::vector<std::string> names{"# x_m", "y_m", "w_tr_right_m", "w_tr_left_m", "bank_rad", "z_m"};
  if (!track.closed) {
    names.emplace_back(kClosedColumn);
  }
  Table table(names);
  for (std::size_t i = 0; i < track.points.size(); ++i) {
    const TrackPoint& point = track.points[i];
    std::vector<double> row{point.position.x(), point.position.y(), point.width_right,
                            point.width_left,   track.banks[i],     track.heights[i]};
    if (!track.closed) {
      row.push_back(0.0);
    }
    table.AddRow(row);
  }
  return table.ToCsv();
}

}  // namespace trackbed
