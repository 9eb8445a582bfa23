#include "render/tyre_forces.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <string>

#include "render/layout.h"
#include "render/palette.h"
#include "trackbed/core/angle.h"
#include "trackbed/sim/car_model.h"

namespace trackbed::render {
namespace {

// Dimensions of the tyre dials, in units of the height of letters.
constexpr double kRadius = 1.15;   // Radius of a tyre dial.
constexpr double kBetween = 0.35;  // Gap between two tyre dials.
// Maximum length of a dial's hand relative to the dial's radius; some tyre laws yield forces
// slightly above friction times load.
constexpr double kOverflow = 1.12;

/// Returns the model's tyre coefficient for an axle or, if missing, the coefficient for both axles;
/// 0 if the model has neither.
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
      legend.push_back({.color = kValue,
                        .text = "grip used by each tyre",
                        .note = fmt::format("rim: all of it; red: over {:.0f} %", 100.0 * kSkidUse),
                        .symbol = LegendSymbol::kDial});
    }
  }

  void Draw(PictureContext& context) override {
    if (!forces_.known()) {
      return;
    }
    const Layout layout(context.image.width, context.image.height);
    const double radius = kRadius * layout.label;
    const double step = (2.0 * kRadius + kBetween) * layout.label;
    const double side = step + 2.0 * radius + 1.2 * layout.pad;
    const double left = context.left;
    const double top = context.bottom - side;
    Canvas canvas(context.image, context.font);
    canvas.Fill({left, top, side, side}, layout.round(), kPanel, kPanelAlpha);
    // The dials are arranged like the car's wheels as seen from above, with the front of the car
    // up.
    const CanvasPoint first{left + 0.6 * layout.pad + radius, top + 0.6 * layout.pad + radius};
    const std::vector<WheelForce> forces = forces_.At(context.time, context.car);
    for (std::size_t wheel = 0; wheel < kWheels.size(); ++wheel) {
      const auto own = std::find_if(forces.begin(), forces.end(),
                                    [&](const WheelForce& force) { return force.wheel == wheel; });
      DrawGripDial(canvas,
                   {first.x + (wheel % 2 == 0 ? 0.0 : step), first.y + (wheel < 2 ? 0.0 : step)},
                   radius, own == forces.end() ? nullptr : &*own, layout.hairline);
    }
    context.left = left + side + 0.5 * layout.pad;
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
      wheel->index = w;
      wheels_.push_back(*wheel);
    }
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
    force.wheel = wheel.index;
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

void DrawGripDial(Canvas& canvas, const CanvasPoint& center, double radius, const WheelForce* tyre,
                  double hairline) {
  const auto ring = [&](double share) {
    constexpr int kCorners = 48;
    std::vector<CanvasPoint> points;
    for (int i = 0; i <= kCorners; ++i) {
      const double angle = 2.0 * kPi * i / kCorners;
      points.push_back({center.x + share * radius * std::cos(angle),
                        center.y + share * radius * std::sin(angle)});
    }
    return points;
  };
  canvas.FillConvex(ring(1.0), kPanel, 0.55);
  canvas.Stroke(ring(0.5), 0.6 * hairline, kLabel, 0.5);
  canvas.Stroke(ring(1.0), hairline, kValue, tyre == nullptr ? 0.35 : 0.9);
  if (tyre == nullptr) {
    return;
  }
  // Tyre force divided by the friction limit along each axis. Dividing by the friction limits maps
  // the friction ellipse to the rim of the dial.
  Vec2 share = tyre->force.cwiseQuotient(tyre->most);
  const double use = share.norm();
  if (use > kOverflow) {
    share *= kOverflow / use;
  }
  const CanvasPoint tip{center.x - radius * share.y(), center.y - radius * share.x()};
  const Color& color = use > kSkidUse ? kLimitColor : kValue;
  canvas.Stroke({center, tip}, 2.2 * hairline, color, 1.0);
  const double dot = 2.2 * hairline;
  canvas.Fill({tip.x - dot, tip.y - dot, 2.0 * dot, 2.0 * dot}, dot, color, 1.0);
}

OverlayEntry ForceOverlay() {
  return MakeOverlayEntry<Forces>(
      "forces", "dials: how much of its grip each tyre uses, and in which direction");
}

}  // namespace trackbed::render
