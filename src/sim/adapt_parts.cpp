#include "src/sim/adapt_parts.h"

#include <fmt/format.h>

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <iterator>
#include <set>

// Divides the model of another program into the parts of a car (adapt.h).
// 1. The bodies between the chassis and a wheel become the wheel and its knuckle. If there is no
//    body between chassis and wheel, the knuckle gets a share of the wheel's mass.
// 2. The rack is a small scaled copy of the chassis, so that the inertias of rack and chassis stay
//    physical.
// 3. Masses and inertias of the proposed parts add up to those of the model. A wheel that is too
//    light for tyre forces gets a share of the chassis mass.
// 4. CopyLooks copies the visible geoms as MJCF text; meshes with many faces become boxes.
namespace trackbed::adapt {
namespace {

/// Share of the vehicle's mass below which a wheel is too light to be simulated with tyre forces. A
/// wheel that is too light gets the mass share kProposedWheel instead.
constexpr double kLightWheel = 0.001;
constexpr double kProposedWheel = 0.01;
/// Share of a wheel's mass that becomes the mass of its knuckle if the model has no body for the
/// knuckle.
constexpr double kKnuckleShare = 0.1;
/// Share of the chassis mass that becomes the mass of the rack.
constexpr double kRackShare = 0.001;
/// Largest number of faces of a copied mesh; meshes with more faces are drawn as boxes.
constexpr int kMaxFaces = 4000;

bool IsWithin(const mjModel& m, int body, int part) {
  while (part > body) {
    part = m.body_parentid[part];
  }
  return part == body;
}

MassSum SumOfSubtree(const FoundModel& found, const FoundVehicle& vehicle, int top) {
  MassSum sum;
  for (int body = top; body < found.model->nbody; ++body) {
    if (IsWithin(*found.model, top, body)) {
      sum.Add(MassOfBody(found, vehicle, body));
    }
  }
  return sum;
}

/// Returns the body nearest to the base, between the base and the wheel, that contains no other
/// wheel; -1 if the wheel is directly on the base.
int CarrierTop(const mjModel& m, const FoundVehicle& vehicle, std::size_t wheel) {
  int top = -1;
  for (int body = vehicle.wheels[wheel].body; body > vehicle.base; body = m.body_parentid[body]) {
    for (std::size_t other = 0; other < vehicle.wheels.size(); ++other) {
      if (other != wheel && IsWithin(m, body, vehicle.wheels[other].body)) {
        return top;
      }
    }
    top = body;
  }
  return top;
}

/// Returns the mass properties of a disk about the y axis at `hub`, close to the given mass
/// properties.
MassSum Disk(const MassSum& sum, const Vector& hub) {
  const double spin = sum.inertia(1, 1);
  const double across = std::min(0.5 * (sum.inertia(0, 0) + sum.inertia(2, 2)), spin);
  return {sum.mass, hub,
          Vector(std::max(across, 0.51 * spin), spin, std::max(across, 0.51 * spin)).asDiagonal()};
}

MassSum SolidDisk(double mass, double radius, const Vector& hub) {
  const double spin = 0.5 * mass * radius * radius;
  return {mass, hub, Vector(0.51 * spin, spin, 0.51 * spin).asDiagonal()};
}

MassSum Scaled(const MassSum& sum, double factor) {
  return {factor * sum.mass, sum.center, factor * sum.inertia};
}

/// Whether a body can have this inertia: all principal moments are positive, and none is larger
/// than the sum of the other two.
bool IsPhysical(const Matrix& inertia) {
  const Vector moments = Eigen::SelfAdjointEigenSolver<Matrix>(inertia).eigenvalues();
  return moments[0] > 0.0 && moments[0] + moments[1] > moments[2] * (1.0 - 1e-9);
}

void SplitWheel(const FoundModel& found, const FoundVehicle& vehicle, std::size_t w,
                bool needs_knuckle, PartMasses& parts, Findings& findings) {
  const FoundWheel& wheel = vehicle.wheels[w];
  const Vector hub = HubOf(vehicle, w);
  const int top = CarrierTop(*found.model, vehicle, w);
  MassSum carrier = top < 0 ? MassSum{} : SumOfSubtree(found, vehicle, top);
  MassSum own = wheel.spin < 0 ? Scaled(carrier, 0.5) : SumOfSubtree(found, vehicle, wheel.body);
  carrier.Add(own, -1.0);
  if (own.mass < kLightWheel * parts.total.mass) {
    findings.Guess("mass of the wheel " + std::string(w < 2 ? "in front" : "behind"),
                   fmt::format("{:.3g} kg", kProposedWheel * parts.total.mass),
                   fmt::format("assumed: 1 % of the vehicle, taken from the chassis; {} has {:.3g} "
                               "kg in the model",
                               wheel.name, own.mass));
    own = SolidDisk(kProposedWheel * parts.total.mass, vehicle.radius, hub);
  } else {
    own = Disk(own, hub);
    if (!(own.inertia(1, 1) > 0.05 * own.mass * vehicle.radius * vehicle.radius)) {
      own = SolidDisk(own.mass, vehicle.radius, hub);
    }
  }
  MassSum knuckle;
  if (needs_knuckle && carrier.mass > kLightWheel * parts.total.mass) {
    knuckle = carrier;
    if (!IsPhysical(knuckle.inertia)) {
      const double moment = std::max(carrier.inertia.trace() / 3.0,
                                     1e-3 * carrier.mass * vehicle.radius * vehicle.radius);
      knuckle.inertia = moment * Matrix::Identity();
    }
  } else if (needs_knuckle) {
    knuckle = Scaled(own, kKnuckleShare);
    own = Scaled(own, 1.0 - kKnuckleShare);
  }
  parts.chassis.Add(own, -1.0);
  if (knuckle.mass > 0.0) {
    parts.chassis.Add(knuckle, -1.0);
  }
  parts.wheels.push_back(own);
  parts.knuckles.push_back(knuckle);
}

const float* ColorOf(const mjModel& m, int geom) {
  const float* own = m.geom_rgba + 4 * geom;
  const bool is_default = own[0] == 0.5F && own[1] == 0.5F && own[2] == 0.5F && own[3] == 1.0F;
  return m.geom_matid[geom] >= 0 && is_default ? m.mat_rgba + 4 * m.geom_matid[geom] : own;
}

/// Copies visible geoms of the model as MJCF text.
class LooksCopier {
 public:
  LooksCopier(const FoundModel& found, const FoundVehicle& vehicle, bool as_boxes)
      : m_(*found.model), d_(*found.data), vehicle_(vehicle), as_boxes_(as_boxes) {}

