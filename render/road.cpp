#include "render/road.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "render/decor.h"
#include "render/ground_line.h"
#include "render/ground_paint.h"
#include "render/ribbon.h"

// Draws roads on the ground in several layers of different height. The asphalt consists of flat
// tiles that follow the ground. Gravel verges, edge lines, dashes and road marks are ribbons; posts
// stand beside the road. The center line of a road is taken from the road network, the track or the
// plan. A center line along a plan has a point every 0.5 m. To limit the number of shapes, lines
// are thinned and pieces far from the camera's target are omitted.
namespace trackbed::render {
namespace {

constexpr Color kRoadColor{0.40F, 0.41F, 0.42F};
constexpr Color kPaint{0.93F, 0.93F, 0.90F};
constexpr Color kYellowPaint{0.90F, 0.72F, 0.20F};
// Depth by which the ground surface is lowered, so that it stays below the asphalt [m].
constexpr float kGroundUnderRoad = 0.006F;
// Width of the strip of asphalt outside the edge lines [m].
constexpr double kShoulder = 0.4;
constexpr double kLineWidth = 0.14;   // Width of a painted line [m].
constexpr double kVergeWidth = 1.05;  // Width of the gravel verge, which covers the rough
                                      // edge of the asphalt [m].
constexpr double kVergeBegin = 0.22;  // Distance from the center of the edge line to the
                                      // gravel [m].
constexpr Color kGravel{0.58F, 0.54F, 0.45F};
// Height of the gravel verge above the ground [m]; higher than the asphalt, whose corners the verge
// covers.
constexpr double kVergeHeight = -0.0015;
// Height of the asphalt above the ground, below all other paint [m].
constexpr double kAsphaltHeight = -0.003;
// Distance from the camera's target beyond which asphalt would be thinner than a pixel [m].
constexpr double kAsphaltRange = 250.0;
constexpr double kPaintHeight = -0.001;
constexpr double kDash = 3.0;         // Length of a dash of a lane line [m].
constexpr double kDashPeriod = 9.0;   // Distance between the starts of neighboring dashes [m].
constexpr double kPostPeriod = 10.0;  // Distance between two road posts along the road [m].
// Distance from the camera's target beyond which posts would be thinner than a pixel [m].
constexpr double kPostRange = 120.0;
constexpr double kPostHeight = 1.0;  // Height of a road post [m].

/// A point of a line, with the unit vector to the left of the line.
struct Spot {
  Point point;
  Vec2 left;
};

/// Returns points every `step` [m] along a line, beginning at the start of the line.
std::vector<Spot> SpotsAlong(const std::vector<Point>& line, double step) {
  std::vector<Spot> spots;
  double ahead = 0.0;  // distance along the line to the next point
  for (std::size_t i = 1; i < line.size(); ++i) {
    const Vec2 from(line[i - 1].x, line[i - 1].y);
    const Vec2 piece = Vec2(line[i].x, line[i].y) - from;
    const double length = piece.norm();
    for (; ahead < length; ahead += step) {
      const Vec2 at = from + piece * (ahead / length);
      spots.push_back({{at.x(), at.y()}, Vec2(-piece.y(), piece.x()) / length});
    }
    ahead -= length;
  }
  return spots;
}

/// A road, given by the points of the road's center line and half the road's width at each point
/// [m].
struct Roadway {
  std::vector<Spot> spots;
  std::vector<double> half;
};

Roadway AlongPlan(const std::vector<Point>& plan, double width, double step) {
  Roadway way{.spots = SpotsAlong(plan, step), .half = {}};
  way.half.assign(way.spots.size(), 0.5 * width);
  return way;
}

/// Returns the road along a whole lap of the track, which ends at the track's start.
Roadway AlongTrack(const Track& track) {
  Roadway way;
  const std::size_t count = track.left_edge().size();
  for (std::size_t i = 0; i <= count; ++i) {
    const Vec2 left = track.left_edge()[i % count];
    const Vec2 right = track.right_edge()[i % count];
    const Vec2 middle = 0.5 * (left + right);
    way.spots.push_back({{middle.x(), middle.y()}, (left - right).normalized()});
    way.half.push_back(0.5 * (left - right).norm());
  }
  return way;
}

bool NearTheCamera(const CameraPose& camera, const Point& place) {
  // distance from the camera that counts as near, as a fraction of the distance from the camera to
  // its target
  constexpr double kNearFraction = 0.6;
  const double level = camera.distance * std::cos(camera.elevation);
  const double x = place.x - camera.target_x + level * std::cos(camera.azimuth);
  const double y = place.y - camera.target_y + level * std::sin(camera.azimuth);
  return !camera.inside && std::hypot(x, y) < kNearFraction * level;
}

/// Colors the ground like grass and lowers the ground slightly, so that the depth buffer can
/// separate it from the road.
void PaintGround(const mjModel& model, mjvScene& scene) {
  const int ground = mj_name2id(&model, mjOBJ_GEOM, "ground");
  for (int i = 0; i < scene.ngeom; ++i) {
    mjvGeom& geom = scene.geoms[i];
    if (geom.objtype == mjOBJ_GEOM && (geom.objid == ground || geom.type == mjGEOM_HFIELD)) {
      geom.pos[2] -= kGroundUnderRoad;
      constexpr std::array<float, 3> kGrass{0.86F, 1.02F, 0.66F};
      std::transform(kGrass.begin(), kGrass.end(), geom.rgba, geom.rgba,
                     [](float share, float own) { return std::min(1.0F, share * own); });
    }
  }
}

class RoadRibbons : public Overlay {
 public:
  explicit RoadRibbons(const OverlaySetup& setup) : recording_(setup.recording) {
    AddNetwork();
    if (!recording_.road || recording_.plan.size() < 2) {
      return;
    }
    constexpr double kStep = 0.5;  // [m]
    const double width = recording_.road->width;
    const Roadway way =
        recording_.track ? AlongTrack(*recording_.track) : AlongPlan(recording_.plan, width, kStep);
    AddAsphalt(way);
    edges_ = {Beside(way, 1.0, 0.0), Beside(way, -1.0, 0.0)};
    constexpr double kVerge = kVergeBegin + 0.5 * kVergeWidth;
    verges_ = {Coarse(Beside(way, 1.0, kVerge)), Coarse(Beside(way, -1.0, kVerge))};
    if (recording_.track) {
      dashes_.emplace_back(OffsetFrom(way.spots.front(), way.half.front()),
                           OffsetFrom(way.spots.front(), -way.half.front()));
      return;  // the road of a track has a start line, but neither lanes nor posts
    }
    const int lanes = recording_.road->lanes;
    for (int lane = 1; lane < lanes; ++lane) {
      AddDashes(way.spots, width * (static_cast<double>(lane) / lanes - 0.5), kStep);
    }
    for (const Spot& spot : SpotsAlong(recording_.plan, kPostPeriod)) {
      for (const double side : {-1.0, 1.0}) {
        posts_.push_back(OffsetFrom(spot, side * (0.5 * width + kVergeBegin + 0.6 * kVergeWidth)));
      }
    }
  }

