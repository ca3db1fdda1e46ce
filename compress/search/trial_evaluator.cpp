// Measures the quantities that a budget limits.
#include "compress/search/trial_evaluator.h"

#include "compress/metric/error_moments.h"

#include <algorithm>

namespace prt {

TrialEvaluator::TrialEvaluator(const TransferView& transfer, const ReceiverSurface& surface,
                               const LightMetric& metric, const Budget& budget, int threads)
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

Score TrialEvaluator::operator()(const CompressResult& result) const {
    Score score{result.statistics.lit_rms};
    if (budget_.skies.empty() && !budget_.max_jump)
        return score;
    const TransferView decoded(result.transfer);
    if (!budget_.skies.empty()) {
        const ErrorMoments moments = error_moments(transfer_, decoded, surface_.areas, squares_, threads_);
        for (const Lighting& sky : budget_.skies)
            score.worst_lit_rms = std::max(score.worst_lit_rms, lit_rms_over_rotations(moments, sky).worst);
    }
    if (jumps_)
        score.jump = jumps_->percentile_99(decoded, result.transfer.receivers.cluster_indices());
    return score;
}

} // namespace prt
