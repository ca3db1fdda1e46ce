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

/// Maximum size of packed weights with their cluster: eight 32-bit words per receiver.
inline constexpr int kMaxPackedWords = 8;
/// Maximum number of bits of the packed weights of a receiver: 240, because the cluster takes up to 16 bits
/// of the words.
inline constexpr int kMaxPackedBits = 32 * kMaxPackedWords - 16;

/// Maximum magnitude of a transfer coefficient that can be compressed. Real coefficients are at most about 1,
/// and a few hundred behind nearly black sheets. Squares of values up to this limit can be summed in floats.
inline constexpr float kMaxInputTransfer = 1e12f;
/// Maximum of CompressOptions::seam_weight.
inline constexpr double kMaxSeamWeight = 1e6;

/// Storage of a receiver's weights.
struct WeightCoding {
    WeightFormat format = WeightFormat::packed;
    /// Maximum number of components of a cluster; limited to the dimension of the transfer vectors, and to 16
    /// for packed weights.
    int components = 16;

    // Packed weights only:

    /// Number of bits for all weights of a receiver, at most kMaxPackedBits. Each cluster distributes them
    /// over its components by variance.
    int bits = 24;
    /// Number of bits of each component, 1..16, identical in all clusters; if not empty, replaces `bits`.
    std::vector<int> fixed_bits = {};
    /// Number of bits of the cluster index; 0: the minimum for the number of clusters.
    int cluster_bits = 0;
};

/// Returns a coding with one 32-bit word per vertex: 8 bits for the cluster and 24 bits for weights, which
/// each cluster distributes separately.
WeightCoding preset_u32();
/// Returns a coding with two 32-bit words per vertex: 8 bits for the cluster and 56 bits for weights, which
/// each cluster distributes separately.
WeightCoding preset_u64();
/// Returns a coding with one 32-bit word per vertex and the same bit widths in all clusters, for shaders
/// without a loop: four weights of 7, 6, 6 and 5 bits.
WeightCoding preset_u32x4();
/// Returns a coding with two 32-bit words per vertex and the same bit widths in all clusters, for shaders
/// without a loop: nine weights of 9, 8, 7, 7, 6, 6, 5, 4 and 4 bits.
WeightCoding preset_u64x9();

/// Predictors to use (prt/clustered_bases.h), by the vertex attributes that the renderer has. Each predictor
/// costs three multiply-adds in the vertex shader, and three rows per cluster.
enum class PredictorChoice { none, normal, normal_and_position };

/// Settings of the compressor.
struct CompressOptions {
    int clusters = 256;
    WeightCoding coding = {};
    /// Maximum mean number of components per receiver, which is the cost in the vertex shader in addition to
    /// predictors. Clusters may then have different numbers of components. 0: no limit.
    double mean_components = 0;
    PredictorChoice predictors = PredictorChoice::normal;
    /// Squared error that rounding of the bases may add, as a fraction of the squared error without it. 0:
    /// bases are float32. Without a value: 0.1. Ignored for float weights, whose bases are always float32.
    std::optional<double> basis_share = {};
    /// For packed weights: include the bytes of the bases in the cost. Clusters then omit directions whose
    /// bytes reduce the error more if they are spent on other clusters.
    bool bases_count = false;
    /// Cost of an error. Without a value: the metric of LightFamily::outdoor, `balanced`.
    std::optional<LightMetric> metric = {};
    /// mu of docs/math.md, eq. 28: the cost of a jump of the error along a mesh edge, relative to the error
    /// itself.
    double seam_weight = 1;
    std::uint64_t seed = 0;
    int threads = 0;          ///< 0: all
    CompressTrace trace = {}; ///< receives progress events; does not change results
};

/// Measurements of a compression.
struct CompressStatistics {
    /// Expected `lit_rms` under the metric after each round of clustered PCA with the full number of
    /// components, before weights are quantised.
    std::vector<double> lit_rms_by_iteration;
    double lit_rms = 0; ///< expected lit_rms of the result under the metric
    /// Contrast error (prt/error_measures.h) under each lamp alone, root mean square over receivers and
    /// lamps. 0 without lamps, and for probes.
    double lamp_contrast = 0;
    /// Contrast error under skies, relative to the mean light of a receiver; 0 for probes and for transfer of
    /// lamps alone.
    double sky_contrast = 0;
    int clusters = 0;           ///< number of clusters with receivers; empty ones are removed
    double mean_components = 0; ///< mean over all receivers
    int predictor_rows = 0;     ///< per cluster
    double seconds = 0;
    std::size_t bytes_per_receiver = 0; ///< bytes of vertex attributes: cluster and weights
    std::size_t bits_per_receiver = 0;  ///< number of used bits
    std::size_t basis_bytes = 0;        ///< size of all bases, and of the layout of packed weights

    /// Returns the error that budgets limit: the maximum of the three errors.
    double error() const { return std::max({lit_rms, lamp_contrast, sky_contrast}); }
    /// Returns the mean number of rows that the vertex shader multiplies by a weight and adds to the cluster
    /// mean.
    double operations() const { return mean_components + predictor_rows; }
    /// Returns the size per receiver in bytes, including the bases.
    double bytes_with_bases(std::size_t receivers) const {
        return static_cast<double>(bytes_per_receiver) +
               static_cast<double>(basis_bytes) / static_cast<double>(receivers);
    }
};

/// Result of the compressor.
struct CompressResult {
    ClusteredTransfer transfer;
    CompressStatistics statistics;
};

/// Compresses `transfer`, whose receivers are described by `surface`. The result does not depend on the
/// number of threads. Thread-safe. Throws `Error` for options out of range, transfer above
/// `kMaxInputTransfer`, areas, normals and positions that are not finite, and edges of receivers that do not
/// exist; throws `Cancelled` after a stop request. Reads transfer block by block. Memory in addition to the
/// arguments, per receiver: two bytes (four bytes below 65 536 receivers) for every coefficient and predictor
/// coordinate that contributes to the error, three times the size of its code, and about a hundred bytes.
/// Time: proportional to receivers × clusters × components.
CompressResult compress(const TransferView& transfer, const ReceiverSurface& surface,
                        const CompressOptions& options, const Progress& progress = {});

} // namespace prt
