#include "clusters/clustering.h"

#include "clusters/cluster_neighbours.h"
#include "clusters/kmeans.h"
#include "prt/support/parallel.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>
#include <tuple>

namespace prt {
namespace {

/// Everything that a round changes.
struct State {
    std::vector<std::uint32_t> clusters; ///< [points]
    ClusterMoments moments;
    std::vector<ClusterFit> fits;
    double cost = 0;
};

class ClusterSearch {
public:
    ClusterSearch(const PointBlocks& points, std::span<const float> weights, const ClusteringOptions& options)
        : points_(points), weights_(weights), options_(options) {}

    State start(const ClusterModels& centers) const {
        const std::size_t count = centers.clusters();
        State state{assign(points_, centers, options_.threads).clusters,
                    ClusterMoments(count, points_.dimension), std::vector<ClusterFit>(count), 0};
        state.moments.build(points_, weights_, state.clusters, options_.threads);
        return state;
    }

    /// Refits all clusters, then gives every point the best one. Empty clusters stay empty.
    void round(State& state, const Spending& spending) const {
        refit(state, spending);
        reassign(state);
    }

    void reassign(State& state) const {
        Assignment next = state.fits.size() <= 2 * kNeighbours
                              ? assign(points_, models(state.fits), options_.threads)
                              : assign(points_, models(state.fits), neighbours(state.fits), state.clusters,
                                       options_.threads);
        state.moments.update(points_, weights_, state.clusters, next.clusters, options_.threads);
        state.clusters = std::move(next.clusters);
    }

    std::span<const float> weights() const { return weights_; }

    void refit(State& state, const Spending& spending) const {
        parallel_for(state.fits.size(), 1, options_.threads, [&](std::size_t begin, std::size_t end) {
            for (std::size_t k = begin; k < end; ++k)
                state.fits[k] = fit_cluster(state.moments.view(k), spending);
        });
        state.cost = 0;
        for (const ClusterFit& fit : state.fits)
            state.cost += fit.cost(spending);
    }

    /// Rounds until nothing more is gained.
    void converge(State& state, const Spending& spending, int most_rounds, const Progress& progress,
                  std::vector<double>* history) const;

    /// One sweep of moves; whether the cost fell.
    bool move(State& state, const Spending& spending, const Progress& progress) const;

    double squared_error(const State& state) const {
        double error = 0;
        for (std::size_t k = 0; k < state.fits.size(); ++k) {
            Spending free = options_.spending;
            free.bits = 0;
            free.fixed_bits.clear();
            free.most_components = static_cast<int>(state.fits[k].plan.bits.size());
            free.row_price = free.operation_price = 0;
            error += cluster_cost(state.moments.view(k), free);
        }
        return error;
    }

private:
    /// Where there are many clusters a point looks among so many that are near its own.
    static constexpr std::size_t kNeighbours = 32;
    std::vector<std::vector<std::uint32_t>> neighbours(const std::vector<ClusterFit>& fits) const;

    MeanDistances mean_distances(const std::vector<ClusterFit>& fits) const {
        return {fits.size(), points_.dimension, [&](std::size_t k) { return fits[k].mean.data(); }};
    }

    ClusterModels models(const std::vector<ClusterFit>& fits) const {
        std::size_t most = 0;
        for (const ClusterFit& fit : fits)
            most = std::max(most, fit.plan.bits.size());
        ClusterModels result(fits.size(), points_.dimension, most);
        for (std::size_t k = 0; k < fits.size(); ++k) {
            const ClusterFit& fit = fits[k];
            std::copy(fit.mean.begin(), fit.mean.end(), result.mean(k));
            if (!fit.directions.empty())
                std::copy(fit.directions.begin(), fit.directions.end(), result.direction(k, 0));
            result.components[k] = static_cast<int>(fit.plan.bits.size());
            // What a point loses here beyond its distance. The plan's error holds the variance along the axes
            // that it leaves out, which the distance counts exactly.
            result.penalties[k] = fit.weight > 0 ? static_cast<float>(fit.plan.penalty)
                                                 : std::numeric_limits<float>::infinity();
        }
        return result;
    }

