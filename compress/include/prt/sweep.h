#pragma once

// Rate against distortion of this compressor and of what it is measured against.

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
    double table_bytes = 0;     ///< bases and all else, per receiver
    double mean_components = 0; ///< per receiver; each is a multiply-add of a color
    double lit_rms = 0;         ///< root of the mean square over the lights of the sweep
    double relative_l2 = 0;
    /// Of the jumps of error along edges (`EdgeJumps`), across clusters or not, 99 % are below; root mean
    /// square over the lights. 0 where the surface has no edges.
    double jumps = 0;
    double seconds = 0;

    double bytes() const { return payload_bytes + table_bytes; }
};

struct Sweep {
    std::vector<SweepPoint> by_bytes; ///< every method at sizes that suit it
    /// The literature's clustered methods with `kSweepClusters` clusters, or one for each
    /// `kLeastReceiversPerCluster` receivers where that is fewer; ours with any number that takes no more
    /// bytes than classic CPCA does with the same number of components.
    std::vector<SweepPoint> by_components;
    std::vector<std::string> left_out; ///< what of ours is missing, and why
};

inline constexpr int kSweepClusters = 256; ///< in one byte
/// Receivers for each cluster of the literature's methods, at least. By hand.
inline constexpr std::size_t kLeastReceiversPerCluster = 8;
/// Budgets of the sweep, bytes per receiver with bases: one, one, two and three words at most.
inline constexpr double kSweepBytes[] = {5, 7, 9, 13};
/// Components per receiver.
inline constexpr int kSweepComponents[] = {1, 2, 4, 8};

/// The tables of a sweep that a point goes into.
enum class SweepTables { both, by_bytes, by_components };

/// Coded transfer of a candidate, and its setting.
struct CandidateResult {
    std::string setting; ///< as `SweepPoint::setting`
    BaselineResult coded;
};

/// A method that the caller brings, at one setting.
struct SweepCandidate {
    std::string method;
    /// Codes and decodes. Returns nothing where the method has no code at this setting.
    std::function<std::optional<CandidateResult>(const Progress&)> run;
    SweepTables tables = SweepTables::both;
};

/// Measures all methods and `others` under `lights`, which should be others than those that `options`
/// compresses for. Minutes.
Sweep sweep(const Transfer& transfer, const ReceiverSurface& surface, std::span<const Light> lights,
            const CompressOptions& options, std::span<const SweepCandidate> others = {},
            const Progress& progress = {});

/// The best point of `method` with at most `bytes` per receiver; nothing where it has none.
const SweepPoint* best_by_bytes(const Sweep& sweep, const std::string& method, double bytes);
/// The best point of `method` with at most so many `components`.
const SweepPoint* best_by_components(const Sweep& sweep, const std::string& method, double components);

inline constexpr const char* kOurs = "prtkit";
inline constexpr const char* kClassic = "classic CPCA";

} // namespace prt
