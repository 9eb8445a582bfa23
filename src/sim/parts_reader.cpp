#include "src/sim/parts_reader.h"

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "src/sim/trailer_parts.h"

namespace trackbed {
namespace {

double Square(double value) {
  return value * value;
}

}  // namespace

PartsReader::PartsReader(const mjModel& model, const std::string& file)
    : m_(model), file_(file), data_(MakeMujocoData(model)) {
  mj_kinematics(&m_, data_.get());
  mj_comPos(&m_, data_.get());
}

void PartsReader::AddError(std::string name, std::string message) {
  problems_.push_back({file_, 0, 0, std::move(name), std::move(message)});
}

void PartsReader::ThrowIfAnything() const {
  if (!problems_.empty()) {
    throw InputError(problems_);
  }
}

int PartsReader::Find(int type, const char* kind, const std::string& name) {
  const int id = mj_name2id(&m_, type, name.c_str());
  if (id < 0) {
    AddError(name, fmt::format("the model has no {} of this name", kind));
  }
  return id;
}

int PartsReader::Joint(const std::string& name, int type, const char* kind) {
  const int id = Find(mjOBJ_JOINT, kind, name);
  if (id >= 0 && m_.jnt_type[id] != type) {
    AddError(name, fmt::format("must be a {}", kind));
    return -1;
  }
  return id;
}

double PartsReader::Number(const std::string& name) {
  const int id = Find(mjOBJ_NUMERIC, "<custom><numeric>", name);
  return id < 0 ? 0.0 : m_.numeric_data[m_.numeric_adr[id]];
}

std::string PartsReader::QuotedName(int type, int id) const {
  const char* name = mj_id2name(&m_, type, id);
  return name == nullptr ? "without a name" : fmt::format("'{}'", name);
}

double PartsReader::Offset(const mjtNum* point, std::size_t axis) const {
  return point[axis] - data_->xpos[3 * static_cast<std::size_t>(chassis_.chassis) + axis];
}

std::string PartsReader::Text(const mjtNum* v) {
  return fmt::format("{:.4g} {:.4g} {:.4g}", v[0] + 0.0, v[1] + 0.0, v[2] + 0.0);
}

void PartsReader::ReadChassis(int free_joint) {
  if (const int body = m_.jnt_bodyid[free_joint]; body != chassis_.chassis) {
    AddError("chassis",
             fmt::format("the free joint is in the body {}; must be in the body 'chassis'",
                         QuotedName(mjOBJ_BODY, body)));
  }
  params_.name = m_.names;  // MuJoCo's buffer of object names begins with the name of the model
  chassis_.chassis_qpos = m_.jnt_qposadr[free_joint];
  chassis_.chassis_dof = m_.jnt_dofadr[free_joint];
  params_.mass = m_.body_subtreemass[chassis_.chassis];
  const mjtNum* cg = data_->subtree_com + 3 * chassis_.chassis;
  params_.cg_to_rear = Offset(cg, 0);
  chassis_.cg_height = Offset(cg, 2);
  std::array<mjtNum, 2> center{cg[0], cg[1]};
  const std::optional<TrailerParts> trailer = FindTrailer(m_);
  const auto is_of_car = [&](int body) {
    return m_.body_rootid[body] == m_.body_rootid[chassis_.chassis] &&
           !(trailer && IsOfTrailer(m_, *trailer, body));
  };
  if (trailer) {
    params_.mass = 0.0;
    Eigen::Vector3d moment = Eigen::Vector3d::Zero();
    for (int body = 1; body < m_.nbody; ++body) {
      if (is_of_car(body)) {
        params_.mass += m_.body_mass[body];
        moment += m_.body_mass[body] * Eigen::Map<const Eigen::Vector3d>(data_->xipos + 3 * body);
      }
    }
    const Eigen::Vector3d own = moment / params_.mass;
    params_.cg_to_rear = Offset(own.data(), 0);
    chassis_.cg_height = Offset(own.data(), 2);
    center = {own.x(), own.y()};
  }
  for (int body = 1; body < m_.nbody; ++body) {
    if (!is_of_car(body)) {
      continue;
    }
    const Eigen::Map<const Eigen::Matrix<mjtNum, 3, 3, Eigen::RowMajor>> axes(data_->ximat +
                                                                              9 * body);
    const mjtNum* at = data_->xipos + 3 * body;
    params_.yaw_inertia +=
        axes.row(2).cwiseAbs2().dot(
            Eigen::Map<const Eigen::RowVector3d>(m_.body_inertia + 3 * body)) +
        m_.body_mass[body] * (Square(at[0] - center[0]) + Square(at[1] - center[1]));
  }
}

void PartsReader::ReadAerodynamics() {
  CarAerodynamics& air = chassis_.aerodynamics;
  numerics_.Read("drag_area", air.drag_area);
  numerics_.Read("side_area", air.side_area);
  air.center_of_pressure = {params_.cg_to_rear, chassis_.cg_height};
  if (const mjtNum* at = numerics_.Find("center_of_pressure", 2)) {
    air.center_of_pressure = {at[0], at[1]};
  }
  if (!(air.drag_area >= 0.0 && air.side_area >= 0.0)) {
    AddError("drag_area", "drag_area and side_area must not be negative");
  }
}

void PartsReader::ReadFootprint(int site) {
  if (m_.site_type[site] != mjGEOM_BOX) {
    AddError("footprint", "must be a box site");
  }
  if (const int body = m_.site_bodyid[site]; body != chassis_.chassis) {
    AddError("footprint", fmt::format("must be a site of the body 'chassis'; it is on {}",
                                      QuotedName(mjOBJ_BODY, body)));
  }
  const mjtNum* half = m_.site_size + 3 * site;
  const mjtNum* middle = m_.site_pos + 3 * site;
  const mjtNum* turn = m_.site_quat + 4 * site;
  if (std::abs(middle[1]) > kExact || !(std::abs(turn[0]) > 1.0 - kExact)) {
    AddError("footprint", "must be centered on y = 0 and not rotated");
  }
  params_.length = 2.0 * half[0];
  params_.width = 2.0 * half[1];
  params_.height = middle[2] + half[2];
  params_.rear_overhang = half[0] - middle[0];
}

double PartsReader::Place(int body, std::size_t axis) const {
  return Offset(data_->xpos + 3 * body, axis);
}

void PartsReader::CheckOrigin(const char* axle, const char* wheels, int left, int right) {
  if (std::abs(Place(left, 0)) > kExact || std::abs(Place(right, 0)) > kExact) {
    const double ahead = 0.5 * (Place(left, 0) + Place(right, 0));
    AddError("chassis", fmt::format("the body origin must be under {}; {} are {:.4g} m {} it", axle,
                                    wheels, std::abs(ahead), ahead < 0.0 ? "behind" : "ahead of"));
  }
}

void PartsReader::CheckStand(const std::string& wheel, const mjtNum* hub_W, double radius) {
  // Scenes with hilly ground (WithGround) are not checked, because the car stands at a different
  // height there. The original model with its level ground was checked before the hills were added.
  if (mj_name2id(&m_, mjOBJ_GEOM, ("ground_" + wheel).c_str()) >= 0) {
    return;
  }
  const int ground = mj_name2id(&m_, mjOBJ_GEOM, "ground");
  const bool level = m_.geom_type[ground] == mjGEOM_PLANE && m_.geom_quat[4 * ground] == 1.0;
  const double gap = hub_W[2] - radius - m_.geom_pos[3 * ground + 2];
  if (level && !(std::abs(gap) <= 0.5 * radius)) {
    AddError("tyre_" + wheel,
             fmt::format("its lowest point is {:.4g} m {} the ground at qpos0; the car must stand "
                         "on the ground",
                         std::abs(gap), gap < 0.0 ? "below" : "above"));
  }
}

void PartsReader::CheckWheel(const std::string& wheel, int spin, int tyre, int first,
                             const char* all) {
  const mjtNum* axis = m_.jnt_axis + 3 * spin;
  const mjtNum* axis_W = data_->xaxis + 3 * spin;
  if (!(axis[1] > 1.0 - kExact)) {
    AddError(
        "spin_" + wheel,
        fmt::format("axis must be 0 1 0 (positive rotation rolls forward), found {}", Text(axis)));
  } else if (!(axis_W[1] > kUpright)) {
    AddError("spin_" + wheel,
             fmt::format("axis must point to the vehicle's left, found {}", Text(axis_W)));
  }
  const int turned = m_.jnt_bodyid[spin];
  if (const int body = m_.geom_bodyid[tyre]; body != turned) {
    AddError("tyre_" + wheel,
             fmt::format("must be in the body of spin_{}, {}; found in {}", wheel,
                         QuotedName(mjOBJ_BODY, turned), QuotedName(mjOBJ_BODY, body)));
  }
  const double radius = m_.geom_size[3 * tyre];
  CheckStand(wheel, data_->xpos + 3 * turned, radius);
  const double wanted = m_.geom_size[3 * first];
  if (!(std::abs(radius - wanted) <= kExact * wanted)) {
    AddError("tyre_" + wheel,
             fmt::format("radius {:.6g} m differs from {}, {:.6g} m; {} must be equal", radius,
                         mj_id2name(&m_, mjOBJ_GEOM, first), wanted, all));
  }
}

}  // namespace trackbed
