// Entry points of the search: budgets and presets.
#include "prt/compress/search.h"

#include "compress/pipeline/compress_options.h"
#include "compress/search/budget_search.h"
#include "prt/core/error.h"
#include "runtime/core/support/counted.h"
#include "runtime/core/support/stopwatch.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <string>

namespace prt {
namespace {

void check_budget(const SearchOptions& o, const ReceiverSurface& surface) {
    for (const auto& [value, name] :
         {std::pair(o.budget.max_error, "the error"), std::pair(o.budget.max_jump, "jumps"),
          std::pair(o.budget.bytes_per_vertex, "bytes per vertex"),
          std::pair(o.budget.operations, "shader operations")})
        if (value && !(*value > 0 && std::isfinite(*value)))
            throw Error(std::string("the budget for ") + name + " must be finite and greater than 0, not " +
                        std::to_string(*value));
    if (!o.budget.any())
        throw Error("a search needs a budget: a maximum error, bytes per vertex or shader operations");
    if (!o.budget.aims())
        throw Error("--max-jump alone is met by a single cluster; add --max-error, --bytes-per-vertex or "
                    "--shader-ops");
    if (!o.budget.skies.empty() && !o.budget.max_error)
        throw Error("skies for the error are given, but no maximum error");
    if (!o.budget.skies_of_jumps.empty() && !o.budget.max_jump)
        throw Error("skies for jumps are given, but no maximum jump");
    const int rows = predictor_rows_of(o.compress.predictors, surface);
    if (!o.choose_predictors && o.budget.operations && rows > *o.budget.operations)
        throw Error("the predictors alone need " + counted(rows, "shader operation") +
                    "; increase --shader-ops or use --predictors none");
}

/// Builds the task with its metric. The metric is expensive and shared by all trials.
SearchTask task_of(const TransferView& transfer, const ReceiverSurface& surface, const SearchOptions& options,
                   const Progress& progress) {
    check_input(transfer, surface, options.compress);
    SearchTask task{transfer, surface, options, progress};
    task.options.compress.metric = metric_of(options.compress, transfer, surface.areas);
    return task;
}

/// Searches within the budget. A limit on operations that is not binding must not affect the result: the
/// search without it runs first.
SearchResult within(const SearchTask& task) {
    const Budget& budget = task.options.budget;
    if (!budget.operations || !(budget.max_error || budget.bytes_per_vertex))
        return BudgetSearch(task).run();
    const Progress first = task.progress.range(0, 0.5), second = task.progress.range(0.5, 1);
    SearchTask free{task.transfer, task.surface, task.options, first};
    free.options.budget.operations.reset();
    SearchResult of_free = BudgetSearch(free).run();
    if (of_free.kept && !(of_free.best.operations > *budget.operations))
        return of_free;
    const SearchTask bound{task.transfer, task.surface, task.options, second};
    SearchResult found = BudgetSearch(bound).run();
    found.trials.insert(found.trials.begin(), of_free.trials.begin(), of_free.trials.end());
    return found;
}

} // namespace

std::vector<PromiseKept> promises_of(const Budget& budget, const SearchTrial& trial) {
    std::vector<PromiseKept> kept;
    const auto add = [&](Promise promise, double reached, const std::optional<double>& limit) {
        if (limit)
            kept.push_back({promise, reached, *limit});
    };
    add(Promise::error, trial.worst_lit_rms, budget.max_error);
    if (trial.sky_contrast > 0)
        add(Promise::skies, trial.sky_contrast, budget.max_error);
    if (trial.lamp_contrast > 0)
        add(Promise::lamps, trial.lamp_contrast, budget.max_error);
    add(Promise::jump, trial.jump, budget.max_jump);
    add(Promise::bytes, trial.bytes_per_vertex, budget.bytes_per_vertex);
    add(Promise::operations, trial.operations, budget.operations);
    std::ranges::stable_sort(kept, std::greater(), &PromiseKept::share);
    return kept;
}

SearchResult compress_within(const TransferView& transfer, const ReceiverSurface& surface,
                             const SearchOptions& options, const Progress& progress) {
    check_budget(options, surface);
    const Stopwatch stopwatch;
    SearchResult found = within(task_of(transfer, surface, options, progress));
    found.result.statistics.seconds = stopwatch.seconds();
    progress.update(1);
    return found;
}

SearchResult compress_preset(const TransferView& transfer, const ReceiverSurface& surface,
                             const CompressOptions& options, const Progress& progress) {
    const Stopwatch stopwatch;
    SearchResult found;
    // The search that may follow only applies to small meshes and takes little time.
    CompressOptions whole = options;
    whole.bases_count = options.coding.fixed_bits.empty();
    found.result = compress(transfer, surface, whole, progress.range(0, 0.99));
    const CompressStatistics& s = found.result.statistics;
    const auto receivers = static_cast<double>(transfer.receivers());
    const int payload = payload_of(options.coding, transfer.dimension());
    const double bound = payload_bytes(options.coding.format, payload);
    const double max_bases = std::max(tuning::kBasesOverWeights * bound * receivers, tuning::kAlwaysForBases);
    found.kept = static_cast<double>(s.basis_bytes) <= max_bases;
    if (!found.kept) {
        SearchOptions fitting;
        fitting.compress = options;
        fitting.payload = payload;
        fitting.choose_components = options.coding.format == WeightFormat::packed;
        fitting.choose_predictors = false;
        fitting.budget.bytes_per_vertex = bound + max_bases / receivers;
        const Progress rest = progress.range(0.99, 1);
        const SearchTask task = task_of(transfer, surface, fitting, rest);
        found = BudgetSearch(task, effort_of_preset(s)).run();
        found.result.statistics.seconds = stopwatch.seconds();
    }
    progress.update(1);
    return found;
}

} // namespace prt
