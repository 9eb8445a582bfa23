#include "render/obstacles.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "render/decor.h"
#include "render/events.h"
#include "render/scene.h"
#include "render/scene_handle.h"
#include "trackbed/core/angle.h"
#include "trackbed/sim/mujoco_handles.h"

// Draws each obstacle with an appearance that depends on the obstacle's size (ChooseLook). An
// obstacle is drawn as the run's own car stretched to the obstacle's box, or as a wall, cone, post
// or crate. The obstacle's box in MuJoCo's scene is recolored, or replaced by other shapes. Until
// shortly after the planner detects an obstacle, an outline along the edges of the obstacle's box
// is drawn.
namespace trackbed::render {
namespace {

/// Returns how far an obstacle moves through its poses in the direction of its heading plus `yaw`
/// [m]; negative: against this direction.
double DrivenAlong(const Obstacle& obstacle, double yaw) {
  double sum = 0.0;
  for (std::size_t i = 1; i < obstacle.motion.size(); ++i) {
    const Pose2& from = obstacle.motion[i - 1].pose;
    sum += Direction(from.yaw + yaw).dot(obstacle.motion[i].pose.position() - from.position());
  }
  return sum;
}

// Time for which the outline of an obstacle stays visible after the planner has detected it [s].
constexpr double kOutlineDuration = 1.5;
// Thickness of the outlines of obstacles and of the edges of crates [m].
constexpr double kEdge = 0.05;
constexpr std::size_t kEdges = 12;  // Number of edges of a box.

constexpr Color kUnknown{0.98F, 0.98F, 0.98F};
constexpr Color kWood{0.72F, 0.61F, 0.44F};
constexpr Color kWoodEdge{0.46F, 0.37F, 0.25F};
constexpr Color kConcrete{0.66F, 0.65F, 0.62F};
constexpr Color kDark{0.20F, 0.20F, 0.21F};
constexpr Color kWhitePaint{0.94F, 0.94F, 0.92F};
constexpr Color kConeOrange{0.95F, 0.35F, 0.05F};
constexpr std::array<Color, 4> kCarPaints{
    {{0.72F, 0.73F, 0.75F}, {0.28F, 0.29F, 0.31F}, {0.62F, 0.57F, 0.48F}, {0.86F, 0.86F, 0.84F}}};

/// Box of an obstacle in the world: pose, half sides and opacity of its geom in the scene.
struct Block {
  Eigen::Vector3d center;
  RowMajorMatrix3 axes;
  std::array<double, 3> half;  // [m]
  float alpha = 1.0F;

