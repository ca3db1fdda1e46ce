// Measures rate and distortion of this compressor and of reference methods, at equal bytes and at equal
// components per receiver.

#include "compress/study/sweep.h"

#include "prt/compress/search.h"
#include "prt/core/error_measures.h"
#include "runtime/core/support/counted.h"
#include "runtime/core/support/stopwatch.h"

#include <algorithm>
#include <cmath>
#include <iomanip>
#include <set>
#include <sstream>

namespace prt {
namespace {

/// Formats a number with three digits: "7", "3.25".
std::string short_number(double value) {
    std::ostringstream text;
    text << std::setprecision(3) << value;
    return text.str();
}

class Sweeper {
public:
    Sweeper(const Transfer& transfer, const ReceiverSurface& surface, std::span<const Light> lights,
            const CompressOptions& options, const Progress& progress)
        : transfer_(transfer), surface_(surface), lights_(lights), options_(options), progress_(progress) {
        for (const Light& light : lights)
            references_.push_back(exit_radiance(transfer, light, options.threads));
        one_cluster_.resize(transfer.receivers());
    }

    Sweep run(std::span<const SweepCandidate> others) {
        truncations();
        plain_pca();
        measure(others);
        clustered();
        ours();
        progress_.update(1);
        return std::move(sweep_);
    }

private:
    SweepPoint measured(const std::string& method, const std::string& setting,
                        const Transfer& decoded) const {
        SweepPoint point{method, setting};
        double squares = 0, squared_jumps = 0;
        for (std::size_t l = 0; l < lights_.size(); ++l) {
            const auto lit = exit_radiance(decoded, lights_[l], options_.threads);
            const double rms = lit_rms(references_[l], lit, surface_.areas);
            squares += rms * rms;
            // Measures methods with and without clusters equally: all edges are inside one cluster.
            const double jump = lit_error(references_[l], lit, surface_.areas, surface_.edges, one_cluster_)
                                    .inner.percentile_99;
            squared_jumps += jump * jump;
        }
        const double lights = std::max(1.0, static_cast<double>(lights_.size()));
        point.lit_rms = std::sqrt(squares / lights);
        point.jumps = std::sqrt(squared_jumps / lights);
        point.relative_l2 = relative_l2(transfer_, decoded, surface_.areas);
        return point;
    }

    SweepPoint measured(const std::string& method, const std::string& setting, const BaselineResult& r,
                        double seconds) const {
        SweepPoint point = measured(method, setting, r.decoded);
        point.payload_bytes = r.payload_bytes;
        point.table_bytes = r.table_bytes / static_cast<double>(transfer_.receivers());
        point.mean_components = r.mean_components;
        point.seconds = seconds;
        return point;
    }

    SweepPoint measured(const std::string& setting, const CompressResult& r) const {
        SweepPoint point = measured(kOurs, setting, decode(r.transfer, options_.threads));
        point.payload_bytes = static_cast<double>(r.statistics.bytes_per_receiver);
        point.table_bytes =
            static_cast<double>(r.statistics.basis_bytes) / static_cast<double>(transfer_.receivers());
        point.mean_components = r.statistics.operations();
        point.seconds = r.statistics.seconds;
        return point;
    }

    void truncations() {
        for (int bands = 1; bands <= transfer_.layout.order; ++bands) {
            const SweepPoint point =
                measured("truncated SH", "order " + std::to_string(bands), truncated_sh(transfer_, bands), 0);
            sweep_.by_bytes.push_back(point);
            sweep_.by_components.push_back(point);
        }
    }

    SweepPoint classic(const std::string& method, int clusters, int components, bool iterate,
                       const Progress& progress) const {
        const Stopwatch stopwatch;
        const BaselineResult r = classic_cpca(transfer_, surface_.areas,
                                              {.clusters = clusters,
                                               .components = components,
                                               .iterate = iterate,
                                               .seed = options_.seed,
                                               .threads = options_.threads},
                                              progress);
        return measured(method, std::to_string(clusters) + " x " + std::to_string(components), r,
                        stopwatch.seconds());
    }

    void plain_pca() {
        double done = 0.01;
        for (const int components : {2, 4, 8, 12, 16, 24, 32}) {
            if (static_cast<std::size_t>(components) > transfer_.dimension())
                break;
            const SweepPoint point =
                classic("plain PCA", 1, components, true, progress_.range(done, done + 0.002));
            done += 0.002;
            sweep_.by_bytes.push_back(point);
            sweep_.by_components.push_back(point);
        }
    }

    void measure(std::span<const SweepCandidate> others) {
        double done = 0.025;
        for (const SweepCandidate& other : others) {
            const double end = done + 0.045 / static_cast<double>(others.size());
            const Progress progress = progress_.range(done, end);
            done = end;
            progress.update(0);
            const Stopwatch stopwatch;
            const std::optional<CandidateResult> found = other.run(progress);
            if (!found)
                continue;
            const SweepPoint point =
                measured(other.method, found->setting, found->coded, stopwatch.seconds());
            if (other.tables != SweepTables::by_components)
                sweep_.by_bytes.push_back(point);
            if (other.tables != SweepTables::by_bytes)
                sweep_.by_components.push_back(point);
        }
    }

