#pragma once

// Measures errors of a compressed file or of a bake: what `prt evaluate` does.

#include "cli/pipeline/host.h"
#include "cli/pipeline/loaded_light.h"
#include "cli/pipeline/model.h"
#include "cli/pipeline/reading_options.h"
#include "cli/report/report.h"

#include <optional>
#include <set>
#include <string>
#include <vector>

namespace prt::pipeline {

enum class Measure { sweep, budget, volume };

struct EvaluateRequest {
    FileSource baked, shipped; ///< shipped: empty if only the bake is measured
    std::vector<Path> lights;
    LightOptions light_options;
    SunCount suns = {std::nullopt};
    int rotations = 1; ///< number of rotations of each light about +Y
    std::set<Measure> measures;
    std::vector<std::string> no_shadow; ///< names of materials
    ReadingOptions reading;
    bool pictures = false; ///< add pictures to the report
    int threads = 0;
};

/// Returns the figures. Throws `Error`.
Report evaluate_model(EvaluateRequest request, const Host& host);

} // namespace prt::pipeline
