// Writes error budgets as tables, bars and sentences.

#include "cli/pipeline/budget_report.h"

#include <fmt/core.h>
#include <fmt/ranges.h>

#include <cmath>

namespace prt::pipeline {
namespace {

constexpr ErrorCause kCauses[] = {ErrorCause::light, ErrorCause::bounces, ErrorCause::vertices,
                                  ErrorCause::rays, ErrorCause::bytes};

/// The error that a bound of its square is.
double root(double squared) {
    return std::sqrt(std::max(squared, 0.0));
}

std::vector<Json> row_of(const std::string& name, const ErrorBudget& budget) {
    std::vector<Json> row = {name, budget.total.root()};
    for (const ErrorCause cause : kCauses)
        row.emplace_back(budget.of(cause).root());
    row.emplace_back(budget.total.value > 0 ? Json(budget.sum() / budget.total.value) : Json());
    row.emplace_back(
        fmt::format("{:.2f} .. {:.2f} %", 100 * root(budget.total.low), 100 * root(budget.total.high)));
    for (const SquaredError* error :
         {&budget.total, &budget.of(ErrorCause::light), &budget.of(ErrorCause::bounces),
          &budget.of(ErrorCause::vertices), &budget.of(ErrorCause::rays), &budget.of(ErrorCause::bytes)}) {
        row.emplace_back(root(error->low));
        row.emplace_back(root(error->high));
    }
    return row;
}

Bars bars_of(const std::vector<ReferenceLight>& lights, const std::vector<ErrorBudget>& budgets) {
    Bars bars{"squared error over the surface by cause; the length of a bar is the total error", {}, {}};
    for (const ErrorCause cause : kCauses)
        bars.series.emplace_back(to_string(cause));
    for (std::size_t i = 0; i < lights.size(); ++i) {
        const double sum = budgets[i].sum(), total = budgets[i].total.root();
        Bar bar{lights[i].name, fmt::format("{:.2f} %", 100 * total), {}};
        for (const ErrorCause cause : kCauses)
            bar.lengths.push_back(sum > 0 ? total * std::max(0.0, budgets[i].of(cause).value) / sum : 0);
        bars.bars.push_back(std::move(bar));
    }
    return bars;
}

} // namespace

namespace {

/// A row for each light and one for their mean; `about` is left empty.
Table table_of(const std::vector<ReferenceLight>& lights, const std::vector<ErrorBudget>& budgets,
               const char* name, const char* title) {
    Table table{name, title, "", {}, {}};
    table.columns = {{"light", "light"}, {"total", "total", Unit::percent, 2}};
    for (const ErrorCause cause : kCauses)
        table.columns.push_back(
            {std::string(to_string(cause)) + "_error", to_string(cause), Unit::percent, 2});
    table.columns.push_back({"sum_over_total", "sum / total (squares)", Unit::plain, 2});
    table.columns.push_back({"total_interval", "95 % interval of the total"});
    for (const char* measured : {"total", "light", "bounces", "vertices", "rays", "bytes"})
        for (const char* end : {"_low", "_high"})
            table.columns.push_back({std::string(measured) + end});
    for (std::size_t i = 0; i < lights.size(); ++i)
        table.rows.push_back(row_of(lights[i].name, budgets[i]));
    if (lights.size() > 1)
        table.rows.push_back(row_of("root mean square", mean_budget(budgets)));
    table.bars = {bars_of(lights, budgets)};
    return table;
}

std::string causes_in_words(const ErrorBudget& mean) {
    constexpr double kMuch = 1.25; // exceeds the uncertainty of the squares
    std::vector<std::string> causes;
    for (const ErrorCause cause : kCauses)
        causes.push_back(fmt::format("{} {:.2f}", to_string(cause), 100 * mean.of(cause).root()));
    const char* together = mean.sum() > kMuch * mean.total.value   ? ", which partly cancel each other"
                           : mean.total.value > kMuch * mean.sum() ? ", which reinforce each other"
                                                                   : "";
    return fmt::format("{} %{}", fmt::join(causes, ", "), together);
}

} // namespace

std::vector<Table> budget_tables(const std::vector<ReferenceLight>& lights, const Budgets& budgets) {
    Table relative = table_of(lights, budgets.relative, "budget", "Error over the surface by cause");
    relative.about =
        "Relative L2 of exit radiance for albedo 1, at points over the whole surface, against path tracing "
        "under the complete light. Light: truncation of the light to the bands of the bake, with ringing "
        "removed. Bounces: bounces that were not baked. Vertices: interpolation between vertices. Rays: "
        "sampling noise of the bake. Bytes: compression. Each value is the error with this cause alone; the "
        "squares add up to the square of the total, except for interactions between causes. Separate suns "
        "are shadowed by the renderer: they have no error here, but the errors are relative to light that "
        "includes them.";
    Table visible =
        table_of(lights, budgets.visible, "visible_budget", "Contrast error over the surface by cause");
    visible.about = "Root mean square of the contrast error: each error is relative to the luminance at its "
                    "point plus a tenth of the logarithmic mean of all points. The causes are those above.";
    return {std::move(relative), std::move(visible)};
}

std::string budget_in_words(const ErrorBudget& mean, const ErrorBudget& visible_mean, std::size_t lights) {
    return fmt::format("error {:.2f} % against path tracing{}: {}; contrast error {:.2f} %: {}",
                       100 * mean.total.root(),
                       lights > 1 ? fmt::format(" under these {} lights", lights) : "", causes_in_words(mean),
                       100 * visible_mean.total.root(), causes_in_words(visible_mean));
}

std::string advice_in_words(const std::optional<Advice>& advice) {
    return advice ? fmt::format("to reduce the error of {}, use {}: the total falls from {:.2f} to {:.2f} %",
                                to_string(advice->cause), advice->option, 100 * advice->before,
                                100 * advice->after)
                  : "no single option reduces the error by more than a fiftieth";
}

void add_advice(const std::optional<Advice>& advice, Report& report) {
    add_figures(report, {{"advice", advice_in_words(advice)}});
    if (advice)
        add_figures(report, {{"advice_cause", to_string(advice->cause)},
                             {"advice_option", advice->option},
                             {"total_error", advice->before},
                             {"total_error_with_advice", advice->after}});
}

} // namespace prt::pipeline