    struct Split {
        double gain = 0;
        std::vector<std::uint32_t> leaving; ///< points that go to the new cluster
    };
    struct Merge {
        double loss = 0;
        std::size_t into = 0, from = 0;
    };
    std::vector<Split> possible_splits(const State& state, const Spending& spending) const;
    std::vector<Merge> possible_merges(const State& state, const Spending& spending) const;

    const PointBlocks& points_;
    std::span<const float> weights_;
    const ClusteringOptions& options_;
};

/// By the distance of one's mean to the other's points: to its mean, less what its directions reach with
/// weights of up to three deviations.
std::vector<std::vector<std::uint32_t>> ClusterSearch::neighbours(const std::vector<ClusterFit>& fits) const {
    const MeanDistances means = mean_distances(fits);
    return nearest_clusters(means, kNeighbours, options_.threads, [&](std::size_t k, std::size_t other) {
        const ClusterFit& fit = fits[other];
        std::array<float, kMostDimensions> d;
        for (std::size_t i = 0; i < points_.dimension; ++i)
            d[i] = fits[k].mean[i] - fit.mean[i];
        for (std::size_t j = 0; j < fit.plan.bits.size(); ++j) {
            const float* direction = &fit.directions[j * points_.dimension];
            const float along = std::inner_product(direction, direction + points_.dimension, d.begin(), 0.0f);
            const auto reach = 3 * static_cast<float>(std::sqrt(fit.variances[j]));
            const float w = std::clamp(along, -reach, reach);
            for (std::size_t i = 0; i < points_.dimension; ++i)
                d[i] -= w * direction[i];
        }
        return std::inner_product(d.begin(), d.begin() + static_cast<std::ptrdiff_t>(points_.dimension),
                                  d.begin(), 0.0f);
    });
}

void ClusterSearch::converge(State& state, const Spending& spending, int most_rounds,
                             const Progress& progress, std::vector<double>* history) const {
    State best = state;
    best.cost = std::numeric_limits<double>::infinity();
    for (int r = 0; r < most_rounds; ++r) {
        progress.update(0.5);
        refit(state, spending);
        const bool better = state.cost < best.cost;
        if (history && better)
            history->push_back(squared_error(state));
        const bool converged = !(state.cost < best.cost * (1 - options_.tolerance));
        if (better)
            best = state;
        if (converged)
            break;
        reassign(state);
    }
    state = std::move(best);
}

std::vector<ClusterSearch::Split> ClusterSearch::possible_splits(const State& state,
                                                                 const Spending& spending) const {
    std::vector<std::vector<std::uint32_t>> members(state.fits.size());
    for (std::uint32_t p = 0; p < points_.count; ++p)
        if (weights_[p] > 0)
            members[state.clusters[p]].push_back(p);
    // Only clusters whose cost is above the mean are worth a look.
    const double mean = state.cost / static_cast<double>(state.fits.size());
    std::vector<Split> splits(state.fits.size());
    parallel_for(state.fits.size(), 1, options_.threads, [&](std::size_t begin, std::size_t end) {
        std::vector<float> point(points_.dimension);
        for (std::size_t k = begin; k < end; ++k) {
            const ClusterFit& fit = state.fits[k];
            if (fit.directions.empty() || members[k].size() < 2 || fit.cost(spending) < mean)
                continue;
            std::vector<double> low(state.moments.stride(), 0), high(state.moments.stride(), 0);
            for (const std::uint32_t p : members[k]) {
                points_.copy_point(p, point.data());
                double along = 0;
                for (std::size_t i = 0; i < points_.dimension; ++i)
                    along +=
                        static_cast<double>(fit.directions[i]) * static_cast<double>(point[i] - fit.mean[i]);
                ClusterMoments::add(point.data(), static_cast<double>(weights_[p]), along > 0 ? high : low);
                if (along > 0)
                    splits[k].leaving.push_back(p);
            }
            splits[k].gain = fit.cost(spending) - cluster_cost({points_.dimension, low}, spending) -
                             cluster_cost({points_.dimension, high}, spending);
        }
    });
    return splits;
}

std::vector<ClusterSearch::Merge> ClusterSearch::possible_merges(const State& state,
                                                                 const Spending& spending) const {
    constexpr std::size_t kPartners = 4;
    const MeanDistances means = mean_distances(state.fits);
    std::vector<std::vector<Merge>> found(state.fits.size());
    parallel_for(state.fits.size(), 1, options_.threads, [&](std::size_t begin, std::size_t end) {
        for (std::size_t k = begin; k < end; ++k) {
            const Eigen::ArrayXf squared = means.from(k);
            std::vector<std::pair<float, std::size_t>> near;
            for (std::size_t other = 0; other < state.fits.size(); ++other)
                if (other != k)
                    near.emplace_back(
                        state.fits[other].weight > 0 ? squared[static_cast<Eigen::Index>(other)] : 0, other);
            const std::size_t count = std::min(kPartners, near.size());
            std::partial_sort(near.begin(), near.begin() + static_cast<std::ptrdiff_t>(count), near.end());
            for (std::size_t n = 0; n < count; ++n) {
                const std::size_t other = near[n].second;
                const auto a = state.moments.view(k), b = state.moments.view(other);
                std::vector<double> sum(a.values.begin(), a.values.end());
                for (std::size_t i = 0; i < sum.size(); ++i)
                    sum[i] += b.values[i];
                const double loss = cluster_cost({points_.dimension, sum}, spending) -
                                    state.fits[k].cost(spending) - state.fits[other].cost(spending);
                found[k].push_back({loss, std::min(k, other), std::max(k, other)});
            }
        }
    });
    std::vector<Merge> merges;
    for (const auto& list : found)
        merges.insert(merges.end(), list.begin(), list.end());
    std::sort(merges.begin(), merges.end(), [](const Merge& a, const Merge& b) {
        return std::tie(a.loss, a.into, a.from) < std::tie(b.loss, b.into, b.from);
    });
    return merges;
}

bool ClusterSearch::move(State& state, const Spending& spending, const Progress& progress) const {
    const std::vector<Split> splits = possible_splits(state, spending);
    const std::vector<Merge> merges = possible_merges(state, spending);
    std::vector<std::size_t> order(splits.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::stable_sort(order.begin(), order.end(),
                     [&](std::size_t a, std::size_t b) { return splits[a].gain > splits[b].gain; });

    State next = state;
    std::vector<bool> touched(splits.size(), false);
    std::size_t split = 0;
    bool any = false;
    for (const Merge& merge : merges) {
        if (touched[merge.into] || touched[merge.from])
            continue;
        while (split < order.size() &&
               (touched[order[split]] || order[split] == merge.into || order[split] == merge.from))
            ++split;
        // In the rounds that follow neighbours adapt: a split gains more, a merger loses less than is known
        // here. Measured on four scenes, 0.7 finds what there is to find; the sum has the last word.
        if (split == order.size() || !(splits[order[split]].gain > 0.7 * std::max(merge.loss, 0.0)))
            break;
        touched[merge.into] = touched[merge.from] = touched[order[split]] = true;
        for (std::uint32_t& cluster : next.clusters)
            if (cluster == merge.from)
                cluster = static_cast<std::uint32_t>(merge.into);
        for (const std::uint32_t p : splits[order[split]].leaving)
            next.clusters[p] = static_cast<std::uint32_t>(merge.from);
        ++split;
        any = true;
    }
    if (!any)
        return false;
    next.moments.update(points_, weights_, state.clusters, next.clusters, options_.threads);
    for (int r = 0; r < 2; ++r) {
        progress.update(0.6);
        round(next, spending);
    }
    refit(next, spending);
    if (!(next.cost < state.cost * (1 - options_.tolerance)))
        return false;
    state = std::move(next);
    return true;
}

/// What one more direction in a cluster costs in a file whose bases count. A direction takes about 64 bits
/// there, measured on five scenes. A bit more for the weights of each of V receivers takes away 1.4/m of the
/// error (m components share it, and each bit quarters the squared error), so a bit is worth 1.4/m/V of it.
double row_price(const State& state, std::size_t points) {
    double rows = 0;
    for (const ClusterFit& fit : state.fits)
        rows += static_cast<double>(fit.plan.bits.size());
    const double mean = std::max(1.0, rows / static_cast<double>(state.fits.size()));
    return 64 * 1.4 / mean * state.cost / static_cast<double>(points);
}

/// The least operation price at which receivers have at most `most` components on average, by bisection over
/// the plans that the spectra of the clusters allow.
double operation_price(const State& state, std::span<const float> weights, Spending spending, double most) {
    std::vector<double> members(state.fits.size(), 0);
    for (std::size_t p = 0; p < weights.size(); ++p)
        members[state.clusters[p]] += 1;
    const auto mean = [&](double price) {
        spending.operation_price = price;
        double sum = 0;
        for (std::size_t k = 0; k < state.fits.size(); ++k)
            sum += members[k] *
                   static_cast<double>(
                       plan_components(state.fits[k].variances, state.fits[k].weight, spending).bits.size());
        return sum / static_cast<double>(weights.size());
    };
    double low = 0, high = 1;
    if (mean(low) <= most)
        return low;
    for (int i = 0; i < 60; ++i) {
        const double middle = i < 40 ? std::sqrt(std::max(low, 1e-20) * high) : 0.5 * (low + high);
        (mean(middle) > most ? low : high) = middle;
    }
    return high;
}

/// Lets clusters have different numbers of components, at most `options.mean_components` on average: the
/// price that does that is found anew in each round, since prices move the points, and points the prices.
/// Leaves the best round in `state` and its price in `spending`.
void spend_operations(const ClusterSearch& search, const ClusteringOptions& options, Spending& spending,
                      const Progress& progress, State& state) {
    constexpr int kRounds = 12;
    State best = state;
    double least = std::numeric_limits<double>::infinity(), best_price = 0;
    for (int r = 0; r < kRounds; ++r) {
        progress.update(0.6);
        spending.operation_price = 0;
        search.refit(state, spending); // for the spectra
        spending.operation_price =
            operation_price(state, search.weights(), spending, options.mean_components);
        search.refit(state, spending);
        double paid = 0;
        for (const ClusterFit& fit : state.fits)
            paid += fit.weight * spending.operation_price * static_cast<double>(fit.plan.bits.size());
        if (state.cost - paid < least) {
            least = state.cost - paid;
            best = state;
            best_price = spending.operation_price;
        }
        search.reassign(state);
    }
    state = std::move(best);
    spending.operation_price = best_price;
}

} // namespace

Clustering cluster_points(const PointBlocks& points, std::span<const float> weights,
                          const ClusteringOptions& options, std::mt19937_64& random,
                          const Progress& progress) {
    const ClusterSearch search(points, weights, options);
    State state = search.start(
        vector_quantise(points, weights, options.clusters, 0, random, options.threads, progress));
    Spending spending = options.spending;
    // Where the mean is limited clusters differ only at the end: earlier those with many components would
    // swallow the others' points.
    if (options.mean_components > 0)
        spending.most_components =
            std::min(spending.most_components, std::max(1, static_cast<int>(options.mean_components)));
    const int full = spending.most_components;
    for (int most = 1; options.grow && most < full; ++most) {
        spending.most_components = most;
        for (int r = 0; r < 2; ++r) {
            progress.update(0.1 + 0.4 * most / full);
            search.round(state, spending);
        }
    }
    spending.most_components = full;
    search.refit(state, spending);
    if (options.rows_cost)
        spending.row_price = row_price(state, points.count);
    Clustering result;
    search.converge(state, spending, options.most_rounds, progress, &result.history);
    for (int m = 0; m < options.most_moves && search.move(state, spending, progress); ++m) {
    }
    search.converge(state, spending, options.most_rounds, progress, nullptr);
    if (options.mean_components > 0) {
        spending.most_components = options.spending.most_components;
        spend_operations(search, options, spending, progress, state);
    }
    // Of what came and went rounding is left in the moments, of an outlier more than others have.
    state.moments.build(points, weights, state.clusters, options.threads);
    if (options.mean_components > 0) { // what was promised holds for the clusters as they are now
        spending.operation_price = 0;
        search.refit(state, spending);
        spending.operation_price = operation_price(state, weights, spending, options.mean_components);
    }
    search.refit(state, spending);
    result.clusters = std::move(state.clusters);
    result.fits = std::move(state.fits);
    result.cost = state.cost;
    return result;
}

} // namespace prt
