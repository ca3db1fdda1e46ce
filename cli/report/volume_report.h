#pragma once

#include "cli/report/report.h"
#include "prt/bake/volume_bake.h"
#include "prt/compress/compress.h"

namespace prt::pipeline {

/// Returns {"probes": 3213, "bricks": 40, "spacing_metres": 0.5, ..}.
Json grid_figures(const VolumeGrid& grid, std::size_t probes, int order);
/// Returns "volume: 3213 probes in 40 bricks, finest spacing 0.5 m, incident light of order 3", with the
/// figures under `key`.
std::string grid_sentence(const std::string& key);

/// Adds the bake of a volume to a report.
void add_volume_bake(const VolumeBake& bake, Report& report);

/// Adds the compression of a volume to a report.
void add_volume_compression(const CompressStatistics& statistics, const CompressedVolume& volume,
                            Report& report);

} // namespace prt::pipeline
