#include "render/tyre_forces.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <string>

#include "render/layout.h"
#include "trackbed/core/angle.h"
#include "trackbed/sim/car_model.h"

namespace trackbed::render {
namespace {

constexpr Color kEllipse{1.00F, 1.00F, 1.00F};
constexpr Color kUnder{0.05F, 0.06F, 0.08F};
// An arrow by how much of the friction is used.
constexpr Color kLittle{0.35F, 0.95F, 0.55F};
constexpr Color kMuch{1.00F, 0.80F, 0.15F};
constexpr Color kAll{1.00F, 0.25F, 0.20F};

Color Between(const Color& a, const Color& b, double share) {
  const auto part = static_cast<float>(std::clamp(share, 0.0, 1.0));
  return {a.r + part * (b.r - a.r), a.g + part * (b.g - a.g), a.b + part * (b.b - a.b)};
}

Color ColorOfUse(double use) {
  return use < 0.75 ? Between(kLittle, kMuch, (use - 0.35) / 0.4)
                    : Between(kMuch, kAll, (use - 0.75) / 0.2);
}

/// A tyre coefficient of the model, of an axle or of both; 0 where it has none.
double Coefficient(const mjModel& model, const std::string& name, const char* axle) {
  int id = mj_name2id(&model, mjOBJ_NUMERIC, (name + "_" + axle).c_str());
  if (id < 0) {
    id = mj_name2id(&model, mjOBJ_NUMERIC, name.c_str());
  }
  return id < 0 ? 0.0 : model.numeric_data[model.numeric_adr[id]];
}

bool HasMagicFormula(const Recording& recording) {
  const std::string& plant = recording.plants.front().plant();
  if (plant.ends_with("magic_formula") || plant.ends_with("contact")) {
    return plant.ends_with("magic_formula");
  }
  const bool has_coefficients =
      mj_name2id(recording.model.get(), mjOBJ_NUMERIC, "p_ky1") >= 0 ||
      mj_name2id(recording.model.get(), mjOBJ_NUMERIC, "p_ky1_front") >= 0;
  return recording.tyre == TyreLaw::kMagicFormula ||
         (recording.tyre == TyreLaw::kAuto && has_coefficients);
}

class Forces : public Overlay {
 public:
  explicit Forces(const OverlaySetup& setup) : forces_(setup.recording) {}

  void AddLegend(std::vector<LegendEntry>& legend) const override {
    if (forces_.known()) {
      legend.push_back({kEllipse, "friction ellipse of each tyre"});
      legend.push_back({kLittle, "tyre force", "", {kLittle, kMuch, kAll}});
    }
  }

  void Draw(PictureContext& context) override {
    if (!forces_.known()) {
      return;
    }
    Canvas canvas(context.image, context.font);
    const int width = context.image.width;
    const int height = context.image.height;
    DrawTyreForces(canvas, Projection(context.camera, width, height),
                   forces_.At(context.time, context.car), forces_.meters_per_newton(),
                   Layout(width, height).hairline);
  }

