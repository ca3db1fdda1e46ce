#pragma once

// Rate-distortion comparison of this compressor with reference methods.

#include "prt/baselines.h"
#include "prt/compress.h"

#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace prt {

struct SweepPoint {
    std::string method, setting;
    double payload_bytes = 0;   ///< per receiver, as a game binds it: whole 32-bit words
    double table_bytes = 0;     ///< bases and all other tables, per receiver
    double mean_components = 0; ///< per receiver; each costs one multiply-add of a color
    double lit_rms = 0;         ///< root mean square over the lights of the sweep
    double relative_l2 = 0;
    /// 99th percentile of the jumps of error along all edges (`EdgeJumps`), within or across clusters; root
    /// mean square over the lights. 0 if the surface has no edges.
    double jumps = 0;
    double seconds = 0;

    double bytes() const { return payload_bytes + table_bytes; }
};

struct Sweep {
    std::vector<SweepPoint> by_bytes; ///< every method at suitable sizes
    /// The clustered methods of the literature with `kSweepClusters` clusters, or one per
    /// `kMinReceiversPerCluster` receivers if that is fewer. prtkit with any number of clusters that needs
    /// no more bytes than classic CPCA with the same number of components.
    std::vector<SweepPoint> by_components;
    std::vector<std::string> left_out; ///< missing points of prtkit, with reasons
};

inline constexpr int kSweepClusters = 256; ///< fits one byte
/// Minimum number of receivers per cluster for the methods of the literature. Chosen by hand.
inline constexpr std::size_t kMinReceiversPerCluster = 8;
/// Budgets of the sweep, bytes per receiver including bases: at most one, one, two and three words.
inline constexpr double kSweepBytes[] = {5, 7, 9, 13};
/// Components per receiver.
inline constexpr int kSweepComponents[] = {1, 2, 4, 8};

/// The tables of a sweep that a point belongs to.
enum class SweepTables { both, by_bytes, by_components };

/// Coded transfer of a candidate, and its setting.
struct CandidateResult {
    std::string setting; ///< see `SweepPoint::setting`
    BaselineResult coded;
};

/// A method supplied by the caller, at one setting.
struct SweepCandidate {
    std::string method;
    /// Codes and decodes. Returns no value if the method has no code at this setting.
    std::function<std::optional<CandidateResult>(const Progress&)> run;
    SweepTables tables = SweepTables::both;
};

/// Measures all methods and `others` under `lights`, which should differ from the lights that `options`
/// compresses for. Takes minutes.
Sweep sweep(const Transfer& transfer, const ReceiverSurface& surface, std::span<const Light> lights,
            const CompressOptions& options, std::span<const SweepCandidate> others = {},
            const Progress& progress = {});

/// Returns the best point of `method` with at most `bytes` per receiver; null if absent.
const SweepPoint* best_by_bytes(const Sweep& sweep, const std::string& method, double bytes);
/// Returns the best point of `method` with at most `components`; null if absent.
const SweepPoint* best_by_components(const Sweep& sweep, const std::string& method, double components);

inline constexpr const char* kOurs = "prtkit";
inline constexpr const char* kClassic = "classic CPCA";

} // namespace prt
