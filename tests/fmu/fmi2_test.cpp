#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdarg>
#include <filesystem>
#include <string>
#include <vector>

#include "src/fmu/contents.h"
#include "src/fmu/fmi2_interface.h"
#include "src/fmu/resources.h"
#include "src/fmu/shared_library.h"
#include "src/fmu/variables.h"
#include "tests/support/temp_folder.h"
#include "trackbed/core/error.h"

// The C functions of FMI 2, whose arguments and results differ from those of FMI 3. The simulation
// behind them is the same (export_test.cpp).
namespace trackbed::fmi2_test {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

class Fmi2 : public testing::Test {
 protected:
  Fmi2() : library_(fmu::FindLibrary()) {
    const fs::path file = fs::path(TRACKBED_SOURCE_DIR) / "scenarios/three_turns.yaml";
    const Scenario scenario =
        fmu::ScenarioOfFmu(ReadScenario(file, {"drive.time_limit=1"}), "kinematic");
    const fmu::Resources resources = fmu::MakeResources(scenario);
    token_ = fmu::TokenOf(resources);
    // A space and a percent sign, which a URI has as %20 and %25.
    for (const auto& [name, content] : resources) {
      folder_.Write("a %b/" + name, content);
    }
  }

  /// Returns the URI of the resources.
  [[nodiscard]] std::string Uri() const {
    return "file://" + folder_.path().string() + "/a%20%25b";
  }

  fmi2Component Instantiate(const std::string& uri, fmi2Type type = fmi2CoSimulation) {
    using Function = fmi2Component(fmi2String, fmi2Type, fmi2String, fmi2String,
                                   const fmi2CallbackFunctions*, fmi2Boolean, fmi2Boolean);
    callbacks_.logger = &Fmi2::Log;
    callbacks_.componentEnvironment = &messages_;
    return library_.Find<Function>("fmi2Instantiate")("test", type, token_.c_str(), uri.c_str(),
                                                      &callbacks_, 0, 0);
  }

  fmi2Status Call(const char* name, fmi2Component component) {
    return library_.Find<fmi2Status(fmi2Component)>(name)(component);
  }
  void Free(fmi2Component component) {
    library_.Find<void(fmi2Component)>("fmi2FreeInstance")(component);
  }
  fmi2Status Step(fmi2Component component, double time, double step) {
    using Function = fmi2Status(fmi2Component, double, double, fmi2Boolean);
    return library_.Find<Function>("fmi2DoStep")(component, time, step, 1);
  }
  double Time(fmi2Component component) {
    using Function = fmi2Status(fmi2Component, const fmi2ValueReference*, std::size_t, double*);
    const fmi2ValueReference reference = fmu::kTime;
    double value = -1.0;
    EXPECT_EQ(library_.Find<Function>("fmi2GetReal")(component, &reference, 1, &value), fmi2OK);
    return value;
  }

  const TempFolder folder_;
  fmu::SharedLibrary library_;
  std::string token_;
  fmi2CallbackFunctions callbacks_{};
  std::string messages_;

