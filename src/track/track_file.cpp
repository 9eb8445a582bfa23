#include "trackbed/track/track_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <system_error>
#include <tuple>
#include <utility>

#include "src/track/track_fold.h"
#include "src/track/track_rows.h"
#include "src/track/track_steps.h"
#include "trackbed/core/angle.h"
#include "trackbed/core/error.h"
#include "trackbed/core/table.h"

// Reads the center line and widths of a track from a CSV file.
// 1. TrackRows reads the columns and checks the numbers.
// 2. CheckShape refuses center lines with large gaps, and center lines that turn back at a point.
// 3. FitSmoothing chooses the wavelength of the smoothing. Where the smooth line swings aside of
//    the straight line between two points, FittingTrack adds points on this straight line.
// 4. If an edge folds over in a tight bend, Narrow moves this edge inwards, with a note, but by at
//    most half of its width.
namespace trackbed {
namespace {

constexpr std::uintmax_t kMaxTrackFileBytes = std::uintmax_t{16} << 20U;
constexpr double kMaxLapLength = 200e3;  // Largest permitted length of the lap [m].
// Largest permitted change of direction at a point [deg]; beyond this angle, the center line counts
// as turning back at the point.
constexpr double kMaxTurn = 150.0;
constexpr const char* kFirstColumn = "# x_m";

void CheckSize(const std::filesystem::path& file) {
  std::error_code ignored;
  const std::uintmax_t size = std::filesystem::file_size(file, ignored);
  if (!ignored && size > kMaxTrackFileBytes) {
    throw InputError(Problem{
        .file = file.string(),
        .message = fmt::format("has {} bytes; a track has at most {}", size, kMaxTrackFileBytes)});
  }
}

/// Rejects a center line that jumps back and forth, because such a line cannot be smoothed to a
/// track.
void CheckShape(const std::string& name, const std::vector<int>& lines,
                const std::vector<TrackPoint>& points, ProblemList& problems) {
  const std::size_t count = points.size();
  double length = 0.0;
  double longest = 0.0;
  std::size_t widest = 0;  // index of the point before the largest gap
  for (std::size_t i = 0; i < count; ++i) {
    const Vec2& here = points[i].position;
    const Vec2 before = here - points[(i + count - 1) % count].position;
    const Vec2 after = points[(i + 1) % count].position - here;
    length += after.norm();
    widest = after.norm() > longest ? i : widest;
    longest = std::max(longest, after.norm());
    const double turn = std::abs(AngleDifference(std::atan2(after.y(), after.x()),
                                                 std::atan2(before.y(), before.x()))) *
                        180.0 / std::numbers::pi;
    if (turn > kMaxTurn) {
      problems.Add({.file = name,
                    .line = lines[i],
                    .message = fmt::format("the center line turns back here, by {:.3g} degrees; "
                                           "must be at most {:.3g} from point to point",
                                           turn, kMaxTurn)});
    }
  }
  if (length > kMaxLapLength) {
    const int end = lines[(widest + 1) % count];
    problems.Add(
        {.file = name,
         .line = end,
         .message = fmt::format("a lap is {:.4g} km long; must be at most {:.4g}: the gap "
                                "between rows {} and {} is {:.7g} m",
                                length / 1e3, kMaxLapLength / 1e3, lines[widest], end, longest)});
  }
}

std::string DescribeFold(const TrackFold& fold, double given) {
  return fold.width < fold.radius && fold.turn > 0.0
             ? fmt::format(
                   "the center line turns by {:.3g} rad within a quarter of the mean "
                   "distance of the points; must be at most half a circle: a point may be "
                   "wrong, or the smoothing too short",
                   fold.turn)
             : fmt::format(
                   "the center line bends on a radius of {:.4g} m, but the inner edge is "
                   "{:.4g} m from it; an edge is narrowed to {} of the radius, but not to less "
                   "than half: a point may be wrong, or a longer mission.track.smoothing "
                   "straightens the bend",
                   fold.radius, given, kMaxRadiusFraction);
}

/// Returns the track points with half of their widths. The edges may be narrowed to half of the
/// given widths, but not further.
std::vector<TrackPoint> Halved(std::vector<TrackPoint> points) {
  for (TrackPoint& point : points) {
    point.width_left *= 0.5;
    point.width_right *= 0.5;
  }
  return points;
}

/// Rejects track points at which an edge would have to be narrowed to less than half of its width.
void CheckFolds(TrackRows& rows, std::optional<double> smoothing) {
  if (std::optional<TrackFold> fold = FindFold(Halved(rows.points), smoothing)) {
    rows.Add(fold->point, "", DescribeFold(*fold, 2.0 * fold->width));
  }
  rows.problems.ThrowIfAny();
}

/// Limit of the displacement by a default smoothing, as a fraction of the narrowest width of the
/// track. This displacement limit applies to the shift of each point, and to the deviation of the
/// smoothed line from the straight line of a long step.
constexpr double kMaxShift = 0.1;

/// Returns the largest distance by which a default smoothing may move a point of this track [m].
double LargestShift(const TrackRows& rows) {
  double narrowest = std::numeric_limits<double>::infinity();
  for (const TrackPoint& point : rows.points) {
    narrowest = std::min(narrowest, point.width_left + point.width_right);
  }
  return kMaxShift * narrowest;
}

/// Adds a note if the center line with this smoothing swings aside on steps between the points.
void NoteSwings(TrackRows& rows, double smoothing) {
  const double largest = LargestShift(rows);
  const LineDeviations found = FindDeviations(rows.points, smoothing, largest);
  if (!found.swinging.empty()) {
    rows.notes.push_back(fmt::format(
        "the center line, smoothed over {:.4g} m, swings aside of the straight lines between the "
        "points by more than {:.3g} m on {} {}, the first of which begins in line {}; without "
        "mission.track.smoothing, the wavelength is chosen so that it does not",
        smoothing, largest, found.swinging.size(), found.swinging.size() == 1 ? "step" : "steps",
        rows.lines[found.swinging.front()]));
  }
}

/// Returns the track if no edge would have to be narrowed to less than half of its width, and if
/// the smoothing does not move a point by more than LargestShift. Adds the middles of the steps on
/// which the center line swings aside (FindDeviations), until none is left. Each round halves these
/// steps, so the line approaches the straight lines between the points there. Otherwise returns
/// nullopt; the rows then contain the points of the last round. Steps shorter than the default
/// distance for this wavelength are not halved, because a shorter wavelength helps there.
std::optional<Track> FittingTrack(TrackRows& rows, double smoothing) {
  constexpr std::size_t kMostAdded = 4;  // Largest number of added points per point of the file.
  const double largest = LargestShift(rows);
  const std::size_t most = std::min((kMostAdded + 1) * rows.points.size(), Track::kMaxPoints);
  while (true) {
    const LineDeviations found = FindDeviations(rows.points, smoothing, largest);
    if (found.largest > largest) {
      return std::nullopt;
    }
    if (found.swinging.empty()) {
      return FindFold(Halved(rows.points), smoothing)
                 ? std::nullopt
                 : std::optional(Track(rows.points, smoothing));
    }
    if (rows.points.size() + found.swinging.size() > most ||
        ShortestStep(rows.points, found.swinging) < smoothing / kDefaultSmoothing) {
      return std::nullopt;
    }
    AddMiddles(rows, found.swinging);
  }
}

/// Whether the polyline turns both left and right within eight points before and eight points after
/// a point.
bool Zigzags(const std::vector<TrackPoint>& points, std::size_t at) {
  constexpr std::size_t kAround = 8;
  const std::size_t count = points.size();
  bool turns_left = false;
  bool turns_right = false;
  for (std::size_t i = at + count - std::min(kAround, count); i <= at + count + kAround; ++i) {
    const Vec2& here = points[i % count].position;
    const double turn = Cross(here - points[(i + count - 1) % count].position,
                              points[(i + 1) % count].position - here);
    turns_left = turns_left || turn > 0.0;
    turns_right = turns_right || turn < 0.0;
  }
  return turns_left && turns_right;
}

/// A track, and whether it results from the default wavelength and the points of the file.
struct SmoothedTrack {
  Track track;
  bool is_default = false;
};

/// Finds a smoothing wavelength for which the track fits (FittingTrack): the default of Track,
/// multiplied by the power of 2 nearest to 1. Points on the grid of a picture turn to the left and
/// to the right alternately, so they need a longer wavelength. Points with long straights between
/// them need a shorter wavelength. Returns nullopt, with unchanged rows, if no wavelength fits.
std::optional<SmoothedTrack> FitSmoothing(TrackRows& rows) {
  const std::pair given(rows.points, rows.lines);
  double length = 0.0;
  for (std::size_t i = 0; i < rows.points.size(); ++i) {
    length += (rows.points[(i + 1) % rows.points.size()].position - rows.points[i].position).norm();
  }
  const double usual = kDefaultSmoothing * length / static_cast<double>(rows.points.size());
  const std::optional<TrackFold> fold = FindFold(Halved(rows.points), usual);
  const bool zigzags = fold && Zigzags(rows.points, fold->point);
  constexpr int kMostDoublings = 6;
  for (int i = 0; i <= kMostDoublings; ++i) {
    const double smoothing = std::ldexp(usual, zigzags ? i : -i);
    std::optional<Track> track = FittingTrack(rows, smoothing);
    if (!track) {
      std::tie(rows.points, rows.lines) = given;
      continue;
    }
    if (rows.points.size() > given.first.size()) {
      rows.notes.push_back(
          fmt::format("{} points are added on the straight lines between the points, where a "
                      "smooth line would swing aside by more than {:.3g} m",
                      rows.points.size() - given.first.size(), LargestShift(rows)));
    }
    if (i > 0) {
      rows.notes.push_back(fmt::format(
          "the center line is smoothed over {:.4g} m instead of {:.4g} m, four times the mean "
          "distance of the points, because {}; mission.track.smoothing sets the length",
          smoothing, usual,
          zigzags ? "an edge would fold over in the bends of the points"
          : FindDeviations(given.first, usual, 0.0).largest > LargestShift(rows)
              ? fmt::format("this would move a point by more than {:.3g} m", LargestShift(rows))
              : "an edge would fold over, or the line would swing aside"));
    }
    const bool is_default = i == 0 && rows.points.size() == given.first.size();
    return SmoothedTrack{std::move(*track), is_default};
  }
  return std::nullopt;
}

/// For each surveyed point, the largest offset of the edges at which they do not fold over [m].
struct EdgeLimits {
  std::vector<double> left;
  std::vector<double> right;
  std::vector<double> radius;  // Smallest radius of curvature of the center line next to each point
                               // [m].
};

EdgeLimits FindEdgeLimits(const Track& track) {
  const std::size_t count = track.points().size();
  constexpr double kAny = std::numeric_limits<double>::infinity();
  EdgeLimits limits{std::vector<double>(count, kAny), std::vector<double>(count, kAny),
                    std::vector<double>(count, kAny)};
  for (std::size_t i = 0; i < count; ++i) {
    const std::size_t next = (i + 1) % count;
    for (int k = 0; k < kFoldSamples; ++k) {
      const double s = StationOfSample(track, i, k);
      const double curvature = track.At(s).curvature;
      // This factor is slightly below 1, because the track edge is interpolated with rounding
      // errors.
      constexpr double kRounding = 1.0 - 1e-9;
      const double limit = kRounding * kMaxRadiusFraction / std::abs(curvature);
      std::vector<double>& side = curvature > 0.0 ? limits.left : limits.right;
      for (const std::size_t point : {i, next}) {
        side[point] = std::min(side[point], limit);
        limits.radius[point] = std::min(limits.radius[point], 1.0 / std::abs(curvature));
      }
    }
  }
  return limits;
}

/// Collects notes on the narrowed places of one edge; consecutive narrowed points form one place.
class NarrowedPlaces {
 public:
  NarrowedPlaces(TrackRows& rows, const char* edge) : rows_(rows), edge_(edge) {}

