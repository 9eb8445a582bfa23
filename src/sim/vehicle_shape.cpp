#include "trackbed/sim/vehicle_shape.h"

#include <fmt/format.h>
#include <mujoco/mujoco.h>

#include <algorithm>
#include <limits>
#include <map>

#include "trackbed/sim/compile_scene.h"

namespace trackbed {
namespace {

constexpr int kMaxTriangles = 20000;
// number of geom groups that MuJoCo's viewer shows by default; geoms of higher groups are not drawn
constexpr int kDrawnGroups = 3;

template <std::size_t count, typename Number>
std::array<double, count> Copied(const Number* values) {
  std::array<double, count> copy{};
  std::copy_n(values, count, copy.begin());
  return copy;
}

std::vector<ShapeJoint> JointsOf(const mjModel& model, int body) {
  std::vector<ShapeJoint> joints;
  for (int i = 0; i < model.body_jntnum[body]; ++i) {
    const int joint = model.body_jntadr[body] + i;
    const int type = model.jnt_type[joint];
    const char* name = mj_id2name(&model, mjOBJ_JOINT, joint);
    if (type == mjJNT_FREE) {
      joints.emplace_back();
    } else if (name != nullptr && (type == mjJNT_SLIDE || type == mjJNT_HINGE)) {
      const bool slides = type == mjJNT_SLIDE;
      joints.push_back({.type = slides ? ShapeJoint::Type::kSlide : ShapeJoint::Type::kHinge,
                        .axis = Copied<3>(model.jnt_axis + 3 * joint),
                        .anchor = Copied<3>(model.jnt_pos + 3 * joint),
                        .channel = fmt::format("{}_{}", name, slides ? "m" : "rad")});
    }
  }
  return joints;
}

/// Returns the color with which a geom is drawn. As in MuJoCo, a geom with the default color takes
/// the color of its material.
std::array<double, 4> DrawnColor(const mjModel& model, int geom) {
  const float* own = model.geom_rgba + 4 * geom;
  const int material = model.geom_matid[geom];
  const bool is_default = own[0] == 0.5F && own[1] == 0.5F && own[2] == 0.5F && own[3] == 1.0F;
  return Copied<4>(material >= 0 && is_default ? model.mat_rgba + 4 * material : own);
}

const char* TypeName(int type) {
  switch (type) {
    case mjGEOM_SPHERE:
      return "sphere";
    case mjGEOM_CAPSULE:
      return "capsule";
    case mjGEOM_ELLIPSOID:
      return "ellipsoid";
    case mjGEOM_CYLINDER:
      return "cylinder";
    case mjGEOM_BOX:
      return "box";
    case mjGEOM_MESH:
      return "mesh";
    default:
      return nullptr;  // a plane or height field is ground and does not belong to a vehicle
  }
}

ShapeMesh MeshOf(const mjModel& model, int mesh) {
  const float* vertices = model.mesh_vert + 3 * model.mesh_vertadr[mesh];
  const int* faces = model.mesh_face + 3 * model.mesh_faceadr[mesh];
  return {{vertices, vertices + 3 * model.mesh_vertnum[mesh]},
          {faces, faces + 3 * model.mesh_facenum[mesh]}};
}

/// Returns the bounding box of a mesh as a mesh of twelve triangles.
ShapeMesh Bounds(const ShapeMesh& mesh) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  std::array<double, 3> low{kInfinity, kInfinity, kInfinity};
  std::array<double, 3> high{-kInfinity, -kInfinity, -kInfinity};
  for (std::size_t i = 0; i < mesh.vertices.size(); ++i) {
    low[i % 3] = std::min(low[i % 3], mesh.vertices[i]);
    high[i % 3] = std::max(high[i % 3], mesh.vertices[i]);
  }
  ShapeMesh box;
  for (unsigned corner = 0; corner < 8; ++corner) {
    for (unsigned axis = 0; axis < 3; ++axis) {
      box.vertices.push_back((corner >> axis & 1U) != 0U ? high[axis] : low[axis]);
    }
  }
  box.faces = {0, 2, 1, 1, 2, 3, 4, 5, 6, 5, 7, 6, 0, 1, 4, 1, 5, 4,
               2, 6, 3, 3, 6, 7, 0, 4, 2, 2, 4, 6, 1, 3, 5, 3, 7, 5};
  return box;
}

/// Whether a body belongs to a vehicle and not to an obstacle. A vehicle has a free joint, whereas
/// a moving obstacle has none.
bool IsOfVehicle(const mjModel& model, int body) {
  const int root = model.body_rootid[body];
  return model.body_jntnum[root] > 0 && model.jnt_type[model.body_jntadr[root]] == mjJNT_FREE;
}

}  // namespace

VehicleShape ReadVehicleShape(const Scene& scene, const std::string& name) {
  const MujocoModel compiled = CompileScene(scene, name, Looks::kKept);
  const mjModel& model = *compiled;
  VehicleShape shape;
  std::map<int, int> bodies;  // maps the index of a body in the model to its index in the shape
  for (int body = 1; body < model.nbody; ++body) {
    if (!IsOfVehicle(model, body)) {
      continue;
    }
    bodies.emplace(body, static_cast<int>(shape.bodies.size()));
    const auto parent = bodies.find(model.body_parentid[body]);
    shape.bodies.push_back({.parent = parent == bodies.end() ? -1 : parent->second,
                            .position = Copied<3>(model.body_pos + 3 * body),
                            .quaternion = Copied<4>(model.body_quat + 4 * body),
                            .joints = JointsOf(model, body)});
  }
  std::map<int, int> meshes;  // maps the index of a mesh in the model to its index in the shape
  for (int geom = 0; geom < model.ngeom; ++geom) {
    const char* type = TypeName(model.geom_type[geom]);
    const std::array<double, 4> rgba = DrawnColor(model, geom);
    if (type == nullptr || model.geom_group[geom] >= kDrawnGroups || rgba[3] <= 0.0 ||
        !bodies.contains(model.geom_bodyid[geom])) {
      continue;
    }
    ShapeGeom drawn{.body = bodies.at(model.geom_bodyid[geom]),
                    .type = type,
                    .size = Copied<3>(model.geom_size + 3 * geom),
                    .position = Copied<3>(model.geom_pos + 3 * geom),
                    .quaternion = Copied<4>(model.geom_quat + 4 * geom),
                    .rgba = rgba};
    if (model.geom_type[geom] == mjGEOM_MESH) {
      const int mesh = model.geom_dataid[geom];
      const auto [at, is_new] = meshes.emplace(mesh, static_cast<int>(shape.meshes.size()));
      drawn.mesh = at->second;
      if (is_new) {
        const ShapeMesh own = MeshOf(model, mesh);
        shape.meshes.push_back(model.mesh_facenum[mesh] > kMaxTriangles ? Bounds(own) : own);
      }
    }
    shape.geoms.push_back(std::move(drawn));
  }
  return shape;
}

}  // namespace trackbed
