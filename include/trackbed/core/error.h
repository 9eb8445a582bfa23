#pragma once

#include <fmt/format.h>

#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

/// The library reports four kinds of failure, which differ in who has to act.
///   InputError: the user's input is wrong (a file, an option, a model); exit code 2.
///   RunError: the environment failed (a full disk, an unwritable folder, no encoder); exit code 2.
///   PreconditionError: the calling program passed an invalid argument to a function of the
///   library; a bug in the calling program.
///   InternalError: an internal check failed; a bug in Trackbed; exit code 1.
/// Two kinds of failure are results, not exceptions: a planner that finds no plan (PlanStatus), and
/// a run that ends early (DriveStatus).
namespace trackbed {

/// One problem in an input of the user, and the position of the problem in the file.
struct Problem {
  std::string file{};     ///< File name as the user gave it; empty if there is no file.
  int line = 0;           ///< Line number from 1; 0 if unknown.
  int column = 0;         ///< Column number from 1; 0 if unknown.
  std::string key{};      ///< Dotted key, such as "mission.waypoints[2]"; may be empty.
  std::string message{};  ///< Message with the invalid value and the allowed values.

  /// Formats the problem as "file:line:column: key: message", on one line. The text omits unknown
  /// parts of the position and replaces control characters (WithoutControls). Truncates a key or
  /// message after 4000 bytes.
  [[nodiscard]] std::string ToString() const;
  /// Formats the problem as "key: message", without the file and the position in the file.
  [[nodiscard]] std::string WithoutPlace() const;
};

/// Invalid input from the user. The text `what()` lists every problem on a separate line.
class InputError : public std::runtime_error {
 public:
  explicit InputError(std::vector<Problem> problems);
  explicit InputError(Problem problem) : InputError(std::vector<Problem>{std::move(problem)}) {}

  [[nodiscard]] const std::vector<Problem>& problems() const { return problems_; }

 private:
  std::vector<Problem> problems_;
};

/// A failure of the environment, such as a full disk. The text `what()` is a message of one line
/// for the user.
class RunError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// An invalid argument. The text `what()` names the function, the invalid argument, the argument's
/// value and the allowed values.
class PreconditionError : public std::invalid_argument {
 public:
  using std::invalid_argument::invalid_argument;
};

/// A bug in Trackbed: an invariant of the program does not hold.
class InternalError : public std::logic_error {
 public:
  using std::logic_error::logic_error;
};

/// Makes text safe for terminals and text files. Replaces invisible characters (IsInvisible) by
/// their codes, such as "<U+001B>". Replaces bytes that are not UTF-8 by their values, such as
/// "<0xFF>". WithoutControls is needed because file names and keys may come from untrusted sources.
std::string WithoutControls(std::string_view text);

[[noreturn]] void ThrowPreconditionError(const std::string& message);

[[noreturn]] void ThrowInternalError(const char* file, int line, const char* condition,
                                     const std::string& message);

}  // namespace trackbed

/// Throws PreconditionError if `condition`, which states a requirement on a caller's argument, is
/// false. The remaining arguments are an fmt format string and its arguments, for the error
/// message.
#define TRACKBED_REQUIRE(condition, ...)                              \
  do {                                                                \
    if (!(condition))                                                 \
      ::trackbed::ThrowPreconditionError(::fmt::format(__VA_ARGS__)); \
  } while (false)

/// Throws InternalError when `condition` is false, in every build type. The remaining arguments are
/// an fmt format string and its arguments, for the error message.
#define TRACKBED_CHECK(condition, ...)                                                            \
  do {                                                                                            \
    if (!(condition))                                                                             \
      ::trackbed::ThrowInternalError(__FILE__, __LINE__, #condition, ::fmt::format(__VA_ARGS__)); \
  } while (false)
