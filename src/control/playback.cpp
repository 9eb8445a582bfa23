#include "trackbed/control/playback.h"

#include <fmt/format.h>

#include <cmath>
#include <utility>

#include "trackbed/control/recording_file.h"
#include "trackbed/control/speed_controller.h"

namespace trackbed {
namespace {

class PlaybackController final : public SteeringController {
 public:
  explicit PlaybackController(const PlaybackOptions& options) : options_(options) {
    const Recording& recording = options.recording;
    TRACKBED_CHECK(!recording.steering.empty() && recording.steering.IsStrictlyIncreasing() &&
                       recording.speed.IsStrictlyIncreasing() &&
                       recording.acceleration.IsStrictlyIncreasing(),
                   "a recording without steering, or whose rows do not rise");
    TRACKBED_CHECK(recording.speed.empty() || recording.acceleration.empty(),
                   "a recording of both speed and acceleration");
  }

  double Steer(const ControlInput& input) override {
    return PlaybackSteering(options_, Axis(input), input.state.speed, input.period);
  }

  std::optional<double> Accelerate(const ControlInput& input) override {
    return PlaybackAcceleration(options_, Axis(input), input.state.speed, input.speed_gain,
                                input.period);
  }

 private:
  /// Look up recordings over distance by the car's odometer, not by the plan's station, because a
  /// new plan must not restart the recording.
  [[nodiscard]] double Axis(const ControlInput& input) const {
    return options_.by == PlaybackAxis::kTime ? input.state.time : input.state.distance;
  }

