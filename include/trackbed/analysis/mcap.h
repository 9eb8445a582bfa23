#pragma once

#include <string>

#include "trackbed/analysis/run.h"

/// Exports runs as MCAP files, the log format of Foxglove and other viewers.
namespace trackbed {

/// Exports a run as an MCAP file (mcap.dev/spec, version 0). The MCAP file has chunks of 1 MB with
/// index, statistics and checksums, without compression. The messages of the file are in JSON
/// format and in order of time. Message times count from the start of the run [ns]. The MCAP file
/// has these topics:
///
/// | topic | schema | |
/// |---|---|---|
/// | `/<plant>/tf` | foxglove.FrameTransform | `world` to `<plant>` (rear axle on the ground) |
/// | `/<plant>/log` | trackbed.Log | a row of `<plant>.csv`, with the columns by name |
/// | `/<plant>/plan` | foxglove.PosesInFrame | each plan, at the time of its adoption |
/// | `/<plant>/footprint` | foxglove.SceneUpdate | a box of the size of the car, sent once |
/// | `/obstacles` | foxglove.SceneUpdate | boxes at their positions; every 0.1 s if one moves |
///
/// Exported poses are planar, without ground height, roll and pitch. Exporting the same run twice
/// yields identical files.
std::string ToMcap(const RunResult& result);

}  // namespace trackbed
