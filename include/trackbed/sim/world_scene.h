#pragma once

#include "trackbed/sim/scene.h"
#include "trackbed/vehicle/params.h"
#include "trackbed/world/world.h"

namespace trackbed {

/// Adds the ground of the world to the scene of a car. The geom `ground` becomes a plane with the
/// ground's grade. Every bump and every side slope becomes a height field `ground_0`, `ground_1`, …
/// on the plane. The distance between the samples of a height field is at most 5 cm or 1/256 of the
/// height field's side. A terrain has one height field for each refined block, and one coarse
/// height field for each group of 64 x 64 blocks. Within refined blocks, the coarse height field is
/// lowered by 4 m. If the scene has height fields, every wheel also gets a plane (`ground_fl`, …)
/// without contacts, which RoadContact moves. Planes and height fields have the
/// friction and other properties of the geom `ground` in the car's file. If the ground is flat, the
/// scene is unchanged.
Scene WithGround(const Scene& car_scene, const Ground& ground);

/// Adds the world's obstacles `obstacle_0`, `obstacle_1`, … to the scene, as fixed boxes. An
/// obstacle that moves is a box on joints such as `obstacle_0_x`, `obstacle_0_y` and, if it can
/// rotate, `obstacle_0_yaw`. The walls of the world's map (`obstacle_wall_0`, …) are fixed boxes on
/// flat ground. The body `chassis` of the car gets a box geom `shell`, which can touch obstacles
/// but nothing else. The geom `shell` has the length and width of the car's footprint. The geom
/// `shell` extends vertically from one tenth of the car's height up to the roof. Obstacles stand on
/// the world's ground. If the world has no obstacles, the scene is unchanged.
Scene WithObstacles(const Scene& car_scene, const VehicleParams& vehicle, const World& world);

/// Adds the world's ground and obstacles to the scene.
Scene WithWorld(const Scene& car_scene, const VehicleParams& vehicle, const World& world);

}  // namespace trackbed
