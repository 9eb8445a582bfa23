#include "trackbed/sim/world_scene.h"

#include <fmt/format.h>
#include <tinyxml2.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <functional>

#include "src/sim/road_contact.h"
#include "src/sim/scene_xml.h"
#include "src/sim/trailer_parts.h"
#include "src/sim/upright.h"
#include "trackbed/core/error.h"
#include "trackbed/sim/car_model.h"

// Adds the ground and obstacles of a world to the scene of a car.
// 1. WithGround adds the ground plane, and height fields for terrain, bumps and side slopes.
//    WithGround also adds a plane under each wheel, which RoadContact keeps tangent to the exact
//    ground.
// 2. WithObstacles adds a box for each obstacle, with two slide joints if the obstacle moves.
//    WithObstacles also adds the walls of the map, and a shell of the car that can touch only
//    obstacles.
namespace trackbed {
namespace {

using tinyxml2::XMLDocument;
using tinyxml2::XMLElement;

/// Thickness of a height field below its lowest sample [m]. The thickness places the base of the
/// height field below the ground plane.
constexpr double kBase = 0.1;

/// Height samples on a grid over a rectangle, in MuJoCo's file format for height fields.
struct HeightField {
  double lowest = 0.0;   ///< Smallest height of all samples [m].
  double highest = 0.0;  ///< Largest height of all samples [m].
  std::string file;
};

/// Returns the number of grid cells along a side of a height field with the length `side` [m].
int CellsAlong(double side) {
  constexpr double kCell = 0.05;  // [m]
  return std::clamp(static_cast<int>(std::ceil(side / kCell)), 16, 256);
}

/// Samples ground heights on a grid over a box, with `columns` points along its length and `rows`
/// points along its width.
HeightField Sample(const OrientedBox& box, std::int32_t columns, std::int32_t rows,
                   const std::function<double(const Vec2& point_W)>& height_at) {
  std::vector<double> heights;
  for (int row = 0; row < rows; ++row) {
    for (int column = 0; column < columns; ++column) {
      const Vec2 p = ToWorld(box.center, {(column / (columns - 1.0) - 0.5) * box.length,
                                          (row / (rows - 1.0) - 0.5) * box.width});
      heights.push_back(height_at(p));
    }
  }
  const auto [lowest, highest] = std::minmax_element(heights.begin(), heights.end());
  HeightField field{*lowest, *highest, {}};
  const auto append = [&](auto number) {
    std::array<char, sizeof number> bytes{};
    std::memcpy(bytes.data(), &number, sizeof number);
    field.file.append(bytes.data(), bytes.size());
  };
  append(rows);
  append(columns);
  for (const double height : heights) {
    append(static_cast<float>((height - field.lowest) / (field.highest - field.lowest)));
  }
  return field;
}

template <typename Feature>
HeightField Sample(const Feature& feature, const Ground& ground) {
  const OrientedBox box = Extent(feature);
  return Sample(box, CellsAlong(box.length) + 1, CellsAlong(box.width) + 1,
                [&](const Vec2& p) { return ground.grade.dot(p) + Rise(feature, p); });
}

/// Returns the rectangle that is covered by a rectangular range of terrain blocks.
OrientedBox BlocksAt(const Terrain::Size& size, int column, int row, int columns, int rows) {
  const Vec2 sides = Terrain::kBlock * Vec2(columns, rows);
  const Vec2 middle = size.low + Terrain::kBlock * Vec2(column, row) + 0.5 * sides;
  return {{middle.x(), middle.y(), 0.0}, sides.x(), sides.y()};
}

/// Whether a point is in the interior of the area that all refined blocks cover together.
bool IsInRefined(const Terrain& terrain, const Vec2& point_W) {
  const Terrain::Size& size = terrain.size();
  constexpr double kProbeOffset = 1e-3 * Terrain::kBlock;
  const auto refined = [&](double x, double y) {
    const Vec2 place = (point_W + Vec2(x, y) - size.low) / Terrain::kBlock;
    return place.x() >= 0.0 && place.y() >= 0.0 && place.x() < size.columns &&
           place.y() < size.rows &&
           terrain.IsRefined(static_cast<int>(place.x()), static_cast<int>(place.y()));
  };
  return refined(-kProbeOffset, -kProbeOffset) && refined(-kProbeOffset, kProbeOffset) &&
         refined(kProbeOffset, -kProbeOffset) && refined(kProbeOffset, kProbeOffset);
}

/// Calls `add(box, field)` for each height field that represents a part of a terrain. Each refined
/// block becomes one height field, with a sample at each node of the block. Coarse height fields
/// cover the whole rest of the terrain and are lowered where they overlap refined blocks.
void SampleTerrain(
    const Terrain& terrain,
    const std::function<void(const OrientedBox& box, const HeightField& field)>& add) {
  const Terrain::Size& size = terrain.size();
  for (int row = 0; row < size.rows; ++row) {
    for (int column = 0; column < size.columns; ++column) {
      if (terrain.IsRefined(column, row)) {
        const OrientedBox box = BlocksAt(size, column, row, 1, 1);
        constexpr int kSamples = Terrain::kCells + 1;
        add(box,
            Sample(box, kSamples, kSamples, [&](const Vec2& p) { return terrain.At(p).height; }));
      }
    }
  }
  // Maximum number of blocks along a side of a coarse height field, which then has 257 samples per
  // side.
  constexpr int kMaxBlocks = 64;
  // Depth by which a coarse height field is lowered below refined blocks [m]; the resulting step is
  // steeper than any refined ground.
  constexpr double kCoarseDrop = 4.0;
  for (int row = 0; row < size.rows; row += kMaxBlocks) {
    for (int column = 0; column < size.columns; column += kMaxBlocks) {
      const int columns = std::min(kMaxBlocks, size.columns - column);
      const int rows = std::min(kMaxBlocks, size.rows - row);
      const OrientedBox box = BlocksAt(size, column, row, columns, rows);
      add(box, Sample(box, columns * Terrain::kCoarseCells + 1, rows * Terrain::kCoarseCells + 1,
                      [&](const Vec2& p) {
                        return terrain.At(p).height - (IsInRefined(terrain, p) ? kCoarseDrop : 0.0);
                      }));
    }
  }
}

void Place(XMLElement& geom, const Eigen::Vector3d& position, const Eigen::Quaterniond& turn) {
  for (const char* other : {"axisangle", "xyaxes", "zaxis", "euler", "fromto"}) {
    geom.DeleteAttribute(other);
  }
  geom.SetAttribute("pos", Numbers({position.x(), position.y(), position.z()}).c_str());
  geom.SetAttribute("quat", Numbers({turn.w(), turn.x(), turn.y(), turn.z()}).c_str());
}

/// Adds a copy of the geom `ground` under another name, with the same friction, appearance and
/// other attributes.
XMLElement& AddLike(XMLElement& ground, const std::string& name) {
  XMLElement* geom = ground.ShallowClone(ground.GetDocument())->ToElement();
  ground.Parent()->InsertEndChild(geom);
  geom->SetAttribute("name", name.c_str());
  return *geom;
}

}  // namespace

Scene WithGround(const Scene& car_scene, const Ground& ground) {
  if (IsFlat(ground)) {
    return car_scene;
  }
  XMLDocument document;
  ParseComposed(car_scene.xml, document);
  XMLElement& root = *document.RootElement();
  XMLElement* plane = FindInWorld(root, "geom", "ground");
  TRACKBED_CHECK(plane != nullptr, "the car has no geom 'ground'");
  plane->SetAttribute("type", "plane");
  plane->SetAttribute("size", "0 0 1");
  const Eigen::Quaterniond lean = Upright(ground.grade, 0.0);
  const double base = ground.terrain ? ground.terrain->size().base : 0.0;
  Place(*plane, {0.0, 0.0, base}, lean);

  Scene scene = car_scene;
  XMLElement* assets = root.InsertNewChildElement("asset");
  int count = 0;
  const auto add = [&](const OrientedBox& box, const HeightField& field, const char* rgba) {
    if (field.highest == field.lowest) {
      return;  // skips a height field that is flat, for example at a side slope of 0
    }
    const std::string name = fmt::format("ground_{}", count);
    const std::string file = name + ".hfield";
    ++count;
    scene.assets.push_back({file, field.file});
    XMLElement* asset = assets->InsertNewChildElement("hfield");
    asset->SetAttribute("name", name.c_str());
    asset->SetAttribute("file", file.c_str());
    asset->SetAttribute(
        "size",
        Numbers({0.5 * box.length, 0.5 * box.width, field.highest - field.lowest, kBase}).c_str());
    XMLElement& geom = AddLike(*plane, name);
    geom.DeleteAttribute("size");
    geom.SetAttribute("type", "hfield");
    geom.SetAttribute("hfield", name.c_str());
    if (rgba != nullptr) {
      geom.SetAttribute("rgba", rgba);
    }
    Place(geom, {box.center.x, box.center.y, field.lowest}, Upright(Vec2::Zero(), box.center.yaw));
  };
  if (ground.terrain) {
    SampleTerrain(*ground.terrain, [&](const OrientedBox& box, const HeightField& field) {
      add(box, field, nullptr);
    });
  }
  for (const Bump& bump : ground.bumps) {
    // The height field of a bump has a distinct color, so that the bump is visible.
    add(Extent(bump), Sample(bump, ground), "1 0.93 0.68 1");
  }
  for (const Superelevation& side_slope : ground.side_slopes) {
    add(Extent(side_slope), Sample(side_slope, ground), nullptr);
  }
  if (count > 0) {
    // The list of wheel names covers cars, vehicles with differential drive, and trailers.
    for (const auto& [wheel, index] :
         {std::pair("fl", 0), std::pair("fr", 1), std::pair("rl", 2), std::pair("rr", 3),
          std::pair("left", 0), std::pair("right", 1), std::pair(kTrailerSides[0], 4),
          std::pair(kTrailerSides[1], 5)}) {
      if (FindInWorld(root, "geom", fmt::format("tyre_{}", wheel)) == nullptr) {
        continue;
      }
      XMLElement& geom = AddLike(*plane, fmt::format("ground_{}", wheel));
      geom.SetAttribute("contype", 0);
      geom.SetAttribute("conaffinity", WheelPlaneBit(static_cast<std::size_t>(index)));
      geom.SetAttribute("group", 4);  // geoms of group 4 are not drawn
    }
  }
  scene.xml = Print(document);
  scene.lines.clear();
  scene.ground = ground;
  return scene;
}

/// Mass of an obstacle [kg], so large that no car can move the obstacle.
constexpr double kHeavy = 1e6;

/// A joint of an obstacle, along which the obstacle moves.
struct ObstacleJoint {
  const char* suffix;
  const char* type;
  const char* axis;
};

/// Returns the joints of a moving obstacle. Only an obstacle that moves through poses can rotate.
std::vector<ObstacleJoint> JointsOf(const Obstacle& obstacle) {
  std::vector<ObstacleJoint> joints{{"x", "slide", "1 0 0"}, {"y", "slide", "0 1 0"}};
  if (!obstacle.motion.empty()) {
    joints.push_back({"yaw", "hinge", "0 0 1"});
  }
  return joints;
}

/// Inserts a body that can move over the ground along joints such as `name`_x. All attributes of
/// the obstacle's joints are set, so that the defaults in the car's file do not apply.
XMLElement* InsertSlider(XMLElement& bodies, const std::string& name, const Vec2& place,
                         const std::vector<ObstacleJoint>& joints) {
  XMLElement* body = bodies.InsertNewChildElement("body");
  body->SetAttribute("name", name.c_str());
  body->SetAttribute("pos", Numbers({place.x(), place.y(), 0.0}).c_str());
  for (const ObstacleJoint& each : joints) {
    XMLElement* joint = body->InsertNewChildElement("joint");
    joint->SetAttribute("name", (name + "_" + each.suffix).c_str());
    joint->SetAttribute("type", each.type);
    joint->SetAttribute("axis", each.axis);
    for (const char* nothing : {"damping", "stiffness", "armature", "frictionloss", "ref"}) {
      joint->SetAttribute(nothing, 0);
    }
    joint->SetAttribute("limited", false);
  }
  return body;
}

/// Excludes contacts of moving obstacles with the ground, with static obstacles and with each
/// other, because the motion of moving obstacles is prescribed. Moving obstacles can touch only the
/// car.
void ExcludeContacts(XMLElement& root, const std::vector<std::string>& sliders) {
  if (sliders.empty()) {
    return;
  }
  XMLElement* contact = root.InsertNewChildElement("contact");
  const auto exclude = [&](const std::string& first, const std::string& second) {
    XMLElement* pair = contact->InsertNewChildElement("exclude");
    pair->SetAttribute("body1", first.c_str());
    pair->SetAttribute("body2", second.c_str());
  };
  for (auto one = sliders.begin(); one != sliders.end(); ++one) {
    exclude("world", *one);
    for (auto other = one + 1; other != sliders.end(); ++other) {
      exclude(*one, *other);
    }
  }
}

/// Appends a zero for each new joint to the keyframes; the coordinates of the new joints are
/// relative to the obstacle's initial position.
void ExtendKeyframes(XMLElement& root, int joints) {
  for (XMLElement* frame = root.FirstChildElement("keyframe"); frame != nullptr;
       frame = frame->NextSiblingElement("keyframe")) {
    for (XMLElement* key = frame->FirstChildElement("key"); key != nullptr;
         key = key->NextSiblingElement("key")) {
      for (const char* vector : {"qpos", "qvel"}) {
        if (const char* numbers = key->Attribute(vector)) {
          std::string longer = numbers;
          for (int i = 0; i < joints; ++i) {
            longer += " 0";
          }
          key->SetAttribute(vector, longer.c_str());
        }
      }
    }
  }
}

/// Sets the collision bits of an obstacle's geom, so that the car's shell and wheels can collide
/// with the obstacle.
void MakeObstacle(XMLElement& geom, const char* rgba) {
  geom.SetAttribute("contype", 1);
  geom.SetAttribute("conaffinity", 3);
  geom.SetAttribute("group", 0);
  geom.SetAttribute("rgba", rgba);
}

/// Adds the walls of the world's map. The ground of a world with a map is flat.
void AddWalls(XMLElement& bodies, const World& world) {
  const std::vector<OrientedBox>& walls = MapWalls(world);
  for (std::size_t i = 0; i < walls.size(); ++i) {
    const OrientedBox& box = walls[i];
    const double half_height = 0.5 * world.map->height;
    XMLElement* geom = bodies.InsertNewChildElement("geom");
    geom->SetAttribute("name", fmt::format("obstacle_wall_{}", i).c_str());
    geom->SetAttribute("type", "box");
    geom->SetAttribute("pos", Numbers({box.center.x, box.center.y, half_height}).c_str());
    const double half_yaw = 0.5 * box.center.yaw;
    geom->SetAttribute("quat", Numbers({std::cos(half_yaw), 0.0, 0.0, std::sin(half_yaw)}).c_str());
    geom->SetAttribute("size", Numbers({0.5 * box.length, 0.5 * box.width, half_height}).c_str());
    MakeObstacle(*geom, "0.62 0.60 0.57 1");
  }
}

Scene WithObstacles(const Scene& car_scene, const VehicleParams& vehicle, const World& world) {
  if (!HasObstacles(world)) {
    return car_scene;
  }
  XMLDocument document;
  ParseComposed(car_scene.xml, document);
  XMLElement& root = *document.RootElement();
  XMLElement* chassis = FindInWorld(root, "body", "chassis");
  TRACKBED_CHECK(chassis != nullptr, "the car has no body 'chassis'");

  // Of the collision bits contype and conaffinity, bit 1 is the default of all geoms, and bit 2 is
  // used only for the car's shell. With its own collision bit, the car's shell can touch obstacles,
  // but not, for example, the car's own wheels. The lower end of the car's shell is a tenth of the
  // car's height above the ground, so that the shell does not scrape the ground on soft springs.
  const double half_height = 0.45 * vehicle.height;
  XMLElement* shell = chassis->InsertNewChildElement("geom");
  shell->SetAttribute("name", "shell");
  shell->SetAttribute("type", "box");
  shell->SetAttribute("pos", Numbers({0.5 * vehicle.length - vehicle.rear_overhang, 0.0,
                                      vehicle.height - half_height})
                                 .c_str());
  shell->SetAttribute("size",
                      Numbers({0.5 * vehicle.length, 0.5 * vehicle.width, half_height}).c_str());
  shell->SetAttribute("contype", 2);
  shell->SetAttribute("conaffinity", 0);
  shell->SetAttribute("mass", 0);
  shell->SetAttribute("group", 4);
  shell->SetAttribute("rgba", "0 0 0 0");

  XMLElement* bodies = root.InsertNewChildElement("worldbody");
  std::vector<std::string> sliders;
  std::size_t joint_count = 0;
  for (std::size_t i = 0; i < world.obstacles.size(); ++i) {
    const Obstacle& obstacle = world.obstacles[i];
    const OrientedBox& box = obstacle.footprint;
    const Vec2 place = box.center.position();
    const Eigen::Quaterniond turn = Upright(GroundSlope(world.ground, place), box.center.yaw);
    const Eigen::Vector3d up = turn * Eigen::Vector3d(0.0, 0.0, 0.5 * obstacle.height);
    const std::string name = fmt::format("obstacle_{}", i);
    XMLElement* parent = bodies;
    Vec2 origin = Vec2::Zero();
    if (obstacle.moves()) {
      const std::vector<ObstacleJoint> joints = JointsOf(obstacle);
      parent = InsertSlider(*bodies, name, place, joints);
      joint_count += joints.size();
      origin = place;
      sliders.push_back(name);
    }
    XMLElement* geom = parent->InsertNewChildElement("geom");
    if (obstacle.moves()) {
      geom->SetAttribute("mass", kHeavy);
    }
    geom->SetAttribute("name", name.c_str());
    geom->SetAttribute("type", "box");
    geom->SetAttribute("pos",
                       Numbers({place.x() - origin.x() + up.x(), place.y() - origin.y() + up.y(),
                                GroundHeight(world, place) + up.z()})
                           .c_str());
    geom->SetAttribute("quat", Numbers({turn.w(), turn.x(), turn.y(), turn.z()}).c_str());
    geom->SetAttribute("size",
                       Numbers({0.5 * box.length, 0.5 * box.width, 0.5 * obstacle.height}).c_str());
    MakeObstacle(*geom, "0.78 0.15 0.20 1");
  }
  AddWalls(*bodies, world);
  ExcludeContacts(root, sliders);
  ExtendKeyframes(root, static_cast<int>(joint_count));
  Scene scene = car_scene;
  scene.xml = Print(document);
  scene.lines.clear();
  return scene;
}

Scene WithWorld(const Scene& car_scene, const VehicleParams& vehicle, const World& world) {
  return WithObstacles(WithGround(car_scene, world.ground), vehicle, world);
}

}  // namespace trackbed
