#pragma once

// Evaluation of results against a budget.

#include "compress/metric/jumps.h"
#include "prt/compress/search.h"

#include <optional>

namespace prt {

/// Quantities by which a result is evaluated.
struct Score {
    double worst_lit_rms = 0; ///< maximum of the expected error and the errors under the budget's skies, at
                              ///< their worst rotations
    double jump = 0;          ///< jump limited by `Budget::max_jump`; 0 if there is no limit
};

/// Evaluates results of one transfer against a budget. Keeps references.
class TrialEvaluator {
public:
    TrialEvaluator(const TransferView& transfer, const ReceiverSurface& surface, const LightMetric& metric,
                   const Budget& budget, int threads);

    Score operator()(const CompressResult& result) const;

private:
    const TransferView& transfer_;
    const ReceiverSurface& surface_;
    const Budget& budget_;
    int threads_;
    std::vector<double> squares_;       ///< `ErrorMoments::references`, if the budget has skies
    std::optional<ClusterJumps> jumps_; ///< set if the budget limits jumps
};

} // namespace prt