 private:
  static void Log(fmi2ComponentEnvironment environment, fmi2String, fmi2Status, fmi2String,
                  fmi2String format, ...) {
    EXPECT_STREQ(format, "%s");
    va_list arguments;
    va_start(arguments, format);
    *static_cast<std::string*>(environment) += va_arg(arguments, const char*);
    va_end(arguments);
  }
};

TEST_F(Fmi2, DiscardsTheStepInWhichTheRunEnds) {
  fmi2Component component = Instantiate(Uri());
  ASSERT_NE(component, nullptr) << messages_;
  ASSERT_EQ(Call("fmi2EnterInitializationMode", component), fmi2OK) << messages_;
  ASSERT_EQ(Call("fmi2ExitInitializationMode", component), fmi2OK) << messages_;
  using Flag = fmi2Status(fmi2Component, fmi2StatusKind, fmi2Boolean*);
  fmi2Boolean ended = -1;
  EXPECT_EQ(Step(component, 0.0, 0.02), fmi2OK) << messages_;
  library_.Find<Flag>("fmi2GetBooleanStatus")(component, fmi2Terminated, &ended);
  EXPECT_EQ(ended, 0);
  // The run lasts 1 s.
  EXPECT_EQ(Step(component, 0.02, 2.0), fmi2Discard);
  library_.Find<Flag>("fmi2GetBooleanStatus")(component, fmi2Terminated, &ended);
  EXPECT_EQ(ended, 1);
  using Number = fmi2Status(fmi2Component, fmi2StatusKind, double*);
  double last = -1.0;
  library_.Find<Number>("fmi2GetRealStatus")(component, fmi2LastSuccessfulTime, &last);
  EXPECT_EQ(last, 1.0);
  EXPECT_EQ(messages_, "");
  EXPECT_EQ(Step(component, 1.0, 0.02), fmi2Error);
  EXPECT_THAT(messages_, HasSubstr("the run ended at 1 s (time_limit)"));
  Free(component);
}

TEST_F(Fmi2, ReturnsToASerializedState) {
  fmi2Component component = Instantiate(Uri());
  ASSERT_NE(component, nullptr) << messages_;
  Call("fmi2EnterInitializationMode", component);
  Call("fmi2ExitInitializationMode", component);
  ASSERT_EQ(Step(component, 0.0, 0.2), fmi2OK) << messages_;
  fmi2FMUstate state = nullptr;
  using Get = fmi2Status(fmi2Component, fmi2FMUstate*);
  ASSERT_EQ(library_.Find<Get>("fmi2GetFMUstate")(component, &state), fmi2OK);
  using Size = fmi2Status(fmi2Component, fmi2FMUstate, std::size_t*);
  std::size_t size = 0;
  ASSERT_EQ(library_.Find<Size>("fmi2SerializedFMUstateSize")(component, state, &size), fmi2OK);
  std::vector<fmi2Byte> bytes(size);
  using Write = fmi2Status(fmi2Component, fmi2FMUstate, fmi2Byte*, std::size_t);
  EXPECT_EQ(library_.Find<Write>("fmi2SerializeFMUstate")(component, state, bytes.data(), size - 1),
            fmi2Error);
  EXPECT_THAT(messages_, HasSubstr("there is room for"));
  ASSERT_EQ(library_.Find<Write>("fmi2SerializeFMUstate")(component, state, bytes.data(), size),
            fmi2OK);
  library_.Find<Get>("fmi2FreeFMUstate")(component, &state);
  EXPECT_EQ(state, nullptr);
  ASSERT_EQ(Step(component, 0.2, 0.2), fmi2OK);
  using Read = fmi2Status(fmi2Component, const fmi2Byte*, std::size_t, fmi2FMUstate*);
  ASSERT_EQ(library_.Find<Read>("fmi2DeSerializeFMUstate")(component, bytes.data(), size, &state),
            fmi2OK);
  using Set = fmi2Status(fmi2Component, fmi2FMUstate);
  ASSERT_EQ(library_.Find<Set>("fmi2SetFMUstate")(component, state), fmi2OK);
  library_.Find<Get>("fmi2FreeFMUstate")(component, &state);
  EXPECT_EQ(Time(component), 10 * 0.02);
  Free(component);
}

TEST_F(Fmi2, SaysWhyItDoesNotStart) {
  EXPECT_EQ(Instantiate(Uri(), fmi2ModelExchange), nullptr);
  EXPECT_THAT(messages_, HasSubstr("for co-simulation only"));
  EXPECT_EQ(Instantiate("http://host/resources"), nullptr);
  EXPECT_THAT(messages_, HasSubstr("must begin with file:///"));
  EXPECT_EQ(Instantiate("file:///nowhere"), nullptr);
  EXPECT_THAT(messages_, HasSubstr("/nowhere"));
}

}  // namespace
}  // namespace trackbed::fmi2_test
