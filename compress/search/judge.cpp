// Measures the quantities that a budget limits.
#include "search/judge.h"

#include "prt/error_moments.h"

#include <algorithm>

namespace prt {

Judge::Judge(const TransferView& transfer, const ReceiverSurface& surface, const LightMetric& metric,
             const Budget& budget, int threads)
    : transfer_(transfer), surface_(surface), budget_(budget), threads_(threads) {
    if (!budget.skies.empty())
        squares_ = second_moments(transfer, surface.areas, threads);
    if (!budget.max_jump)
        return;
    if (budget.skies_of_jumps.empty())
        jumps_.emplace(transfer, surface, metric, threads);
    else
        jumps_.emplace(transfer, surface, budget.skies_of_jumps, threads);
}

Verdict Judge::operator()(const CompressResult& result) const {
    Verdict verdict{result.statistics.lit_rms};
    if (budget_.skies.empty() && !budget_.max_jump)
        return verdict;
    const TransferView decoded(result.transfer);
    if (!budget_.skies.empty()) {
        const ErrorMoments moments = error_moments(transfer_, decoded, surface_.areas, squares_, threads_);
        for (const Lighting& sky : budget_.skies)
            verdict.worst_lit_rms =
                std::max(verdict.worst_lit_rms, lit_rms_over_rotations(moments, sky).worst);
    }
    if (jumps_)
        verdict.jump = jumps_->percentile_99(decoded, result.transfer.receivers.clusters);
    return verdict;
}

} // namespace prt
