// Codes for clusters and clusters for codes in turn, as the generalised Lloyd algorithm does (Gersho and Gray
// 1992), with weights and bases on the grids of the file (docs/math.md, eq. 25 to 27).

#include "coding/alternation.h"

#include "coding/refit.h"
#include "prt/coded_rows.h"

namespace prt {
namespace {

/// The step of the bases at which rounding adds `share` of the squared error `error`: a receiver's code is
/// the sum of its mean and of m rows times weights, which are rounded to twice the step.
double basis_step(const AffineClusters& clusters, double error, double share) {
    double rows = 0, largest = 0;
    for (const int m : clusters.components)
        rows += static_cast<double>(1 + clusters.guides) + 4 * tuning::kMeanSquareWeight * m;
    for (const float v : clusters.means)
        largest = std::max(largest, static_cast<double>(std::abs(v)));
    for (const float v : clusters.slopes)
        largest = std::max(largest, static_cast<double>(std::abs(v)));
    for (const float v : clusters.rows)
        largest = std::max(largest, static_cast<double>(std::abs(v)) / 2);
    const double noise =
        static_cast<double>(clusters.dimension) * rows / static_cast<double>(clusters.clusters()) / 12;
    const double most = static_cast<double>(1 << (kMostRowBits - 1)) - 1;
    return std::max({noise > 0 ? std::sqrt(share * error / noise) : 0.0, largest / most, 1e-30});
}

} // namespace

void encode_all(const PointBlocks& points, const AlternationOptions& options, CodedClusters& coded) {
    if (options.stay)
        encode_in_place(points, coded.clusters, coded.codes, options.threads);
    else
        encode_points(points, coded.clusters,
                      neighbours_of_codes(coded.clusters, tuning::kNeighboursOfCodes, options.threads),
                      coded.codes, options.threads);
}

void alternate(const PointBlocks& points, std::span<const float> significance,
               const AlternationOptions& options, const Progress& progress, CodedClusters& coded) {
    const bool rounds_bases = options.basis_share > 0;
    CodedClusters best;
    double least = std::numeric_limits<double>::infinity();
    for (int round = 0; round < options.rounds; ++round) {
        progress.update(static_cast<double>(round) / options.rounds);
        const bool rounded = rounds_bases && round >= options.rounded_from;
        refit(points, significance, coded.codes, coded.clusters, options.threads);
        if (rounded) {
            coded.step = basis_step(coded.clusters, total_error(significance, coded.codes.errors),
                                    options.basis_share);
            round_rows(coded.clusters, coded.step);
        }
        const Codes before = coded.codes;
        encode_all(points, options, coded);
        keep_better(points, coded.clusters, before, coded.codes, options.threads);
        const double error = total_error(significance, coded.codes.errors);
        if (options.trace)
            options.trace(CodingRound{rounded, error});
        if (rounded == rounds_bases && error < least) {
            least = error;
            best = coded;
        }
    }
    coded = std::move(best);
}

} // namespace prt
