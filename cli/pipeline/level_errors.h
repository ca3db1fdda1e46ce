#pragma once

// Measures errors of the coarser levels of a shipped file against level 0 of its bake.

#include "pipeline/loaded_light.h"
#include "pipeline/model.h"
#include "pipeline/reading_options.h"
#include "report/report.h"

#include <vector>

namespace prt::pipeline {

struct LevelFiles {
    const GltfDocument& baked;
    Path baked_path, shipped_path;
    ReadingOptions reading;
    int threads = 0;
};

/// Adds a table of levels, where both files have transfer of some.
void add_level_errors(const LevelFiles& files, const std::vector<LoadedLight>& lights, Report& report);

} // namespace prt::pipeline
