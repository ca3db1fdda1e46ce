#pragma once

// The compressor: clustered PCA of transfer vectors (Sloan, Hall, Hart and Snyder 2003, "Clustered Principal
// Components for Precomputed Radiance Transfer"). It minimises the error of exit radiance rather than of
// coefficients; docs/math.md, section 4.
//
//     CompressResult r = compress(transfer, SceneSurface(scene).view(), {.coding = preset_u32()});
//
// `prt/search.h` chooses options for a budget; docs/terminology.md defines the terms.

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

/// Maximum size of packed weights: eight 32-bit words per receiver, minus the cluster with up to 16 bits: 240
/// bits, 30 bytes.
inline constexpr int kMaxPackedWords = 8;
inline constexpr int kMaxPackedBits = 32 * kMaxPackedWords - 16;

/// Maximum transfer coefficient that can be compressed. A real one is 1 if all light arrives, and a few
/// hundred behind nearly black sheets. Squares of values up to this limit can be summed in floats.
inline constexpr float kMaxInputTransfer = 1e12f;
/// Maximum multiplier of seams.
inline constexpr double kMaxSeamWeight = 1e6;

/// Storage of a receiver's weights.
struct WeightCoding {
    WeightFormat format = WeightFormat::packed;
    /// Maximum number of components of a cluster; limited to the dimension of the transfer vectors, and to 16
    /// for packed weights.
    int components = 16;

    // Packed weights only:

    /// Total bits of a receiver's weights, at most kMaxPackedBits. Every cluster distributes them by
    /// variance.
    int bits = 24;
    /// Bits of each component, 1..16, identical in all clusters; replaces `bits`.
    std::vector<int> fixed_bits = {};
    /// Bits of the cluster index; 0: the minimum.
    int cluster_bits = 0;
};

/// Returns a coding with one 32-bit word per vertex: 8 bits of cluster, 24 bits of weights, which every
/// cluster distributes separately.
WeightCoding preset_u32();
/// Returns a coding with two words per vertex: 8 bits of cluster, 56 bits of weights.
WeightCoding preset_u64();
/// Return codings with one and two words, and the same bit widths in all clusters, for shaders without a
/// loop: four weights of 7, 6, 6 and 5 bits; nine weights of 9, 8, 7, 7, 6, 6, 5, 4 and 4 bits.
WeightCoding preset_u32x4();
WeightCoding preset_u64x9();

/// Predictors (prt/clustered_bases.h), selected by the attributes that the renderer has. Each predictor costs
/// three multiply-adds in the vertex shader, and three rows per cluster.
enum class PredictorChoice { none, normal, normal_and_position };

struct CompressOptions {
    int clusters = 256;
    WeightCoding coding = {};
    /// Maximum mean number of components per receiver, if clusters may differ: the cost in the vertex shader
    /// in addition to predictors. 0: no limit.
    double mean_components = 0;
    PredictorChoice predictors = PredictorChoice::normal;
    /// Squared error that rounding the bases may add, as a fraction of the existing error; 0: bases are
    /// float32. Without a value: 0.1. Ignored for float weights, whose bases are float32.
    std::optional<double> basis_share = {};
    /// Packed weights: count the bases in the size, so that clusters omit directions that cost more than they
    /// save.
    bool bases_count = false;
    /// Cost of an error; without a value: the outdoor family, `balanced`.
    std::optional<LightMetric> metric = {};
    /// mu of docs/math.md, eq. 28: the cost of a jump of the error along a mesh edge, relative to the error
    /// itself.
    double seam_weight = 1;
    std::uint64_t seed = 0;
    int threads = 0;          ///< 0: all
    CompressTrace trace = {}; ///< receives progress events; does not change results
};

struct CompressStatistics {
    /// Expected lit_rms under the metric after each round of clustered PCA at the full number of components,
    /// before weights are quantised.
    std::vector<double> lit_rms_by_iteration;
    double lit_rms = 0; ///< expected lit_rms of the result under the metric
    /// Contrast error of lamps, each alone: root mean square over receivers and lamps (prt/error_measures.h).
    /// 0 without lamps, and for probes.
    double lamp_contrast = 0;
    /// Contrast error under skies, relative to the mean light of a receiver; 0 for probes and for transfer of
    /// lamps alone.
    double sky_contrast = 0;
    int clusters = 0;           ///< number of clusters with receivers; empty ones are removed
    double mean_components = 0; ///< mean over all receivers
    int predictor_rows = 0;     ///< per cluster
    double seconds = 0;
    std::size_t bytes_per_receiver = 0; ///< size bound by a game: cluster and weights
    std::size_t bits_per_receiver = 0;  ///< number of used bits
    std::size_t basis_bytes = 0;        ///< size of all bases, and of the layout of packed weights

    /// The error that budgets limit.
    double error() const { return std::max({lit_rms, lamp_contrast, sky_contrast}); }
    /// Mean number of terms that the vertex shader adds to the cluster mean.
    double operations() const { return mean_components + predictor_rows; }
    double bytes_with_bases(std::size_t receivers) const {
        return static_cast<double>(bytes_per_receiver) +
               static_cast<double>(basis_bytes) / static_cast<double>(receivers);
    }
};

struct CompressResult {
    ClusteredTransfer transfer;
    CompressStatistics statistics;
};

/// Compresses `transfer` on `surface`. The result depends only on the seed, not on the number of threads.
/// Thread-safe. Throws `Error` for options out of range, transfer above `kMaxInputTransfer`, areas, normals
/// and positions that are not finite and edges of receivers that do not exist; throws `Cancelled`. Memory in
/// addition to the arguments, per receiver: two bytes for every coefficient and predictor coordinate that
/// carries error (four bytes for fewer than 65 536 receivers), three times its code, and about a hundred
/// bytes. Transfer is read block by block. Time: proportional to receivers × clusters × components.
CompressResult compress(const TransferView& transfer, const ReceiverSurface& surface,
                        const CompressOptions& options, const Progress& progress = {});

} // namespace prt
