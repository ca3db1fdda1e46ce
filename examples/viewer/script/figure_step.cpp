// Parses the figure options of a script.

#include "script/figure_step.h"

#include "prt/core/error.h"

#include <nlohmann/json.hpp>

#include <array>
#include <cmath>

namespace viewer {

/// Maximum coordinate of a path, metres; rays and paths stay exact within it.
constexpr double kFarthest = 1e6;

FigureChoice figure_choice(const nlohmann::json& json) {
    FigureChoice choice;
    choice.animation = json.value("animation", "");
    choice.scale = json.value("scale", 1.0);
    if (!(choice.scale > 0 && choice.scale < 1e6))
        throw prt::Error("the scale of a figure must be above 0");
    for (const nlohmann::json& point : json.value("path", nlohmann::json::array())) {
        const auto at = point.get<std::array<double, 3>>();
        for (const double number : at)
            if (!(std::abs(number) <= kFarthest))
                throw prt::Error("a position on the figure's path is not finite or beyond 1e6 m");
        choice.path.emplace_back(at[0], at[1], at[2]);
    }
    return choice;
}

} // namespace viewer