  explicit Block(const mjvGeom& geom)
      : center(geom.pos[0], geom.pos[1], geom.pos[2]), alpha(geom.rgba[3]) {
    for (int row = 0; row < 3; ++row) {
      half[static_cast<std::size_t>(row)] = geom.size[row];
      for (int column = 0; column < 3; ++column) {
        axes(row, column) = geom.mat[3 * row + column];
      }
    }
  }
  /// Returns a point of the obstacle's box. Each coordinate of the point in the box is given as a
  /// fraction of the box's half side, from -1 to 1.
  [[nodiscard]] Eigen::Vector3d At(double along, double across, double up) const {
    return center + axes * Eigen::Vector3d(along * half[0], across * half[1], up * half[2]);
  }
};

std::array<float, 4> Rgba(const Color& color, float alpha) {
  return {color.r, color.g, color.b, alpha};
}

void AddEdges(mjvScene& scene, const Block& block, const Color& color, float emission) {
  for (int axis = 0; axis < 3; ++axis) {
    for (const double a : {-1.0, 1.0}) {
      for (const double b : {-1.0, 1.0}) {
        std::array<double, 3> share{};
        share[static_cast<std::size_t>((axis + 1) % 3)] = a;
        share[static_cast<std::size_t>((axis + 2) % 3)] = b;
        std::array<mjtNum, 3> size{0.5 * kEdge, 0.5 * kEdge, 0.5 * kEdge};
        size[static_cast<std::size_t>(axis)] += block.half[static_cast<std::size_t>(axis)];
        mjvGeom* edge = AddDecor(scene, mjGEOM_BOX, size, block.At(share[0], share[1], share[2]),
                                 block.axes, Rgba(color, block.alpha));
        if (edge != nullptr) {
          edge->emission = emission;
        }
      }
    }
  }
}

/// Shapes of the run's own car, without small parts. The car is scaled so that its bounding box has
/// half sides of 1.
class CarParts {
 public:
  explicit CarParts(const Recording& recording) {
    const mjModel& model = *recording.model;
    const MujocoData data = MakeMujocoData(*recording.model);
    const int joint = mj_name2id(&model, mjOBJ_JOINT, "chassis");
    mjtNum* pose = data->qpos + model.jnt_qposadr[joint];
    std::fill(pose, pose + 7, 0.0);
    pose[3] = 1.0;
    mj_kinematics(&model, data.get());
    mj_comPos(&model, data.get());
    mj_camlight(&model, data.get());
    mjvOption visible;
    mjv_defaultOption(&visible);
    std::fill(std::begin(visible.sitegroup), std::end(visible.sitegroup), mjtByte{0});
    mjvCamera camera;
    mjv_defaultFreeCamera(&model, &camera);
    SceneHandle posed(model, 2 * model.ngeom + 100);
    mjvScene& scene = posed.get();
    mjv_updateScene(&model, data.get(), &visible, nullptr, &camera, mjCAT_DYNAMIC, &scene);
    const std::vector<CarPart> looks = FindCarParts(model);
    const CarBox box = FindCarBox(model);
    scale_ = {1.0 / box.half_length, 1.0 / box.half_width, 2.0 / box.height};
    const Eigen::Vector3d middle(box.middle, 0.0, 0.5 * box.height);
    for (int i = 0; i < scene.ngeom; ++i) {
      mjvGeom part = scene.geoms[i];
      constexpr float kSmall = 0.05F;  // [m]
      if (part.objtype != mjOBJ_GEOM || !looks[static_cast<std::size_t>(part.objid)].of_car ||
          std::max({part.size[0], part.size[1], part.size[2]}) < kSmall) {
        continue;
      }
      parts_.push_back({part, Block(part).center - middle, Block(part).axes,
                        looks[static_cast<std::size_t>(part.objid)].painted});
      parts_.back().geom.objtype = mjOBJ_UNKNOWN;
      parts_.back().geom.category = kCastsShadow;
    }
  }

  [[nodiscard]] std::size_t count() const { return parts_.size(); }

  /// Draws the car, stretched to the size of the obstacle's box. The argument `forward` is the
  /// car's direction along the longer side of the box, 1 or -1.
  void Add(mjvScene& scene, const Block& block, double forward, const Color& paint) const {
    // The car is turned so that its length is along the longer side of the box.
    RowMajorMatrix3 turn = RowMajorMatrix3::Identity() * forward;
    turn(2, 2) = 1.0;
    Eigen::Vector3d half(block.half[0], block.half[1], block.half[2]);
    if (half.x() < half.y()) {
      std::swap(half.x(), half.y());
      turn << 0.0, -forward, 0.0, forward, 0.0, 0.0, 0.0, 0.0, 1.0;
    }
    // The rotation matrix of the car's geoms also stretches the car. MuJoCo uses the stretched
    // rotation matrix unchanged and normalizes the surface normals.
    const RowMajorMatrix3 stretched = block.axes * turn * half.cwiseProduct(scale_).asDiagonal();
    for (const Part& part : parts_) {
      if (scene.ngeom >= scene.maxgeom) {
        return;
      }
      mjvGeom& geom = scene.geoms[scene.ngeom++];
      geom = part.geom;
      const Eigen::Vector3d place = block.center + stretched * part.center;
      const RowMajorMatrix3 axes = stretched * part.axes;
      for (int i = 0; i < 3; ++i) {
        geom.pos[i] = static_cast<float>(place[i]);
      }
      std::transform(axes.data(), axes.data() + 9, geom.mat,
                     [](double value) { return static_cast<float>(value); });
      if (part.painted) {
        geom.rgba[0] = paint.r;
        geom.rgba[1] = paint.g;
        geom.rgba[2] = paint.b;
      }
      geom.rgba[3] *= block.alpha;
    }
  }

