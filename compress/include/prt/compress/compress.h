#pragma once

// The compressor: clustered PCA of transfer vectors (Sloan, Hall, Hart and Snyder 2003, "Clustered Principal
// Components for Precomputed Radiance Transfer"). It minimises the error of exit radiance rather than of
// coefficients; docs/math.md, section 4.
//
//     CompressResult r = compress(transfer, SceneSurface(scene).view(), {.coding = preset_u32()});
//
// `prt/compress/search.h` chooses options for a budget; docs/terminology.md defines the terms.

#include "prt/compress/compress_trace.h"
#include "prt/compress/light_metric.h"
#include "prt/compress/receiver_surface.h"
#include "prt/core/clustered_transfer.h"
#include "prt/core/progress.h"
#include "prt/core/transfer_volume.h"

#include <algorithm>
#include <cstdint>
#include <optional>
#include <vector>

namespace prt {

/// Maximum number of 32-bit words per receiver for the cluster index and packed weights together.
inline constexpr int kMaxPackedWords = 8;
/// Maximum of WeightCoding::bits: 240. The remaining 16 bits of the words can hold the cluster index.
inline constexpr int kMaxPackedBits = 32 * kMaxPackedWords - 16;

/// Maximum magnitude of a transfer coefficient that can be compressed. Typical coefficients are below 1;
/// those of nearly black thin sheets reach a few hundred. The sum of the squares of many such coefficients
/// fits into a float.
inline constexpr float kMaxInputTransfer = 1e12f;
/// Maximum of CompressOptions::seam_weight.
inline constexpr double kMaxSeamWeight = 1e6;

/// Storage format of the cluster index and the weights of a receiver.
struct WeightCoding {
    /// `packed`: weights of few bits share 32-bit words with the cluster index. `float32`: weights are not
    /// rounded.
    WeightFormat format = WeightFormat::packed;
    /// Maximum number of components of a cluster, at least 0. Also limited by the dimension of the transfer
    /// vectors, and for packed weights by kMaxPackedComponents and the number of bits.
    int components = 16;

    // Packed weights only:

    /// Total number of bits of all weights of a receiver, 0..kMaxPackedBits; 0: no components. Each cluster
    /// distributes the bits over its components to minimise the error. Ignored if `fixed_bits` is not empty.
    int bits = 24;
    /// [components] number of bits of each component, 1..16 each, the same in all clusters. Only the first
    /// kMaxPackedComponents elements are used; their sum must be at most kMaxPackedBits, which is not
    /// checked. The length also limits the number of components. Empty: each cluster distributes `bits`.
    std::vector<int> fixed_bits = {};
    /// Number of bits of the cluster index in the words, 1..16. CompressOptions::clusters must be at most 2
    /// to this power. 0: the minimum for the number of clusters of the result.
    int cluster_bits = 0;
};

/// Returns a coding with one 32-bit word per receiver: 8 bits for the cluster index, so that at most 256
/// clusters are allowed, and 24 bits for weights. Each cluster distributes the 24 bits over its components
/// separately.
WeightCoding preset_u32();
/// Returns a coding with two 32-bit words per receiver: 8 bits for the cluster index, so that at most 256
/// clusters are allowed, and 56 bits for weights. Each cluster distributes the 56 bits over its components
/// separately.
WeightCoding preset_u64();
/// Returns a coding with one 32-bit word per receiver: 8 bits for the cluster index (at most 256 clusters),
/// and four weights of 7, 6, 6 and 5 bits in every cluster. The vertex shader needs no loop.
WeightCoding preset_u32x4();
/// Returns a coding with two 32-bit words per receiver: 8 bits for the cluster index (at most 256 clusters),
/// and nine weights of 9, 8, 7, 7, 6, 6, 5, 4 and 4 bits in every cluster. The vertex shader needs no loop.
WeightCoding preset_u64x9();

/// Settings of the compressor.
struct CompressOptions {
    int clusters = 256; ///< maximum number of clusters, 1..65536; clusters without receivers are removed
    WeightCoding coding = {}; ///< storage format of cluster index and weights
    /// Maximum of the mean number of components per receiver; finite and at least 0. Each component costs one
    /// multiply-add of a color in the vertex shader; predictors are not counted. Clusters then have different
    /// numbers of components. 0: no limit except WeightCoding::components.
    double mean_components = 0;
    PredictorChoice predictors = PredictorChoice::normal; ///< receiver attributes that act as predictors
    /// Squared error that rounding of the bases may add, as a fraction of the squared error with exact bases:
    /// at least 0 and less than 1. 0: bases are float32. No value: 0.1. Ignored for WeightFormat::float32,
    /// whose bases are always float32.
    std::optional<double> basis_share = {};
    /// True: also minimise the bytes of the bases. A cluster then omits directions whose bytes would reduce
    /// the error more in other clusters. False: bases cost nothing. Ignored for WeightFormat::float32.
    bool bases_count = false;
    /// Cost of a transfer error, with the layout of the transfer. No value: the `balanced` metric of
    /// LightFamily::outdoor.
    std::optional<LightMetric> metric = {};
    /// mu of docs/math.md, eq. 28: the cost of a squared jump of the error along a mesh edge, relative to the
    /// cost of a squared error. 0..kMaxSeamWeight; 0: jumps cost nothing.
    double seam_weight = 1;
    std::uint64_t seed = 0;   ///< seed of the initial clusters
    int threads = 0;          ///< number of threads; 0: all
    CompressTrace trace = {}; ///< callback for events, which does not change the result; may be empty
};

/// Measurements of a compression. "The metric" is CompressOptions::metric or its default. Errors are
/// fractions, weighted by area: 0.01 is 1 %.
struct CompressStatistics {
    /// Relative error, before weights are quantised, after each round of clustered PCA that decreased the
    /// cost. The list ends before clusters are split and merged; it does not include later rounds. It
    /// approximates `lit_rms`, but receivers with more visible errors count more. With lamps it is an error
    /// of logarithms of light and cannot be compared with `lit_rms`.
    std::vector<double> lit_rms_by_iteration;
    double lit_rms = 0; ///< `expected_lit_rms` (prt/compress/light_metric.h) of the result under the metric
    /// Contrast error (docs/math.md, eq. 33b) with one lamp on and all other light off: root mean square over
    /// receivers and lamps. 0 if the transfer has no lamps or is that of probes.
    double lamp_contrast = 0;
    /// Contrast error (docs/math.md, eq. 33b) of sky light under the metric, relative to the expected sky
    /// light of each receiver: root mean square over receivers. 0 if the transfer has only lamps or is that
    /// of probes.
    double sky_contrast = 0;
    int clusters = 0;                   ///< number of clusters, all of which have receivers
    double mean_components = 0;         ///< number of components per receiver, averaged over all receivers
    int predictor_rows = 0;             ///< number of predictor rows per cluster: three per predictor
    double seconds = 0;                 ///< duration of the compression
    std::size_t bytes_per_receiver = 0; ///< size of the cluster index and weights of one receiver, as a game
                                        ///< binds them
    std::size_t bits_per_receiver = 0;  ///< used bits in these bytes, maximum over all clusters
    std::size_t basis_bytes = 0; ///< size of the bases of all clusters in bytes, including the layout of
                                 ///< packed weights

