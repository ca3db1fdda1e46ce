// Settings of a basis that moves (Silvennoinen and Sloan 2021, "Moving Basis Decomposition for Precomputed
// Light Transport") at the bytes and at the components of the sweep.

#include "moving_basis_candidates.h"

#include "moving_basis_baseline.h"

#include <algorithm>
#include <optional>
#include <string>
#include <utility>

namespace prt {
namespace {

/// A moving basis for one of `kSweepBytes`: settings that were best on the knot, the head, the room or the
/// bunny.
struct MovingBasisSetting {
    double bytes;                ///< per receiver, including tables
    int weight_bits, components; ///< per receiver
};

constexpr MovingBasisSetting kMovingBasisSettings[] = {
    {5, 32, 5}, {5, 32, 8}, {7, 32, 5}, {7, 32, 8}, {9, 32, 6}, {9, 64, 12}, {13, 64, 8}, {13, 64, 12},
};
/// Each component needs eight operations, and so does the mean.
constexpr int kMovingBasisComponents[] = {0, 1, 2, 4};

SweepCandidate candidate(const Transfer& transfer, const ReceiverSurface& surface, MovingBasisOptions options,
                         SweepTables tables) {
    return {kMovingBasis,
            [&transfer, surface,
             options = std::move(options)](const Progress& progress) -> std::optional<CandidateResult> {
                std::optional<MovingBasisResult> found = moving_basis(transfer, surface, options, progress);
                if (!found)
                    return std::nullopt;
                return CandidateResult{std::to_string(found->nodes) + " nodes x " +
                                           std::to_string(options.components),
                                       std::move(found->result)};
            },
            tables};
}

} // namespace

std::vector<SweepCandidate> moving_basis_candidates(const Transfer& transfer, const ReceiverSurface& surface,
                                                    int threads) {
    std::vector<SweepCandidate> candidates;
    if (surface.positions.empty())
        return candidates;
    const LightMetric metric =
        balanced(metric_of_family(LightFamily::outdoor, transfer.layout), transfer, surface.areas, threads);
    const auto receivers = static_cast<double>(transfer.receivers());
    for (const MovingBasisSetting& setting : kMovingBasisSettings) {
        const double words = bound_bytes(static_cast<std::size_t>(setting.weight_bits / 8));
        candidates.push_back(candidate(transfer, surface,
                                       {.components = setting.components,
                                        .weight_bits = setting.weight_bits,
                                        .table_bytes = receivers * (setting.bytes - words),
                                        .metric = metric,
                                        .threads = threads},
                                       SweepTables::by_bytes));
    }
    for (const int components : kMovingBasisComponents)
        candidates.push_back(candidate(transfer, surface,
                                       {.components = components,
                                        .weight_bits = std::max(32, 8 * components),
                                        .nodes = static_cast<std::size_t>(kSweepClusters),
                                        .metric = metric,
                                        .threads = threads},
                                       SweepTables::by_components));
    return candidates;
}

} // namespace prt
