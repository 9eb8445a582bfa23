#include "src/cli/progress_bar.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>

namespace trackbed::cli {

ProgressBar::ProgressBar(std::string label, bool quiet)
    : label_(std::move(label)), visible_(!quiet && ::isatty(STDERR_FILENO) != 0) {
  Show(0.0);
}

ProgressBar::~ProgressBar() {
  if (visible_) {
    fmt::print(stderr, "\r\x1b[K");
    std::fflush(stderr);
  }
}

void ProgressBar::Show(double fraction) {
  if (!visible_) {
    return;
  }
  constexpr std::size_t kWidth = 32;
  const auto filled =
      static_cast<std::size_t>(std::clamp(fraction, 0.0, 1.0) * static_cast<double>(kWidth));
  fmt::print(stderr, "\r{} [{}{}] {:3.0f} %\x1b[K", label_, std::string(filled, '#'),
             std::string(kWidth - filled, '.'), fraction * 100.0);
  std::fflush(stderr);
}

}  // namespace trackbed::cli