  std::string Copy(int geom, const Vector& origin) {
    const int type = m_.geom_type[geom];
    const mjtNum* size = m_.geom_size + 3 * geom;
    const float* color = ColorOf(m_, geom);
    const Eigen::Quaterniond turn(
        Matrix(vehicle_.turn.transpose() * ToMatrix(d_.geom_xmat + 9 * geom)));
    Vector at = vehicle_.ToVehicle(ToVector(d_.geom_xpos + 3 * geom)) - origin;
    std::string shape;
    if (type == mjGEOM_MESH && !as_boxes_ && m_.mesh_facenum[m_.geom_dataid[geom]] <= kMaxFaces) {
      shape = fmt::format("type=\"mesh\" mesh=\"mesh{}\"", m_.geom_dataid[geom]);
      AddMesh(m_.geom_dataid[geom]);
    } else if (type == mjGEOM_MESH) {
      const auto [middle, half] = BoundsOf(m_.geom_dataid[geom]);
      at += turn * middle;
      shape = fmt::format("type=\"box\" size=\"{:.6g} {:.6g} {:.6g}\"", half[0], half[1], half[2]);
    } else {
      const char* name = type == mjGEOM_SPHERE      ? "sphere"
                         : type == mjGEOM_CAPSULE   ? "capsule"
                         : type == mjGEOM_ELLIPSOID ? "ellipsoid"
                         : type == mjGEOM_CYLINDER  ? "cylinder"
                                                    : "box";
      shape =
          fmt::format("type=\"{}\" size=\"{:.6g} {:.6g} {:.6g}\"", name, size[0], size[1], size[2]);
    }
    return fmt::format(
        "<geom class=\"look\" {} pos=\"{:.6g} {:.6g} {:.6g}\" quat=\"{:.7g} {:.7g} {:.7g} "
        "{:.7g}\" rgba=\"{:.3g} {:.3g} {:.3g} {:.3g}\"/>\n",
        shape, at.x(), at.y(), at.z(), turn.w(), turn.x(), turn.y(), turn.z(), color[0], color[1],
        color[2], color[3]);
  }

