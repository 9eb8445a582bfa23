#include "src/cli/progress_bar.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>

namespace trackbed::cli {
namespace {

/// Plain stdio, which does not throw: where the terminal has been closed there is nobody to tell.
void Put(const std::string& text) {
  std::fputs(text.c_str(), stderr);
  std::fflush(stderr);
}

}  // namespace

ProgressBar::ProgressBar(std::string label, bool quiet)
    : label_(std::move(label)), visible_(!quiet && ::isatty(STDERR_FILENO) != 0) {
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
  Put(fmt::format("\r{} [{}{}] {:3.0f} %\x1b[K", label_, std::string(filled, '#'),
                  std::string(kWidth - filled, '.'), fraction * 100.0));
}

}  // namespace trackbed::cli
