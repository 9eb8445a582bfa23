#include "render/ground_paint.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "render/decor.h"

namespace trackbed::render {
namespace {

// Minimum and maximum height of friction patches above the ground [m]; all ribbons are higher.
constexpr double kMinPaintHeight = 0.0010;
constexpr double kMaxPaintHeight = 0.0018;

constexpr double kIce = 0.25;  // Maximum friction factor of a patch that is drawn as ice.
// Alpha value of ice; MuJoCo draws translucent surfaces twice, so the opacity is 1 - 0.55^2 = 0.70.
constexpr float kIceAlpha = 0.45F;
constexpr float kWetAlpha = 0.35F;

float FrictionAlpha(double friction) {
  return friction <= kIce ? kIceAlpha : kWetAlpha;
}

bool IsPlane(const Ground& ground, const OrientedBox& box) {
  if (ground.terrain) {
    return false;
  }
  const auto apart = [&box](const auto& feature) { return Separation(box, Extent(feature)) > 0.0; };
  return std::all_of(ground.bumps.begin(), ground.bumps.end(), apart) &&
         std::all_of(ground.side_slopes.begin(), ground.side_slopes.end(), apart);
}

/// Returns the largest deviation of the ground's height from the straight line between two points
/// [m].
double Bend(const Ground& ground, const Vec2& a, const Vec2& b) {
  double most = 0.0;
  for (const double part : {0.25, 0.5, 0.75}) {
    const double line = (1.0 - part) * GroundHeight(ground, a) + part * GroundHeight(ground, b);
    most = std::max(most, std::abs(GroundHeight(ground, (1.0 - part) * a + part * b) - line));
  }
  return most;
}

OrientedBox Part(const OrientedBox& box, double x, double y, double length, double width) {
  const Vec2 center = ToWorld(box.center, {x, y});
  return {{center.x(), center.y(), box.center.yaw}, length, width};
}

class Tiler {
 public:
  Tiler(const Ground& ground, double tolerance, std::vector<Tile>& tiles)
      : ground_(ground), tolerance_(tolerance), tiles_(tiles) {}

  void Cut(const OrientedBox& box, const Tile& like, double above) {
    // Maximum side of a tile on ground that is not a plane [m].
    constexpr double kMaxTileSide = 2.0;
    constexpr double kMinTileSide = 0.1;  // Minimum side of a tile [m].
    if (IsPlane(ground_, box)) {
      Add(box, like, above);
      return;
    }
    const auto at = [&](double x, double y) {
      return ToWorld(box.center, {0.5 * x * box.length, 0.5 * y * box.width});
    };
    double along = 0.0;
    double across = 0.0;
    for (const double side : {-1.0, 0.0, 1.0}) {
      along = std::max(along, Bend(ground_, at(-1.0, side), at(1.0, side)));
      across = std::max(across, Bend(ground_, at(side, -1.0), at(side, 1.0)));
    }
    // Twisted ground may be straight along all lines that Bend checks, so the twist is checked
    // separately.
    const auto height = [&](double x, double y) { return GroundHeight(ground_, at(x, y)); };
    const double twist = 0.25 * std::abs(height(1.0, 1.0) + height(-1.0, -1.0) - height(1.0, -1.0) -
                                         height(-1.0, 1.0));
    double& longer = box.length >= box.width ? along : across;
    longer = std::max(longer, twist);
    // Halves the side of the tile along which the ground deviates more from a straight line. Sides
    // longer than kMaxTileSide are always halved, since the few lines along which the ground is
    // checked may miss bumps.
    along = box.length > kMaxTileSide ? 1e3 * box.length : box.length > kMinTileSide ? along : 0.0;
    across = box.width > kMaxTileSide ? 1e3 * box.width : box.width > kMinTileSide ? across : 0.0;
    if (std::max(along, across) < tolerance_) {
      Add(box, like, above);
    } else if (along >= across) {
      const double half = 0.5 * box.length;
      Cut(Part(box, -0.5 * half, 0.0, half, box.width), like, above);
      Cut(Part(box, 0.5 * half, 0.0, half, box.width), like, above);
    } else {
      const double half = 0.5 * box.width;
      Cut(Part(box, 0.0, -0.5 * half, box.length, half), like, above);
      Cut(Part(box, 0.0, 0.5 * half, box.length, half), like, above);
    }
  }

