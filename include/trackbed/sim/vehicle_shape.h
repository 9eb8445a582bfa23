#pragma once

#include <array>
#include <string>
#include <vector>

#include "trackbed/sim/scene.h"

/// Reads the visual shape of a vehicle, for viewers that do not use MuJoCo.
namespace trackbed {

/// A joint of a body. The free joint of a vehicle has neither an axis nor a channel, because its
/// coordinates are the columns x_m, y_m, z_m, qw, qx, qy, qz of a state log.
struct ShapeJoint {
  enum class Type { kFree, kSlide, kHinge };
  Type type = Type::kFree;
  std::array<double, 3> axis{};    ///< Unit vector along the axis, in the body's frame.
  std::array<double, 3> anchor{};  ///< Position of the joint in the body's frame [m].
  std::string channel;             ///< Column of a state log with the joint's coordinate, such as
                                   ///< "steer_fl_rad".
};

/// A body, with its pose relative to its parent when all joints are at zero.
struct ShapeBody {
  int parent = -1;  ///< Index of the parent body; -1: the world.
  std::array<double, 3> position{};
  std::array<double, 4> quaternion{1.0, 0.0, 0.0, 0.0};  ///< Orientation as w, x, y, z.
  std::vector<ShapeJoint> joints;                        ///< Joints, in the order in which MuJoCo
                                                         ///< applies them.
};

/// A geom of a body, as MuJoCo draws it.
struct ShapeGeom {
  int body = 0;
  std::string type;              ///< Type of the geom: sphere, capsule, ellipsoid, cylinder, box or
                                 ///< mesh.
  std::array<double, 3> size{};  ///< Size parameters as defined by MuJoCo (half lengths and radii)
                                 ///< [m]; unused for a mesh.
  std::array<double, 3> position{};
  std::array<double, 4> quaternion{1.0, 0.0, 0.0, 0.0};
  std::array<double, 4> rgba{};
  int mesh = -1;  ///< Index of the mesh; -1 if the geom is not a mesh.
};

/// The triangles of a mesh, in the frame of the geoms that use the mesh.
struct ShapeMesh {
  std::vector<double> vertices;  ///< x, y, z of each vertex [m].
  std::vector<int> faces;        ///< Three vertex indices for each triangle.
};

struct VehicleShape {
  std::vector<ShapeBody> bodies;
  std::vector<ShapeGeom> geoms;
  std::vector<ShapeMesh> meshes;
};

/// Reads the bodies of the vehicle in a scene, and those of its geoms that MuJoCo's viewer draws.
/// The viewer draws the geoms of groups 0 to 2 that are not completely transparent, in the colors
/// of their materials. Obstacles are omitted. A mesh with more than 20 000 triangles is replaced by
/// its bounding box. `name` is the name of the scene in messages.
///
/// ReadVehicleShape has the errors and cost of CompileScene.
VehicleShape ReadVehicleShape(const Scene& scene, const std::string& name);

}  // namespace trackbed
