#include "prt/search.h"

#include "prt/support/error.h"
#include "prt/support/stopwatch.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <map>
#include <numeric>
#include <string>

namespace prt {
namespace {

constexpr int kPatience = 2;     ///< steps that may make it worse before a search turns back
constexpr double kNotKept = 1e6; ///< least cost of what does not keep the budget
constexpr int kMostWords = 8;    ///< of packed weights
constexpr double kBasesOverWeights =
    2; ///< bases of a preset take at most so many times the weights' bytes ..
constexpr double kAlwaysForBases = 4096; ///< .. or so many bytes: a prop of some hundred vertices needs them

void check(const SearchOptions& o) {
    for (const auto& [value, name] :
         {std::pair(o.budget.max_error, "error"), std::pair(o.budget.bytes_per_vertex, "bytes per vertex"),
          std::pair(o.budget.shader_ops, "shader operations")})
        if (value && !(*value > 0 && std::isfinite(*value)))
            throw Error("a budget of " + std::to_string(*value) + " " + name + " makes no sense");
    if (!o.budget.any())
        throw Error("there is no budget to search for");
}

/// A number of clusters is searched for along a line: at so much payload, and with directions that pay for
/// their bytes or do not.
struct Line {
    int payload = 1; ///< packed: 32-bit words of a receiver; else groups of four weights
    bool bases_count = true;
    int most_components = std::numeric_limits<int>::max(); ///< fewer where bytes are so few
    friend auto operator<=>(const Line&, const Line&) = default;
};

/// A number of clusters and what it led to.
struct Known {
    double clusters = 0, value = 0;
};

/// Bytes of a receiver that a payload takes; where it is not packed, four of them hold the cluster.
double payload_bytes(WeightFormat format, int payload) {
    return format == WeightFormat::packed ? 4.0 * payload
                                          : 4 + 4.0 * payload * static_cast<double>(bytes_per_weight(format));
}

/// Words of a preset, or the groups of four that its components take.
int payload_of(const CompressOptions& preset, std::size_t dimension) {
    if (preset.weights != WeightFormat::packed)
        return (std::min(preset.components, static_cast<int>(dimension)) + 3) / 4;
    const int bits = std::accumulate(preset.fixed_bits.begin(), preset.fixed_bits.end(), preset.cluster_bits);
    return (bits + 31) / 32;
}

/// How hard a search tries.
struct Effort {
    double least_filled = 0.975; ///< share of the bytes that ends a line
    /// Bytes over those of the weights above which directions are tried both as paying for their bytes and as
    /// not.
    double both_ways = 2;
    double bytes_per_cluster = 120; ///< of the bases, before the first try
};

/// A preset that does not fit: its bytes are a rule of thumb, and a tenth of them is not worth a try. Both
/// ways differ only where there are so few vertices that bases take more than their share: 2 478 of them had
/// 0.479 and 0.506 %, and 0.069 and 0.074 %.
Effort effort_of_preset(const CompressStatistics& too_large) {
    return {.least_filled = 0.9,
            .both_ways = 1.02 * (1 + kBasesOverWeights),
            .bytes_per_cluster =
                static_cast<double>(too_large.basis_bytes) / static_cast<double>(too_large.clusters)};
}

/// Where a straight line through both has `value`.
double interpolated(const Known& a, const Known& b, double value) {
    return a.clusters + (b.clusters - a.clusters) * (value - a.value) / (b.value - a.value);
}

/// Tries numbers of clusters on lines, each pair once, and keeps the best.
class Search {
public:
    Search(const Transfer& transfer, std::span<const float> areas, std::span<const Edge> edges,
           const SearchOptions& options, const Progress& progress, const Effort& effort = {})
        : transfer_(transfer), areas_(areas), edges_(edges), options_(options), progress_(progress),
          effort_(effort), receivers_(static_cast<double>(transfer.receivers())),
          bytes_per_cluster_(effort.bytes_per_cluster) {
        // Fewer than a dozen receivers a cluster, and tables outweigh weights.
        const std::size_t enough = std::max<std::size_t>(64, transfer.receivers() / 12);
        most_clusters_ =
            static_cast<int>(std::clamp<std::size_t>(std::min(enough, transfer.receivers()), 1, 65536));
        if (!options.choose_clusters)
            most_clusters_ = options.compress.clusters;
    }

