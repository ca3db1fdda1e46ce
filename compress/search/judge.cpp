#include "search/judge.h"

#include "prt/error_moments.h"
#include "prt/jumps.h"

#include <algorithm>

namespace prt {

Judge::Judge(const TransferView& transfer, const ReceiverSurface& surface, const LightMetric& metric,
             const Budget& budget, int threads)
    : transfer_(transfer), surface_(surface), metric_(metric), budget_(budget), threads_(threads) {
    if (!budget.skies.empty())
        squares_ = second_moments(transfer, surface.areas, threads);
}

Verdict Judge::operator()(const CompressResult& result) const {
    Verdict verdict{result.statistics.lit_rms};
    if (budget_.skies.empty() && !budget_.max_jump)
        return verdict;
    const TransferView decoded(result.transfer);
    if (!budget_.skies.empty()) {
        const ErrorMoments moments = error_moments(transfer_, decoded, surface_.areas, squares_, threads_);
        for (const Lighting& sky : budget_.skies)
            verdict.worst_lit_rms = std::max(verdict.worst_lit_rms, lit_rms_over_turns(moments, sky).worst);
    }
    const std::vector<std::uint16_t>& clusters = result.transfer.receivers.clusters;
    if (budget_.max_jump)
        verdict.jump = budget_.skies_of_jumps.empty()
                           ? jump_across_clusters(transfer_, decoded, clusters, surface_, metric_, threads_)
                           : worst_jump_across_clusters(transfer_, decoded, clusters, surface_,
                                                        budget_.skies_of_jumps, threads_);
    return verdict;
}

} // namespace prt
