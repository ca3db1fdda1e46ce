#pragma once

// The whole road from a scene to what a game loads, spending where it pays.

#include "back_sides.h"
#include "budget/budget.h"
#include "inputs.h"
#include "reading_options.h"
#include "report/report.h"
#include "session.h"

#include <optional>
#include <string>
#include <vector>

namespace prt::cli {

/// What the result is to keep; with none of them `kUsualError` is aimed at.
struct MakeGoal {
    std::optional<double>
        max_error; ///< over the surface, against path tracing, root mean square of all lights
    std::optional<double> bytes_per_vertex; ///< with bases
    std::optional<double> seconds;          ///< in all
    bool best_effort = false;               ///< write the nearest where nothing keeps the error
};

struct MakeRequest {
    Path scene, output, baked; ///< baked: empty where it is not to be kept
    std::vector<Path> lights;
    LightOptions reading_lights;
    std::string light_options; ///< as they were given, to be said again
    std::vector<std::string> no_shadow;
    BackSides back_sides = BackSides::automatic;
    MakeGoal goal;
    ReadingOptions reading;
    int threads = 0;
};

/// Writes `request.output` and adds what was chosen, why, and what came of it to `report`. Throws `Error`.
void make_model(const MakeRequest& request, Report& report, Session& session);

} // namespace prt::cli