  [[nodiscard]] std::size_t max_shapes() const override {
    std::size_t count = asphalt_.size() + posts_.size() + PointCount(edges_) + PointCount(verges_);
    for (const NetworkLine& line : network_lines_) {
      count += line.points.size();
    }
    return count + dashes_.size();
  }

  void AddShapes(SceneContext& context) override {
    if (asphalt_.empty()) {
      return;
    }
    PaintGround(*recording_.model, context.scene);
    const Eigen::Vector2d around(context.camera.target_x, context.camera.target_y);
    for (const Tile& tile : asphalt_) {
      if ((tile.center.head<2>() - around).norm() < kAsphaltRange + tile.half_length) {
        AddTile(context.scene, tile);
      }
    }
    for (const std::vector<Point>& verge : verges_) {
      AddLine(context, recording_.world, verge, {kGravel, kVergeWidth, kVergeHeight});
    }
    for (const std::vector<Point>& edge : edges_) {
      AddLine(context, recording_.world, edge, {kPaint, kLineWidth, kPaintHeight});
    }
    for (const auto& [from, to] : dashes_) {
      AddPiece(context, recording_.world, from, to, {kPaint, kLineWidth, kPaintHeight});
    }
    for (const NetworkLine& line : network_lines_) {
      AddLine(context, recording_.world, line.points, line.style);
    }
    for (const Point& post : posts_) {
      AddPost(context, post);
    }
  }

