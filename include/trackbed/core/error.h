#pragma once

#include <fmt/format.h>

#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

/// Four kinds of failure, and who has to act on each:
///  * InputError: what the user gave is wrong (a file, an option, a model). Exit code 2.
///  * RunError: the surroundings failed (a full disk, an unwritable folder, no encoder). Exit
///  code 2.
///  * PreconditionError: a program called a function of the library with an argument that the
///  function does not take; a bug in the calling program.
///  * InternalError: a check of our own failed; a bug in Trackbed. Exit code 1.
/// That a plan cannot be found or a drive ends early is no error but an outcome: see PlanStatus and
/// DriveStatus.
namespace trackbed {

/// One thing wrong with an input, placed where the user can find it.
struct Problem {
  std::string file{};     ///< as the user named it; empty when there is no file
  int line = 0;           ///< 1-based; 0 when unknown
  int column = 0;         ///< 1-based; 0 when unknown
  std::string key{};      ///< dotted key, such as "mission.waypoints[2]"; may be empty
  std::string message{};  ///< what was found and what is allowed

  /// "file:line:column: key: message", leaving out what is unknown.
  [[nodiscard]] std::string ToString() const;
};

/// Bad input. `what()` lists every problem, one line each.
class InputError : public std::runtime_error {
 public:
  explicit InputError(std::vector<Problem> problems);
  explicit InputError(Problem problem) : InputError(std::vector<Problem>{std::move(problem)}) {}

  [[nodiscard]] const std::vector<Problem>& problems() const { return problems_; }

 private:
  std::vector<Problem> problems_;
};

/// The surroundings did not do what they were asked to: `what()` is one line for the user.
class RunError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// A bad argument: `what()` names the function, the argument, its value and what is allowed.
class PreconditionError : public std::invalid_argument {
 public:
  using std::invalid_argument::invalid_argument;
};

/// A bug: a condition that the program's own logic guarantees did not hold.
class InternalError : public std::logic_error {
 public:
  using std::logic_error::logic_error;
};

[[noreturn]] void ThrowPreconditionError(const std::string& message);

[[noreturn]] void ThrowInternalError(const char* file, int line, const char* condition,
                                     const std::string& message);

}  // namespace trackbed

/// Throws PreconditionError when `condition`, which concerns an argument of the caller's, is false.
/// The rest is an fmt message.
#define TRACKBED_REQUIRE(condition, ...)                              \
  do {                                                                \
    if (!(condition))                                                 \
      ::trackbed::ThrowPreconditionError(::fmt::format(__VA_ARGS__)); \
  } while (false)

/// Throws InternalError when `condition` is false, in every build type. The rest is an fmt message.
#define TRACKBED_CHECK(condition, ...)                                                            \
  do {                                                                                            \
    if (!(condition))                                                                             \
      ::trackbed::ThrowInternalError(__FILE__, __LINE__, #condition, ::fmt::format(__VA_ARGS__)); \
  } while (false)
