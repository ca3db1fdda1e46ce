#pragma once

// The compressor: clustered PCA of transfer vectors (Sloan, Hall, Hart and Snyder 2003, "Clustered Principal
// Components for Precomputed Radiance Transfer"), for the least error of exit radiance rather than of
// coefficients; docs/math.md, section 4.
//
//     CompressResult r = compress(transfer, SceneSurface(scene).view(), {.coding = preset_u32()});
//
// `prt/search.h` chooses options for a budget; docs/terminology.md says what the words mean.

#include "prt/clustered_transfer.h"
#include "prt/compress_trace.h"
#include "prt/light_metric.h"
#include "prt/receiver_surface.h"
#include "prt/support/progress.h"

#include <algorithm>
#include <cstdint>
#include <optional>
#include <vector>

namespace prt {

/// Packed weights take at most eight 32-bit words of a receiver, less the cluster, which takes up to 16 bits:
/// 240 bits, 30 bytes.
inline constexpr int kMostPackedWords = 8;
inline constexpr int kMostPackedBits = 32 * kMostPackedWords - 16;

/// Largest coefficient of transfer that is compressed: a real one is 1 where all light arrives, a few hundred
/// behind nearly black sheets, and the squares of these can be summed in floats.
inline constexpr float kMostTransfer = 1e12f;
/// Largest price of seams.
inline constexpr double kMostPrice = 1e6;

/// How a receiver's weights are written.
struct WeightCoding {
    WeightFormat format = WeightFormat::packed;
    /// Most components of a cluster; beyond the dimension of the transfer vectors, or 16 for packed weights,
    /// there are none.
    int components = 16;

    // Packed weights only:

    /// Bits of a receiver's weights together, at most kMostPackedBits. Every cluster divides them by
    /// variance.
    int bits = 24;
    /// Bits of each component, 1..16, the same in all clusters, instead of `bits`.
    std::vector<int> fixed_bits = {};
    /// Bits of the cluster's number; 0: as few as do.
    int cluster_bits = 0;
};

/// One 32-bit word per vertex: 8 bits of cluster, 24 of weights, which every cluster divides as it likes.
WeightCoding preset_u32();
/// Two of them: 8 bits of cluster, 56 of weights.
WeightCoding preset_u64();
/// The same words, divided alike in all clusters, for shaders without a loop: four weights of 7, 6, 6 and 5
/// bits; nine of 9, 8, 7, 7, 6, 6, 5, 4 and 4.
WeightCoding preset_u32x4();
WeightCoding preset_u64x9();

/// Guides (prt/clustered_bases.h): those by which a renderer has what the surface gives. They take three
/// multiply-adds each of the vertex shader, and three rows of every cluster.
enum class GuideChoice { none, normal, normal_and_position };

struct CompressOptions {
    int clusters = 256;
    WeightCoding coding = {};
    /// Components per receiver on average, where clusters may differ: what the vertex shader pays beside
    /// guides. 0: no limit.
    double mean_components = 0;
    GuideChoice guides = GuideChoice::normal;
    /// Squared error that rounding the bases may add, as a share of what there is; 0: bases are float32.
    /// Unset: 0.1. Not for floats, beside which bases are float32.
    std::optional<double> basis_share = {};
    /// Packed weights: bases count in the size, so that clusters leave out directions which take more than
    /// they give.
    bool bases_count = false;
    /// What an error costs; nothing: the outdoor family, `balanced`.
    std::optional<LightMetric> metric = {};
    /// mu of docs/math.md, eq. 28: what a jump of the error along a mesh edge costs, in units of the error
    /// itself.
    double seam_price = 1;
    std::uint64_t seed = 0;
    int threads = 0;          ///< 0: all
    CompressTrace trace = {}; ///< is told what happens; results are the same with and without
};

struct CompressStatistics {
    /// Expected lit_rms under the metric after each round of clustered PCA at the full number of components,
    /// before weights are quantised.
    std::vector<double> lit_rms_by_iteration;
    double lit_rms = 0; ///< expected under the metric, of what is returned
    /// Contrast errors of lamps, each alone: the root of their mean square over receivers and lamps
    /// (prt/error_measures.h). 0 without lamps, and of probes.
    double lamp_contrast = 0;
    /// The same under skies, over the light that a receiver has on average; 0 of probes and of lamps alone.
    double sky_contrast = 0;
    int clusters = 0;           ///< that hold receivers; empty ones are dropped
    double mean_components = 0; ///< of all receivers
    int guide_rows = 0;         ///< of every cluster
    double seconds = 0;
    std::size_t bytes_per_receiver = 0; ///< what a game binds: cluster and weights
    std::size_t bits_per_receiver = 0;  ///< of them in use
    std::size_t basis_bytes = 0;        ///< all bases, and the layout of packed weights

    /// The error that budgets limit.
    double error() const { return std::max({lit_rms, lamp_contrast, sky_contrast}); }
    /// What the vertex shader adds to a mean, on average.
    double operations() const { return mean_components + guide_rows; }
    double bytes_with_bases(std::size_t receivers) const {
        return static_cast<double>(bytes_per_receiver) +
               static_cast<double>(basis_bytes) / static_cast<double>(receivers);
    }
};

struct CompressResult {
    ClusteredTransfer transfer;
    CompressStatistics statistics;
};

/// Compresses `transfer` on `surface`. Deterministic from the seed, whatever the number of threads.
/// Thread-safe. Throws `Error` for options outside their range, transfer beyond `kMostTransfer`, areas,
/// normals and positions that are not finite and edges of receivers that are not there, and `Cancelled`.
/// Memory, beside what is passed: of each of many receivers two bytes for every number of its transfer and
/// guides that carries error (four for less than 65 536 receivers), three times its code, and about a hundred
/// bytes; transfer is read block by block. Time: proportional to receivers × clusters × components.
CompressResult compress(const TransferView& transfer, const ReceiverSurface& surface,
                        const CompressOptions& options, const Progress& progress = {});

} // namespace prt