 private:
  /// A line of paint of the road network, such as an edge line.
  struct NetworkLine {
    std::vector<Point> points;
    RibbonStyle style;
  };

  /// Adds the pavement and road marks of the world's road network.
  void AddNetwork() {
    for (const PavedBand& band : recording_.roads.bands) {
      for (std::size_t i = 1; i < band.left.size(); ++i) {
        // Each tile of asphalt extends across the road, from border to border. Neighboring tiles of
        // asphalt overlap, so they lie alternately at two heights to avoid flickering.
        const Vec2 from = 0.5 * (band.left[i - 1] + band.right[i - 1]);
        const Vec2 to = 0.5 * (band.left[i] + band.right[i]);
        const Vec2 along = to - from;
        const Vec2 center = 0.5 * (from + to);
        const double width = 0.5 * ((band.left[i - 1] - band.right[i - 1]).norm() +
                                    (band.left[i] - band.right[i]).norm());
        // In a bend, the outer border of a road is longer than its center line.
        const double length = std::max((band.left[i] - band.left[i - 1]).norm(),
                                       (band.right[i] - band.right[i - 1]).norm());
        // maximum deviation of a tile from the ground, so that the tile stays below the paint [m]
        constexpr double kTolerance = 0.0007;
        Tile like;
        like.color = kRoadColor;
        const double above = kAsphaltHeight + (i % 2 == 0 ? 0.0 : 0.0008);
        // overlap of a tile with each neighboring tile [m]; without overlap, the ground would be
        // visible between tiles
        constexpr double kOverlap = 0.1;
        const OrientedBox box{{center.x(), center.y(), std::atan2(along.y(), along.x())},
                              length + 2.0 * kOverlap,
                              width};
        for (const Tile& tile :
             CutToGround(recording_.world.ground, box, like, above, kTolerance)) {
          asphalt_.push_back(tile);
        }
      }
    }
    for (const PaintedLine& line : recording_.roads.lines) {
      std::vector<Point> points;
      for (const Vec2& point : line.points) {
        points.push_back(recording_.OnGround({point.x(), point.y()}));
      }
      // Lines on uneven ground are not thinned, since a thinned line would sink below the asphalt
      // at crests.
      const bool flat = IsFlat(recording_.world.ground);
      network_lines_.push_back({flat ? Thinned(points) : points,
                                {line.yellow ? kYellowPaint : kPaint, line.width, kPaintHeight}});
    }
  }

  [[nodiscard]] Point OffsetFrom(const Spot& spot, double left) const {
    return recording_.OnGround(
        {spot.point.x + left * spot.left.x(), spot.point.y + left * spot.left.y()});
  }

  /// Returns a line along the left (1) or right (-1) side of the road, at the distance `beyond`
  /// outside the road's edge [m].
  [[nodiscard]] std::vector<Point> Beside(const Roadway& way, double side, double beyond) const {
    std::vector<Point> line;
    for (std::size_t i = 0; i < way.spots.size(); ++i) {
      line.push_back(OffsetFrom(way.spots[i], side * (way.half[i] + beyond)));
    }
    return Thinned(line);
  }

  /// Thins the edge of the gravel, with a tolerance of 3 cm. The edge of the gravel is thinned only
  /// on flat ground, where no point can sink below the surface.
  [[nodiscard]] std::vector<Point> Coarse(const std::vector<Point>& line) const {
    if (!IsFlat(recording_.world.ground)) {
      return line;
    }
    constexpr double kTolerance = 0.03;  // [m]
    std::vector<Point> points;
    for (const std::size_t i : Thin(line, kTolerance, line.size())) {
      points.push_back(line[i]);
    }
    return points;
  }

