#pragma once

#include <array>
#include <string>
#include <vector>

#include "trackbed/sim/scene.h"

/// Reads the visual shape of a vehicle from its scene, for viewers that do not use MuJoCo.
namespace trackbed {

/// A joint of a body of the vehicle. The free joint of a vehicle has neither an `axis` nor a
/// `channel` (log column). The coordinates of the free joint are in the columns x_m, y_m, z_m, qw,
/// qx, qy, qz of a state log.
struct ShapeJoint {
  enum class Type { kFree, kSlide, kHinge };
  Type type = Type::kFree;
  std::array<double, 3> axis{};    ///< Unit vector along the joint's axis, in the body's frame.
  std::array<double, 3> anchor{};  ///< Position of the joint in the body's frame [m].
  /// Name of the column of a state log that contains the joint's coordinate, such as
  /// "steer_fl_rad".
  std::string channel;
};

/// A body of the vehicle, with its pose relative to its parent body when all joint coordinates are
/// zero.
struct ShapeBody {
  int parent = -1;  ///< Index of the parent body; -1: the world.
  std::array<double, 3> position{};
  /// Orientation of the body, as a quaternion w, x, y, z.
  std::array<double, 4> quaternion{1.0, 0.0, 0.0, 0.0};
  /// Joints of the body, in the order in which MuJoCo applies the joints.
  std::vector<ShapeJoint> joints;
};

/// A geom of a body, as MuJoCo draws it.
struct ShapeGeom {
  int body = 0;
  std::string type;  ///< Type of the geom: sphere, capsule, ellipsoid, cylinder, box or
                     ///< mesh.
  /// Size parameters of the geom, as defined by MuJoCo (half lengths and radii) [m]; unused for a
  /// mesh.
  std::array<double, 3> size{};
  std::array<double, 3> position{};
  std::array<double, 4> quaternion{1.0, 0.0, 0.0, 0.0};
  std::array<double, 4> rgba{};
  int mesh = -1;  ///< Index of the geom's mesh; -1 if the geom is not a mesh.
};

/// The triangles of a mesh, in the frame of the geoms that use the mesh.
struct ShapeMesh {
  std::vector<double> vertices;  ///< Coordinates x, y, z of each vertex [m].
  std::vector<int> faces;        ///< Indices of the three vertices of each triangle.
};

struct VehicleShape {
  std::vector<ShapeBody> bodies;
  std::vector<ShapeGeom> geoms;
  std::vector<ShapeMesh> meshes;
};

/// Reads the bodies of the vehicle in a scene, and those geoms of the vehicle that MuJoCo's viewer
/// draws. MuJoCo's viewer draws the geoms of groups 0 to 2 that are not completely transparent, in
/// the colors of their materials. Obstacles are omitted. A mesh with more than 20 000 triangles is
/// replaced by its bounding box. Error messages use `name` as the name of the scene.
///
/// ReadVehicleShape throws the same errors and has the same cost as CompileScene.
VehicleShape ReadVehicleShape(const Scene& scene, const std::string& name);

}  // namespace trackbed