    /// Returns the error that a budget limits (Budget::max_error): the maximum of `lit_rms`, `lamp_contrast`
    /// and `sky_contrast`.
    double error() const { return std::max({lit_rms, lamp_contrast, sky_contrast}); }
    /// Returns the number of multiply-adds of a color per receiver in the vertex shader, averaged over all
    /// receivers: one per component and one per predictor row.
    double operations() const { return mean_components + predictor_rows; }
    /// Returns `bytes_per_receiver` plus the share of one receiver in `basis_bytes`. `receivers`: number of
    /// receivers of the transfer.
    double bytes_with_bases(std::size_t receivers) const {
        return static_cast<double>(bytes_per_receiver) +
               static_cast<double>(basis_bytes) / static_cast<double>(receivers);
    }
};

/// Result of the compressor.
struct CompressResult {
    ClusteredTransfer transfer;    ///< bases of all clusters; cluster and weights of each receiver
    CompressStatistics statistics; ///< errors and sizes
};

/// Compresses `transfer`. `surface` has the areas, edges and attributes of the same receivers, in the same
/// order; receivers with area 0 do not count in the error. Keeps no references. The result does not depend on
/// the number of threads. Thread-safe.
///
/// Throws `Error` for an invalid layout, for options out of range, for a metric with another layout, for
/// transfer without receivers, and for transfer that is not finite or exceeds `kMaxInputTransfer`. Throws
/// `Error` if an array of `surface` has another number of receivers (`normals` and `positions` may be empty),
/// if areas, normals or positions are not finite, and if edges or jumps refer to receivers that do not exist.
/// Throws `Cancelled` after a stop request.
///
/// Memory per receiver, in addition to the arguments: two bytes (four bytes below 65 536 receivers) for every
/// coefficient and predictor coordinate that contributes to the error, three times the size of the compressed
/// receiver, and about a hundred bytes. The time is proportional to receivers × clusters × components.
CompressResult compress(const TransferView& transfer, const ReceiverSurface& surface,
                        const CompressOptions& options, const Progress& progress = {});

// Volumes: each probe is one receiver, whose transfer vector has one output per SH coefficient of incident
// light (TransferLayout::outputs).

/// Returns a view of the raw transfer of `volume` with one receiver per probe and `volume.coefficients()`
/// outputs. The view keeps a reference to `volume`, which must outlive the view.
TransferView as_probes(const BakedVolume& volume);

/// Returns a metric for vectors with `outputs` outputs: 4, 9 or 16, which is not checked. The cost of an
/// error is the sum over the outputs of the cost under `of_one`, a metric of exit radiance (one output). This
/// sum is proportional to the squared error of incident light, averaged over all directions.
LightMetric incident_metric(const LightMetric& of_one, std::size_t outputs);

/// Returns a coding with 128 bits per probe: 8 bits for the cluster index, which allow up to 256 clusters,
/// and 120 bits for weights.
WeightCoding preset_volume();

/// Result of `compress_volume`.
struct CompressedVolumeResult {
    CompressedVolume volume;       ///< grid, order, visibility and record are those of the input
    CompressStatistics statistics; ///< receivers are probes; `sky_contrast` and `lamp_contrast` are 0
};

/// Compresses `volume`. All probes have the same significance. `options` are used as in `compress`, except:
/// `coding.format` must be `packed`, else throws `Error`. `metric` is a metric of exit radiance (one output);
/// without a value it is that of `LightFamily::outdoor`, `balanced`. `predictors` and `seam_weight` are
/// ignored: no predictors are used, and jumps are not reduced. Throws the errors of `compress`.
CompressedVolumeResult compress_volume(const BakedVolume& volume, CompressOptions options,
                                       const Progress& progress = {});

} // namespace prt
