#include <fmt/format.h>

#include <memory>

#include "src/cli/verbs.h"
#include "trackbed/core/file.h"
#include "trackbed/sim/car_model.h"

namespace trackbed::cli {
namespace {

void Print(const CarModel& car, const std::string& file) {
  const VehicleParams& p = car.params();
  const auto row = [](const char* name, double value, const char* unit) {
    fmt::print("  {:<26} {:>12.6g} {}\n", name, value, unit);
  };
  fmt::print("{} ({})\n", p.name, file);
  row("wheelbase", p.wheelbase, "m");
  row("cg_to_rear", p.cg_to_rear, "m");
  row("cg_to_front", p.cg_to_front(), "m");
  row("cg_height", car.parts().cg_height, "m");
  row("track_front", p.track_front, "m");
  row("track_rear", p.track_rear, "m");
  row("wheel_radius", p.wheel_radius, "m");
  row("mass", p.mass, "kg");
  row("yaw_inertia", p.yaw_inertia, "kg m^2");
  if (car.parts().tyres) {
    row("cornering_stiffness_front", p.cornering_stiffness_front, "N/rad");
    row("cornering_stiffness_rear", p.cornering_stiffness_rear, "N/rad");
  }
  row("steering_limit", p.steering_limit, "rad");
  row("steering_rate", p.steering_rate, "rad/s");
  row("steering_ratio", p.steering_ratio, "");
  row("min_turning_radius", p.min_turning_radius(), "m");
  row("length", p.length, "m");
  row("width", p.width, "m");
  row("height", p.height, "m");
  row("rear_overhang", p.rear_overhang, "m");
  row("drive_torque", car.parts().drive_limit, "N m");
  row("brake_torque_front", car.parts().brake_torque_front, "N m per wheel");
  row("brake_torque_rear", car.parts().brake_torque_rear, "N m per wheel");
}

}  // namespace

void AddModel(CLI::App& command, int& exit_code) {
  struct Options {
    std::string name;
    std::string save;
  };
  const auto options = std::make_shared<Options>();
  command.add_option("name", options->name, "A model by name, or the path of an MJCF file")
      ->required()
      ->type_name("NAME");
  command
      .add_option("--save", options->save,
                  "Write the composed MJCF, to open in MuJoCo's viewer, with the files it needs "
                  "beside it")
      ->type_name("FILE");
  command.callback([options, &exit_code] {
    const auto file = FindModel(options->name, "");
    const CarModel car(ComposeScene(file, {}), file.string());
    if (options->save.empty()) {
      Print(car, file.string());
    } else {
      WriteScene(car.scene(), options->save);
    }
    exit_code = kOk;
  });
}

}  // namespace trackbed::cli