 private:
  TyreForces forces_;
};

}  // namespace

double WheelForce::Use() const {
  return force.cwiseQuotient(most).norm();
}

TyreForces::TyreForces(const Recording& recording) : recording_(recording) {
  constexpr std::array<const char*, 4> kAxles{"front", "front", "rear", "rear"};
  for (std::size_t w = 0; w < kWheels.size(); ++w) {
    if (std::optional<Wheel> wheel = FindWheel(kWheels[w], kAxles[w])) {
      wheels_.push_back(*wheel);
    }
  }
  if (known()) {
    const mjModel& model = *recording.model;
    double friction = 0.0;
    for (const Wheel& wheel : wheels_) {
      friction = std::max(friction, wheel.friction.maxCoeff());
    }
    const double weight = model.body_subtreemass[model.body_rootid[wheels_.front().body]] *
                          std::abs(model.opt.gravity[2]);
    constexpr double kRadius = 0.72;  // [m]; half a car's track, so that neighbors just touch
    meters_per_newton_ =
        kRadius * static_cast<double>(wheels_.size()) / (std::max(friction, 0.1) * weight);
  }
}

std::optional<TyreForces::Wheel> TyreForces::FindWheel(const char* name, const char* axle) const {
  const mjModel& model = *recording_.model;
  const TimedTable& log = recording_.plants.front().log();
  const std::string end = std::string("_") + name + "_N";
  const std::array<std::optional<std::size_t>, 3> columns{log.Find("normal_force" + end),
                                                          log.Find("longitudinal_force" + end),
                                                          log.Find("lateral_force" + end)};
  Wheel wheel;
  wheel.joint = mj_name2id(&model, mjOBJ_JOINT, (std::string("spin_") + name).c_str());
  const int tyre = mj_name2id(&model, mjOBJ_GEOM, (std::string("tyre_") + name).c_str());
  if (!columns[0] || !columns[1] || !columns[2] || wheel.joint < 0 || tyre < 0) {
    return std::nullopt;
  }
  wheel.columns = {*columns[0], *columns[1], *columns[2]};
  wheel.body = model.jnt_bodyid[wheel.joint];
  if (HasMagicFormula(recording_)) {
    wheel.friction = {Coefficient(model, "p_dx1", axle), Coefficient(model, "p_dy1", axle)};
    wheel.friction_per_load = {Coefficient(model, "p_dx2", axle),
                               Coefficient(model, "p_dy2", axle)};
    wheel.nominal_load = Coefficient(model, "F_z0", axle);
  } else {
    wheel.friction = Vec2::Constant(model.geom_friction[3 * tyre]);
  }
  return wheel;
}

std::vector<WheelForce> TyreForces::At(double time, const mjData& data) const {
  const TimedTable& log = recording_.plants.front().log();
  const TimedTable::Place place = log.At(time);
  std::vector<WheelForce> forces;
  for (const Wheel& wheel : wheels_) {
    const double load = log.Value(place, wheel.columns[0]);
    if (load <= 0.0) {
      continue;
    }
    const Eigen::Map<const Eigen::Vector3d> hub(data.xpos + 3 * wheel.body);
    const Eigen::Map<const Eigen::Vector3d> axle(data.xaxis + 3 * wheel.joint);
    const Vec2 under = hub.head<2>();
    const Eigen::Vector3d up = GroundNormal(recording_.world, under);
    WheelForce force;
    force.body = wheel.body;
    force.place = {under.x(), under.y(), GroundHeight(recording_.world, under)};
    force.forward = axle.cross(up).normalized();
    force.left = up.cross(force.forward);
    force.force = {log.Value(place, wheel.columns[1]), log.Value(place, wheel.columns[2])};
    const double over =
        wheel.nominal_load > 0.0 ? (load - wheel.nominal_load) / wheel.nominal_load : 0.0;
    force.most = load * RoadFactor(recording_.world, under) *
                 (wheel.friction + over * wheel.friction_per_load);
    if (force.most.minCoeff() > 0.0) {
      forces.push_back(force);
    }
  }
  return forces;
}

void DrawTyreForces(Canvas& canvas, const Projection& projection,
                    const std::vector<WheelForce>& forces, double meters_per_newton,
                    double hairline) {
  for (const WheelForce& tyre : forces) {
    const auto at = [&](const Vec2& force) {
      return projection(tyre.place +
                        meters_per_newton * (force.x() * tyre.forward + force.y() * tyre.left));
    };
    constexpr int kCorners = 36;
    std::vector<CanvasPoint> ellipse;
    for (int i = 0; i < kCorners; ++i) {
      const double angle = 2.0 * kPi * i / kCorners;
      if (const auto corner =
              at({tyre.most.x() * std::cos(angle), tyre.most.y() * std::sin(angle)})) {
        ellipse.push_back(*corner);
      }
    }
    const auto root = at({0.0, 0.0});
    const auto tip = at(tyre.force);
    if (ellipse.size() < kCorners || !root || !tip) {
      continue;
    }
    canvas.FillConvex(ellipse, kUnder, 0.30);
    ellipse.push_back(ellipse.front());
    canvas.Stroke(ellipse, 2.0 * hairline, kUnder, 0.35);
    canvas.Stroke(ellipse, hairline, kEllipse, 0.90);
    // A shaft and a head that lie on the ground as the ellipse does; a short arrow is all head.
    const double length = meters_per_newton * tyre.force.norm();
    if (length < 0.02) {
      continue;
    }
    constexpr double kHead = 0.24;       // [m] long
    constexpr double kHalfHead = 0.11;   // and to each side
    constexpr double kHalfShaft = 0.04;  // [m]
    const double head = std::min(kHead, length);
    const Vec2 along = tyre.force.normalized() / meters_per_newton;
    const Vec2 across(-along.y(), along.x());
    const auto shape = [&](std::initializer_list<Vec2> corners) {
      std::vector<CanvasPoint> points;
      for (const Vec2& corner : corners) {
        if (const auto point = at(corner.x() * along + corner.y() * across)) {
          points.push_back(*point);
        }
      }
      canvas.FillConvex(points, ColorOfUse(tyre.Use()), 1.0);
    };
    const double neck = length - head;
    if (neck > 0.0) {
      // Under the head a little, so that no seam is left between them.
      const double overlap = neck + 0.1 * head;
      shape({{0.0, kHalfShaft}, {0.0, -kHalfShaft}, {overlap, -kHalfShaft}, {overlap, kHalfShaft}});
    }
    const double half = kHalfHead * head / kHead;
    shape({{neck, half}, {neck, -half}, {length, 0.0}});
  }
}

OverlayEntry ForceOverlay() {
  return EntryOf<Forces>("forces", "tyre forces inside their friction ellipses");
}

}  // namespace trackbed::render
