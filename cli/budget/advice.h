#pragma once

// What to change first, and what it would bring: measured, on a part of the model where that is enough.

#include "budget/budget.h"
#include "inputs.h"
#include "prt/bake.h"

#include <optional>
#include <string>

namespace prt::cli {

struct Advice {
    ErrorCause cause = ErrorCause::light; ///< the largest that something can be done about
    std::string option;                   ///< "prt bake --order 8"
    double before = 0, after = 0;         ///< total relative L2
};

/// What advice rests on.
struct AdviceSource {
    const BudgetReference& reference;
    const SceneFile& baked;
    const SceneFile* shipped = nullptr; ///< null: not compressed
    BudgetEffort effort;
};

/// Of the causes of `budget`, the mean over all lights, from the largest on, the first of which an option
/// takes a fiftieth of the total or more; none where no option does.
std::optional<Advice> advice(const AdviceSource& source, const ErrorBudget& budget, const Progress& progress);

} // namespace prt::cli