  void Add(std::size_t point, double from, double to, double radius, double station) {
    if (count_ > 0 && point == last_ + 1) {
      last_ = point;
      if (from - to > from_ - to_) {
        Set(from, to, radius, station);
      }
      return;
    }
    Finish();
    ++count_;
    first_ = last_ = point;
    Set(from, to, radius, station);
  }

  void Finish() {
    if (count_ == 0 || count_ > kMaxNoted) {
      return;
    }
    const std::string lines =
        first_ == last_ ? fmt::format("line {}", rows_.lines[first_])
                        : fmt::format("lines {} to {}", rows_.lines[first_], rows_.lines[last_]);
    rows_.notes.push_back(fmt::format(
        "{}, s = {:.4g} m: the {} edge is narrowed from {:.4g} m to {:.4g} m, because the center "
        "line bends on a radius of {:.4g} m",
        lines, station_, edge_, from_, to_, radius_));
  }

  void FinishAll() {
    Finish();
    if (count_ > kMaxNoted) {
      rows_.notes.push_back(
          fmt::format("the {} edge is narrowed at {} more places", edge_, count_ - kMaxNoted));
    }
  }

 private:
  static constexpr std::size_t kMaxNoted = 5;

  void Set(double from, double to, double radius, double station) {
    from_ = from;
    to_ = to;
    radius_ = radius;
    station_ = station;
  }

