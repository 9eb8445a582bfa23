#pragma once

#include <chrono>
#include <optional>
#include <string>

namespace trackbed::cli {

/// A progress bar in one line on stderr. After two seconds, the progress bar shows the remaining
/// time. The bar is not printed if stderr is not a terminal, or if `quiet`.
class ProgressBar {
 public:
  ProgressBar(std::string label, bool quiet);
  ProgressBar(const ProgressBar&) = delete;
  ProgressBar& operator=(const ProgressBar&) = delete;
  ~ProgressBar();  ///< the destructor clears the line

  void Show(double fraction);

 private:
  struct Moment {
    std::chrono::steady_clock::time_point time;
    double fraction;
  };

  /// The text ", 12 s left", or an empty text.
  std::string TimeLeft(double fraction);

  std::string label_;
  bool visible_;
  std::optional<Moment> begun_;  ///< time of the first progress; earlier work does not count for
                                 ///< the speed
};

}  // namespace trackbed::cli
