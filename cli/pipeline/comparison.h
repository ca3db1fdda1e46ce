#pragma once

// Compares a compressed file, or another bake of the same scene, with its bake.

#include "cli/pipeline/loaded_light.h"
#include "cli/pipeline/reading_options.h"
#include "cli/report/report.h"

#include <vector>

namespace prt::pipeline {

struct ComparisonOptions {
    Path baked;
    FileSource shipped;
    ReadingOptions reading; ///< options for `shipped`
    bool pictures = false;  ///< pictures of both and their difference, under the light with the
                            ///< largest error
    int threads = 0;
};

/// Adds a verdict, errors, sizes and, for compressed files, clusters to `report`. Errors are measured under
/// `lights`, with separate suns if the transfer allows it, and under the standard lights. Puts `baked`,
/// loaded from `options.baked`, in the order of the shipped file. Throws `Error` if the files do not belong
/// together.
void add_comparison(const ComparisonOptions& options, SceneFile& baked,
                    const std::vector<LoadedLight>& lights, Report& report);

} // namespace prt::pipeline
