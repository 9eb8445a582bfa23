#pragma once

#include <chrono>
#include <optional>
#include <string>

namespace trackbed::cli {

/// A progress bar that occupies one line on stderr. After two seconds, the progress bar shows the
/// remaining time. The bar is not printed if stderr is not a terminal, or if `quiet` is set.
class ProgressBar {
 public:
  ProgressBar(std::string label, bool quiet);
  ProgressBar(const ProgressBar&) = delete;
  ProgressBar& operator=(const ProgressBar&) = delete;
  ~ProgressBar();  ///< clears the line with the progress bar

  void Show(double fraction);

 private:
  struct Moment {
    std::chrono::steady_clock::time_point time;
    double fraction;
  };

  /// Returns the remaining time as a text such as ", 12 s left", or an empty text if no estimate
  /// exists yet.
  std::string TimeLeft(double fraction);

  std::string label_;
  bool visible_;
  // Time and fraction of the first call of Show with a positive fraction. The estimate of the
  // remaining time uses only the progress after this first call.
  std::optional<Moment> begun_;
};

}  // namespace trackbed::cli