 private:
  void Add(const OrientedBox& box, const Tile& like, double above) {
    // The plane of the tile touches the ground at the middles of its sides, where neighboring tiles
    // meet.
    std::array<Eigen::Vector3d, 4> sides;
    const std::array<Vec2, 4> ways{{{1.0, 0.0}, {-1.0, 0.0}, {0.0, 1.0}, {0.0, -1.0}}};
    Eigen::Vector3d middle = Eigen::Vector3d::Zero();
    for (std::size_t i = 0; i < sides.size(); ++i) {
      const Vec2 p =
          ToWorld(box.center, {0.5 * ways[i].x() * box.length, 0.5 * ways[i].y() * box.width});
      sides[i] = {p.x(), p.y(), GroundHeight(ground_, p)};
      middle += 0.25 * sides[i];
    }
    Tile tile = like;
    const Eigen::Vector3d length = sides[0] - sides[1];
    const Eigen::Vector3d width = sides[2] - sides[3];
    tile.rotation.col(0) = length.normalized();
    tile.rotation.col(2) = length.cross(width).normalized();
    tile.rotation.col(1) = tile.rotation.col(2).cross(tile.rotation.col(0));
    tile.center = middle + above * tile.rotation.col(2);
    tile.half_length = 0.5 * length.norm();
    tile.half_width = 0.5 * width.norm();
    tiles_.push_back(tile);
  }

  const Ground& ground_;
  double tolerance_;  // [m]
  std::vector<Tile>& tiles_;
};

}  // namespace

Color PatchColor(double friction) {
  if (friction <= kIce) {
    return {0.66F, 0.87F, 1.00F};
  }
  if (friction > 1.0) {
    return {0.52F, 0.42F, 0.30F};
  }
  // As friction increases, the color changes from that of a wet road to that of a nearly dry road.
  const auto dry = static_cast<float>((friction - kIce) / (1.0 - kIce));
  return {0.16F + 0.34F * dry, 0.24F + 0.29F * dry, 0.36F + 0.17F * dry};
}

Color PatchColorOnRoad(double friction) {
  constexpr float kAsphalt = 0.62F;
  const Color own = PatchColor(friction);
  const float through = 1.0F - FrictionAlpha(friction);
  const auto mix = [through](float channel) {
    return through * through * kAsphalt + (1.0F - through * through) * channel;
  };
  return {mix(own.r), mix(own.g), mix(own.b)};
}

std::vector<Tile> PatchTiles(const World& world) {
  std::vector<Tile> tiles;
  constexpr double kTolerance = 0.0015;  // [m]
  Tiler tiler(world.ground, kTolerance, tiles);
  const auto count = static_cast<double>(world.friction_patches.size());
  double above = kMinPaintHeight;
  for (const FrictionPatch& patch : world.friction_patches) {
    Tile like;
    like.color = PatchColor(patch.friction);
    like.alpha = FrictionAlpha(patch.friction);
    tiler.Cut(patch.area, like, above);
    above += (kMaxPaintHeight - kMinPaintHeight) / count;
  }
  return tiles;
}

std::vector<Tile> CutToGround(const Ground& ground, const OrientedBox& box, const Tile& like,
                              double above, double tolerance) {
  std::vector<Tile> tiles;
  Tiler(ground, tolerance, tiles).Cut(box, like, above);
  return tiles;
}

void AddTile(mjvScene& scene, const Tile& tile) {
  const std::array<mjtNum, 3> size{tile.half_length, tile.half_width, 1.0};
  const std::array<float, 4> rgba{tile.color.r, tile.color.g, tile.color.b, tile.alpha};
  AddDecor(scene, mjGEOM_PLANE, size, tile.center, tile.rotation, rgba);
}

}  // namespace trackbed::render
