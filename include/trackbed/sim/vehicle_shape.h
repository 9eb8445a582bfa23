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
  std::array<double, 3> axis{};    ///< Direction in the body's frame [1].
  std::array<double, 3> anchor{};  ///< Position in the body's frame [m].
  std::string channel;             ///< Column of a state log: "steer_fl_rad".
};

/// A body in the frame of its parent, with its joints at zero.
struct ShapeBody {
  int parent = -1;  ///< Index of the parent; -1: the world.
  std::array<double, 3> position{};
  std::array<double, 4> quaternion{1.0, 0.0, 0.0, 0.0};  ///< Orientation as w, x, y, z.
  std::vector<ShapeJoint> joints;                        ///< Joints in order of action.
};

/// A geom on its body, in the form that MuJoCo draws.
struct ShapeGeom {
  int body = 0;
  std::string type;              ///< Sphere, capsule, ellipsoid, cylinder, box or mesh.
  std::array<double, 3> size{};  ///< MuJoCo's half lengths [m]; unused for a mesh.
  std::array<double, 3> position{};
  std::array<double, 4> quaternion{1.0, 0.0, 0.0, 0.0};
  std::array<double, 4> rgba{};
  int mesh = -1;  ///< Index of the mesh, if the geom is one.
};

/// The triangles of a mesh, in the frame of its geoms.
struct ShapeMesh {
  std::vector<double> vertices;  ///< x, y, z of each vertex [m].
  std::vector<int> faces;        ///< Three indices of vertices for each triangle.
};

struct VehicleShape {
  std::vector<ShapeBody> bodies;
  std::vector<ShapeGeom> geoms;
  std::vector<ShapeMesh> meshes;
};

/// The bodies of a scene's vehicle, without those of obstacles, and the geoms that MuJoCo's viewer
/// draws. The viewer draws the geoms of groups 0 to 2 that are not completely transparent, with
/// their materials' colors. A mesh with more than 20 000 triangles is replaced by its bounding box.
/// `name` is the scene's name in messages.
///
/// Errors and cost are those of CompileScene.
VehicleShape ReadVehicleShape(const Scene& scene, const std::string& name);

}  // namespace trackbed