 private:
  struct Part {
    mjvGeom geom;
    Eigen::Vector3d center;  // position of the car's part relative to the middle of the car's box
    RowMajorMatrix3 axes;
    bool painted;
  };
  Eigen::Vector3d scale_;
  std::vector<Part> parts_;
};

/// Fills the obstacle's box with a stack of cylinders or boxes of equal height. The argument
/// `layers` has the horizontal size relative to the box and the color of each piece of the stack,
/// from bottom to top.
void AddStack(mjvScene& scene, const Block& block, mjtGeom type,
              const std::vector<std::pair<double, Color>>& layers) {
  const double tall = 1.0 / static_cast<double>(layers.size());
  for (std::size_t i = 0; i < layers.size(); ++i) {
    const double up = tall * (2.0 * static_cast<double>(i) + 1.0) - 1.0;
    const auto& [share, color] = layers[i];
    const double half_height = tall * block.half[2];
    const double radius = share * std::min(block.half[0], block.half[1]);
    const std::array<mjtNum, 3> size =
        type == mjGEOM_CYLINDER
            ? std::array<mjtNum, 3>{radius, half_height, 0.0}
            : std::array<mjtNum, 3>{share * block.half[0], share * block.half[1], half_height};
    if (mjvGeom* geom = AddDecor(scene, type, size, block.At(0.0, 0.0, up), block.axes,
                                 Rgba(color, block.alpha))) {
      geom->specular = 0.3F;
      geom->category = kCastsShadow;
    }
  }
}

class Obstacles : public Overlay {
 public:
  explicit Obstacles(const OverlaySetup& setup)
      : recording_(setup.recording),
        geoms_(ObstacleGeoms(setup.recording)),
        known_(KnownFrom(setup.recording)),
        car_(setup.recording) {}

  [[nodiscard]] std::size_t max_shapes() const override {
    return geoms_.size() * (std::max<std::size_t>(car_.count(), 2 * kEdges) + kEdges);
  }

  void AddShapes(SceneContext& context) override {
    mjvScene& scene = context.scene;
    const int count = scene.ngeom;  // number of shapes in the scene before obstacles are added
    for (std::size_t i = 0; i < geoms_.size(); ++i) {
      const auto is_own = [&](const mjvGeom& geom) {
        return geom.objtype == mjOBJ_GEOM && geom.objid == geoms_[i];
      };
      mjvGeom* const end = scene.geoms + std::min(count, scene.ngeom);
      mjvGeom* const own = std::find_if(scene.geoms, end, is_own);
      if (geoms_[i] >= 0 && own != end) {
        AddOne(context, i, own);
      }
    }
    RemoveGeoms(scene, [](const mjvGeom& geom) { return geom.objtype == kReplaced; });
  }

  void AddLegend(std::vector<LegendEntry>& legend) const override {
    const bool unknown = std::any_of(known_.begin(), known_.end(),
                                     [](double from) { return std::isfinite(from) || from > 0.0; });
    if (unknown) {
      legend.push_back({.color = kUnknown,
                        .text = "obstacle not detected yet",
                        .symbol = LegendSymbol::kOutline});
    }
  }

 private:
  // Object type that marks a geom that other shapes replace. MuJoCo itself has no object type with
  // the number -1.
  static constexpr int kReplaced = -1;

