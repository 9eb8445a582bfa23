#pragma once

#include <chrono>
#include <optional>
#include <string>

namespace trackbed::cli {

/// One line on stderr that fills up, with the time left once two seconds tell how fast it goes;
/// nothing at all unless stderr is a terminal and not `quiet`.
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

  /// ", 12 s left", or nothing.
  std::string TimeLeft(double fraction);

  std::string label_;
  bool visible_;
  std::optional<Moment> begun_;  ///< the first progress: what was done before tells no speed
};

}  // namespace trackbed::cli
