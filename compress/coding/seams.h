#pragma once

#include "coding/weight_coding.h"
#include "prt/lightmap.h"
#include "tuning.h"

namespace prt {

struct SeamOptions {
    double seam_price = 0;      ///< mu of docs/math.md, eq. 28
    double mean_components = 0; ///< receivers have at most so many on average; 0: any
    /// Receivers whose weights are solved for together, as real numbers.
    std::size_t solved_together = tuning::kSolvedTogether;
    int threads = 0;
};

/// Trades error of receivers for smoothness of the error over the mesh. First all weights of so many
/// receivers together, as real numbers, by conjugate gradients on the normal equations of eq. 28; then
/// receiver by receiver the cluster, of its own and its neighbours', and the rounded weights that are best
/// while the neighbours stay, until few change; last the receivers of `jumps`, so that these close.
void smooth_seams(const PointBlocks& points, std::span<const float> significance, std::span<const Edge> edges,
                  std::span<const SeamJump> jumps, const QuantisedClusters& clusters,
                  const SeamOptions& options, Codes& codes);

} // namespace prt
