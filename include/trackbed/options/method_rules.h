#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

/// The rules and files of a registered method's options. Keys are relative to the section of the
/// method: "segments[2].curvature" for the key "plan.segments[2].curvature".
namespace trackbed {

/// A problem of the options, reported at the key that the user should change.
struct OptionProblem {
  std::string key;
  std::string message;  ///< The value found and the allowed values.
};

/// Whether the value of a key was read. An unreadable key has already been reported, so its checks
/// are skipped.
using CouldReadKey = std::function<bool(const std::string& key)>;

/// A file named in the options, with the content that a run folder stores.
struct InputFile {
  std::string name;     ///< Name in the run folder: "path.csv".
  std::string content;  ///< Content of the file in the run folder.
  std::string source;   ///< The kind of file and its name in the options: "path lane.csv".
};

/// Reads the files that the options name, and collects the problems.
class InputReader {
 public:
  /// Function that reads a file. InputErrors and RunErrors of the function are reported.
  using Read = std::function<void(const std::filesystem::path& file)>;

  virtual ~InputReader() = default;

  [[nodiscard]] virtual bool CouldRead(const std::string& key) const = 0;
  /// Whether the scenario has a recorded drive.
  [[nodiscard]] virtual bool has_record() const = 0;
  virtual void AddError(const std::string& key, std::string message) = 0;
  /// Calls `read` with the location of the file `name`, which is the value of `key`. If the file
  /// may not or cannot be read, reports an error of the key. A Problem that `read` reports for a
  /// file keeps its place in the file; a Problem that `read` reports for another key is reported
  /// under that key.
  virtual void ReadFile(const std::string& key, const std::string& name, const Read& read) = 0;
};

/// Converts a function that takes an options struct to a function that takes the options of any
/// method. Further arguments, which are references, are passed on.
template <typename Options, auto Function>
inline constexpr auto OnOptions = [](auto& options, auto&... arguments) {
  return Function(options.template Get<Options>(), arguments...);
};

}  // namespace trackbed
