#pragma once

#include <gtest/gtest.h>
#include <zip.h>

#include <filesystem>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "src/fmu/fmi3_interface.h"
#include "src/fmu/shared_library.h"
#include "trackbed/core/file.h"

/// A small host of FMUs for tests: reads the ZIP archive with libzip and calls the C functions.
namespace trackbed::fmu_test {

/// Returns the entries of a ZIP archive by name. A wrong checksum of an entry fails the test.
inline std::map<std::string, std::string> Unzipped(const std::filesystem::path& file) {
  std::map<std::string, std::string> entries;
  int error = 0;
  zip_t* archive = zip_open(file.c_str(), ZIP_RDONLY | ZIP_CHECKCONS, &error);
  EXPECT_NE(archive, nullptr) << error;
  if (archive == nullptr) {
    return entries;
  }
  for (zip_int64_t i = 0; i < zip_get_num_entries(archive, 0); ++i) {
    zip_stat_t stat;
    EXPECT_EQ(zip_stat_index(archive, static_cast<zip_uint64_t>(i), 0, &stat), 0);
    std::string content(stat.size, '\0');
    zip_file_t* entry = zip_fopen_index(archive, static_cast<zip_uint64_t>(i), 0);
    EXPECT_EQ(zip_fread(entry, content.data(), content.size()),
              static_cast<zip_int64_t>(content.size()));
    EXPECT_EQ(zip_fclose(entry), 0) << stat.name;
    entries[stat.name] = content;
  }
  zip_discard(archive);
  return entries;
}

/// Writes the entries of an archive below `folder`.
inline void Extract(const std::map<std::string, std::string>& entries,
                    const std::filesystem::path& folder) {
  for (const auto& [name, content] : entries) {
    std::filesystem::create_directories((folder / name).parent_path());
    WriteFileAtomically(folder / name, content);
  }
}

/// The functions of FMI 3 that the tests call.
struct Functions {
  explicit Functions(const std::filesystem::path& file)
      : library(std::make_shared<fmu::SharedLibrary>(file)) {}

  template <typename Function>
  Function* Find(const char* name) const {
    return library->Find<Function>(name);
  }

  std::shared_ptr<fmu::SharedLibrary> library;
};

using Values = fmi3Status(fmi3Instance, const fmi3ValueReference*, std::size_t, double*,
                          std::size_t);
using Bytes = std::vector<fmi3Byte>;

/// An instance of an FMU.
class Host {
 public:
  Host(const Functions& functions, const std::filesystem::path& folder, const std::string& token)
      : functions_(functions) {
    instance_ = functions.Find<fmi3InstantiateCoSimulationTYPE>("fmi3InstantiateCoSimulation")(
        "test", token.c_str(), (folder / "resources").c_str(), false, false, false, false, nullptr,
        0, this, &Host::Log, nullptr);
  }
  Host(const Host&) = delete;
  Host& operator=(const Host&) = delete;
  ~Host() { functions_.Find<fmi3FreeInstanceTYPE>("fmi3FreeInstance")(instance_); }

  [[nodiscard]] bool exists() const { return instance_ != nullptr; }
  /// All messages of errors since the last call.
  std::string TakeMessages() { return std::exchange(messages_, ""); }

  fmi3Status EnterInitialization(double start = 0.0) {
    return functions_.Find<fmi3EnterInitializationModeTYPE>("fmi3EnterInitializationMode")(
        instance_, false, 0.0, start, false, 0.0);
  }
  fmi3Status ExitInitialization() { return Call("fmi3ExitInitializationMode"); }
  fmi3Status Initialize() {
    const fmi3Status entered = EnterInitialization();
    return entered == fmi3OK ? ExitInitialization() : entered;
  }
  /// Calls a function without further arguments.
  fmi3Status Call(const char* name) {
    return functions_.Find<fmi3ExitInitializationModeTYPE>(name)(instance_);
  }

