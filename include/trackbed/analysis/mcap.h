#pragma once

#include <string>

#include "trackbed/analysis/run.h"

/// Export of runs as MCAP, the container format of Foxglove and other viewers.
namespace trackbed {

/// Exports a run as an MCAP file (mcap.dev/spec, version 0). The file has chunks of 1 MB with
/// index, statistics and checksums, without compression. Messages are JSON, in order of time. Times
/// count from the start of the run [ns].
///
/// | topic | schema | |
/// |---|---|---|
/// | `/<plant>/tf` | foxglove.FrameTransform | `world` to `<plant>` (rear axle on the ground) |
/// | `/<plant>/log` | trackbed.Log | a row of `<plant>.csv`, with the columns by name |
/// | `/<plant>/plan` | foxglove.PosesInFrame | each plan, at the time of its adoption |
/// | `/<plant>/footprint` | foxglove.SceneUpdate | a box of the size of the car, sent once |
/// | `/obstacles` | foxglove.SceneUpdate | boxes at their positions; every 0.1 s if one moves |
///
/// Poses are planar: they omit ground height, roll and pitch. The same run always gives an
/// identical file.
std::string ToMcap(const RunResult& result);

}  // namespace trackbed
