#include <memory>

#include "src/fmu/fmi2_interface.h"
#include "src/fmu/unit/functions.h"

// The C functions of FMI 2.0 for co-simulation.
namespace {

using trackbed::InputError;
using trackbed::Problem;
using trackbed::fmu::Guarded;
using trackbed::fmu::RequireGiven;
using trackbed::fmu::Type;
using trackbed::fmu::Unit;

struct Instance : trackbed::fmu::InstanceBase {
  using Status = fmi2Status;
  static constexpr Status kOk = fmi2OK;
  static constexpr Status kError = fmi2Error;
  static constexpr const char* kStateName = "FMUstate";

  std::string name;
  fmi2CallbackFunctions functions{};
  double start_time = 0.0;

  void Log(fmi2Status status, const char* category, const std::string& message) const {
    if (functions.logger != nullptr) {
      // Pass the message as an argument of "%s", because the message may contain percent signs.
      functions.logger(functions.componentEnvironment, name.c_str(), status, category, "%s",
                       message.c_str());
    }
  }
  void Fail(const std::string& message) const { Log(fmi2Error, "logStatusError", message); }
};

using Shared = trackbed::fmu::Functions<Instance>;

}  // namespace

extern "C" {

const char* fmi2GetTypesPlatform() {
  return "default";
}

const char* fmi2GetVersion() {
  return "2.0";
}

fmi2Status fmi2SetDebugLogging(fmi2Component component, fmi2Boolean logging, std::size_t,
                               const fmi2String*) {
  return Shared::With(component, [&](Instance& own) { own.logging = logging != 0; });
}

fmi2Component fmi2Instantiate(fmi2String instance_name, fmi2Type type, fmi2String guid,
                              fmi2String resource_location, const fmi2CallbackFunctions* functions,
                              fmi2Boolean /*visible*/, fmi2Boolean logging) {
  std::unique_ptr<Instance> instance;
  const bool made = Guarded(
      [&] {
        instance = std::make_unique<Instance>();
        RequireGiven(functions, "functions");
        instance->functions = *functions;
        instance->logging = logging != 0;
        instance->name = instance_name == nullptr ? "" : instance_name;
        if (type != fmi2CoSimulation) {
          throw InputError(Problem{.message = "this FMU is for co-simulation only"});
        }
        RequireGiven(guid, "fmuGUID");
        RequireGiven(resource_location, "fmuResourceLocation");
        Instance* const own = instance.get();
        own->unit = std::make_unique<Unit>(trackbed::fmu::PathOfUri(resource_location), guid,
                                           [own](const std::string& note) {
                                             if (own->logging) {
                                               own->Log(fmi2Warning, "logStatusWarning", note);
                                             }
                                           });
      },
      [&](const std::string& text) {
        if (instance != nullptr) {
          instance->Fail(text);
        }
      });
  return made ? instance.release() : nullptr;
}

void fmi2FreeInstance(fmi2Component component) {
  delete static_cast<Instance*>(component);
}

fmi2Status fmi2SetupExperiment(fmi2Component component, fmi2Boolean, fmi2Real, fmi2Real start_time,
                               fmi2Boolean, fmi2Real) {
  return Shared::With(component, [&](Instance& own) { own.start_time = start_time; });
}

fmi2Status fmi2EnterInitializationMode(fmi2Component component) {
  return Shared::With(component,
                      [](Instance& own) { own.unit->EnterInitialization(own.start_time); });
}

fmi2Status fmi2ExitInitializationMode(fmi2Component component) {
  return Shared::ExitInitialization(component);
}

fmi2Status fmi2Terminate(fmi2Component component) {
  return Shared::Terminate(component);
}

fmi2Status fmi2Reset(fmi2Component component) {
  return Shared::With(component, [](Instance& own) {
    own.unit->Reset();
    own.start_time = 0.0;
  });
}

fmi2Status fmi2DoStep(fmi2Component component, fmi2Real time, fmi2Real step, fmi2Boolean) {
  bool ended = false;
  const fmi2Status status =
      Shared::With(component, [&](Instance& own) { ended = own.unit->Step(time, step).ended; });
  // Return fmi2Discard if the run has ended: a slave that ends the simulation discards the rest of
  // the step. The function fmi2GetBooleanStatus then reports the termination.
  return status == fmi2OK && ended ? fmi2Discard : status;
}

fmi2Status fmi2GetReal(fmi2Component component, const fmi2ValueReference* references,
                       std::size_t count, fmi2Real* values) {
  return Shared::Get(component, Type::kReal, references, count, values, count);
}

fmi2Status fmi2SetReal(fmi2Component component, const fmi2ValueReference* references,
                       std::size_t count, const fmi2Real* values) {
  return Shared::Set(component, Type::kReal, references, count, values, count);
}

fmi2Status fmi2GetInteger(fmi2Component component, const fmi2ValueReference* references,
                          std::size_t count, fmi2Integer* values) {
  return Shared::Get(component, Type::kInteger, references, count, values, count);
}

fmi2Status fmi2SetInteger(fmi2Component component, const fmi2ValueReference* references,
                          std::size_t count, const fmi2Integer* values) {
  return Shared::Set(component, Type::kInteger, references, count, values, count);
}

fmi2Status fmi2GetBoolean(fmi2Component component, const fmi2ValueReference* references,
                          std::size_t count, fmi2Boolean* values) {
  return Shared::Get(component, Type::kBoolean, references, count, values, count);
}

fmi2Status fmi2SetBoolean(fmi2Component component, const fmi2ValueReference* references,
                          std::size_t count, const fmi2Boolean* values) {
  return Shared::Set(component, Type::kBoolean, references, count, values, count);
}

fmi2Status fmi2GetString(fmi2Component component, const fmi2ValueReference*, std::size_t,
                         fmi2String*) {
  return Shared::Refuse(component, "fmi2GetString");
}

fmi2Status fmi2SetString(fmi2Component component, const fmi2ValueReference*, std::size_t,
                         const fmi2String*) {
  return Shared::Refuse(component, "fmi2SetString");
}

fmi2Status fmi2GetFMUstate(fmi2Component component, fmi2FMUstate* state) {
  return Shared::Save(component, state);
}

fmi2Status fmi2SetFMUstate(fmi2Component component, fmi2FMUstate state) {
  return Shared::Restore(component, state);
}

fmi2Status fmi2FreeFMUstate(fmi2Component component, fmi2FMUstate* state) {
  return Shared::Free(component, state);
}

fmi2Status fmi2SerializedFMUstateSize(fmi2Component component, fmi2FMUstate state,
                                      std::size_t* size) {
  return Shared::SizeOfSerialized(component, state, size);
}

fmi2Status fmi2SerializeFMUstate(fmi2Component component, fmi2FMUstate state, fmi2Byte* bytes,
                                 std::size_t size) {
  return Shared::Serialize(component, state, bytes, size);
}

fmi2Status fmi2DeSerializeFMUstate(fmi2Component component, const fmi2Byte* bytes, std::size_t size,
                                   fmi2FMUstate* state) {
  return Shared::Deserialize(component, bytes, size, state);
}

fmi2Status fmi2GetDirectionalDerivative(fmi2Component component, const fmi2ValueReference*,
                                        std::size_t, const fmi2ValueReference*, std::size_t,
                                        const fmi2Real*, fmi2Real*) {
  return Shared::Refuse(component, "fmi2GetDirectionalDerivative");
}

fmi2Status fmi2SetRealInputDerivatives(fmi2Component component, const fmi2ValueReference*,
                                       std::size_t, const fmi2Integer*, const fmi2Real*) {
  return Shared::Refuse(component, "fmi2SetRealInputDerivatives");
}

fmi2Status fmi2GetRealOutputDerivatives(fmi2Component component, const fmi2ValueReference*,
                                        std::size_t, const fmi2Integer*, fmi2Real*) {
  return Shared::Refuse(component, "fmi2GetRealOutputDerivatives");
}

fmi2Status fmi2CancelStep(fmi2Component component) {
  return Shared::Refuse(component, "fmi2CancelStep");
}

fmi2Status fmi2GetStatus(fmi2Component component, fmi2StatusKind, fmi2Status*) {
  return Shared::Refuse(component, "fmi2GetStatus");
}

fmi2Status fmi2GetRealStatus(fmi2Component component, fmi2StatusKind kind, fmi2Real* value) {
  return Shared::With(component, [&](Instance& own) {
    RequireGiven(value, "value");
    if (kind != fmi2LastSuccessfulTime) {
      throw InputError(Problem{.message = "the only real status is fmi2LastSuccessfulTime"});
    }
    *value = own.unit->Present().time;
  });
}

fmi2Status fmi2GetIntegerStatus(fmi2Component component, fmi2StatusKind, fmi2Integer*) {
  return Shared::Refuse(component, "fmi2GetIntegerStatus");
}

fmi2Status fmi2GetBooleanStatus(fmi2Component component, fmi2StatusKind kind, fmi2Boolean* value) {
  return Shared::With(component, [&](Instance& own) {
    RequireGiven(value, "value");
    if (kind != fmi2Terminated) {
      throw InputError(Problem{.message = "the only Boolean status is fmi2Terminated"});
    }
    *value = own.unit->Present().ended ? 1 : 0;
  });
}

fmi2Status fmi2GetStringStatus(fmi2Component component, fmi2StatusKind, fmi2String*) {
  return Shared::Refuse(component, "fmi2GetStringStatus");
}

}  // extern "C"