  [[nodiscard]] const std::string& meshes() const { return meshes_; }

 private:
  void AddMesh(int mesh) {
    if (!added_.insert(mesh).second) {
      return;
    }
    meshes_ += fmt::format("    <mesh name=\"mesh{}\" vertex=\"", mesh);
    const float* vertex = m_.mesh_vert + 3 * static_cast<std::ptrdiff_t>(m_.mesh_vertadr[mesh]);
    for (int i = 0; i < 3 * m_.mesh_vertnum[mesh]; ++i) {
      fmt::format_to(std::back_inserter(meshes_), "{:.6g} ", vertex[i]);
    }
    meshes_ += "\" face=\"";
    const int* face = m_.mesh_face + 3 * static_cast<std::ptrdiff_t>(m_.mesh_faceadr[mesh]);
    for (int i = 0; i < 3 * m_.mesh_facenum[mesh]; ++i) {
      fmt::format_to(std::back_inserter(meshes_), "{} ", face[i]);
    }
    meshes_ += "\"/>\n";
  }

  [[nodiscard]] std::pair<Vector, Vector> BoundsOf(int mesh) const {
    Vector low = Vector::Constant(1e300);
    Vector high = Vector::Constant(-1e300);
    const float* vertex = m_.mesh_vert + 3 * static_cast<std::ptrdiff_t>(m_.mesh_vertadr[mesh]);
    for (int i = 0; i < m_.mesh_vertnum[mesh]; ++i, vertex += 3) {
      const Vector at(vertex[0], vertex[1], vertex[2]);
      low = low.cwiseMin(at);
      high = high.cwiseMax(at);
    }
    const Vector thin = Vector::Constant(1e-4);
    return {0.5 * (low + high), (0.5 * (high - low)).cwiseMax(thin)};
  }

