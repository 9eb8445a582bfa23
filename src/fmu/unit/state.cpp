#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <utility>

#include "src/fmu/unit/unit.h"
#include "trackbed/core/error.h"
#include "trackbed/core/hash.h"

// A serialized state contains the parameters and the commands of all control periods, and is
// restored by repeating the simulation with these commands. Plants, planners and controllers cannot
// be serialized, but a repeated simulation has the same result bit for bit. A hash of the last row
// of the log shows whether the repeated simulation had the same result.
//
// A serialized state consists of the following parts: the text kMark, the FMU's token, numbers and
// counts of 8 bytes in the machine's byte order, the hash of the last log row, and a hash of all
// preceding bytes.
namespace trackbed::fmu {
namespace {

constexpr std::string_view kMark = "trackbed-fmu-state-1\n";
constexpr std::size_t kTokenLength = 38;
constexpr std::size_t kHashLength = 64;

[[noreturn]] void Refuse(std::string message) {
  throw InputError(Problem{.message = std::move(message)});
}

template <typename Number>
void Append(Number number, std::string& bytes) {
  static_assert(sizeof(Number) == 8);
  bytes.append(reinterpret_cast<const char*>(&number), sizeof(Number));
}

void Append(const Commands& commands, std::string& bytes) {
  Append(commands.steering, bytes);
  Append(commands.acceleration, bytes);
  Append(std::uint64_t{commands.controller_steers} | std::uint64_t{commands.plan_sets_speed} << 1U,
         bytes);
}

/// Reads the bytes of a serialized state from front to back.
class Reader {
 public:
  explicit Reader(std::string_view bytes) : left_(bytes) {}

  std::string_view Text(std::size_t length) {
    if (left_.size() < length) {
      Refuse("the serialized state is cut off");
    }
    const std::string_view text = left_.substr(0, length);
    left_.remove_prefix(length);
    return text;
  }

  template <typename Number>
  Number Read() {
    Number number{};
    std::memcpy(&number, Text(sizeof(Number)).data(), sizeof(Number));
    return number;
  }

  /// Reads the number of the following elements, each of which has `size` bytes. Throws InputError
  /// if the serialized state is too short for that number of elements.
  std::size_t Count(std::size_t size) {
    const auto count = Read<std::uint64_t>();
    if (count > left_.size() / size) {
      Refuse("the serialized state is cut off");
    }
    return count;
  }

  Commands ReadCommands() {
    Commands commands;
    commands.steering = Read<double>();
    commands.acceleration = Read<double>();
    const auto flags = Read<std::uint64_t>();
    commands.controller_steers = (flags & 1U) != 0;
    commands.plan_sets_speed = (flags & 2U) != 0;
    return commands;
  }

  [[nodiscard]] bool AtEnd() const { return left_.empty(); }

 private:
  std::string_view left_;
};

std::string HashOf(const SteppedLoop& loop) {
  return Sha256(PresentRow(loop).ToCsv());
}

constexpr std::size_t kParameterSize = 16;
constexpr std::size_t kCommandsSize = 24;

}  // namespace

std::string Unit::Serialize(const State& state) const {
  std::string bytes(kMark);
  bytes += token_;
  Append(static_cast<std::uint64_t>(state.phase), bytes);
  Append(state.start_time, bytes);
  Append(std::uint64_t{state.parameters.size()}, bytes);
  for (const auto& [reference, value] : state.parameters) {
    Append(std::uint64_t{reference}, bytes);
    Append(value, bytes);
  }
  Append(state.commands, bytes);
  Append(std::uint64_t{state.history.size()}, bytes);
  for (const Commands& commands : state.history) {
    Append(commands, bytes);
  }
  bytes += state.loop ? HashOf(*state.loop) : "";
  return bytes + Sha256(bytes);
}

State Unit::Deserialize(std::string_view bytes) const {
  const std::size_t size = bytes.size() - std::min(bytes.size(), kHashLength);
  if (Sha256(bytes.substr(0, size)) != bytes.substr(size)) {
    Refuse("the serialized state is damaged or cut off");
  }
  Reader reader(bytes.substr(0, size));
  if (reader.Text(kMark.size()) != kMark) {
    Refuse("these bytes are no serialized state of this version of Trackbed");
  }
  if (const std::string_view token = reader.Text(kTokenLength); token != token_) {
    Refuse(fmt::format("the serialized state is of the FMU {}, not of {}", token, token_));
  }
  State state;
  const auto phase = reader.Read<std::uint64_t>();
  state.phase = static_cast<Phase>(phase);
  state.start_time = reader.Read<double>();
  for (std::size_t left = reader.Count(kParameterSize); left > 0; --left) {
    const auto reference = reader.Read<std::uint64_t>();
    const auto value = reader.Read<double>();
    if (reference >= variables_.size() ||
        variables_[reference].causality != Causality::kParameter || !std::isfinite(value)) {
      Refuse("the serialized state is damaged");
    }
    state.parameters.emplace(static_cast<std::uint32_t>(reference), value);
  }
  state.commands = reader.ReadCommands();
  for (std::size_t left = reader.Count(kCommandsSize); left > 0; --left) {
    state.history.push_back(reader.ReadCommands());
  }
  const std::string hash = reader.AtEnd() ? "" : std::string(reader.Text(kHashLength));
  if (!reader.AtEnd() || phase > static_cast<std::uint64_t>(Phase::kTerminated)) {
    Refuse("the serialized state is damaged");
  }
  if (hash.empty()) {
    if (state.phase > Phase::kInitialization || !state.history.empty()) {
      Refuse("the serialized state is cut off");
    }
    return state;
  }
  state.loop = MakeLoop(state.parameters);
  for (const Commands& commands : state.history) {
    if (state.loop->status()) {
      Refuse("the run of the serialized state ends early; another build of Trackbed wrote it");
    }
    StepOnce(*state.loop, commands);
  }
  if (HashOf(*state.loop) != hash) {
    Refuse(
        "the serialized state cannot be repeated exactly: another build of Trackbed wrote it, or "
        "the plan has a time limit in wall-clock time");
  }
  return state;
}

}  // namespace trackbed::fmu
