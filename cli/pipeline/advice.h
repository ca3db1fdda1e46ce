#pragma once

// Advice on which option to change first. Its effect is measured, on a part of the model if that suffices.

#include "cli/pipeline/budget.h"
#include "cli/pipeline/model.h"
#include "prt/bake/bake.h"

#include <optional>
#include <string>

namespace prt::pipeline {

struct Advice {
    ErrorCause cause = ErrorCause::light; ///< the largest that something can be done about
    std::string option;                   ///< "prt bake --order 8"
    double before = 0, after = 0;         ///< total relative L2
};

/// Input of `advice`.
struct AdviceSource {
    const BudgetReference& reference;
    const SceneFile& baked;
    const SceneFile* shipped = nullptr; ///< null: not compressed
    BudgetEffort effort;
};

/// Returns the first option that reduces the total error by at least a fiftieth. Causes of `budget`, the mean
/// over all lights, are tried from the largest on. Empty if no option does.
std::optional<Advice> advice(const AdviceSource& source, const ErrorBudget& budget, const Progress& progress);

} // namespace prt::pipeline
