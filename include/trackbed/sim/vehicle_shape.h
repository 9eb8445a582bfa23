#pragma once

#include <array>
#include <string>
#include <vector>

#include "trackbed/sim/scene.h"

/// The visual shape of a compiled vehicle, for viewers without MuJoCo.
namespace trackbed {

/// A joint of a body. The free joint of a vehicle has neither axis nor channel: its coordinates are
/// the columns x_m, y_m, z_m, qw, qx, qy, qz of a state log.
struct ShapeJoint {
  enum class Type { kFree, kSlide, kHinge };
  Type type = Type::kFree;
  std::array<double, 3> axis{};    ///< in the body's frame [1]
  std::array<double, 3> anchor{};  ///< in the body's frame [m]
  std::string channel;             ///< the column of a state log: "steer_fl_rad"
};

/// A body in the frame of its parent, with its joints at zero.
struct ShapeBody {
  int parent = -1;  ///< index; -1: the world
  std::array<double, 3> position{};
  std::array<double, 4> quaternion{1.0, 0.0, 0.0, 0.0};  ///< w, x, y, z
  std::vector<ShapeJoint> joints;                        ///< in order of action
};

/// A geom on its body, as MuJoCo draws it.
struct ShapeGeom {
  int body = 0;
  std::string type;              ///< sphere, capsule, ellipsoid, cylinder, box or mesh
  std::array<double, 3> size{};  ///< MuJoCo's half lengths [m]; unused for a mesh
  std::array<double, 3> position{};
  std::array<double, 4> quaternion{1.0, 0.0, 0.0, 0.0};
  std::array<double, 4> rgba{};
  int mesh = -1;  ///< index, for a mesh
};

/// Triangles, in the frame of their geoms.
struct ShapeMesh {
  std::vector<double> vertices;  ///< x, y, z of each [m]
  std::vector<int> faces;        ///< three indices of vertices each
};

struct VehicleShape {
  std::vector<ShapeBody> bodies;
  std::vector<ShapeGeom> geoms;
  std::vector<ShapeMesh> meshes;
};

/// The bodies of a scene's vehicle, without those of obstacles, and the geoms that MuJoCo's viewer
/// draws: those of groups 0 to 2 that are not completely transparent, with their materials' colors.
/// A mesh with more than 20 000 triangles is replaced by its bounding box. `name` is the scene's
/// name in messages.
///
/// Errors and cost: as CompileScene.
VehicleShape ReadVehicleShape(const Scene& scene, const std::string& name);

}  // namespace trackbed
