#pragma once

// Comparison of this compressor with reference methods (compress/study/baselines.h): error against size, and
// error against components per receiver.

#include "compress/study/baselines.h"
#include "prt/compress/compress.h"

#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace prt {

/// Error and size of one method at one setting.
struct SweepPoint {
    /// Name of the method, such as `kOurs` or `kClassic`, and text that describes its setting for reports,
    /// such as "256 x 4" (clusters x components).
    std::string method, setting;
    double payload_bytes = 0; ///< bytes per receiver that a game binds: whole 32-bit words, without tables
    double table_bytes = 0;   ///< bytes of bases and all other tables, divided by the number of receivers
    /// Mean number of multiply-adds of a color per receiver: components, for prtkit also predictor rows, for
    /// truncated SH the coefficients.
    double mean_components = 0;
    double lit_rms = 0; ///< relative L2 error of exit radiance; root mean square over the lights of the sweep
    double relative_l2 = 0; ///< relative L2 error of transfer vectors, weighted by area
    /// 99th percentile of the jumps of the error of exit radiance along all edges, inside clusters and
    /// between clusters, in the unit of `LitError::inner`; root mean square over the lights. 0 if the surface
    /// has no edges.
    double jumps = 0;
    double seconds = 0; ///< duration of compression, or of `run` of a candidate; 0 for truncated SH

    /// Returns the size in bytes per receiver, including tables.
    double bytes() const { return payload_bytes + table_bytes; }
};

/// Result of a comparison.
struct Sweep {
    /// All methods at several sizes. prtkit has one point for each limit of `kSweepBytes`; the clustered
    /// methods of the literature have several numbers of clusters, each with the most components within each
    /// limit. Truncated SH has all orders, plain PCA fixed numbers of components.
    std::vector<SweepPoint> by_bytes;
    /// All methods at several numbers of components. The clustered methods of the literature have
    /// `kSweepComponents` components (vector quantisation has 0), with `kSweepClusters` clusters, or one per
    /// `kMinReceiversPerCluster` receivers if that is fewer. prtkit has at most the multiply-adds and the
    /// bytes of classic CPCA.
    std::vector<SweepPoint> by_components;
    std::vector<std::string> left_out; ///< one sentence for each missing point of prtkit, with the reason
};

/// Maximum number of clusters in `Sweep::by_components` for the methods of the literature; their cluster
/// index fits one byte.
inline constexpr int kSweepClusters = 256;
/// Minimum mean number of receivers per cluster for the methods of the literature. Chosen by hand.
inline constexpr std::size_t kMinReceiversPerCluster = 8;
/// Size limits of `Sweep::by_bytes`: bytes per receiver, including bases. They leave room for one, one, two
/// and three 32-bit words of payload.
inline constexpr double kSweepBytes[] = {5, 7, 9, 13};
/// Numbers of components per receiver in `Sweep::by_components`.
inline constexpr int kSweepComponents[] = {1, 2, 4, 8};

/// Tables of `Sweep` that a candidate is added to: both, or only one.
enum class SweepTables { both, by_bytes, by_components };

/// Transfer that a candidate has coded and decoded.
struct CandidateResult {
    std::string setting;  ///< becomes `SweepPoint::setting`
    BaselineResult coded; ///< decoded transfer and the size of its code
};

/// A method at one setting, for a comparison with the built-in methods.
struct SweepCandidate {
    std::string method; ///< becomes `SweepPoint::method`
    /// Function that codes and decodes the transfer that the caller passes to `sweep`. Returns no value if
    /// the method does not support this setting; the comparison then omits the candidate.
    std::function<std::optional<CandidateResult>(const Progress&)> run;
    SweepTables tables = SweepTables::both; ///< tables to which the result is added
};

/// Measures this compressor, the methods of compress/study/baselines.h and the candidates `others` on
/// `transfer`. `lights` are the skies for the errors; these should differ from the lights that
/// `options.metric` represents. `options` apply to this compressor, except sizes; `seed` and `threads` apply
/// to all built-in methods. Takes minutes. Throws the errors of `compress_within` and of `others`, and
/// `Error` if a light has fewer bands than `transfer`.
Sweep sweep(const Transfer& transfer, const ReceiverSurface& surface, std::span<const Light> lights,
            const CompressOptions& options, std::span<const SweepCandidate> others = {},
            const Progress& progress = {});

/// Returns the point of `method` in `sweep.by_bytes` with the lowest `lit_rms` among points of at most
/// `bytes` bytes per receiver, including tables. Returns null without such a point. The pointer refers into
/// `sweep`.
const SweepPoint* best_by_bytes(const Sweep& sweep, const std::string& method, double bytes);
/// Returns the point of `method` in `sweep.by_components` with the lowest `lit_rms` among points whose
/// `mean_components` is at most `components`. Returns null without such a point. The pointer refers into
/// `sweep`.
const SweepPoint* best_by_components(const Sweep& sweep, const std::string& method, double components);

/// `SweepPoint::method` of this compressor.
inline constexpr const char* kOurs = "prtkit";
/// `SweepPoint::method` of clustered PCA as published (Sloan, Hall, Hart and Snyder 2003): `classic_cpca`.
inline constexpr const char* kClassic = "classic CPCA";

} // namespace prt