  fmi3Status Step(double time, double step) {
    using Function = fmi3Status(fmi3Instance, double, double, bool, bool*, bool*, bool*, double*);
    bool event = false;
    bool early = false;
    return functions_.Find<Function>("fmi3DoStep")(instance_, time, step, true, &event, &ended,
                                                   &early, &time_reached);
  }

  double Get(fmi3ValueReference reference) {
    double value = -12345.0;
    status = functions_.Find<Values>("fmi3GetFloat64")(instance_, &reference, 1, &value, 1);
    return value;
  }
  fmi3Status Set(fmi3ValueReference reference, double value) {
    using Function = fmi3Status(fmi3Instance, const fmi3ValueReference*, std::size_t, const double*,
                                std::size_t);
    return functions_.Find<Function>("fmi3SetFloat64")(instance_, &reference, 1, &value, 1);
  }
  fmi3Status SetBoolean(fmi3ValueReference reference, bool value) {
    using Function =
        fmi3Status(fmi3Instance, const fmi3ValueReference*, std::size_t, const bool*, std::size_t);
    return functions_.Find<Function>("fmi3SetBoolean")(instance_, &reference, 1, &value, 1);
  }
  std::int64_t GetInteger(fmi3ValueReference reference) {
    using Function = fmi3Status(fmi3Instance, const fmi3ValueReference*, std::size_t, std::int64_t*,
                                std::size_t);
    std::int64_t value = -1;
    status = functions_.Find<Function>("fmi3GetInt64")(instance_, &reference, 1, &value, 1);
    return value;
  }

  fmi3FMUState Save() {
    fmi3FMUState state = nullptr;
    using Function = fmi3Status(fmi3Instance, fmi3FMUState*);
    status = functions_.Find<Function>("fmi3GetFMUState")(instance_, &state);
    return state;
  }
  fmi3Status Restore(fmi3FMUState state) {
    using Function = fmi3Status(fmi3Instance, fmi3FMUState);
    return functions_.Find<Function>("fmi3SetFMUState")(instance_, state);
  }
  void Free(fmi3FMUState state) {
    using Function = fmi3Status(fmi3Instance, fmi3FMUState*);
    functions_.Find<Function>("fmi3FreeFMUState")(instance_, &state);
  }
  Bytes Serialize(fmi3FMUState state) {
    using Size = fmi3Status(fmi3Instance, fmi3FMUState, std::size_t*);
    using Function = fmi3Status(fmi3Instance, fmi3FMUState, fmi3Byte*, std::size_t);
    std::size_t size = 0;
    EXPECT_EQ(functions_.Find<Size>("fmi3SerializedFMUStateSize")(instance_, state, &size), fmi3OK);
    Bytes bytes(size);
    EXPECT_EQ(functions_.Find<Function>("fmi3SerializeFMUState")(instance_, state, bytes.data(),
                                                                 bytes.size()),
              fmi3OK);
    return bytes;
  }
  /// Returns null if the bytes are refused.
  fmi3FMUState Deserialize(const Bytes& bytes) {
    using Function = fmi3Status(fmi3Instance, const fmi3Byte*, std::size_t, fmi3FMUState*);
    fmi3FMUState state = nullptr;
    status = functions_.Find<Function>("fmi3DeserializeFMUState")(instance_, bytes.data(),
                                                                  bytes.size(), &state);
    return state;
  }

  bool ended = false;          ///< Whether the last step asked for the end of the simulation.
  double time_reached = 0.0;   ///< By the last step [s].
  fmi3Status status = fmi3OK;  ///< Of the last call that returns something else.

 private:
  static void Log(fmi3InstanceEnvironment environment, fmi3Status status, fmi3String,
                  fmi3String message) {
    auto* const own = static_cast<Host*>(environment);
    if (status == fmi3Error) {
      own->messages_ += own->messages_.empty() ? message : std::string("\n") + message;
    }
  }

  const Functions& functions_;
  fmi3Instance instance_ = nullptr;
  std::string messages_;
};

}  // namespace trackbed::fmu_test
