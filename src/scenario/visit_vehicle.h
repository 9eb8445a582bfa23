#pragma once

#include "trackbed/scenario/scenario.h"

/// Declares the keys of the section `vehicle` of a scenario.
namespace trackbed {

inline constexpr Key kVehicleSection{"vehicle", "", "vehicle"};

inline void Visit(KeyVisitor& a, AidOptions& aids) {
  a.Field({"abs", "", "anti-lock brakes"}, aids.abs, Need::kOptional);
  a.Field({"esc", "", "electronic stability control"}, aids.esc, Need::kOptional);
  static const EnumNames<Differential> differentials{{Differential::kOpen, "open"},
                                                     {Differential::kLocked, "locked"},
                                                     {Differential::kLimitedSlip, "limited_slip"}};
  a.Field({"differential", "", "differential of the driven axle"}, aids.differential,
          Need::kOptional, differentials);
  a.Field({"differential_preload", "N m",
           "largest torque difference between the wheels without drive torque, for limited_slip; "
           "default: 0.02 m g R"},
          aids.differential_preload, Range{.min = 0.0, .max = 1e5});
  a.Field({"differential_ramp", "",
           "increase of this difference per drive torque, for limited_slip; default: 0.25"},
          aids.differential_ramp, Range{.min = 0.0, .max = 1.0});
}

inline void Visit(KeyVisitor& a, TrailerOptions& trailer) {
  constexpr Range kLength{.max = 100.0, .above = 0.0};
  a.Field(
      {"hitch", "m",
       "distance of the hitch behind the rear axle; default: 2 % of the car's length behind its "
       "rear end"},
      trailer.hitch, kLength);
  a.Field({"hitch_height", "m", "height of the hitch; default: 1.2 wheel radii of the car"},
          trailer.hitch_height, kLength);
  a.Field({"tongue", "m", "distance from the hitch to the trailer's axle; default: the wheelbase"},
          trailer.tongue, kLength);
  a.Field({"track", "m", "distance between the trailer's wheels; default: that of the rear wheels"},
          trailer.track, kLength);
  a.Field({"length", "m", "length of the body without drawbar; default: 0.6 of the car's"},
          trailer.length, kLength);
  a.Field({"width", "m", "width of the body; default: that of the car"}, trailer.width, kLength);
  a.Field({"height", "m", "height of the body's top; default: 0.8 of the car's"}, trailer.height,
          kLength);
  a.Field({"body_ahead", "m",
           "distance of the middle of the body ahead of the trailer's axle; default: 0"},
          trailer.body_ahead, Range{.min = -100.0, .max = 100.0});
  a.Field({"mass", "kg", "mass with wheels; default: 0.4 of the car's"}, trailer.mass,
          Range{.max = 1e5, .above = 0.0});
  a.Field({"yaw_inertia", "kg m^2",
           "yaw inertia about the center of gravity; default: that of a uniform box"},
          trailer.yaw_inertia, Range{.max = 1e7, .above = 0.0});
  a.Field({"cg_ahead", "m",
           "distance of the center of gravity ahead of the trailer's axle; default: 6 % of the "
           "tongue"},
          trailer.cg_ahead, Range{.min = -100.0, .max = 100.0});
  a.Field(
      {"cg_height", "m", "height of the center of gravity; default: 1.75 wheel radii of the car"},
      trailer.cg_height, kLength);
  a.Field({"wheel_radius", "m", "radius of the trailer's wheels; default: that of the car"},
          trailer.wheel_radius, kLength);
}

inline void Visit(KeyVisitor& a, VehicleSpec& vehicle) {
  a.Field({"model", "", "name under models/, or path relative to this file"}, vehicle.model,
          Need::kOptional);
  static const EnumNames<TyreLaw> laws{{TyreLaw::kAuto, "auto"},
                                       {TyreLaw::kContact, "contact"},
                                       {TyreLaw::kMagicFormula, "magic_formula"}};
  a.Field({"tyre", "",
           "tyre model of the plant mujoco; auto: Magic Formula if the model has tyre "
           "coefficients, else MuJoCo contacts"},
          vehicle.tyre, Need::kOptional, laws);
  a.Field({"tyre_file", "",
           "tyre property file (.tir), relative to this file; replaces the tyre coefficients of "
           "the model"},
          vehicle.tyre_file);
  a.Field({"tyre_file_rear", "",
           "tyre property file of the rear tyres, relative to this file; default: tyre_file"},
          vehicle.tyre_file_rear);
  a.Field({"steering_rate", "rad/s", "steering rate of the road wheels, overrides the model's"},
          vehicle.steering_rate, Range{.max = 10.0, .above = 0.0});
  a.Section({"aids", "", "driver aids of the plant mujoco on Magic Formula tyres; default: none"},
            vehicle.aids);
  a.Section({"trailer", "",
             "trailer with one axle on a hitch behind the car, on the plants kinematic and mujoco; "
             "default: none"},
            vehicle.trailer);
}

}  // namespace trackbed