  void AddOne(SceneContext& context, std::size_t i, mjvGeom* own) const {
    mjvScene& scene = context.scene;
    const Block block(*own);
    const double since = context.time - known_[i];
    if (since < kOutlineDuration) {
      // The outline is drawn slightly larger than the obstacle's shape, so that the shape does not
      // hide the outline.
      Block outline = block;
      for (double& half : outline.half) {
        half += since < 0.0 ? 0.0 : kEdge;
      }
      AddEdges(scene, outline, kUnknown, 0.5F);
    }
    if (since < 0.0) {
      own->objtype = kReplaced;
      return;
    }
    const auto paint = [own](const Color& color) {
      own->rgba[0] = color.r;
      own->rgba[1] = color.g;
      own->rgba[2] = color.b;
    };
    switch (ChooseLook(2.0 * block.half[0], 2.0 * block.half[1], 2.0 * block.half[2])) {
      case ObstacleLook::kCar:
        own->objtype = kReplaced;
        car_.Add(scene, block, ForwardOf(i, block), kCarPaints[i % kCarPaints.size()]);
        break;
      case ObstacleLook::kWall: {
        paint(kConcrete);
        constexpr double kCap = 0.06;  // [m]
        AddDecor(scene, mjGEOM_BOX, {block.half[0] + 0.02, block.half[1] + 0.02, 0.5 * kCap},
                 block.At(0.0, 0.0, 1.0), block.axes, Rgba(kDark, block.alpha));
        break;
      }
      case ObstacleLook::kCone:
        own->objtype = kReplaced;
        AddStack(scene, block, mjGEOM_CYLINDER,
                 {{1.0, kConeOrange}, {0.7, kConeOrange}, {0.5, kWhitePaint}, {0.3, kConeOrange}});
        break;
      case ObstacleLook::kPost:
        own->objtype = kReplaced;
        AddStack(scene, block, mjGEOM_BOX,
                 {{1.0, kWhitePaint}, {1.0, kWhitePaint}, {1.0, kDark}, {1.0, kWhitePaint}});
        break;
      case ObstacleLook::kCrate:
        paint(kWood);
        AddEdges(scene, block, kWoodEdge, 0.0F);
        break;
    }
  }

  /// Returns the direction, 1 or -1, in which an obstacle drawn as a car faces along the box's
  /// longer side: the direction in which the obstacle drives farther.
  [[nodiscard]] double ForwardOf(std::size_t i, const Block& block) const {
    const Obstacle& obstacle = recording_.world.obstacles[i];
    if (!obstacle.motion.empty()) {
      return DrivenAlong(obstacle, block.half[0] >= block.half[1] ? 0.0 : 0.5 * kPi) < 0.0 ? -1.0
                                                                                           : 1.0;
    }
    const Vec2& velocity = obstacle.velocity;
    const int side = block.half[0] >= block.half[1] ? 0 : 1;
    const double along = velocity.x() * block.axes(0, side) + velocity.y() * block.axes(1, side);
    return along < 0.0 ? -1.0 : 1.0;
  }

  const Recording& recording_;
  std::vector<int> geoms_;
  std::vector<double> known_;  // [s]
  CarParts car_;
};

}  // namespace

ObstacleLook ChooseLook(double length, double width, double height) {
  const double longer = std::max(length, width);
  const double shorter = std::min(length, width);
  const auto within = [](double value, double low, double high) {
    return value >= low && value <= high;
  };
  if (within(longer, 3.0, 6.0) && within(shorter, 1.4, 2.3) && within(height, 1.2, 2.2)) {
    return ObstacleLook::kCar;
  }
  if (shorter <= 1.0 && longer >= 4.0 * shorter) {
    return ObstacleLook::kWall;
  }
  if (longer <= 0.6) {
    return height <= 1.0 ? ObstacleLook::kCone : ObstacleLook::kPost;
  }
  return ObstacleLook::kCrate;
}

OverlayEntry ObstacleOverlay() {
  return MakeOverlayEntry<Obstacles>(
      "obstacles", "obstacles as cars, walls, cones or crates; as outlines until detected");
}

}  // namespace trackbed::render
