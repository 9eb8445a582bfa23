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
/// | `/<plant>/tf` | foxglove.FrameTransform | `world` to `<plant>`, the rear axle on the ground |
/// | `/<plant>/log` | trackbed.Log | a row of `<plant>.csv`: its columns by name |
/// | `/<plant>/plan` | foxglove.PosesInFrame | each plan, when adopted |
/// | `/<plant>/footprint` | foxglove.SceneUpdate | a box as large as the car, once |
/// | `/obstacles` | foxglove.SceneUpdate | boxes, where they are; again every 0.1 s if any moves |
///
/// Poses are planar: they omit ground height, roll and pitch. The same run gives the same bytes.
std::string ToMcap(const RunResult& result);

}  // namespace trackbed
