#include "src/sim/adapt_wheels.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <optional>

#include "src/sim/object_name.h"

namespace trackbed::adapt {
namespace {

constexpr double kHorizontal = 0.35;  // Largest vertical component of a wheel axis's unit vector.
constexpr double kOnGround = 0.3;     // Largest height of a tyre above the vehicle's lowest tyre
                                      // [wheel radii].

/// Finds the wheels of a model.
class WheelFinder {
 public:
  WheelFinder(const FoundModel& found, const AdaptOptions& options)
      : m_(*found.model), d_(*found.data), options_(options) {}

  [[nodiscard]] std::vector<FoundWheel> Find() const {
    std::vector<FoundWheel> wheels;
    for (int joint = 0; joint < m_.njnt; ++joint) {
      if (m_.jnt_type[joint] == mjJNT_HINGE) {
        AddHinge(joint, wheels);
      }
    }
    AddFixed(wheels);
    KeepOnGround(wheels);
    return wheels;
  }

 private:
  /// Adds the wheel that turns about the given hinge joint, if there is such a wheel. If two hinges
  /// have the same axis, the wheel is assigned to the hinge that is deeper in the tree of bodies.
  void AddHinge(int joint, std::vector<FoundWheel>& wheels) const {
    const Vector axis = ToVector(d_.xaxis + 3 * joint);
    const Vector anchor = ToVector(d_.xanchor + 3 * joint);
    const int body = m_.jnt_bodyid[joint];
    if (std::abs(axis.z()) > kHorizontal) {
      return;
    }
    std::optional<RoundGeom> best;
    bool collides = false;
    for (int geom = 0; geom < m_.ngeom; ++geom) {
      if (m_.body_weldid[m_.geom_bodyid[geom]] != m_.body_weldid[body]) {
        continue;
      }
      const auto round = RoundAbout(m_, d_, geom, anchor, axis);
      const bool touches = (m_.geom_contype[geom] | m_.geom_conaffinity[geom]) != 0;
      if (round && (!best || (touches && !collides) ||
                    (touches == collides && round->radius > best->radius))) {
        best = round;
        collides = touches;
      }
    }
    if (!best && options_.wheel_radius && m_.jnt_limited[joint] == 0) {
      best = RoundGeom{-1, anchor, *options_.wheel_radius, 0.5 * *options_.wheel_radius};
    }
    if (!best) {
      return;
    }
    FoundWheel wheel{.body = body,
                     .spin = joint,
                     .round = *best,
                     .axis = axis,
                     .name = ObjectName(m_, mjOBJ_JOINT, joint)};
    for (FoundWheel& other : wheels) {
      if ((other.round.center - wheel.round.center).norm() < 0.5 * wheel.round.radius) {
        other = wheel;  // in MuJoCo's list of joints, the joints of a child body come later than
                        // those of its parent
        return;
      }
    }
    wheels.push_back(std::move(wheel));
  }

  /// Adds round geoms without a hinge as wheels, if fewer than four wheels have hinges. A round
  /// geom without a hinge counts as a wheel only if it has a twin on the other side of the vehicle.
  void AddFixed(std::vector<FoundWheel>& wheels) const {
    if (wheels.size() >= 4) {
      return;
    }
    std::vector<FoundWheel> fixed;
    for (int geom = 0; geom < m_.ngeom; ++geom) {
      const auto axis = OwnAxis(m_, d_, geom);
      const int body = m_.geom_bodyid[geom];
      if (!axis || std::abs(axis->z()) > kHorizontal || m_.body_rootid[body] == 0) {
        continue;
      }
      const Vector at = ToVector(d_.geom_xpos + 3 * geom);
      const bool known = std::any_of(wheels.begin(), wheels.end(), [&](const FoundWheel& wheel) {
        return (wheel.round.center - at).norm() < 0.5 * wheel.round.radius;
      });
      const auto round = RoundAbout(m_, d_, geom, at, *axis);
      const auto twin = std::find_if(fixed.begin(), fixed.end(), [&](const FoundWheel& wheel) {
        return round && (wheel.round.center - at).norm() < 0.5 * round->radius;
      });
      if (known || !round || round->width > 2.0 * round->radius) {
        continue;
      }
      if (twin != fixed.end()) {
        if (round->radius > twin->round.radius) {
          twin->round = *round;
        }
        continue;
      }
      fixed.push_back({.body = body,
                       .round = *round,
                       .axis = *axis,
                       .name = "the geom " + ObjectName(m_, mjOBJ_GEOM, geom) + " of the body " +
                               ObjectName(m_, mjOBJ_BODY, body)});
    }
    wheels.insert(wheels.end(), fixed.begin(), fixed.end());
  }

  void KeepOnGround(std::vector<FoundWheel>& wheels) const {
    const auto bottom = [](const FoundWheel& wheel) {
      return wheel.round.center.z() - wheel.round.radius;
    };
    std::map<int, double> least;  // for each vehicle
    for (const FoundWheel& wheel : wheels) {
      const auto [at, is_new] = least.emplace(m_.body_rootid[wheel.body], bottom(wheel));
      at->second = std::min(at->second, bottom(wheel));
    }
    std::erase_if(wheels, [&](const FoundWheel& wheel) {
      return bottom(wheel) > least.at(m_.body_rootid[wheel.body]) + kOnGround * wheel.round.radius;
    });
  }

  const mjModel& m_;
  const mjData& d_;
  const AdaptOptions& options_;
};

}  // namespace

std::vector<FoundWheel> FindWheels(const FoundModel& found, const AdaptOptions& options) {
  return WheelFinder(found, options).Find();
}

std::string WhyNoWheels(const FoundModel& found) {
  const mjModel& m = *found.model;
  std::vector<std::string> reasons;
  for (int joint = 0; joint < m.njnt && reasons.size() < 8; ++joint) {
    if (m.jnt_type[joint] != mjJNT_HINGE) {
      continue;
    }
    const mjtNum* axis = found.data->xaxis + 3 * joint;
    const std::string name = ObjectName(m, mjOBJ_JOINT, joint);
    if (std::abs(axis[2]) > kHorizontal) {
      reasons.push_back(fmt::format("{} has the axis {:.2f} {:.2f} {:.2f}, with z up", name,
                                    axis[0], axis[1], axis[2]));
      continue;
    }
    std::string geoms;
    for (int geom = 0; geom < m.ngeom; ++geom) {
      if (m.geom_bodyid[geom] != m.jnt_bodyid[joint]) {
        continue;
      }
      const auto own = OwnAxis(m, *found.data, geom);
      const double off = own ? std::acos(std::min(1.0, std::abs(own->dot(ToVector(axis))))) *
                                   180.0 / std::numbers::pi
                             : 0.0;
      geoms += own ? fmt::format(
                         ", the axis of its geom is {:.3g} degrees off (angles are in "
                         "degrees without <compiler angle=\"radian\"/>)",
                         off)
                   : ", its geom is not round about the axis";
      break;
    }
    reasons.push_back(name + (geoms.empty() ? " has no geom" : geoms));
  }
  std::string text = reasons.empty() ? " The model has no hinge joints."
                                     : fmt::format(" Its hinges: {}.", fmt::join(reasons, "; "));
  for (const std::string& note : found.notes) {
    text += " Note: " + note + ".";
  }
  return text;
}

}  // namespace trackbed::adapt
