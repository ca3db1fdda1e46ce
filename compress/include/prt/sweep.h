#pragma once

// Comparison of this compressor with reference methods: error against size (rate and distortion).

#include "prt/baselines.h"
#include "prt/compress.h"

#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace prt {

/// Error and size of one method at one setting.
struct SweepPoint {
    std::string method, setting;
    double payload_bytes = 0;   ///< per receiver, as a game binds it: whole 32-bit words
    double table_bytes = 0;     ///< bases and all other tables, per receiver
    double mean_components = 0; ///< per receiver; each costs one multiply-add of a color
    double lit_rms = 0;         ///< root mean square over the lights of the sweep
    double relative_l2 = 0;
    /// 99th percentile of the jumps of the error along all edges (`EdgeJumps`), inside clusters and between
    /// them; root mean square over the lights. 0 if the surface has no edges.
    double jumps = 0;
    double seconds = 0;

    double bytes() const { return payload_bytes + table_bytes; }
};

/// Result of a comparison.
struct Sweep {
    std::vector<SweepPoint> by_bytes; ///< all methods, each at suitable sizes
    /// The clustered methods at the same numbers of components. Methods of the literature have
    /// `kSweepClusters` clusters, or one per `kMinReceiversPerCluster` receivers if that is fewer. prtkit has
    /// any number of clusters that needs no more bytes than classic CPCA with the same number of components.
    std::vector<SweepPoint> by_components;
    std::vector<std::string> left_out; ///< missing points of prtkit, with reasons
};

/// Maximum number of clusters of the methods of the literature; their index fits one byte.
inline constexpr int kSweepClusters = 256;
/// Minimum number of receivers per cluster for the methods of the literature. Chosen by hand.
inline constexpr std::size_t kMinReceiversPerCluster = 8;
/// Budgets of the sweep, bytes per receiver including bases: at most one, one, two and three words.
inline constexpr double kSweepBytes[] = {5, 7, 9, 13};
/// Numbers of components per receiver in the sweep.
inline constexpr int kSweepComponents[] = {1, 2, 4, 8};

/// The tables of a sweep that a point belongs to.
enum class SweepTables { both, by_bytes, by_components };

/// Result of a candidate, and its setting.
struct CandidateResult {
    std::string setting; ///< see `SweepPoint::setting`
    BaselineResult coded;
};

/// A method that the caller supplies, at one setting.
struct SweepCandidate {
    std::string method;
    /// Function that codes and decodes the transfer. Returns no value if the method does not support this
    /// setting.
    std::function<std::optional<CandidateResult>(const Progress&)> run;
    SweepTables tables = SweepTables::both;
};

/// Measures all methods and `others` under `lights`, which should differ from the lights that `options`
/// compresses for. Takes minutes.
Sweep sweep(const Transfer& transfer, const ReceiverSurface& surface, std::span<const Light> lights,
            const CompressOptions& options, std::span<const SweepCandidate> others = {},
            const Progress& progress = {});

/// Returns the point of `method` with the lowest error among points with at most `bytes` per receiver; null
/// without such a point.
const SweepPoint* best_by_bytes(const Sweep& sweep, const std::string& method, double bytes);
/// Returns the point of `method` with the lowest error among points with at most `components`; null without
/// such a point.
const SweepPoint* best_by_components(const Sweep& sweep, const std::string& method, double components);

/// Names of methods in `SweepPoint::method`: this compressor, and clustered PCA as published.
inline constexpr const char* kOurs = "prtkit";
inline constexpr const char* kClassic = "classic CPCA";

} // namespace prt
