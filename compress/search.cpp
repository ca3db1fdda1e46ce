// Searches clusters and bits for a budget: over the words of a receiver, and for each over the number of
// clusters, by interpolation (docs/math.md, section 4, "Budgets").

#include "prt/search.h"

#include "options.h"
#include "prt/support/error.h"
#include "prt/support/stopwatch.h"
#include "tuning.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <map>
#include <numeric>
#include <string>

namespace prt {
namespace {

constexpr double kNotKept = 1e6; ///< least cost of what does not keep the budget, above any error or size

void check_budget(const SearchOptions& o) {
    for (const auto& [value, name] :
         {std::pair(o.budget.max_error, "error"), std::pair(o.budget.bytes_per_vertex, "bytes per vertex"),
          std::pair(o.budget.operations, "shader operations")})
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
    GuideChoice guides = GuideChoice::normal;
    double basis_share = -1; ///< CompressOptions::basis_share; below 0: as the format has it
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
int payload_of(const WeightCoding& preset, std::size_t dimension) {
    if (preset.format != WeightFormat::packed)
        return (std::min(preset.components, static_cast<int>(dimension)) + 3) / 4;
    const int bits = preset.fixed_bits.empty()
                         ? preset.bits
                         : std::accumulate(preset.fixed_bits.begin(), preset.fixed_bits.end(), 0);
    return (preset.cluster_bits + bits + 31) / 32;
}

/// How hard a search tries (tuning.h).
struct Effort {
    double least_filled = tuning::kLeastFilled;
    double both_ways = tuning::kBothWays;
    double bytes_per_cluster = tuning::kBytesPerCluster; ///< of the bases, before the first try
};

/// Of a preset that does not fit.
Effort effort_of_preset(const CompressStatistics& too_large) {
    return {.least_filled = tuning::kLeastFilledOfPreset,
            .both_ways = tuning::kBothWaysOfPreset,
            .bytes_per_cluster =
                static_cast<double>(too_large.basis_bytes) / static_cast<double>(too_large.clusters)};
}

/// What is compressed, and what for. Keeps references.
struct SearchTask {
    const Transfer& transfer;
    const ReceiverSurface& surface;
    const SearchOptions& options;
    const Progress& progress;

    double receivers() const { return static_cast<double>(transfer.receivers()); }
    int dimension() const { return static_cast<int>(transfer.dimension()); }
    bool packed() const { return options.compress.coding.format == WeightFormat::packed; }
    double payload_bytes(int payload) const {
        return prt::payload_bytes(options.compress.coding.format, payload);
    }
};

/// Where a straight line through both has `value`.
double interpolated(const Known& a, const Known& b, double value) {
    return a.clusters + (b.clusters - a.clusters) * (value - a.value) / (b.value - a.value);
}

/// Tries numbers of clusters on lines, each pair once, and keeps the best.
class Search {
public:
    explicit Search(const SearchTask& task, const Effort& effort = {})
        : task_(task), budget_(task.options.budget), effort_(effort), most_clusters_(most_clusters(task)),
          bytes_per_cluster_(effort.bytes_per_cluster) {}

    /// Where components are what is short they are few anyway, and more of them must not give way to clusters
    /// that the bytes have room for: 0.40 instead of 1.04 times the error of classic CPCA with one component,
    /// measured on a head. The other way is tried where components turn out not to be short, or where bases
    /// outweigh what they serve: the price of a row is measured on meshes where they do not.
    SearchResult run() {
        const std::optional<double>& most = budget_.operations;
        Line line{.payload = start(), .bases_count = !most, .guides = task_.options.compress.guides};
        if (task_.options.choose_guides && most && !(*most > rows_of(line.guides)))
            line.guides = GuideChoice::none;
        search_payloads(line);
        const SearchTrial best = best_->trial;
        const bool other_way =
            most ? best.operations < tuning::kComponentsShort * *most
                 : task_.packed() && best.bytes_per_vertex > effort_.both_ways * best.payload_bytes;
        if (other_way) {
            line.payload = best_->line.payload;
            line.bases_count = !line.bases_count;
            search_payloads(line);
        }
        if (task_.options.choose_guides)
            search_guides();
        if (budget_.max_error && bases_are_coded(task_.options.compress))
            spend_error();
        if (!result_.kept && budget_.bytes_per_vertex && task_.options.choose_components)
            search_fewer_components();
        result_.result.statistics.seconds = stopwatch_.seconds();
        return std::move(result_);
    }

private:
    struct Best {
        SearchTrial trial;
        Line line;
    };

    /// Operations that guides take, where the surface has them.
    int rows_of(GuideChoice guides) const {
        const bool normals = !task_.surface.normals.empty(), positions = !task_.surface.positions.empty();
        return guides == GuideChoice::none     ? 0
               : guides == GuideChoice::normal ? 3 * normals
                                               : 3 * normals + 3 * positions;
    }

    static int most_clusters(const SearchTask& task) {
        if (!task.options.choose_clusters)
            return task.options.compress.clusters;
        const std::size_t receivers = task.transfer.receivers(),
                          enough =
                              std::max(tuning::kAlwaysClusters, receivers / tuning::kReceiversPerCluster);
        return static_cast<int>(std::clamp<std::size_t>(std::min(enough, receivers), 1, 65536));
    }
    int start() const;
    int least_payload() const {
        const int given = task_.options.payload;
        return given > 0 ? given : task_.packed() ? 1 : 0;
    }
    int most_payload() const;
    /// Bytes per receiver that a line may fill: the budget's, or, where bytes are not asked about, as much as
    /// a preset may.
    double most_bytes(const Line& line) const {
        return budget_.bytes_per_vertex.value_or((1 + tuning::kBasesOverWeights) *
                                                 task_.payload_bytes(line.payload));
    }
    CompressOptions options_on(const Line& line, int clusters) const;
    SearchTrial attempt(int clusters, const Line& line);
    void keep_if_better(CompressResult&& result, const SearchTrial& trial, const Line& line);

    bool keeps(const SearchTrial& t) const {
        return (!budget_.max_error || t.lit_rms <= *budget_.max_error) &&
               (!budget_.bytes_per_vertex || t.bytes_per_vertex <= *budget_.bytes_per_vertex) &&
               (!budget_.operations || t.operations <= *budget_.operations);
    }
    /// What is made small once the budget is kept; while it is not, how far off it is.
    double cost(const SearchTrial& t) const {
        if (keeps(t))
            return budget_.max_error ? t.bytes_per_vertex : t.lit_rms;
        double off = 1;
        for (const auto& [value, most] : {std::pair(t.lit_rms, budget_.max_error),
                                          std::pair(t.bytes_per_vertex, budget_.bytes_per_vertex),
                                          std::pair(t.operations, budget_.operations)})
            if (most)
                off = std::max(off, value / *most);
        return kNotKept * off;
    }

    double search_payloads(const Line& start);
    void search_fewer_components();
    void search_guides();
    void spend_error();
    /// The best number of clusters on a line: by bytes or by error. Returns its cost.
    double best_on(const Line& line);
    void fill_bytes(const Line& line);
    void reach_error(const Line& line);
    int clamped(double clusters) const {
        return static_cast<int>(std::clamp(std::round(clusters), 1.0, static_cast<double>(most_clusters_)));
    }

    const SearchTask& task_;
    const Budget& budget_;
    Effort effort_;
    int most_clusters_;
    double bytes_per_cluster_; ///< of the bases, from the last try
    double clusters_guess_ = tuning::kFirstClusters;
    std::map<std::pair<int, Line>, SearchTrial> tried_;
    std::map<Line, double> least_cost_;
    std::optional<Best> best_;
    SearchResult result_;
    Stopwatch stopwatch_;
};

CompressOptions Search::options_on(const Line& line, int clusters) const {
    CompressOptions o = task_.options.compress;
    WeightCoding& coding = o.coding;
    o.clusters = clusters;
    o.guides = line.guides;
    if (line.basis_share >= 0)
        o.basis_share = line.basis_share;
    o.mean_components = budget_.operations ? *budget_.operations - rows_of(line.guides) : 0;
    int most = 4 * line.payload;
    if (task_.packed()) {
        coding.cluster_bits = static_cast<int>(std::bit_width(static_cast<unsigned>(clusters - 1)));
        o.bases_count = line.bases_count;
        coding.fixed_bits.clear();
        coding.bits =
            std::min(32 * line.payload - coding.cluster_bits, kMostPackedBits); // words are bound whole
        most = kMostPackedComponents;
    }
    if (task_.options.choose_components)
        coding.components = std::min({most, task_.dimension(), line.most_components});
    return o;
}

SearchTrial Search::attempt(int clusters, const Line& line) {
    const auto key = std::pair(clusters, line);
    if (const auto known = tried_.find(key); known != tried_.end())
        return known->second;
    // How many tries there will be is not known; each takes a tenth of what is left of the bar.
    const double done = 1 - std::pow(0.9, static_cast<double>(tried_.size()));
    CompressResult result = compress(task_.transfer, task_.surface, options_on(line, clusters),
                                     task_.progress.part(done, done + 0.1 * (1 - done)));
    const CompressStatistics& s = result.statistics;
    const SearchTrial trial{.clusters = clusters,
                            .payload_bytes = static_cast<int>(s.bytes_per_receiver),
                            .lit_rms = s.lit_rms,
                            .bytes_per_vertex = s.bytes_with_bases(task_.transfer.receivers()),
                            .operations = s.operations(),
                            .seconds = s.seconds};
    bytes_per_cluster_ = std::max(tuning::kLeastBytesPerCluster,
                                  static_cast<double>(s.basis_bytes) / static_cast<double>(s.clusters));
    if (task_.options.compress.trace)
        task_.options.compress.trace(trial);
    tried_[key] = trial;
    result_.trials.push_back(trial);
    least_cost_[line] = std::min(least_cost_[line], cost(trial));
    keep_if_better(std::move(result), trial, line);
    return trial;
}

void Search::keep_if_better(CompressResult&& result, const SearchTrial& trial, const Line& line) {
    if (best_ && !(cost(trial) < cost(best_->trial)))
        return;
    best_ = {trial, line};
    result_.result = std::move(result);
    result_.kept = keeps(trial);
}

/// As many clusters as the bytes have room for, between a number that fits and one that does not.
void Search::fill_bytes(const Line& line) {
    const double most = most_bytes(line), aim = 0.5 * (1 + effort_.least_filled) * most;
    Known fits{0, task_.payload_bytes(line.payload)}, too_many{static_cast<double>(most_clusters_) + 1, 0};
    double next = (aim - fits.value) * task_.receivers() / bytes_per_cluster_;
    for (int i = 0; i < tuning::kBytesTries && fits.clusters + 1 < too_many.clusters; ++i) {
        const int clusters = clamped(std::clamp(next, fits.clusters + 1, too_many.clusters - 1));
        const double bytes = attempt(clusters, line).bytes_per_vertex;
        (bytes <= most ? fits : too_many) = {static_cast<double>(clusters), bytes};
        if (bytes <= most && bytes > effort_.least_filled * most)
            break;
        if (too_many.value > 0)
            next = interpolated(fits, too_many, aim);
        else
            next = clusters + (aim - bytes) * task_.receivers() / bytes_per_cluster_;
    }
}

/// As few clusters as reach the error, between a number that misses and one that does: the logarithm of the
/// error falls straight with that of the clusters, by -kErrorExponent as a rule.
void Search::reach_error(const Line& line) {
    const double wanted = *budget_.max_error, aim = std::log(tuning::kAimedError * wanted);
    Known misses{0, 0}, reaches{static_cast<double>(most_clusters_) + 1, 0};
    bool missed = false, reached = false;
    double next = clusters_guess_;
    for (int i = 0; i < tuning::kErrorTries && misses.clusters + 1 < reaches.clusters; ++i) {
        const int clusters = clamped(std::clamp(next, misses.clusters + 1, reaches.clusters - 1));
        const SearchTrial trial = attempt(clusters, line);
        const double error = std::log(std::max(trial.lit_rms, 1e-12));
        const bool enough = trial.lit_rms <= wanted;
        (enough ? reaches : misses) = {static_cast<double>(clusters), error};
        (enough ? reached : missed) = true;
        if (enough)
            clusters_guess_ = clusters;
        if (enough && trial.lit_rms > tuning::kNearEnough * wanted)
            break;
        // More clusters only cost more where the bytes already pass what is allowed, or the best so far.
        const double dearest =
            result_.kept ? best_->trial.bytes_per_vertex : budget_.bytes_per_vertex.value_or(1e30);
        if (!enough && trial.bytes_per_vertex > dearest)
            break;
        const double factor = std::exp(std::clamp((error - aim) / tuning::kErrorExponent, -5.0, 5.0));
        if (!reached && factor > tuning::kHopelessFactor) // so far off, a larger payload is the way
            break;
        next = clusters * std::clamp(factor, 1 / tuning::kHopelessFactor, tuning::kMostFactor);
        if (missed && reached)
            next = std::exp(interpolated({std::log(misses.clusters), misses.value},
                                         {std::log(reaches.clusters), reaches.value}, aim));
    }
}

double Search::best_on(const Line& line) {
    if (const auto known = least_cost_.find(line); known != least_cost_.end())
        return known->second;
    least_cost_[line] = 1e30;
    if (!task_.options.choose_clusters)
        attempt(task_.options.compress.clusters, line);
    else if (budget_.max_error)
        reach_error(line);
    else
        fill_bytes(line);
    return least_cost_[line];
}

int Search::most_payload() const {
    if (task_.options.payload > 0)
        return task_.options.payload;
    int most = task_.packed() ? kMostPackedWords : (task_.dimension() + 3) / 4;
    if (budget_.bytes_per_vertex)
        while (most > least_payload() && task_.payload_bytes(most) > *budget_.bytes_per_vertex)
            --most;
    else if (task_.packed() && budget_.operations && !budget_.max_error)
        most = std::min(
            most, static_cast<int>(std::ceil(
                      (tuning::kEnoughClusterBits + tuning::kEnoughWeightBits * *budget_.operations) / 32)));
    return most;
}

/// Where to begin. Few components leave little to spend on weights.
int Search::start() const {
    double bytes = tuning::kFirstBytes;
    if (budget_.max_error)
        bytes += tuning::kBytesPerHalving * std::log2(tuning::kFirstBytesError / *budget_.max_error);
    if (budget_.bytes_per_vertex)
        bytes = (budget_.operations ? tuning::kWeightsShareOfFewComponents : tuning::kWeightsShare) *
                *budget_.bytes_per_vertex;
    const double payload = bytes / task_.payload_bytes(1);
    return std::clamp(static_cast<int>(std::lround(payload)), least_payload(), most_payload());
}

/// From the start both ways, until it got worse twice in a row. Returns the least cost.
double Search::search_payloads(const Line& start) {
    double least = best_on(start);
    for (const int direction : {1, -1}) {
        double best = best_on(start);
        int worse = 0;
        for (int payload = start.payload + direction;
             payload >= least_payload() && payload <= most_payload() && worse < tuning::kPatience;
             payload += direction) {
            Line line = start;
            line.payload = payload;
            const double found = best_on(line);
            worse = found < best ? 0 : worse + 1;
            best = std::min(best, found);
        }
        least = std::min(least, best);
    }
    return least;
}

/// Guides pay where their rows are cheap beside the weights of all receivers; operations may be better spent
/// on components. The other ways are tried where the best was found.
void Search::search_guides() {
    const Line found = best_->line;
    for (const GuideChoice guides :
         {GuideChoice::none, GuideChoice::normal, GuideChoice::normal_and_position}) {
        const bool affordable = !budget_.operations || rows_of(guides) < *budget_.operations;
        if (guides == found.guides || !affordable)
            continue;
        Line line = found;
        line.guides = guides;
        best_on(line);
    }
}

/// What is left of an allowed error between one number of clusters and the next is spent on coarser bases.
void Search::spend_error() {
    double spent = tuning::kErrorSpent;
    for (int i = 0; i < tuning::kSpendingTries && result_.kept; ++i) {
        const Best found = *best_;
        const double left = *budget_.max_error / found.trial.lit_rms;
        Line line = found.line;
        line.basis_share =
            std::min((line.basis_share < 0 ? basis_share(task_.options.compress) : line.basis_share) +
                         spent * (left * left - 1),
                     0.9);
        if (!keeps(attempt(found.trial.clusters, line)))
            spent /= 3;
    }
}

/// Where even one cluster with all its directions takes too many bytes: from none of them on, as long as the
/// budget is kept or comes nearer. A mean alone, of one cluster, is the least that there is.
void Search::search_fewer_components() {
    const int all = options_on({.payload = least_payload()}, 1).coding.components;
    double best = std::numeric_limits<double>::infinity();
    int worse = 0;
    for (int components = 0; components < std::max(all, 1) && worse < tuning::kPatience; ++components) {
        const double found = search_payloads(
            {.payload = least_payload(), .most_components = components, .guides = GuideChoice::none});
        worse = found < kNotKept || found < best ? 0 : worse + 1;
        best = std::min(best, found);
    }
}

} // namespace

SearchResult compress_within(const Transfer& transfer, const ReceiverSurface& surface,
                             const SearchOptions& options, const Progress& progress) {
    check_budget(options);
    const SearchTask task{transfer, surface, options, progress};
    return Search(task).run();
}

SearchResult compress_preset(const Transfer& transfer, const ReceiverSurface& surface,
                             const CompressOptions& options, const Progress& progress) {
    const Stopwatch stopwatch;
    SearchResult found;
    // The search that may follow is one of small meshes: it takes no time to speak of.
    CompressOptions whole = options;
    whole.bases_count = options.coding.fixed_bits.empty();
    found.result = compress(transfer, surface, whole, progress.part(0, 0.9));
    const CompressStatistics& s = found.result.statistics;
    const auto receivers = static_cast<double>(transfer.receivers());
    const int payload = payload_of(options.coding, transfer.dimension());
    const double bound = payload_bytes(options.coding.format, payload);
    const double most_bases =
        std::max(tuning::kBasesOverWeights * bound * receivers, tuning::kAlwaysForBases);
    found.kept = static_cast<double>(s.basis_bytes) <= most_bases;
    if (!found.kept) {
        SearchOptions fitting;
        fitting.compress = options;
        fitting.payload = payload;
        fitting.choose_components = options.coding.format == WeightFormat::packed;
        fitting.budget.bytes_per_vertex = bound + most_bases / receivers;
        const Progress rest = progress.part(0.9, 1);
        const SearchTask task{transfer, surface, fitting, rest};
        found = Search(task, effort_of_preset(s)).run();
        found.result.statistics.seconds = stopwatch.seconds();
    }
    progress.update(1);
    return found;
}

} // namespace prt