  /// Adds the asphalt as straight pieces, which are longer than the pieces of the edge lines above
  /// the asphalt.
  void AddAsphalt(const Roadway& way) {
    constexpr double kCoarse = 0.1;       // [m]
    constexpr double kTolerance = 0.002;  // [m]
    constexpr std::size_t kMaxRoadPieces = 2000;
    std::vector<Point> middle;
    for (const Spot& spot : way.spots) {
      middle.push_back({spot.point.x, spot.point.y, 0.0});
    }
    const std::vector<std::size_t> kept = Thin(middle, kCoarse, kMaxRoadPieces);
    Tile like;
    like.color = kRoadColor;
    for (std::size_t i = 1; i < kept.size(); ++i) {
      const Vec2 a(middle[kept[i - 1]].x, middle[kept[i - 1]].y);
      const Vec2 b(middle[kept[i]].x, middle[kept[i]].y);
      const Vec2 along = b - a;
      const Vec2 center = 0.5 * (a + b);
      const auto first = way.half.begin() + static_cast<std::ptrdiff_t>(kept[i - 1]);
      const auto last = way.half.begin() + static_cast<std::ptrdiff_t>(kept[i]);
      const double width = 2.0 * (*std::max_element(first, last + 1) + kShoulder);
      // overlap of neighboring pieces of asphalt, as in AddRibbonPiece
      const double overlap = 0.15 * 0.5 * width;
      const OrientedBox box{{center.x(), center.y(), std::atan2(along.y(), along.x())},
                            along.norm() + 2.0 * overlap,
                            width};
      // Neighboring pieces of asphalt overlap, so they lie alternately at two heights to avoid
      // flickering.
      const double above = kAsphaltHeight + (i % 2 == 0 ? 0.0 : 0.0008);
      const std::vector<Tile> tiles =
          CutToGround(recording_.world.ground, box, like, above, kTolerance);
      asphalt_.insert(asphalt_.end(), tiles.begin(), tiles.end());
    }
  }

  void AddDashes(const std::vector<Spot>& spots, double left, double step) {
    const auto period = static_cast<std::size_t>(kDashPeriod / step);
    const auto dash = static_cast<std::size_t>(kDash / step);
    for (std::size_t i = 0; i + dash < spots.size(); i += period) {
      dashes_.emplace_back(OffsetFrom(spots[i], left), OffsetFrom(spots[i + dash], left));
    }
  }

  static void AddPost(SceneContext& context, const Point& post) {
    const double away =
        std::hypot(post.x - context.camera.target_x, post.y - context.camera.target_y);
    // Omits road posts next to the camera, because these posts would hide the car.
    const bool near = NearTheCamera(context.camera, post);
    if (away < kPostRange && !near) {
      const std::array<mjtNum, 3> size{0.06, 0.06, 0.5 * kPostHeight};
      const std::array<float, 4> rgba{0.90F, 0.89F, 0.85F, 1.0F};
      mjvGeom* geom =
          AddDecor(context.scene, mjGEOM_BOX, size, {post.x, post.y, post.z + 0.5 * kPostHeight},
                   RowMajorMatrix3::Identity(), rgba);
      if (geom != nullptr) {
        geom->category = kCastsShadow;
        geom->emission = 0.35F;  // emission that keeps the post white on its shaded side
      }
    }
  }

  const Recording& recording_;
  std::vector<Tile> asphalt_;
  std::vector<NetworkLine> network_lines_;
  std::vector<std::vector<Point>> edges_;
  std::vector<std::vector<Point>> verges_;
  std::vector<std::pair<Point, Point>> dashes_;
  std::vector<Point> posts_;
};

}  // namespace

OverlayEntry RoadOverlay() {
  return MakeOverlayEntry<RoadRibbons>(
      "road",
      "the road network, or a road along the plan with lanes, verges and posts; on a track, "
      "between its edges");
}

}  // namespace trackbed::render
