#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

/// Checks the options of a registered method, and reads the files that the options name. Keys are
/// relative to the section of the method: "segments[2].curvature" for the key
/// "plan.segments[2].curvature".
namespace trackbed {

/// A problem in the options of a method, reported for the key that the user should change.
struct OptionProblem {
  std::string key;
  std::string message;  ///< Message with the invalid value and the allowed values.
};

/// Function that returns whether the value of a key could be read. The reader has already reported
/// an unreadable key, so further checks of the key are skipped.
using CouldReadKey = std::function<bool(const std::string& key)>;

/// A file that the options name, with the content that is stored in the run folder.
struct InputFile {
  std::string name;     ///< Name of the file in the run folder, such as "path.csv".
  std::string content;  ///< Content of the file in the run folder.
  /// The kind of the file and the file's name in the options, such as "path lane.csv".
  std::string source;
};

/// Reads the files that the options name, and collects the problems of reading.
class InputReader {
 public:
  /// Function that reads a file and reports problems. If the function throws InputError or
  /// RunError, the error is added to the problems.
  using Read = std::function<void(const std::filesystem::path& file)>;

  virtual ~InputReader() = default;

  [[nodiscard]] virtual bool CouldRead(const std::string& key) const = 0;
  /// Whether the scenario replays a recorded drive.
  [[nodiscard]] virtual bool has_record() const = 0;
  virtual void AddError(const std::string& key, std::string message) = 0;
  /// Calls `read` with the path of the file `name`, where `name` is the value of `key`. If the file
  /// must not or cannot be read, adds a problem for `key`. A Problem that `read` reports for a file
  /// keeps its position in the file. If `read` reports a Problem for a key other than `key`, the
  /// Problem is added for the reported key.
  virtual void ReadFile(const std::string& key, const std::string& name, const Read& read) = 0;
};

/// Wraps a function whose argument is one options struct, so that the function can be called with
/// MethodOptions. Further arguments of the wrapper, which must be references, are passed to the
/// wrapped function.
template <typename Options, auto Function>
inline constexpr auto OnOptions = [](auto& options, auto&... arguments) {
  return Function(options.template Get<Options>(), arguments...);
};

}  // namespace trackbed
