#pragma once

#include <cstddef>
#include <optional>
#include <vector>

namespace trackbed {

/// Signals of a closed loop, all sampled at the same times.
struct LoopSignals {
  double period = 0.0;          ///< Sampling period of the signals [s], > 0.
  std::vector<double> command;  ///< Steering command [rad].
  /// Inputs to which the controller may respond in advance, such as the steering angle of the path.
  std::vector<std::vector<double>> foreseen;
  /// Inputs to which the controller only responds afterwards, such as the noise of the pose.
  std::vector<std::vector<double>> unforeseen;
};

/// Returns the part of the command that no input explains [rad]: the residual of a least-squares
/// fit of the command by linear filters of the inputs and a constant. The filters are sums of
/// first-order low-pass filters; the filters of foreseen inputs also run backward in time. The run
/// time of UnexplainedCommand is O(n m^2) for n samples and m filters.
std::vector<double> UnexplainedCommand(const LoopSignals& signals);

/// A sustained oscillation of a signal.
struct Wave {
  /// Amplitude of a sine wave that has the power of the signal's repeating part [rad].
  double amplitude = 0.0;
  double frequency = 0.0;  ///< Frequency [Hz].
  std::size_t first = 0;   ///< Index of the first sample of the oscillation.
  std::size_t last = 0;    ///< Index of the last sample of the oscillation.
};

/// Finds sustained oscillations in the unexplained part of a command: stretches of at least eight
/// cycles and 4 s. The second half of a stretch repeats the first half with a correlation of at
/// least 0.9 and at least half of the amplitude. If inputs of the loop are `random`, each cycle of
/// a wave must also repeat the previous cycle, because noise excites short trains of waves in
/// poorly damped loops. The command itself must contain the wave in both halves with at least half
/// of the wave's amplitude, because the fit of UnexplainedCommand may add waves to the unexplained
/// part, as before a step of the command at a cusp. For each
/// quarter octave of periods, FindWaves returns at most one wave, the wave with the largest
/// amplitude. The argument `period` [s], > 0, is the sampling period of both signals, which have
/// the same size. The run time of FindWaves is O(n log n) for n samples.
std::vector<Wave> FindWaves(const std::vector<double>& unexplained,
                            const std::vector<double>& command, double period, bool random);

}  // namespace trackbed