    /// Where operations are what is short they are few anyway, and more of them must not give way to clusters
    /// that the bytes have room for: 0.40 instead of 1.04 times the error of classic CPCA with one operation,
    /// measured on a head. The other way is tried where operations turn out not to be short, or where bases
    /// outweigh what they serve: the price of a direction is measured on meshes where they do not.
    SearchResult run() {
        const std::optional<double> ops = options_.budget.shader_ops;
        search_payloads({start(), !ops});
        const bool other_way =
            ops ? best_trial_.mean_components < 0.9 * *ops
                : packed() && best_trial_.bytes_per_vertex > effort_.both_ways * best_trial_.payload_bytes;
        if (other_way)
            search_payloads({best_payload_, ops.has_value()});
        if (!result_.kept && options_.budget.bytes_per_vertex && options_.choose_components)
            search_fewer_components();
        result_.result.statistics.seconds = stopwatch_.seconds();
        return std::move(result_);
    }

private:
    bool packed() const { return options_.compress.weights == WeightFormat::packed; }
    int start() const;
    int least_payload() const { return options_.payload > 0 ? options_.payload : packed() ? 1 : 0; }
    int most_payload() const;
    double payload_bytes(int payload) const { return prt::payload_bytes(options_.compress.weights, payload); }
    /// Bytes per receiver that a line may fill: the budget's, or, where bytes are not asked about, as much as
    /// a preset may.
    double most_bytes(const Line& line) const {
        return options_.budget.bytes_per_vertex.value_or((1 + kBasesOverWeights) *
                                                         payload_bytes(line.payload));
    }
    CompressOptions options_on(const Line& line, int clusters) const;
    SearchTrial attempt(int clusters, const Line& line);
    void keep_if_better(CompressResult&& result, const SearchTrial& trial, const Line& line);

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
            return kNotKept * off;
        }
        return b.max_error ? t.bytes_per_vertex : t.lit_rms;
    }

    double search_payloads(const Line& start);
    void search_fewer_components();
    /// The best number of clusters on a line: by bytes or by error. Returns its cost.
    double best_on(const Line& line);
    void fill_bytes(const Line& line);
    void reach_error(const Line& line);
    int clamped(double clusters) const {
        return static_cast<int>(std::clamp(std::round(clusters), 1.0, static_cast<double>(most_clusters_)));
    }

    const Transfer& transfer_;
    std::span<const float> areas_;
    std::span<const Edge> edges_;
    const SearchOptions& options_;
    const Progress& progress_;
    Effort effort_;
    double receivers_;
    int most_clusters_ = 1;
    double bytes_per_cluster_; ///< of the bases, from the last try
    double clusters_guess_ = 64;
    std::map<std::pair<int, Line>, SearchTrial> tried_;
    std::map<Line, double> best_;
    SearchResult result_;
    Stopwatch stopwatch_;
    bool any_ = false;
    SearchTrial best_trial_;
    int best_payload_ = 1;
};

CompressOptions Search::options_on(const Line& line, int clusters) const {
    CompressOptions o = options_.compress;
    o.clusters = clusters;
    o.mean_components = options_.budget.shader_ops.value_or(0);
    if (packed()) {
        o.cluster_bits = static_cast<int>(std::bit_width(static_cast<unsigned>(clusters - 1)));
        o.bases_count = line.bases_count;
        o.fixed_bits.clear();
        o.bits = std::min(32 * line.payload - o.cluster_bits, kMostPackedBits); // words are bound whole
        if (options_.choose_components)
            o.components = std::min(kMostPackedComponents, static_cast<int>(transfer_.dimension()));
    } else if (options_.choose_components) {
        o.components = std::min(4 * line.payload, static_cast<int>(transfer_.dimension()));
    }
    if (options_.choose_components)
        o.components = std::min(o.components, line.most_components);
    return o;
}

