#include <fmt/format.h>
#include <fmt/ranges.h>

#include <filesystem>
#include <memory>
#include <string_view>

#include "src/cli/scenario_options.h"
#include "src/cli/verbs.h"
#include "trackbed/core/error.h"
#include "trackbed/core/file.h"
#include "trackbed/sim/car_model.h"
#include "trackbed/sim/linkage.h"

namespace trackbed::cli {
namespace {

void Row(const char* name, double value, const char* unit) {
  // Five digits: more than any of it is known to.
  fmt::print("  {:<26} {:>12.5g}{}\n", name, value,
             std::string_view(unit).empty() ? "" : fmt::format(" {}", unit));
}

void PrintCar(const CarModel& car) {
  const VehicleParams& p = car.params();
  const CarParts& parts = car.parts();
  Row("wheelbase", p.wheelbase, "m");
  Row("cg_to_rear", p.cg_to_rear, "m");
  Row("cg_to_front", p.cg_to_front(), "m");
  Row("cg_height", parts.cg_height, "m");
  Row("track_front", p.track_front, "m");
  Row("track_rear", p.track_rear, "m");
  Row("wheel_radius", p.wheel_radius, "m");
  Row("mass", p.mass, "kg");
  Row("yaw_inertia", p.yaw_inertia, "kg m^2");
  if (parts.tyres) {
    Row("cornering_stiffness_front", p.cornering_stiffness_front, "N/rad");
    Row("cornering_stiffness_rear", p.cornering_stiffness_rear, "N/rad");
  }
  Row("steering_limit", p.steering_limit, "rad");
  Row("steering_rate", p.steering_rate, "rad/s");
  const SteeringResponse& response = p.steering_response;
  Row("steering_dead_time", response.dead_time, "s");
  Row("steering_time_constant", response.time_constant, "s");
  Row("steering_backlash", response.backlash, "rad");
  for (const Vec2& point : response.curve) {
    Row("steering_curve", point.y(), fmt::format("rad, commanded {:.6g}", point.x()).c_str());
  }
  Row("steering_ratio", p.steering_ratio, "");
  Row("min_turning_radius", p.min_turning_radius(), "m");
}

void PrintWheelPair(const CarModel& car) {
  const VehicleParams& p = car.params();
  Row("track", p.track_rear, "m");
  Row("cg_to_axle", p.cg_to_rear, "m");
  Row("cg_height", car.chassis().cg_height, "m");
  Row("wheel_radius", p.wheel_radius, "m");
  Row("mass", p.mass, "kg");
  Row("yaw_inertia", p.yaw_inertia, "kg m^2");
  Row("steering_limit", p.steering_limit, "rad, atan((v_R - v_L)/v)");
  Row("steering_rate", p.steering_rate, "rad/s, of the same");
  Row("min_turning_radius", p.min_turning_radius(), "m");
}

void Print(const CarModel& car, const std::string& file) {
  const VehicleParams& p = car.params();
  const bool steered = p.kind == VehicleKind::kSteered;
  fmt::print("{} ({}){}\n", p.name, file, steered ? "" : ", differential drive");
  steered ? PrintCar(car) : PrintWheelPair(car);
  Row("length", p.length, "m");
  Row("width", p.width, "m");
  Row("height", p.height, "m");
  Row("rear_overhang", p.rear_overhang, "m");
  if (steered) {
    Row("drive_torque", car.parts().drive_limit, "N m");
    Row("brake_torque_front", car.parts().brake_torque_front, "N m per wheel");
    Row("brake_torque_rear", car.parts().brake_torque_rear, "N m per wheel");
  } else {
    Row("brake_torque", car.wheel_pair().brake_torque, "N m per wheel");
  }
  Row("friction_longitudinal", p.friction_longitudinal, "");
  Row("friction_lateral", p.friction_lateral, "");
  Row("max_deceleration", p.max_deceleration, "m/s^2");
  Row("max_acceleration", p.max_acceleration, "m/s^2");
  if (p.top_speed > 0.0) {
    Row("top_speed", p.top_speed, "m/s");
  }
}

void PrintLinkage(const CarModel& car) {
  const LinkagePolynomials fit = FitLinkage(car.params());
  fmt::print("<!-- Ackermann's linkage within {:.2g} rad, up to {:.4g} rad -->\n", fit.error,
             car.params().steering_limit);
  for (const auto& [side, coefficients] : {std::pair("fl", fit.left), std::pair("fr", fit.right)}) {
    fmt::print(
        "<joint name=\"ackermann_{0}\" joint1=\"steer_{0}\" joint2=\"rack\" "
        "polycoef=\"{1:.6g}\"/>\n",
        side, fmt::join(coefficients, " "));
  }
}

}  // namespace

void AddModel(const Command& command) {
  struct Options {
    std::string name;
    std::string save;
    bool linkage = false;
    std::vector<std::string> asset_folders;
  };
  const auto options = std::make_shared<Options>();
  command.AddPositional("name", options->name, "A model by name, or the path of an MJCF file")
      .Required()
      .TypeName("MODEL");
  command
      .AddOption("--save", options->save,
                 "Write the composed MJCF and the files it needs, to open in MuJoCo's viewer")
      .TypeName("FILE");
  command.AddFlag(
      "--linkage", options->linkage,
      "Print joint couplings fitted to the steering linkage, to paste into the model file");
  AddAllowAssets(command, options->asset_folders);
  command.AddExample("Parameters of a shipped model", "trackbed model bmw320i");
  command.OnRun([options] {
    const auto file = FindModel(options->name, "");
    const CarModel car(ComposeScene(file, {.asset_folders = Paths(options->asset_folders)}),
                       file.string());
    if (options->linkage && car.params().kind != VehicleKind::kSteered) {
      throw InputError(
          Problem{.file = "--linkage", .message = options->name + " has no steered front wheels"});
    }
    if (options->linkage) {
      PrintLinkage(car);
    } else if (options->save.empty()) {
      Print(car, file.string());
    } else {
      RemoveAbandonedTemporaries(std::filesystem::path(options->save).parent_path());
      WriteScene(car.scene(), options->save);
    }
    return kOk;
  });
}

}  // namespace trackbed::cli
