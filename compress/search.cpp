#include "prt/search.h"

#include "prt/error.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <map>
#include <string>

namespace prt {
namespace {

constexpr int kMostPayloadBytes = 30;
constexpr int kMostOperationBytes = 24; ///< sixteen components of 11 or 12 bits

void check(const SearchOptions& o) {
    for (const auto& [value, name] :
         {std::pair(o.budget.max_error, "error"), std::pair(o.budget.bytes_per_vertex, "bytes per vertex"),
          std::pair(o.budget.shader_ops, "shader operations")})
        if (value && !(*value > 0 && std::isfinite(*value)))
            throw Error("a budget of " + std::to_string(*value) + " " + name + " makes no sense");
    if (!o.budget.any())
        throw Error("there is no budget to search for");
}

/// Tries numbers of clusters and bytes of payload, each pair once, and keeps the best.
class Search {
public:
    Search(const Transfer& transfer, std::span<const float> areas, std::span<const Edge> edges,
           const SearchOptions& options, const Progress& progress)
        : transfer_(transfer), areas_(areas), edges_(edges), options_(options), progress_(progress),
          receivers_(static_cast<double>(transfer.receivers())) {
        // Fewer than a dozen receivers a cluster, and tables outweigh weights.
        const std::size_t enough = std::max<std::size_t>(64, transfer.receivers() / 12);
        most_clusters_ =
            static_cast<int>(std::clamp<std::size_t>(std::min(enough, transfer.receivers()), 1, 65536));
        if (!options.choose_clusters)
            most_clusters_ = options.compress.clusters;
    }

    SearchResult run() {
        const std::optional<double> ops = options_.budget.shader_ops;
        bases_count_ = !ops;
        search_payloads();
        if (ops && best_trial_.mean_components < 0.9 * *ops) { // they are not short
            bases_count_ = true;
            tried_.clear();
            best_.clear();
            search_payloads();
        }
        return std::move(result_);
    }

private:
    void search_payloads();
    bool packed() const { return options_.compress.weights == WeightFormat::packed; }
    SearchTrial attempt(int clusters, int payload);
    void keep_if_better(CompressResult&& result, const SearchTrial& trial);

    bool keeps(const SearchTrial& t) const {
        const Budget& b = options_.budget;
        return (!b.max_error || t.lit_rms <= *b.max_error) &&
               (!b.bytes_per_vertex || t.bytes_per_vertex <= *b.bytes_per_vertex) &&
               (!b.shader_ops || t.mean_components <= *b.shader_ops);
    }
    /// What is made small once the budget is kept; while it is not, how far off it is.
    double cost(const SearchTrial& t) const {
        const Budget& b = options_.budget;
        if (!keeps(t)) {
            double off = 1;
            if (b.max_error)
                off = std::max(off, t.lit_rms / *b.max_error);
            if (b.bytes_per_vertex)
                off = std::max(off, t.bytes_per_vertex / *b.bytes_per_vertex);
            if (b.shader_ops)
                off = std::max(off, t.mean_components / *b.shader_ops);
            return 1e6 * off;
        }
        return b.max_error ? t.bytes_per_vertex : t.lit_rms;
    }

    /// The best number of clusters at a payload: by bytes or by error. Returns its cost.
    double best_at(int payload);
    void fill_bytes(int payload);
    void reach_error(int payload);
    int clamped(double clusters) const {
        return static_cast<int>(std::clamp(std::round(clusters), 1.0, static_cast<double>(most_clusters_)));
    }

