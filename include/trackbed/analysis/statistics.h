#pragma once

#include <cstddef>

/// What the rows of a study say about the distribution that they are a sample of.
namespace trackbed {

struct Interval {
  double low = 0.0;
  double high = 0.0;
};

/// The score interval of a probability of which `passed` in `count` independent trials were seen,
/// without continuity correction (Wilson 1927). [0, 1] of no trial.
///
/// PreconditionError unless passed <= count and confidence is in (0, 1).
Interval WilsonInterval(std::size_t passed, std::size_t count, double confidence);

}  // namespace trackbed
