#include <memory>

#include "src/fmu/fmi3_interface.h"
#include "src/fmu/unit/functions.h"

// The C functions of FMI 3.0 for co-simulation.
// 1. Each C function checks its arguments, and calls a function of the class Functions<Instance>,
//    which the FMI 2 interface also uses.
// 2. Functions<Instance> converts exceptions to messages of the host's log and to the status
//    "error".
// 3. FMI 3 also requires functions for other kinds of simulation and for unused variable types,
//    which fail with a message.
namespace {

using trackbed::InputError;
using trackbed::Problem;
using trackbed::fmu::Guarded;
using trackbed::fmu::RequireGiven;
using trackbed::fmu::Type;
using trackbed::fmu::Unit;

struct Instance : trackbed::fmu::InstanceBase {
  using Status = fmi3Status;
  static constexpr Status kOk = fmi3OK;
  static constexpr Status kError = fmi3Error;
  static constexpr const char* kStateName = "FMUState";

  fmi3InstanceEnvironment environment = nullptr;
  fmi3LogMessageCallback log = nullptr;

  void Log(fmi3Status status, const char* category, const std::string& message) const {
    if (log != nullptr) {
      log(environment, status, category, message.c_str());
    }
  }
  void Fail(const std::string& message) const { Log(fmi3Error, "logStatusError", message); }
};

using Shared = trackbed::fmu::Functions<Instance>;

/// Defines a C function that always fails, with the given parameter types.
#define TRACKBED_REFUSE(name, ...)                      \
  fmi3Status name(fmi3Instance instance, __VA_ARGS__) { \
    return Shared::Refuse(instance, #name);             \
  }
#define TRACKBED_REFUSE_PLAIN(name)         \
  fmi3Status name(fmi3Instance instance) {  \
    return Shared::Refuse(instance, #name); \
  }
/// Defines failing C functions to get and set values of a type that no variable has.
#define TRACKBED_REFUSE_TYPE(name)                                                                 \
  TRACKBED_REFUSE(fmi3Get##name, const fmi3ValueReference*, std::size_t, fmi3##name*, std::size_t) \
  TRACKBED_REFUSE(fmi3Set##name, const fmi3ValueReference*, std::size_t, const fmi3##name*,        \
                  std::size_t)

}  // namespace

extern "C" {

const char* fmi3GetVersion() {
  return "3.0";
}

fmi3Status fmi3SetDebugLogging(fmi3Instance instance, fmi3Boolean logging, std::size_t,
                               const fmi3String*) {
  return Shared::With(instance, [&](Instance& own) { own.logging = logging; });
}

fmi3Instance fmi3InstantiateCoSimulation(
    fmi3String /*instance_name*/, fmi3String token, fmi3String resource_path,
    fmi3Boolean /*visible*/, fmi3Boolean logging, fmi3Boolean event_mode,
    fmi3Boolean /*early_return*/, const fmi3ValueReference* /*intermediate_variables*/,
    std::size_t intermediate_count, fmi3InstanceEnvironment environment, fmi3LogMessageCallback log,
    fmi3IntermediateUpdateCallback /*update*/) {
  std::unique_ptr<Instance> instance;
  const bool made = Guarded(
      [&] {
        instance = std::make_unique<Instance>();
        instance->logging = logging;
        instance->environment = environment;
        instance->log = log;
        if (event_mode || intermediate_count > 0) {
          throw InputError(
              Problem{.message = "the event mode and intermediate variables are not supported"});
        }
        RequireGiven(token, "instantiationToken");
        RequireGiven(resource_path, "resourcePath");
        Instance* const own = instance.get();
        own->unit = std::make_unique<Unit>(resource_path, token, [own](const std::string& note) {
          if (own->logging) {
            own->Log(fmi3Warning, "logStatusWarning", note);
          }
        });
      },
      [&](const std::string& text) {
        if (log != nullptr) {
          log(environment, fmi3Error, "logStatusError", text.c_str());
        }
      });
  return made ? instance.release() : nullptr;
}

fmi3Instance fmi3InstantiateModelExchange(fmi3String, fmi3String, fmi3String, fmi3Boolean,
                                          fmi3Boolean, fmi3InstanceEnvironment environment,
                                          fmi3LogMessageCallback log) {
  if (log != nullptr) {
    log(environment, fmi3Error, "logStatusError", "this FMU is for co-simulation only");
  }
  return nullptr;
}

fmi3Instance fmi3InstantiateScheduledExecution(fmi3String, fmi3String, fmi3String, fmi3Boolean,
                                               fmi3Boolean, fmi3InstanceEnvironment environment,
                                               fmi3LogMessageCallback log, fmi3ClockUpdateCallback,
                                               fmi3LockPreemptionCallback,
                                               fmi3UnlockPreemptionCallback) {
  return fmi3InstantiateModelExchange(nullptr, nullptr, nullptr, false, false, environment, log);
}

void fmi3FreeInstance(fmi3Instance instance) {
  delete static_cast<Instance*>(instance);
}

fmi3Status fmi3EnterInitializationMode(fmi3Instance instance, fmi3Boolean, fmi3Float64,
                                       fmi3Float64 start_time, fmi3Boolean, fmi3Float64) {
  return Shared::With(instance, [&](Instance& own) { own.unit->EnterInitialization(start_time); });
}

fmi3Status fmi3ExitInitializationMode(fmi3Instance instance) {
  return Shared::ExitInitialization(instance);
}

fmi3Status fmi3Terminate(fmi3Instance instance) {
  return Shared::Terminate(instance);
}

fmi3Status fmi3Reset(fmi3Instance instance) {
  return Shared::With(instance, [](Instance& own) { own.unit->Reset(); });
}

fmi3Status fmi3DoStep(fmi3Instance instance, fmi3Float64 time, fmi3Float64 step, fmi3Boolean,
                      fmi3Boolean* event_handling_needed, fmi3Boolean* terminate_simulation,
                      fmi3Boolean* early_return, fmi3Float64* last_successful_time) {
  return Shared::With(instance, [&](Instance& own) {
    RequireGiven(event_handling_needed, "eventHandlingNeeded");
    RequireGiven(terminate_simulation, "terminateSimulation");
    RequireGiven(early_return, "earlyReturn");
    RequireGiven(last_successful_time, "lastSuccessfulTime");
    const trackbed::fmu::StepEnd end = own.unit->Step(time, step);
    *event_handling_needed = false;
    *terminate_simulation = end.ended;
    *early_return = false;
    *last_successful_time = end.time;
  });
}

fmi3Status fmi3GetFloat64(fmi3Instance instance, const fmi3ValueReference* references,
                          std::size_t count, fmi3Float64* values, std::size_t value_count) {
  return Shared::Get(instance, Type::kReal, references, count, values, value_count);
}

fmi3Status fmi3SetFloat64(fmi3Instance instance, const fmi3ValueReference* references,
                          std::size_t count, const fmi3Float64* values, std::size_t value_count) {
  return Shared::Set(instance, Type::kReal, references, count, values, value_count);
}

fmi3Status fmi3GetInt64(fmi3Instance instance, const fmi3ValueReference* references,
                        std::size_t count, fmi3Int64* values, std::size_t value_count) {
  return Shared::Get(instance, Type::kInteger, references, count, values, value_count);
}

fmi3Status fmi3SetInt64(fmi3Instance instance, const fmi3ValueReference* references,
                        std::size_t count, const fmi3Int64* values, std::size_t value_count) {
  return Shared::Set(instance, Type::kInteger, references, count, values, value_count);
}

fmi3Status fmi3GetBoolean(fmi3Instance instance, const fmi3ValueReference* references,
                          std::size_t count, fmi3Boolean* values, std::size_t value_count) {
  return Shared::Get(instance, Type::kBoolean, references, count, values, value_count);
}

fmi3Status fmi3SetBoolean(fmi3Instance instance, const fmi3ValueReference* references,
                          std::size_t count, const fmi3Boolean* values, std::size_t value_count) {
  return Shared::Set(instance, Type::kBoolean, references, count, values, value_count);
}

fmi3Status fmi3GetFMUState(fmi3Instance instance, fmi3FMUState* state) {
  return Shared::Save(instance, state);
}

fmi3Status fmi3SetFMUState(fmi3Instance instance, fmi3FMUState state) {
  return Shared::Restore(instance, state);
}

fmi3Status fmi3FreeFMUState(fmi3Instance instance, fmi3FMUState* state) {
  return Shared::Free(instance, state);
}

fmi3Status fmi3SerializedFMUStateSize(fmi3Instance instance, fmi3FMUState state,
                                      std::size_t* size) {
  return Shared::SizeOfSerialized(instance, state, size);
}

fmi3Status fmi3SerializeFMUState(fmi3Instance instance, fmi3FMUState state, fmi3Byte* bytes,
                                 std::size_t size) {
  return Shared::Serialize(instance, state, bytes, size);
}

fmi3Status fmi3DeserializeFMUState(fmi3Instance instance, const fmi3Byte* bytes, std::size_t size,
                                   fmi3FMUState* state) {
  return Shared::Deserialize(instance, bytes, size, state);
}

TRACKBED_REFUSE_TYPE(Float32)
TRACKBED_REFUSE_TYPE(Int8)
TRACKBED_REFUSE_TYPE(UInt8)
TRACKBED_REFUSE_TYPE(Int16)
TRACKBED_REFUSE_TYPE(UInt16)
TRACKBED_REFUSE_TYPE(Int32)
TRACKBED_REFUSE_TYPE(UInt32)
TRACKBED_REFUSE_TYPE(UInt64)
TRACKBED_REFUSE_TYPE(String)
TRACKBED_REFUSE(fmi3GetBinary, const fmi3ValueReference*, std::size_t, std::size_t*, fmi3Binary*,
                std::size_t)
TRACKBED_REFUSE(fmi3SetBinary, const fmi3ValueReference*, std::size_t, const std::size_t*,
                const fmi3Binary*, std::size_t)
TRACKBED_REFUSE(fmi3GetClock, const fmi3ValueReference*, std::size_t, fmi3Clock*)
TRACKBED_REFUSE(fmi3SetClock, const fmi3ValueReference*, std::size_t, const fmi3Clock*)
TRACKBED_REFUSE(fmi3GetNumberOfVariableDependencies, fmi3ValueReference, std::size_t*)
TRACKBED_REFUSE(fmi3GetVariableDependencies, fmi3ValueReference, std::size_t*, fmi3ValueReference*,
                std::size_t*, fmi3DependencyKind*, std::size_t)
TRACKBED_REFUSE(fmi3GetDirectionalDerivative, const fmi3ValueReference*, std::size_t,
                const fmi3ValueReference*, std::size_t, const fmi3Float64*, std::size_t,
                fmi3Float64*, std::size_t)
TRACKBED_REFUSE(fmi3GetAdjointDerivative, const fmi3ValueReference*, std::size_t,
                const fmi3ValueReference*, std::size_t, const fmi3Float64*, std::size_t,
                fmi3Float64*, std::size_t)
TRACKBED_REFUSE_PLAIN(fmi3EnterConfigurationMode)
TRACKBED_REFUSE_PLAIN(fmi3ExitConfigurationMode)
TRACKBED_REFUSE_PLAIN(fmi3EnterEventMode)
TRACKBED_REFUSE(fmi3GetIntervalDecimal, const fmi3ValueReference*, std::size_t, fmi3Float64*,
                fmi3IntervalQualifier*)
TRACKBED_REFUSE(fmi3GetIntervalFraction, const fmi3ValueReference*, std::size_t, fmi3UInt64*,
                fmi3UInt64*, fmi3IntervalQualifier*)
TRACKBED_REFUSE(fmi3GetShiftDecimal, const fmi3ValueReference*, std::size_t, fmi3Float64*)
TRACKBED_REFUSE(fmi3GetShiftFraction, const fmi3ValueReference*, std::size_t, fmi3UInt64*,
                fmi3UInt64*)
TRACKBED_REFUSE(fmi3SetIntervalDecimal, const fmi3ValueReference*, std::size_t, const fmi3Float64*)
TRACKBED_REFUSE(fmi3SetIntervalFraction, const fmi3ValueReference*, std::size_t, const fmi3UInt64*,
                const fmi3UInt64*)
TRACKBED_REFUSE(fmi3SetShiftDecimal, const fmi3ValueReference*, std::size_t, const fmi3Float64*)
TRACKBED_REFUSE(fmi3SetShiftFraction, const fmi3ValueReference*, std::size_t, const fmi3UInt64*,
                const fmi3UInt64*)
TRACKBED_REFUSE_PLAIN(fmi3EvaluateDiscreteStates)
TRACKBED_REFUSE(fmi3UpdateDiscreteStates, fmi3Boolean*, fmi3Boolean*, fmi3Boolean*, fmi3Boolean*,
                fmi3Boolean*, fmi3Float64*)
TRACKBED_REFUSE_PLAIN(fmi3EnterContinuousTimeMode)
TRACKBED_REFUSE(fmi3CompletedIntegratorStep, fmi3Boolean, fmi3Boolean*, fmi3Boolean*)
TRACKBED_REFUSE(fmi3SetTime, fmi3Float64)
TRACKBED_REFUSE(fmi3SetContinuousStates, const fmi3Float64*, std::size_t)
TRACKBED_REFUSE(fmi3GetContinuousStateDerivatives, fmi3Float64*, std::size_t)
TRACKBED_REFUSE(fmi3GetEventIndicators, fmi3Float64*, std::size_t)
TRACKBED_REFUSE(fmi3GetContinuousStates, fmi3Float64*, std::size_t)
TRACKBED_REFUSE(fmi3GetNominalsOfContinuousStates, fmi3Float64*, std::size_t)
TRACKBED_REFUSE(fmi3GetNumberOfEventIndicators, std::size_t*)
TRACKBED_REFUSE(fmi3GetNumberOfContinuousStates, std::size_t*)
TRACKBED_REFUSE_PLAIN(fmi3EnterStepMode)
TRACKBED_REFUSE(fmi3GetOutputDerivatives, const fmi3ValueReference*, std::size_t, const fmi3Int32*,
                fmi3Float64*, std::size_t)
TRACKBED_REFUSE(fmi3ActivateModelPartition, fmi3ValueReference, fmi3Float64)

}  // extern "C"
