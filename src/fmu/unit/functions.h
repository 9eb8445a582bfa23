#pragma once

#include <fmt/format.h>

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <utility>

#include "src/fmu/unit/calls.h"

namespace trackbed::fmu {

/// Base of the instances of FMI 2 and FMI 3. The derived type `Own` must define the type `Status`
/// with the constants kOk and kError. The type `Own` must also define kStateName, the name of the
/// argument with a state, and Fail(message), which passes a message to the host.
struct InstanceBase {
  std::unique_ptr<Unit> unit{};
  bool logging = false;
};

/// The bodies of the C functions that FMI 2 and FMI 3 share. A shared function that fails passes a
/// message to the host and returns kError. For a null instance, the shared functions return kError
/// without a message.
template <typename Own>
struct Functions {
  using Status = typename Own::Status;

  /// Calls the function `call` with the instance, and converts an exception to the status kError.
  template <typename Call>
  static Status With(void* instance, const Call& call) noexcept {
    auto* const own = static_cast<Own*>(instance);
    if (own == nullptr) {
      return Own::kError;
    }
    return Guarded([&] { call(*own); }, [&](const std::string& text) { own->Fail(text); })
               ? Own::kOk
               : Own::kError;
  }

  static Status Refuse(void* instance, const char* function) noexcept {
    return With(instance, [&](Own& /*own*/) {
      throw InputError(Problem{.message = std::string(function) + " is not supported"});
    });
  }

  template <typename Value>
  static Status Get(void* instance, Type type, const std::uint32_t* references, std::size_t count,
                    Value* values, std::size_t value_count) noexcept {
    return With(instance, [&](Own& own) {
      RequireSameCount(count, value_count);
      GetAll(*own.unit, type, references, count, values);
    });
  }

  template <typename Value>
  static Status Set(void* instance, Type type, const std::uint32_t* references, std::size_t count,
                    const Value* values, std::size_t value_count) noexcept {
    return With(instance, [&](Own& own) {
      RequireSameCount(count, value_count);
      SetAll(*own.unit, type, references, count, values);
    });
  }

  static Status ExitInitialization(void* instance) noexcept {
    return With(instance, [](Own& own) { own.unit->ExitInitialization(); });
  }
  static Status Terminate(void* instance) noexcept {
    return With(instance, [](Own& own) { own.unit->Terminate(); });
  }

  /// Saves the state of the FMU in `state`, which may contain an earlier saved state.
  static Status Save(void* instance, void** state) noexcept {
    return With(instance, [&](Own& own) {
      RequireGiven(state, Own::kStateName);
      Replace(state, own.unit->Save());
    });
  }

  static Status Restore(void* instance, const void* state) noexcept {
    return With(instance, [&](Own& own) {
      RequireGiven(state, Own::kStateName);
      own.unit->Restore(*static_cast<const State*>(state));
    });
  }

  static Status Free(void* instance, void** state) noexcept {
    return With(instance, [&](Own& /*own*/) {
      if (state != nullptr) {
        delete static_cast<State*>(*state);
        *state = nullptr;
      }
    });
  }

  static Status SizeOfSerialized(void* instance, const void* state, std::size_t* size) noexcept {
    return With(instance, [&](Own& own) {
      RequireGiven(state, Own::kStateName);
      RequireGiven(size, "size");
      *size = own.unit->Serialize(*static_cast<const State*>(state)).size();
    });
  }

  static Status Serialize(void* instance, const void* state, void* bytes,
                          std::size_t size) noexcept {
    return With(instance, [&](Own& own) {
      RequireGiven(state, Own::kStateName);
      RequireGiven(bytes, "serializedState");
      CopyTo(own.unit->Serialize(*static_cast<const State*>(state)), bytes, size);
    });
  }

  static Status Deserialize(void* instance, const void* bytes, std::size_t size,
                            void** state) noexcept {
    return With(instance, [&](Own& own) {
      RequireGiven(bytes, "serializedState");
      RequireGiven(state, Own::kStateName);
      Replace(state, own.unit->Deserialize({static_cast<const char*>(bytes), size}));
    });
  }

 private:
  static void Replace(void** target, State state) {
    auto made = std::make_unique<State>(std::move(state));
    delete static_cast<State*>(*target);
    *target = made.release();
  }

  static void RequireSameCount(std::size_t references, std::size_t values) {
    if (references != values) {
      throw InputError(Problem{
          .message = fmt::format("{} value references, but {} values", references, values)});
    }
  }
};

}  // namespace trackbed::fmu
