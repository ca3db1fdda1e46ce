#pragma once

// Measures errors of the coarser levels of a shipped file against level 0 of its bake.

#include "cli/pipeline/loaded_light.h"
#include "cli/pipeline/model.h"
#include "cli/pipeline/reading_options.h"
#include "cli/report/report.h"

#include <vector>

namespace prt::pipeline {

struct LevelFiles {
    const GltfDocument& baked;
    Path baked_path;
    FileSource shipped;
    ReadingOptions reading;
    int threads = 0;
};

/// Adds a table of levels, where both files have transfer of some.
void add_level_errors(const LevelFiles& files, const std::vector<LoadedLight>& lights, Report& report);

} // namespace prt::pipeline