SearchTrial Search::attempt(int clusters, const Line& line) {
    const auto key = std::pair(clusters, line);
    if (const auto known = tried_.find(key); known != tried_.end())
        return known->second;
    // How many tries there will be is not known; each takes a tenth of what is left of the bar.
    const double done = 1 - std::pow(0.9, static_cast<double>(tried_.size()));
    Progress part{{}, progress_.stop};
    if (progress_.report)
        part.report = [&, done](double share) { progress_.report(done + 0.1 * (1 - done) * share); };
    CompressResult result = compress(transfer_, areas_, edges_, options_on(line, clusters), part);
    const CompressStatistics& s = result.statistics;
    const SearchTrial trial{clusters,          static_cast<int>(s.bytes_per_receiver),
                            s.lit_rms,         s.bytes_with_bases(transfer_.receivers()),
                            s.mean_components, s.seconds};
    bytes_per_cluster_ = std::max(4.0, static_cast<double>(s.basis_bytes) / static_cast<double>(s.clusters));
    tried_[key] = trial;
    result_.trials.push_back(trial);
    best_[line] = std::min(best_[line], cost(trial));
    keep_if_better(std::move(result), trial, line);
    return trial;
}

void Search::keep_if_better(CompressResult&& result, const SearchTrial& trial, const Line& line) {
    if (any_ && !(cost(trial) < cost(best_trial_)))
        return;
    any_ = true;
    best_trial_ = trial;
    best_payload_ = line.payload;
    result_.result = std::move(result);
    result_.kept = keeps(trial);
}

/// As many clusters as the bytes have room for, between a number that fits and one that does not.
void Search::fill_bytes(const Line& line) {
    constexpr int kTries = 6;
    const double most = most_bytes(line), aim = 0.5 * (1 + effort_.least_filled) * most;
    Known fits{0, payload_bytes(line.payload)}, too_many{static_cast<double>(most_clusters_) + 1, 0};
    double next = (aim - fits.value) * receivers_ / bytes_per_cluster_;
    for (int i = 0; i < kTries && fits.clusters + 1 < too_many.clusters; ++i) {
        const int clusters = clamped(std::clamp(next, fits.clusters + 1, too_many.clusters - 1));
        const double bytes = attempt(clusters, line).bytes_per_vertex;
        (bytes <= most ? fits : too_many) = {static_cast<double>(clusters), bytes};
        if (bytes <= most && bytes > effort_.least_filled * most)
            break;
        if (too_many.value > 0)
            next = interpolated(fits, too_many, aim);
        else
            next = clusters + (aim - bytes) * receivers_ / bytes_per_cluster_;
    }
}

/// As few clusters as reach the error, between a number that misses and one that does: the logarithm of the
/// error falls straight with that of the clusters, by -0.4 as a rule.
void Search::reach_error(const Line& line) {
    constexpr int kTries = 8;
    const double wanted = *options_.budget.max_error, aim = std::log(0.993 * wanted);
    Known misses{0, 0}, reaches{static_cast<double>(most_clusters_) + 1, 0};
    bool missed = false, reached = false;
    double next = clusters_guess_;
    for (int i = 0; i < kTries && misses.clusters + 1 < reaches.clusters; ++i) {
        const int clusters = clamped(std::clamp(next, misses.clusters + 1, reaches.clusters - 1));
        const SearchTrial trial = attempt(clusters, line);
        const double error = std::log(std::max(trial.lit_rms, 1e-12));
        const bool enough = trial.lit_rms <= wanted;
        (enough ? reaches : misses) = {static_cast<double>(clusters), error};
        (enough ? reached : missed) = true;
        if (enough)
            clusters_guess_ = clusters;
        if (enough && trial.lit_rms > 0.985 * wanted)
            break;
        // More clusters only cost more where the bytes already pass what is allowed, or the best so far.
        const double dearest =
            result_.kept ? best_trial_.bytes_per_vertex : options_.budget.bytes_per_vertex.value_or(1e30);
        if (!enough && trial.bytes_per_vertex > dearest)
            break;
        const double factor = std::exp(std::clamp((error - aim) / 0.4, -5.0, 5.0));
        if (!reached && factor > 64) // so far off, a larger payload is the way
            break;
        next = clusters * std::clamp(factor, 1.0 / 64, 4.0);
        if (missed && reached)
            next = std::exp(interpolated({std::log(misses.clusters), misses.value},
                                         {std::log(reaches.clusters), reaches.value}, aim));
    }
}

