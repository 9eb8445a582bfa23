#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "src/cli/output_file.h"
#include "src/cli/scenario_options.h"
#include "src/cli/terminal.h"
#include "src/cli/verbs.h"
#include "trackbed/core/angle.h"
#include "trackbed/core/error.h"
#include "trackbed/core/file.h"
#include "trackbed/core/table.h"
#include "trackbed/sim/adapt.h"
#include "trackbed/sim/car_grip.h"
#include "trackbed/sim/car_model.h"
#include "trackbed/sim/linkage.h"
#include "trackbed/sim/model_notes.h"

// The verb `model`: prints the parameters of a vehicle model.
// 1. Finds the vehicle model by name or path, compiles it, and prints its parameters and notes.
// 2. The option --ggv prints the g-g-v diagram as a table. The option --linkage prints the
//    polynomials of the steering linkage.
// 3. The option --save writes the composed MJCF file with its meshes and textures.
// 4. The option --adapt proposes a car for the model of another program (sim/adapt.h), and prints
//    the evidence.
namespace trackbed::cli {
namespace {

void Row(const char* name, double value, const char* unit) {
  // Print five significant digits, because the vehicle parameters are not known more accurately.
  Print("  {:<26} {:>12.5g}{}\n", name, value,
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

void PrintModel(const CarModel& car, const std::string& file) {
  const VehicleParams& p = car.params();
  const bool steered = p.kind == VehicleKind::kSteered;
  Print("{} ({}){}\n", p.name, file, steered ? "" : ", differential drive");
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
  for (const std::string& note : NotesOnModel(car)) {
    Print("note: {}\n", note);
  }
}

/// Returns the speeds of the g-g-v table, from standstill to the top speed but at most 60 m/s. The
/// speeds are 10 m/s apart; for vehicles with a top speed of at most 20 m/s, the speeds are a tenth
/// of the top speed apart.
std::vector<double> GgvSpeeds(const GgvDiagram& diagram) {
  constexpr double kMaxTableSpeed = 60.0;  // [m/s]
  const double own = diagram.forces().top_speed;
  const double top = own > 0.0 ? std::min(own, kMaxTableSpeed) : kMaxTableSpeed;
  const double step = top > 20.0 ? 10.0 : top / 10.0;
  std::vector<double> speeds;
  for (double speed = 0.0; speed < top * (1.0 + 1e-9); speed += step) {
    speeds.push_back(speed);
  }
  return speeds;
}

void PrintLinkage(const CarModel& car) {
  const LinkagePolynomials fit = FitLinkage(car.params());
  Print("<!-- Ackermann's linkage within {:.2g} rad, up to {:.4g} rad -->\n", fit.error,
        car.params().steering_limit);
  for (const auto& [side, coefficients] : {std::pair("fl", fit.left), std::pair("fr", fit.right)}) {
    Print(
        "<joint name=\"ackermann_{0}\" joint1=\"steer_{0}\" joint2=\"rack\" "
        "polycoef=\"{1}\"/>\n",
        side, fmt::format("{:.6g}", fmt::join(coefficients, " ")));
  }
}

/// Prints the limits of longitudinal acceleration on a level road, at given fractions of the
/// largest lateral acceleration.
void PrintGgv(const GgvDiagram& diagram, const std::string& name) {
  constexpr std::array<double, 4> kShares{0.0, 0.5, 0.8, 0.95};
  Print("g-g-v diagram of {} on a level road of factor 1 [m/s^2]\n", name);
  Print("{:>8} {:>8}", "v [m/s]", "lateral");
  for (const double share : kShares) {
    Print(" {:>15}", share == 0.0 ? "straight" : fmt::format("{:g} of lateral", share));
  }
  Print("\n");
  for (const double speed : GgvSpeeds(diagram)) {
    const double lateral = diagram.MaxLateral({.speed = speed});
    Print("{:>8.4g} {:>8.3f}", speed, lateral);
    for (const double share : kShares) {
      const AccelerationRange range =
          diagram.AccelerationsAt({.speed = speed, .lateral = share * lateral});
      Print(" {:>15}", fmt::format("{:.3f} {:+.3f}", range.smallest, range.largest));
    }
    Print("\n");
  }
}

Table EmptyGgvTable() {
  return Table({"speed_mps", "lateral_acceleration_mps2", "longitudinal_acceleration_mps2"});
}

/// Returns a table with the boundary of the g-g-v diagram at each speed. Each boundary of the g-g-v
/// diagram runs from the maximum deceleration over the maximum lateral acceleration to the maximum
/// acceleration.
Table GgvTable(const GgvDiagram& diagram) {
  Table table = EmptyGgvTable();
  constexpr int kSteps = 24;
  for (const double speed : GgvSpeeds(diagram)) {
    const double lateral = diagram.MaxLateral({.speed = speed});
    for (int i = -kSteps; i <= kSteps; ++i) {
      const double angle = 0.5 * kPi * i / kSteps;
      const double own = std::abs(i) == kSteps ? 0.0 : lateral * std::cos(angle);
      const AccelerationRange range = diagram.AccelerationsAt({.speed = speed, .lateral = own});
      table.AddRow({speed, own, i < 0 ? range.smallest : range.largest});
    }
  }
  return table;
}

void ShowGgv(const CarModel& car, const std::string& out) {
  const GgvDiagram diagram = ComputeGgv(car, TyreLaw::kAuto, {1.0});
  PrintGgv(diagram, car.params().name);
  if (!out.empty()) {
    WriteFileAtomically(out, GgvTable(diagram).ToCsv());
  }
}

void PrintAdapted(const AdaptedModel& adapted, const std::string& file) {
  Print("{}: {}\n", file,
        adapted.kind == VehicleKind::kSteered ? "a car with steered front wheels"
                                              : "a robot with differential drive");
  for (const AdaptGuess& guess : adapted.guesses) {
    Print("  {:<16} {} ({})\n", guess.what, guess.value, guess.evidence);
  }
  for (const std::string& note : adapted.notes) {
    Print("note: {}\n", note);
  }
}

void Adapt(const std::string& file, const AdaptOptions& options, const std::string& out) {
  const AdaptedModel adapted = AdaptModel(file, options);
  PrintAdapted(adapted, file);
  if (!out.empty()) {
    WriteFileAtomically(out, adapted.xml + ModelMark(adapted.xml));
    Print("wrote {}\n", out);
  }
}

void RequireAbove0(const char* option, const std::optional<double>& value) {
  if (value && !(*value > 0.0)) {
    throw InputError(
        Problem{.file = option, .message = fmt::format("must be above 0, found {:g}", *value)});
  }
}

}  // namespace

namespace {

struct ModelOptions {
  std::string name;
  std::string save;
  bool linkage = false;
  bool ggv = false;
  std::string out;
  std::vector<std::string> asset_folders;
  bool adapt = false;
  AdaptOptions answers;
};

/// A command line option with a number above 0, which is an input of AdaptModel.
struct AdaptNumber {
  const char* flag;
  std::optional<double> AdaptOptions::*value;
  const char* help;
  const char* type;
};

constexpr std::array<AdaptNumber, 4> kAdaptNumbers{
    {{"--wheel-radius", &AdaptOptions::wheel_radius, "With --adapt: the radius of all wheels [m]",
      "R"},
     {"--steering-limit", &AdaptOptions::steering_limit,
      "With --adapt: the largest bicycle angle [rad]", "ANGLE"},
     {"--steering-rate", &AdaptOptions::steering_rate,
      "With --adapt: the largest rate of the bicycle angle [rad/s]", "RATE"},
     {"--drive-torque", &AdaptOptions::drive_torque,
      "With --adapt: the largest torque on all driven wheels together [N m]", "TORQUE"}}};

void AddAdaptOptions(const Command& command, ModelOptions& options) {
  command.AddFlag("--adapt", options.adapt,
                  "Propose a car file for a model that was written for another program, MJCF or "
                  "URDF; print what it was guessed from");
  command
      .AddOption("--body", options.answers.body,
                 "With --adapt: the vehicle, if the file has several")
      .TypeName("NAME");
  for (const AdaptNumber& number : kAdaptNumbers) {
    command.AddOption(number.flag, options.answers.*number.value, number.help)
        .TypeName(number.type);
  }
  command.AddFlag("--front-steering", options.answers.steers_front_only,
                  "With --adapt: lock the rear wheels of a vehicle that steers all wheels");
}

void CheckOptions(const ModelOptions& options) {
  const AdaptOptions& answers = options.answers;
  bool answered = !answers.body.empty() || answers.steers_front_only;
  for (const AdaptNumber& number : kAdaptNumbers) {
    RequireAbove0(number.flag, answers.*number.value);
    answered = answered || answers.*number.value;
  }
  if (answered && !options.adapt) {
    throw InputError(Problem{.message =
                                 "--body, --wheel-radius, --steering-limit, --steering-rate, "
                                 "--drive-torque and --front-steering need --adapt"});
  }
  if (options.adapt && (options.ggv || options.linkage || !options.save.empty())) {
    throw InputError(Problem{.file = "--adapt", .message = "excludes --ggv, --linkage and --save"});
  }
  if (!options.out.empty() && !options.ggv && !options.adapt) {
    throw InputError(Problem{.file = "--out", .message = "needs --ggv or --adapt"});
  }
}

int ShowModel(const ModelOptions& options) {
  CheckOptions(options);
  const auto file = FindModel(options.name, "");
  if (!options.out.empty()) {
    PrepareOutputFile(
        "--out", options.out, {file},
        options.ggv ? BeginsWith(EmptyGgvTable().ToCsv()) : WroteFile(IsUneditedModel));
  }
  if (!options.save.empty()) {
    PrepareOutputFile("--save", options.save, {file}, IsUneditedModel);
  }
  if (options.adapt) {
    AdaptOptions answers = options.answers;
    answers.asset_folders = Paths(options.asset_folders);
    Adapt(file.string(), answers, options.out);
    return kOk;
  }
  const CarModel car(ComposeScene(file, {.asset_folders = Paths(options.asset_folders)}),
                     file.string());
  if (options.linkage && car.params().kind != VehicleKind::kSteered) {
    throw InputError(
        Problem{.file = "--linkage", .message = options.name + " has no steered front wheels"});
  }
  if (options.ggv) {
    ShowGgv(car, options.out);
  } else if (options.linkage) {
    PrintLinkage(car);
  } else if (options.save.empty()) {
    PrintModel(car, file.string());
  } else {
    Scene scene = car.scene();
    scene.xml += ModelMark(scene.xml);
    WriteScene(scene, options.save);
  }
  return kOk;
}

}  // namespace

void AddModel(const Command& command) {
  const auto options = std::make_shared<ModelOptions>();
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
  command.AddFlag("--ggv", options->ggv,
                  "Print the g-g-v diagram: accelerations that tyres, brakes and drive give");
  command
      .AddOption("-o,--out", options->out,
                 "Also write the diagram of --ggv as CSV, or the car file of --adapt")
      .TypeName("FILE");
  AddAdaptOptions(command, *options);
  AddAllowAssets(command, options->asset_folders);
  command.AddExample("Parameters of a shipped model", "trackbed model bmw320i");
  command.AddExample("Its g-g-v diagram, also as CSV", "trackbed model bmw320i --ggv -o ggv.csv");
  command.AddExample("A car file proposed from the geometry of a model",
                     "trackbed model dart --adapt -o car.xml");
  command.OnRun([options] { return ShowModel(*options); });
}

}  // namespace trackbed::cli