    /// Returns the maximum number of components of `clusters` clusters in `bytes`, with rows as float16; -1:
    /// not even zero components fit.
    int classic_components(int clusters, double bytes) const {
        const auto row = static_cast<double>(clusters) * static_cast<double>(2 * transfer_.dimension()) /
                         static_cast<double>(transfer_.receivers());
        const double scale = 4.0 * clusters / static_cast<double>(transfer_.receivers());
        const std::size_t index = clusters > 256 ? 2 : 1;
        std::size_t count = 0; // numbers of components that fit, including zero
        while (count <= transfer_.dimension() &&
               bound_bytes(index + count) + row + static_cast<double>(count) * (row + scale) <= bytes)
            ++count;
        return static_cast<int>(count) - 1;
    }

    /// Returns the maximum number of clusters. With a cluster for every few receivers, a method has no error
    /// and compresses nothing.
    int max_clusters() const {
        const std::size_t most = transfer_.receivers() / kMinReceiversPerCluster;
        return static_cast<int>(std::clamp<std::size_t>(most, 1, 1024));
    }

    void clustered() {
        double done = 0.07;
        for (int clusters = std::min(4, max_clusters()); clusters <= max_clusters(); clusters *= 2) {
            std::set<int> components; // fewer components than fit are never better
            for (const double bytes : kSweepBytes)
                components.insert(classic_components(clusters, bytes));
            for (const int m : components) {
                done += 0.02 * (0.5 - done);
                if (m < 1)
                    continue;
                sweep_.by_bytes.push_back(
                    classic("static CPCA", clusters, m, false, progress_.range(done, done)));
                sweep_.by_bytes.push_back(classic(kClassic, clusters, m, true, progress_.range(done, done)));
            }
            if (*components.rbegin() >= 0)
                sweep_.by_bytes.push_back(
                    classic("vector quantisation", clusters, 0, false, progress_.range(done, done)));
        }
        const int clusters = std::min(kSweepClusters, max_clusters());
        for (const int m : kSweepComponents) {
            if (static_cast<std::size_t>(m) > transfer_.dimension())
                break;
            sweep_.by_components.push_back(
                classic("static CPCA", clusters, m, false, progress_.range(0.5, 0.5)));
            sweep_.by_components.push_back(classic(kClassic, clusters, m, true, progress_.range(0.5, 0.5)));
        }
        sweep_.by_components.push_back(
            classic("vector quantisation", clusters, 0, false, progress_.range(0.5, 0.5)));
    }

    void ours() {
        double done = 0.5;
        for (const double bytes : kSweepBytes) {
            Budget budget;
            budget.bytes_per_vertex = bytes;
            within(budget, short_number(bytes) + " bytes", progress_.range(done, done + 0.07),
                   sweep_.by_bytes);
            done += 0.07;
        }
        // The operations of classic CPCA, with at most its bytes.
        for (const SweepPoint& reference : std::vector<SweepPoint>(sweep_.by_components)) {
            if (reference.method != kClassic)
                continue;
            if (!(reference.mean_components > 0)) {
                sweep_.left_out.push_back(
                    "no point for the operations of classic CPCA with " + reference.setting +
                    ": it has one cluster per receiver, or all receivers have the same transfer");
                continue;
            }
            Budget budget;
            budget.bytes_per_vertex = reference.bytes();
            budget.operations = reference.mean_components;
            within(budget,
                   short_number(reference.mean_components) + " operations and " +
                       short_number(reference.bytes()) + " bytes",
                   progress_.range(done, done + 0.01), sweep_.by_components);
            done += 0.01;
        }
    }

    /// Adds the result of prtkit within a budget, or the reason why it is missing.
    void within(const Budget& budget, const std::string& words, const Progress& progress,
                std::vector<SweepPoint>& points) {
        SearchOptions o;
        o.compress = options_;
        o.budget = budget;
        const SearchResult found = compress_within(transfer_, surface_, o, progress);
        const CompressStatistics& s = found.result.statistics;
        if (found.kept)
            points.push_back(measured(counted(s.clusters, "cluster"), found.result));
        else
            sweep_.left_out.push_back("no setting meets " + words + "; the closest has " +
                                      short_number(s.bytes_with_bases(transfer_.receivers())) +
                                      " bytes and " + short_number(s.operations()) + " operations");
    }

    const Transfer& transfer_;
    ReceiverSurface surface_;
    std::span<const Light> lights_;
    const CompressOptions& options_;
    const Progress& progress_;
    std::vector<std::vector<glm::vec3>> references_;
    std::vector<std::uint16_t> one_cluster_; ///< [receivers], all 0
    Sweep sweep_;
};

template <class Cost>
const SweepPoint* best(const std::vector<SweepPoint>& points, const std::string& method, double most,
                       Cost&& cost) {
    const SweepPoint* found = nullptr;
    for (const SweepPoint& point : points)
        if (point.method == method && cost(point) <= most && (!found || point.lit_rms < found->lit_rms))
            found = &point;
    return found;
}

} // namespace

Sweep sweep(const Transfer& transfer, const ReceiverSurface& surface, std::span<const Light> lights,
            const CompressOptions& options, std::span<const SweepCandidate> others,
            const Progress& progress) {
    return Sweeper(transfer, surface, lights, options, progress).run(others);
}

const SweepPoint* best_by_bytes(const Sweep& sweep, const std::string& method, double bytes) {
    return best(sweep.by_bytes, method, bytes, [](const SweepPoint& p) { return p.bytes(); });
}

const SweepPoint* best_by_components(const Sweep& sweep, const std::string& method, double components) {
    return best(sweep.by_components, method, components,
                [](const SweepPoint& p) { return p.mean_components; });
}

} // namespace prt
