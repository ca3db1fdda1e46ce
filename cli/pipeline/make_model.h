#pragma once

// Bakes and compresses a scene in one step, and spends bytes and time on the largest errors.

#include "cli/pipeline/back_sides.h"
#include "cli/pipeline/budget.h"
#include "cli/pipeline/host.h"
#include "cli/pipeline/model.h"
#include "cli/pipeline/reading_options.h"
#include "cli/report/report.h"

#include <optional>
#include <string>
#include <vector>

namespace prt::pipeline {

/// Constraints on the result; without any, the target is `kUsualError`.
struct MakeGoal {
    std::optional<double>
        max_error; ///< over the surface, against path tracing, root mean square over all lights
    std::optional<double> bytes_per_vertex; ///< with bases
    std::optional<double> seconds;          ///< total time
    bool best_effort = false;               ///< write the closest result if nothing meets the error
};

struct MakeRequest {
    Path scene, output, baked; ///< baked: empty if the bake is not kept
    std::vector<Path> lights;
    LightOptions reading_lights;
    std::string light_options; ///< options as given, repeated in the report
    std::vector<std::string> no_shadow;
    BackSides back_sides = BackSides::automatic;
    MakeGoal goal;
    ReadingOptions reading;
    int threads = 0;
};

/// Writes `request.output` and adds the choices, their reasons and the results to `report`. Throws `Error`.
void make_model(const MakeRequest& request, Report& report, const Host& host);

} // namespace prt::pipeline