double Search::best_on(const Line& line) {
    if (const auto known = best_.find(line); known != best_.end())
        return known->second;
    best_[line] = 1e30;
    if (!options_.choose_clusters)
        attempt(options_.compress.clusters, line);
    else if (options_.budget.max_error)
        reach_error(line);
    else
        fill_bytes(line);
    return best_[line];
}

int Search::most_payload() const {
    if (options_.payload > 0)
        return options_.payload;
    int most = packed() ? kMostWords : (static_cast<int>(transfer_.dimension()) + 3) / 4;
    const Budget& budget = options_.budget;
    if (budget.bytes_per_vertex)
        while (most > least_payload() && payload_bytes(most) > *budget.bytes_per_vertex)
            --most;
    else if (packed() && budget.shader_ops && !budget.max_error)
        // More bits than these lose nothing to speak of: 16 of the cluster, 12 of every component.
        most = std::min(most, static_cast<int>(std::ceil((16 + 12 * *budget.shader_ops) / 32)));
    return most;
}

/// Where to begin: what was the best share of the weights on meshes of 10 000 to 40 000 vertices. Few
/// operations leave little to spend there.
int Search::start() const {
    const Budget& budget = options_.budget;
    double bytes = 4;
    if (budget.max_error) // four bytes or so for a hundredth, and one more for every half of it
        bytes = 4 + 1.1 * std::log2(0.01 / *budget.max_error);
    if (budget.bytes_per_vertex)
        bytes = (budget.shader_ops ? 0.4 : 0.6) * *budget.bytes_per_vertex;
    const double payload = packed() ? bytes / 4 : bytes / payload_bytes(1);
    return std::clamp(static_cast<int>(std::lround(payload)), least_payload(), most_payload());
}

/// From the start both ways, until it got worse twice in a row. Returns the least cost.
double Search::search_payloads(const Line& start) {
    double least = best_on(start);
    for (const int direction : {1, -1}) {
        double best = best_on(start);
        int worse = 0;
        for (int payload = start.payload + direction;
             payload >= least_payload() && payload <= most_payload() && worse < kPatience;
             payload += direction) {
            const double found = best_on({payload, start.bases_count, start.most_components});
            worse = found < best ? 0 : worse + 1;
            best = std::min(best, found);
        }
        least = std::min(least, best);
    }
    return least;
}

/// Where even one cluster with all its directions takes too many bytes: from none of them on, as long as the
/// budget is kept or comes nearer. A mean alone, of one cluster, is the least that there is.
void Search::search_fewer_components() {
    const int all = options_on({.payload = least_payload()}, 1).components;
    double best = std::numeric_limits<double>::infinity();
    int worse = 0;
    for (int components = 0; components < std::max(all, 1) && worse < kPatience; ++components) {
        const double found = search_payloads({.payload = least_payload(), .most_components = components});
        worse = found < kNotKept || found < best ? 0 : worse + 1;
        best = std::min(best, found);
    }
}

} // namespace

SearchResult compress_within(const Transfer& transfer, std::span<const float> areas,
                             std::span<const Edge> edges, const SearchOptions& options,
                             const Progress& progress) {
    check(options);
    return Search(transfer, areas, edges, options, progress).run();
}

SearchResult compress_preset(const Transfer& transfer, std::span<const float> areas,
                             std::span<const Edge> edges, const CompressOptions& preset,
                             const Progress& progress) {
    const Stopwatch stopwatch;
    SearchResult found;
    found.result = compress(transfer, areas, edges, preset, progress);
    const CompressStatistics& s = found.result.statistics;
    const auto receivers = static_cast<double>(transfer.receivers());
    const int payload = payload_of(preset, transfer.dimension());
    const double bound = payload_bytes(preset.weights, payload);
    const double most_bases = std::max(kBasesOverWeights * bound * receivers, kAlwaysForBases);
    found.kept = static_cast<double>(s.basis_bytes) <= most_bases;
    if (found.kept)
        return found;
    SearchOptions options;
    options.compress = preset;
    options.payload = payload;
    options.choose_components = preset.weights == WeightFormat::packed;
    options.budget.bytes_per_vertex = bound + most_bases / receivers;
    found = Search(transfer, areas, edges, options, progress, effort_of_preset(s)).run();
    found.result.statistics.seconds = stopwatch.seconds();
    return found;
}

} // namespace prt
