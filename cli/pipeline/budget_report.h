#pragma once

#include "cli/pipeline/advice.h"
#include "cli/report/report.h"

#include <string>
#include <vector>

namespace prt::pipeline {

/// A table of all lights with their mean for each measure, and a bar for each light.
std::vector<Table> budget_tables(const std::vector<ReferenceLight>& lights, const Budgets& budgets);

/// "3.10 % from path tracing under these 2 lights: light 2.90, vertices 1.00, ... %; contrast error 4.20 %:
/// light 3.10, ... %"
std::string budget_in_words(const ErrorBudget& mean, const ErrorBudget& visible_mean, std::size_t lights);

/// "against light: prt bake --order 8 would bring 3.10 to 1.90 %"
std::string advice_in_words(const std::optional<Advice>& advice);

/// Adds the advice as figures.
void add_advice(const std::optional<Advice>& advice, Report& report);

} // namespace prt::pipeline
