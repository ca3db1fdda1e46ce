#pragma once

// Smoothing of the error over the mesh.

#include "compress/coding/weight_coding.h"
#include "compress/tuning/tuning.h"
#include "prt/core/lightmap.h"

namespace prt {

struct SeamOptions {
    double seam_weight = 0;     ///< mu of docs/math.md, eq. 28
    double mean_components = 0; ///< maximum mean number of components; 0: no limit
    /// Number of receivers whose weights are solved for together, as real numbers.
    std::size_t solved_together = tuning::kSolvedTogether;
    int threads = 0;
};

/// Trades error of receivers for smoothness of the error over the mesh. First it solves for the weights of
/// `solved_together` receivers at a time, as real numbers, by conjugate gradients on the normal equations of
/// eq. 28. Then it chooses for each receiver the best cluster, among its own and its neighbours', and the
/// best rounded weights with fixed neighbours, until few change. Last it repeats this for the receivers of
/// `jumps`, to close these.
void smooth_seams(const PointBlocks& points, std::span<const float> significance, std::span<const Edge> edges,
                  std::span<const SeamJump> jumps, const QuantisedClusters& clusters,
                  const SeamOptions& options, Codes& codes);

} // namespace prt