  PlaybackOptions options_;
};

/// Returns how far the playback advances along the recording in a control period, in time or in
/// distance.
double AxisAdvance(const PlaybackOptions& options, double speed, double period) {
  return options.by == PlaybackAxis::kTime ? period : std::abs(speed) * period;
}

/// Returns the last time [s] of a recording over time, or nullopt for a recording over distance.
std::optional<double> DurationOf(const PlaybackOptions& options) {
  const Signal& steering = options.recording.steering;
  if (options.by != PlaybackAxis::kTime || steering.empty() || steering.knots.back().x() <= 0.0) {
    return std::nullopt;
  }
  return steering.knots.back().x();
}

const Recording& RecordingOf(const ControllerOptions& options) {
  return options.Get<PlaybackOptions>().recording;
}

void SetRecording(PlaybackOptions& options, const Recording& recording) {
  options.recording = recording;
}

bool ReplaysRecord(const PlaybackOptions& options) {
  return options.file.empty();
}

/// Checks the recording in a scenario that was created by a program instead of a file. Recordings
/// in files are checked by the reader of scenario files.
std::vector<OptionProblem> CheckRecording(const PlaybackOptions& options,
                                          const CouldReadKey& /*could_read*/) {
  const Recording& recording = options.recording;
  if (recording.steering.empty()) {
    return {{"file", options.file.empty()
                         ? "missing; name a file and use ReadScenario or ParseScenario, which read "
                           "it, or set PlaybackOptions::recording"
                         : fmt::format("{} has not been read; ReadScenario and ParseScenario read "
                                       "it",
                                       options.file)}};
  }
  std::vector<OptionProblem> problems;
  for (const auto& [name, signal] :
       {std::pair("steering", &recording.steering), std::pair("speed", &recording.speed),
        std::pair("acceleration", &recording.acceleration)}) {
    if (!signal->IsStrictlyIncreasing()) {
      problems.push_back(
          {"file", fmt::format("the recorded {} is not finite, or its {} do not increase", name,
                               options.by == PlaybackAxis::kTime ? "times" : "distances")});
    }
  }
  if (!recording.speed.empty() && !recording.acceleration.empty()) {
    problems.push_back({"file", "the recording has both speed and acceleration; remove one"});
  }
  return problems;
}

/// Returns the default options of the playback, used until a recording file is read: straight
/// driving.
PlaybackOptions StraightOn() {
  PlaybackOptions options;
  options.recording.steering = {{{0.0, 0.0}}};
  return options;
}

void ReadInputs(PlaybackOptions& options, InputReader& reader) {
  if (!reader.CouldRead("file") || !reader.CouldRead("columns")) {
    return;
  }
  if (options.file.empty()) {
    if (!reader.has_record()) {
      reader.AddError("file", "missing");
    } else if (options.by == PlaybackAxis::kDistance) {
      reader.AddError("by", "a record is replayed over time; remove this");
    }
    return;
  }
  reader.ReadFile("file", options.file, [&](const std::filesystem::path& file) {
    options.recording = ReadRecording(file, options.by, options.columns);
  });
}

std::vector<InputFile> InputFilesOf(const PlaybackOptions& options) {
  return {
      {kRecordingCsv, RecordingCsv(options.recording, options.by), "recording " + options.file}};
}

void Resolve(ControllerOptions& options, bool from_record) {
  auto& own = options.Get<PlaybackOptions>();
  own.file = from_record ? "" : kRecordingCsv;
  own.columns = {};  // the output file of the recording uses the default column names
}

}  // namespace

double PlaybackSteering(const PlaybackOptions& options, double x, double speed, double period) {
  return options.recording.steering.At(x + AxisAdvance(options, speed, period));
}

std::optional<double> PlaybackAcceleration(const PlaybackOptions& options, double x, double speed,
                                           double gain, double period) {
  const Recording& recording = options.recording;
  const double ahead = AxisAdvance(options, speed, period);
  if (!recording.speed.empty()) {
    return SpeedAlong(recording.speed, x, ahead, gain, std::abs(speed), period);
  }
  if (!recording.acceleration.empty()) {
    return recording.acceleration.Mean(x, x + ahead);
  }
  return std::nullopt;
}

void Visit(KeyVisitor& keys, RecordingColumns& columns) {
  keys.Field({"time", "s", "when; else t_s"}, columns.time);
  keys.Field({"distance", "m", "where; else s_m"}, columns.distance);
  keys.Field({"steering", "rad",
              "column of the bicycle angle, positive to the left; default: steering_rad"},
             columns.steering);
  keys.Field({"speed", "m/s", "column of the speed; default: speed_mps if present"}, columns.speed);
  keys.Field(
      {"acceleration", "m/s^2",
       "column of the acceleration, instead of the speed; default: acceleration_mps2 if present"},
      columns.acceleration);
}

void Visit(KeyVisitor& keys, PlaybackOptions& options) {
  std::optional<std::string> file =
      options.file.empty() ? std::nullopt : std::optional(options.file);
  keys.Field(
      {"file", "",
       "recording: a CSV file with a header, relative to this file; required without record"},
      file);
  options.file = file.value_or("");
  static const EnumNames<PlaybackAxis> axes{{PlaybackAxis::kTime, "time"},
                                            {PlaybackAxis::kDistance, "distance"}};
  keys.Field({"by", "", "independent variable of the rows: time or distance traveled"}, options.by,
             Need::kOptional, axes);
  keys.Section({"columns", "", "column names of the recording"}, options.columns);
}

ControllerEntry Playback() {
  return {.name = "playback",
          .summary = "replays recorded steering and speed or acceleration",
          .defaults = StraightOn(),
          .station = StationSource::kOdometer,
          .needs_plan = false,
          .make = MakeBy<PlaybackOptions, PlaybackController>,
          .check = OnOptions<PlaybackOptions, CheckRecording>,
          .duration = OnOptions<PlaybackOptions, DurationOf>,
          .recording = RecordingOf,
          .replays_record = OnOptions<PlaybackOptions, ReplaysRecord>,
          .set_recording = OnOptions<PlaybackOptions, SetRecording>,
          .read_inputs = OnOptions<PlaybackOptions, ReadInputs>,
          .input_files = OnOptions<PlaybackOptions, InputFilesOf>,
          .input_names = {kRecordingCsv},
          .resolve = Resolve};
}

}  // namespace trackbed