  TrackRows& rows_;
  const char* edge_;
  std::size_t count_ = 0;
  std::size_t first_ = 0;
  std::size_t last_ = 0;
  double from_ = 0.0;
  double to_ = 0.0;
  double radius_ = 0.0;
  double station_ = 0.0;
};

/// Narrows the track edges that fold over; returns the track points with their new widths.
std::vector<TrackPoint> Narrow(const Track& track, TrackRows& rows) {
  const EdgeLimits limits = FindEdgeLimits(track);
  NarrowedPlaces left(rows, "left");
  NarrowedPlaces right(rows, "right");
  std::vector<TrackPoint> points = track.points();
  for (std::size_t i = 0; i < points.size(); ++i) {
    const double s = track.StationOf(i);
    const TrackEdges edges = track.EdgesAt(s);
    const auto narrow = [&](double excess, double& width, NarrowedPlaces& places) {
      if (excess <= 0.0) {
        return;
      }
      places.Add(i, width, width - excess, limits.radius[i], s);
      if (width - excess < 0.5 * width) {
        rows.Add(i, "", DescribeFold({i, limits.radius[i], width}, width));
      }
      width -= excess;
    };
    narrow(edges.left - limits.left[i], points[i].width_left, left);
    narrow(-edges.right - limits.right[i], points[i].width_right, right);
  }
  left.FinishAll();
  right.FinishAll();
  rows.problems.ThrowIfAny();
  return points;
}

}  // namespace

TrackFile ReadTrackFile(const std::filesystem::path& file, const TrackReading& reading) {
  CheckSize(file);
  TrackRows rows(file, reading);
  if (rows.points.size() < Track::kMinPoints || rows.points.size() > Track::kMaxPoints) {
    throw InputError(
        Problem{.file = file.string(),
                .message = fmt::format("has {} points; a track has {} to {}", rows.points.size(),
                                       Track::kMinPoints, Track::kMaxPoints)});
  }
  CheckShape(file.string(), rows.lines, rows.points, rows.problems);
  rows.problems.ThrowIfAny();
  std::optional<SmoothedTrack> fitting = reading.smoothing ? std::nullopt : FitSmoothing(rows);
  if (!fitting) {
    CheckFolds(rows, reading.smoothing);
    if (reading.smoothing) {
      NoteSwings(rows, *reading.smoothing);
    }
    fitting = SmoothedTrack{Track(rows.points, reading.smoothing), true};
  }
  std::optional<double> chosen;
  if (!fitting->is_default) {
    chosen = fitting->track.smoothing();
  }
  Track track = std::move(fitting->track);
  if (FindFold(track)) {
    // Keep the smoothing wavelength, because the default wavelength for the narrower track may be
    // different.
    const double smoothing = track.smoothing();
    track = Track(Narrow(track, rows), smoothing);
    chosen = reading.smoothing ? std::nullopt : std::optional(smoothing);
  }
  TRACKBED_CHECK(!FindFold(track), "{}: an edge folds over after it was narrowed", file.string());
  for (std::size_t i = 0; i < track.points().size(); ++i) {
    const TrackEdges edges = track.EdgesAt(track.StationOf(i));
    if (edges.right >= 0.0 || edges.left <= 0.0) {
      rows.Add(i, "",
               fmt::format("smoothed over {:.4g} m, the center line leaves the track here; use a "
                           "shorter smoothing",
                           track.smoothing()));
      break;
    }
  }
  rows.problems.ThrowIfAny();
  return {std::move(track), std::move(rows.notes), chosen};
}

TrackFilePoints ReadTrackPoints(const std::filesystem::path& file, double log_spacing,
                                double log_half_width) {
  CheckSize(file);
  const TrackReading reading;
  TrackRows rows(file, reading, LogReading{log_spacing, log_half_width});
  return {std::move(rows.points), std::move(rows.lines), rows.is_log()};
}

Track ReadTrack(const std::filesystem::path& file, std::optional<double> smoothing) {
  return ReadTrackFile(file, {.smoothing = smoothing}).track;
}

std::string TrackCsv(const std::vector<TrackPoint>& points) {
  Table table({kFirstColumn, "y_m", "w_tr_right_m", "w_tr_left_m"});
  for (const TrackPoint& point : points) {
    table.AddRow({point.position.x(), point.position.y(), point.width_right, point.width_left});
  }
  return table.ToCsv();
}

}  // namespace trackbed
