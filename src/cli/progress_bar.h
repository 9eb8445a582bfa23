#pragma once

#include <string>

namespace trackbed::cli {

/// One line on stderr that fills up; nothing at all unless stderr is a terminal and not `quiet`.
class ProgressBar {
 public:
  ProgressBar(std::string label, bool quiet);
  ProgressBar(const ProgressBar&) = delete;
  ProgressBar& operator=(const ProgressBar&) = delete;
  ~ProgressBar();  ///< clears the line

  void Show(double fraction);

 private:
  std::string label_;
  bool visible_;
};

}  // namespace trackbed::cli