  const mjModel& m_;
  const mjData& d_;
  const FoundVehicle& vehicle_;
  bool as_boxes_;
  std::set<int> added_;
  std::string meshes_;
};

}  // namespace

Vector HubOf(const FoundVehicle& vehicle, std::size_t wheel) {
  const bool is_car = vehicle.wheels.size() == 4;
  const bool is_front = is_car && wheel < 2;
  const double side = wheel % 2 == 0 ? 0.5 : -0.5;
  return {is_front ? vehicle.wheelbase : 0.0, side * vehicle.track[is_front ? 0 : 1],
          vehicle.radius};
}

PartMasses SplitMasses(const FoundModel& found, const FoundVehicle& vehicle, bool has_springs,
                       Findings& findings) {
  PartMasses parts;
  parts.total = SumOfSubtree(found, vehicle, vehicle.root);
  parts.chassis = parts.total;
  const bool is_car = vehicle.kind == VehicleKind::kSteered;
  for (std::size_t w = 0; w < vehicle.wheels.size(); ++w) {
    SplitWheel(found, vehicle, w, is_car && (w < 2 || has_springs), parts, findings);
  }
  if (parts.chassis.mass > 0.0 && !IsPhysical(parts.chassis.inertia)) {
    const Footprint box = FindFootprint(found, vehicle);
    const Vector size(box.front - box.rear, 2.0 * box.half_width, box.height);
    const Vector square = size.cwiseAbs2();
    parts.chassis.inertia =
        (parts.chassis.mass / 12.0 * (Vector::Constant(square.sum()) - square)).asDiagonal();
    findings.Guess("chassis inertia", "that of a box of the vehicle's size",
                   "assumed: no body can have the inertia that the model's bodies leave");
  }
  if (is_car) {
    // The rack becomes a scaled copy of the chassis, so that the inertias of rack and chassis stay
    // physical.
    parts.rack = Scaled(parts.chassis, kRackShare);
    parts.chassis = Scaled(parts.chassis, 1.0 - kRackShare);
  }
  return parts;
}

Footprint FindFootprint(const FoundModel& found, const FoundVehicle& vehicle) {
  const mjModel& m = *found.model;
  const double ahead = vehicle.wheels.size() == 4 ? vehicle.wheelbase : 0.0;
  Footprint box{-vehicle.radius, ahead + vehicle.radius,
                0.5 * (std::max(vehicle.track[0], vehicle.track[1]) + vehicle.width),
                2.0 * vehicle.radius};
  const Vector x = vehicle.turn.col(0);
  const Vector y = vehicle.turn.col(1);
  for (int geom = 0; geom < m.ngeom; ++geom) {
    if (m.body_rootid[m.geom_bodyid[geom]] != vehicle.root) {
      continue;
    }
    if (const auto front = ReachAlong(m, *found.data, geom, x)) {
      const auto reach = [&](const Vector& along) {
        return *ReachAlong(m, *found.data, geom, along);
      };
      box.front = std::max(box.front, *front - x.dot(vehicle.origin));
      box.rear = std::min(box.rear, -reach(-x) - x.dot(vehicle.origin));
      box.half_width = std::max(
          {box.half_width, reach(y) - y.dot(vehicle.origin), reach(-y) + y.dot(vehicle.origin)});
      box.height = std::max(box.height, reach(Vector::UnitZ()) - vehicle.origin.z());
    }
  }
  return box;
}

CopiedLooks CopyLooks(const FoundModel& found, const FoundVehicle& vehicle, bool as_boxes) {
  const mjModel& m = *found.model;
  CopiedLooks looks;
  looks.wheels.resize(vehicle.wheels.size());
  LooksCopier copier(found, vehicle, as_boxes);
  const auto is_look = [&](int geom) {
    return (m.geom_contype[geom] | m.geom_conaffinity[geom]) == 0;
  };
  std::set<int> shown;  // bodies that have visual geoms; the colliding geoms of these bodies are
                        // not drawn
  for (int geom = 0; geom < m.ngeom; ++geom) {
    if (is_look(geom) && ColorOf(m, geom)[3] > 0.1F) {
      shown.insert(m.geom_bodyid[geom]);
    }
  }
  for (int geom = 0; geom < m.ngeom; ++geom) {
    const int body = m.geom_bodyid[geom];
    const int type = m.geom_type[geom];
    const bool has_shape = type == mjGEOM_SPHERE || type == mjGEOM_CAPSULE ||
                           type == mjGEOM_ELLIPSOID || type == mjGEOM_CYLINDER ||
                           type == mjGEOM_BOX || type == mjGEOM_MESH;
    if (m.body_rootid[body] != vehicle.root || !has_shape || ColorOf(m, geom)[3] <= 0.0F ||
        (!is_look(geom) && shown.contains(body))) {
      continue;
    }
    bool is_of_wheel = false;
    for (std::size_t w = 0; w < vehicle.wheels.size() && !is_of_wheel; ++w) {
      is_of_wheel = vehicle.wheels[w].round.geom == geom ||
                    (vehicle.wheels[w].spin >= 0 && IsWithin(m, vehicle.wheels[w].body, body));
      if (is_of_wheel) {
        looks.wheels[w] += copier.Copy(geom, HubOf(vehicle, w));
      }
    }
    if (!is_of_wheel) {
      looks.chassis += copier.Copy(geom, Vector::Zero());
    }
  }
  looks.meshes = copier.meshes();
  return looks;
}

}  // namespace trackbed::adapt