    const Transfer& transfer_;
    std::span<const float> areas_;
    std::span<const Edge> edges_;
    const SearchOptions& options_;
    const Progress& progress_;
    double receivers_;
    int most_clusters_ = 1;
    double bytes_per_cluster_ = 120; ///< of the bases, from the last try
    int clusters_guess_ = 64;
    /// Whether directions pay for their bytes. Where operations are what is short they are few anyway, and
    /// more of them must not give way to clusters that the bytes have room for: 0.40 instead of 1.04 times
    /// the error of classic CPCA with one operation, measured on a head.
    bool bases_count_ = true;
    std::map<std::pair<int, int>, SearchTrial> tried_;
    std::map<int, double> best_;
    SearchResult result_;
    bool any_ = false;
    SearchTrial best_trial_;
};

SearchTrial Search::attempt(int clusters, int payload) {
    const auto key = std::pair(clusters, payload);
    if (const auto known = tried_.find(key); known != tried_.end())
        return known->second;
    // How many tries there will be is not known; each takes a tenth of what is left of the bar.
    const double done = 1 - std::pow(0.9, static_cast<double>(tried_.size()));
    Progress part{{}, progress_.stop};
    if (progress_.report)
        part.report = [&, done](double share) { progress_.report(done + 0.1 * (1 - done) * share); };

    CompressOptions o = options_.compress;
    o.clusters = clusters;
    o.mean_components = options_.budget.shader_ops.value_or(0);
    const int cluster_bits = static_cast<int>(std::bit_width(static_cast<unsigned>(clusters - 1)));
    if (packed()) {
        o.cluster_bits = cluster_bits;
        o.bases_count = bases_count_ && (options_.budget.max_error || options_.budget.bytes_per_vertex);
        o.fixed_bits.clear();
        o.bits = std::max(0, 8 * payload - cluster_bits);
        if (options_.choose_components)
            o.components = std::min(kMostPackedComponents, static_cast<int>(transfer_.dimension()));
    } else if (options_.choose_components) {
        const int left = payload - (clusters > 256 ? 2 : 1);
        o.components = std::clamp(left / static_cast<int>(bytes_per_weight(o.weights)), 0,
                                  static_cast<int>(transfer_.dimension()));
    }
    CompressResult result = compress(transfer_, areas_, edges_, o, part);
    const CompressStatistics& s = result.statistics;
    const SearchTrial trial{clusters, payload, s.lit_rms, s.bytes_with_bases(transfer_.receivers()),
                            s.mean_components};
    bytes_per_cluster_ = std::max(4.0, static_cast<double>(s.basis_bytes) / static_cast<double>(s.clusters));
    tried_[key] = trial;
    result_.trials.push_back(trial);
    keep_if_better(std::move(result), trial);
    return trial;
}

void Search::keep_if_better(CompressResult&& result, const SearchTrial& trial) {
    if (any_ && !(cost(trial) < cost(best_trial_)))
        return;
    any_ = true;
    best_trial_ = trial;
    result_.result = std::move(result);
    result_.kept = keeps(trial);
}

/// As many clusters as the bytes have room for.
void Search::fill_bytes(int payload) {
    const double room = (*options_.budget.bytes_per_vertex - payload) * receivers_;
    double low = 0, high = static_cast<double>(most_clusters_) + 1; // known to fit, known not to
    double next = room / bytes_per_cluster_;
    for (int i = 0; i < 5; ++i) {
        const int clusters = clamped(std::clamp(next, low + 1, high - 1));
        const SearchTrial trial = attempt(clusters, payload);
        const bool fits = trial.bytes_per_vertex <= *options_.budget.bytes_per_vertex;
        (fits ? low : high) = clusters;
        best_[payload] = std::min(best_[payload], cost(trial));
        if (low + 1 >= high || (fits && trial.bytes_per_vertex > 0.975 * *options_.budget.bytes_per_vertex))
            break;
        next = 0.997 * room / bytes_per_cluster_;
        if (std::round(next) <= low)
            break; // what is left has no room for another
    }
}

/// As few clusters as reach the error: between known bounds by the slope of error against clusters on
/// logarithmic scales, of which -0.4 is usual.
void Search::reach_error(int payload) {
    const double wanted = *options_.budget.max_error;
    double low = 0, high = static_cast<double>(most_clusters_) + 1; // known to miss, known to reach
    double next = clusters_guess_;
    for (int i = 0; i < 8 && low + 1 < high; ++i) {
        const int clusters = clamped(std::clamp(next, low + 1, high - 1));
        const SearchTrial trial = attempt(clusters, payload);
        best_[payload] = std::min(best_[payload], cost(trial));
        const bool reached = trial.lit_rms <= wanted;
        if (reached)
            clusters_guess_ = clusters;
        (reached ? high : low) = clusters;
        if (reached && trial.lit_rms > 0.985 * wanted)
            break;
        // More clusters only cost more where the bytes already pass what is allowed, or the best so far.
        const double most_bytes =
            result_.kept ? best_trial_.bytes_per_vertex : options_.budget.bytes_per_vertex.value_or(1e30);
        if (!reached && trial.bytes_per_vertex > most_bytes)
            break;
        const double factor = std::pow(trial.lit_rms / (0.993 * wanted), 1 / 0.4);
        next = clusters * std::clamp(factor, 1.0 / 64, 4.0);
        if (factor > 64) // so far off, a larger payload is the way
            break;
        if (low > 0 && high <= most_clusters_ && (next <= low || next >= high))
            next = std::sqrt(low * high);
    }
}

double Search::best_at(int payload) {
    if (const auto known = best_.find(payload); known != best_.end())
        return known->second;
    best_[payload] = 1e30;
    if (!options_.choose_clusters) {
        best_[payload] = cost(attempt(options_.compress.clusters, payload));
    } else if (options_.budget.max_error) {
        reach_error(payload);
    } else if (options_.budget.bytes_per_vertex) {
        fill_bytes(payload);
    } else { // operations alone: clusters in one byte, and bits that lose nothing to speak of
        best_[payload] = cost(attempt(std::min(256, most_clusters_), payload));
    }
    return best_[payload];
}

void Search::search_payloads() {
    const Budget& budget = options_.budget;
    int least = 1, most = kMostPayloadBytes, start = 4;
    if (budget.max_error) // four bytes or so for a hundredth, and one more for every half of it
        start = static_cast<int>(std::lround(4 + 1.1 * std::log2(0.01 / *budget.max_error)));
    if (budget.bytes_per_vertex) {
        most = std::min(most, static_cast<int>(std::floor(*budget.bytes_per_vertex)));
        if (most < 1) {
            // Not a byte: a cluster's number alone takes one.
            attempt(1, 1);
            return;
        }
        // What is best in the payload on meshes of 10 000 to 40 000 vertices; larger ones want more. Few
        // operations leave little to spend there.
        start = std::max(
            1, static_cast<int>(std::lround((budget.shader_ops ? 0.4 : 0.6) * *budget.bytes_per_vertex)));
    }
    if (!budget.max_error && !budget.bytes_per_vertex)
        start = least = most = kMostOperationBytes; // bytes are not asked about
    start = std::clamp(start, least, most);
    // From the start in the direction that gets better, until it gets worse.
    best_at(start);
    for (const int direction : {1, -1}) {
        bool moved = false;
        for (int payload = start + direction; payload >= least && payload <= most; payload += direction) {
            if (!(best_at(payload) < best_at(payload - direction)))
                break;
            moved = true;
        }
        if (moved)
            break;
    }
}

} // namespace

SearchResult compress_within(const Transfer& transfer, std::span<const float> areas,
                             std::span<const Edge> edges, const SearchOptions& options,
                             const Progress& progress) {
    check(options);
    return Search(transfer, areas, edges, options, progress).run();
}

} // namespace prt
