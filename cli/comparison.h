#pragma once

// A compressed file, or another bake of the same scene, held against its bake.

#include "reading_options.h"
#include "report/report.h"
#include "split_light.h"

#include <vector>

namespace prt::cli {

struct ComparisonOptions {
    Path baked, shipped;
    ReadingOptions reading; ///< of `shipped`
    bool pictures = false;  ///< of both and their difference, under the light that shows it best
    int threads = 0;
};

/// Adds a verdict, errors under `lights`, with their suns apart, too, where transfer allows it, and under
/// those that are always tried, sizes and, for compressed files, clusters to `report`. Puts `baked`, which
/// was loaded from `options.baked`, in the order of the shipped file. Throws `Error` where the files do not
/// belong together.
void add_comparison(const ComparisonOptions& options, SceneFile& baked, const std::vector<SplitLight>& lights,
                    Report& report);

} // namespace prt::cli
