#include "src/cli/progress_bar.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>

#include "src/cli/terminal.h"

namespace trackbed::cli {
namespace {

/// Prints a text with plain stdio, which does not throw if the terminal was closed.
void Put(const std::string& text) {
  std::fputs(text.c_str(), stderr);
  std::fflush(stderr);
}

}  // namespace

ProgressBar::ProgressBar(std::string label, bool quiet)
    : label_(SafeLine(label)), visible_(!quiet && ::isatty(STDERR_FILENO) != 0) {
  Show(0.0);
}

ProgressBar::~ProgressBar() {
  if (visible_) {
    Put("\r\x1b[K");
  }
}

void ProgressBar::Show(double fraction) {
  if (!visible_) {
    return;
  }
  constexpr std::size_t kWidth = 32;
  const auto filled =
      static_cast<std::size_t>(std::clamp(fraction, 0.0, 1.0) * static_cast<double>(kWidth));
  Put(fmt::format("\r{} [{}{}] {:3.0f} %{}\x1b[K", label_, std::string(filled, '#'),
                  std::string(kWidth - filled, '.'), fraction * 100.0, TimeLeft(fraction)));
}

std::string ProgressBar::TimeLeft(double fraction) {
  const auto now = std::chrono::steady_clock::now();
  if (!begun_ && fraction > 0.0) {
    begun_ = Moment{now, fraction};
  }
  // Elapsed time [s] before which the remaining time is not estimated, because the estimate would
  // be too inaccurate.
  constexpr double kMinElapsed = 2.0;
  const double took = begun_ ? std::chrono::duration<double>(now - begun_->time).count() : 0.0;
  const double done = begun_ ? fraction - begun_->fraction : 0.0;
  if (took < kMinElapsed || !(done > 0.0) || fraction >= 1.0) {
    return "";
  }
  return fmt::format(", {} left", DurationText((1.0 - fraction) * took / done));
}

}  // namespace trackbed::cli
