#pragma once

#include <chrono>
#include <optional>
#include <string>

namespace trackbed::cli {

/// Progress bar in one line on stderr, with the remaining time after two seconds. Prints nothing if
/// stderr is not a terminal, or if `quiet`.
class ProgressBar {
 public:
  ProgressBar(std::string label, bool quiet);
  ProgressBar(const ProgressBar&) = delete;
  ProgressBar& operator=(const ProgressBar&) = delete;
  ~ProgressBar();  ///< clears the line

  void Show(double fraction);

 private:
  struct Moment {
    std::chrono::steady_clock::time_point time;
    double fraction;
  };

  /// ", 12 s left", or an empty string.
  std::string TimeLeft(double fraction);

  std::string label_;
  bool visible_;
  std::optional<Moment> begun_;  ///< first progress; earlier work does not count for the speed
};

}  // namespace trackbed::cli
