#pragma once

// Converts figures and budgets to JSON for scripts.

#include "core/frame_statistics.h"

#include "bake/studies/error_budget.h"

#include <nlohmann/json.hpp>

namespace viewer {

nlohmann::json figures_json(const Figures& figures);
nlohmann::json budget_json(const prt::ErrorBudget& budget);

} // namespace viewer
