#pragma once

#include <fmt/format.h>

#include <cmath>
#include <map>
#include <regex>
#include <string>

#include "trackbed/sim/plant.h"
#include "trackbed/sim/world_scene.h"

namespace trackbed {

/// Numbers under <custom> that replace or extend those of the file.
using Numerics = std::map<std::string, double>;

/// A car of models/ with some of its numbers changed.
inline CarModel CarWith(const std::string& name, const Numerics& numerics, double timestep = 0.002,
                        const World& world = {}) {
  Scene scene = ComposeScene(FindModel(name, ""), {.timestep = timestep});
  for (const auto& [key, value] : numerics) {
    const std::regex old("<numeric name=\"" + key + "\" [^>]*/>");
    scene.xml = std::regex_replace(scene.xml, old, "");
    scene.xml.insert(scene.xml.find("</custom>"),
                     fmt::format("<numeric name=\"{}\" data=\"{}\"/>", key, value));
  }
  CarModel car(scene, name);
  return IsFlat(world.ground) ? std::move(car)
                              : CarModel(WithWorld(car.scene(), car.params(), world), name);
}

/// Disables the effects that make tyres differ from linear, symmetric ones without camber.
inline const Numerics kStripped{{"camber_gain_front", 0.0},
                                {"camber_gain_rear", 0.0},
                                {"p_hx1", 0.0},
                                {"p_vx1", 0.0},
                                {"p_hy1", 0.0},
                                {"p_hy3", 0.0},
                                {"p_vy1", 0.0},
                                {"p_vy3", 0.0},
                                {"p_dy3", 0.0},
                                {"r_hx1", 0.0},
                                {"r_by3", 0.0},
                                {"r_vy1", 0.0},
                                {"r_vy3", 0.0},
                                {"drag_area", 0.0},
                                {"side_area", 0.0}};

/// Runs the plant: calls `command(t, state)` at every step and `look(t, state)` for every state.
template <typename Command_, typename Look>
VehicleState Drive(const CarModel& car, Plant& plant, double duration, const Command_& command,
                   const Look& look) {
  const auto steps = static_cast<int>(std::lround(duration / car.timestep()));
  VehicleState state = plant.Observe();
  for (int i = 0; i < steps && !plant.diverged(); ++i) {
    const double t = i * car.timestep();
    look(t, state);
    plant.Step(command(t, state));
    state = plant.Observe();
  }
  return state;
}

}  // namespace trackbed
