// Split-and-merge moves between clusters, to escape the local optima of Lloyd's iteration.

#include "compress/clusters/moves.h"

#include "compress/clusters/cluster_neighbours.h"
#include "compress/tuning/tuning.h"

#include <numeric>
#include <tuple>

namespace prt {
namespace {

struct PossibleSplit {
    double gain = 0;
    std::vector<std::uint32_t> leaving; ///< points that move to the new cluster
};

struct PossibleMerge {
    double loss = 0;
    std::size_t into = 0, from = 0;
};

class Moves {
public:
    Moves(const ClusterRounds& rounds, const RateBudget& rate_budget, const ClusterState& state)
        : rounds_(rounds), points_(rounds.points), rate_budget_(rate_budget), state_(state),
          clusters_(penalised_clusters(state.fits, rounds.points.dimension)) {}

    /// Returns the best split of each cluster, [clusters]; the gain is 0 if the cluster's cost is below
    /// `least`.
    std::vector<PossibleSplit> splits(double least) const;
    /// Returns merges of every cluster with its nearest neighbours, smallest loss first.
    std::vector<PossibleMerge> merges() const;
    /// Moves points in `next` while pairs of a split and a merge reduce the cost. Returns whether any did.
    bool apply(const std::vector<PossibleSplit>& splits, const std::vector<PossibleMerge>& merges,
               std::vector<std::uint32_t>& next) const;
    /// Splits clusters, largest gain first, until there are `wanted`. Returns the resulting number.
    std::size_t split_most(std::size_t wanted, std::vector<std::uint32_t>& next) const;
    /// Merges pairs, smallest loss first, until `wanted` are left. Returns the resulting number.
    std::size_t merge_least(std::size_t wanted, std::vector<std::uint32_t>& next) const;

private:
    double cost(std::size_t k) const { return state_.fits[k].cost(rate_budget_); }
    double cost_of_moments(std::span<const double> moments) const {
        return cluster_cost({points_.dimension, points_.predictors, moments}, rate_budget_);
    }
    PossibleSplit split(std::size_t k, std::span<const std::uint32_t> members) const;
    PossibleMerge merge(std::size_t k, std::size_t other) const;

    const ClusterRounds& rounds_;
    const PointBlocks& points_;
    const RateBudget& rate_budget_;
    const ClusterState& state_;
    PenalisedClusters clusters_; ///< clusters of `state_`
};

PossibleSplit Moves::split(std::size_t k, std::span<const std::uint32_t> members) const {
    const ClusterFit& fit = state_.fits[k];
    PossibleSplit result;
    std::vector<float> point(points_.width()), left;
    std::vector<double> low(state_.moments.stride(), 0), high(state_.moments.stride(), 0);
    for (const std::uint32_t p : members) {
        points_.copy_point(p, point.data());
        left = point;
        subtract_known(clusters_, k, left.data());
        double along = 0;
        for (std::size_t i = 0; i < points_.dimension; ++i)
            along += static_cast<double>(fit.directions[i]) * static_cast<double>(left[i]);
        ClusterMoments::add(point, static_cast<double>(rounds_.significance[p]), along > 0 ? high : low);
        if (along > 0)
            result.leaving.push_back(p);
    }
    result.gain = cost(k) - cost_of_moments(low) - cost_of_moments(high);
    return result;
}

std::vector<PossibleSplit> Moves::splits(double least) const {
    std::vector<std::vector<std::uint32_t>> members(state_.fits.size());
    for (std::uint32_t p = 0; p < points_.count; ++p)
        if (rounds_.significance[p] > 0)
            members[state_.clusters[p]].push_back(p);
    std::vector<PossibleSplit> found(state_.fits.size());
    parallel_for(found.size(), 1, rounds_.threads, [&](std::size_t begin, std::size_t end) {
        for (std::size_t k = begin; k < end; ++k)
            if (!state_.fits[k].directions.empty() && members[k].size() >= 2 && !(cost(k) < least))
                found[k] = split(k, members[k]);
    });
    return found;
}

PossibleMerge Moves::merge(std::size_t k, std::size_t other) const {
    const auto a = state_.moments.view(k), b = state_.moments.view(other);
    std::vector<double> sum(a.values.begin(), a.values.end());
    for (std::size_t i = 0; i < sum.size(); ++i)
        sum[i] += b.values[i];
    return {cost_of_moments(sum) - cost(k) - cost(other), std::min(k, other), std::max(k, other)};
}

std::vector<PossibleMerge> Moves::merges() const {
    const MeanDistances means(clusters_);
    std::vector<std::vector<PossibleMerge>> found(state_.fits.size());
    parallel_for(found.size(), 1, rounds_.threads, [&](std::size_t begin, std::size_t end) {
        for (std::size_t k = begin; k < end; ++k) {
            const Eigen::ArrayXf squared = means.from(k);
            std::vector<std::pair<float, std::size_t>> near;
            for (std::size_t other = 0; other < found.size(); ++other)
                if (other != k)
                    near.emplace_back(
                        state_.fits[other].significance > 0 ? squared[static_cast<Eigen::Index>(other)] : 0,
                        other);
            const std::size_t count = std::min(tuning::kMergePartners, near.size());
            std::partial_sort(near.begin(), near.begin() + static_cast<std::ptrdiff_t>(count), near.end());
            for (std::size_t n = 0; n < count; ++n)
                found[k].push_back(merge(k, near[n].second));
        }
    });
    std::vector<PossibleMerge> all;
    for (const auto& list : found)
        all.insert(all.end(), list.begin(), list.end());
    std::sort(all.begin(), all.end(), [](const PossibleMerge& a, const PossibleMerge& b) {
        return std::tie(a.loss, a.into, a.from) < std::tie(b.loss, b.into, b.from);
    });
    return all;
}

std::vector<std::size_t> by_gain(const std::vector<PossibleSplit>& splits) {
    std::vector<std::size_t> order(splits.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::stable_sort(order.begin(), order.end(),
                     [&](std::size_t a, std::size_t b) { return splits[a].gain > splits[b].gain; });
    return order;
}

bool Moves::apply(const std::vector<PossibleSplit>& splits, const std::vector<PossibleMerge>& merges,
                  std::vector<std::uint32_t>& next) const {
    const std::vector<std::size_t> order = by_gain(splits);
    std::vector<bool> touched(splits.size(), false);
    auto best = order.begin();
    bool any = false;
    for (const PossibleMerge& merge : merges) {
        if (touched[merge.into] || touched[merge.from])
            continue;
        while (best != order.end() && (touched[*best] || *best == merge.into || *best == merge.from))
            ++best;
        if (best == order.end() ||
            !(splits[*best].gain > tuning::kSplitOverMerge * std::max(merge.loss, 0.0)))
            break;
        const PossibleSplit& split = splits[*best];
        touched[merge.into] = touched[merge.from] = touched[*best] = true;
        std::replace(next.begin(), next.end(), static_cast<std::uint32_t>(merge.from),
                     static_cast<std::uint32_t>(merge.into));
        for (const std::uint32_t p : split.leaving)
            next[p] = static_cast<std::uint32_t>(merge.from);
        rounds_.tell(ClusterMerge{merge.from, merge.into, merge.loss});
        rounds_.tell(ClusterSplit{*best, merge.from, split.gain});
        ++best;
        any = true;
    }
    return any;
}

std::size_t Moves::split_most(std::size_t wanted, std::vector<std::uint32_t>& next) const {
    const std::vector<PossibleSplit> all = splits(0);
    std::size_t count = state_.fits.size();
    for (const std::size_t k : by_gain(all)) {
        if (count == wanted)
            break;
        if (all[k].leaving.empty())
            continue;
        for (const std::uint32_t p : all[k].leaving)
            next[p] = static_cast<std::uint32_t>(count);
        rounds_.tell(ClusterSplit{k, count, all[k].gain});
        ++count;
    }
    return count;
}

std::size_t Moves::merge_least(std::size_t wanted, std::vector<std::uint32_t>& next) const {
    std::vector<std::uint32_t> into(state_.fits.size());
    std::iota(into.begin(), into.end(), 0u);
    std::vector<bool> touched(into.size(), false);
    std::size_t left = into.size();
    for (const PossibleMerge& merge : merges()) {
        if (left == wanted)
            break;
        if (touched[merge.into] || touched[merge.from])
            continue;
        touched[merge.into] = touched[merge.from] = true;
        into[merge.from] = static_cast<std::uint32_t>(merge.into);
        rounds_.tell(ClusterMerge{merge.from, merge.into, merge.loss});
        --left;
    }
    std::vector<std::uint32_t> number(into.size());
    std::uint32_t count = 0;
    for (std::size_t k = 0; k < into.size(); ++k) // a pair gets its lower number
        number[k] = into[k] == k ? count++ : number[into[k]];
    for (std::uint32_t& k : next)
        k = number[k];
    return left;
}

} // namespace

bool split_and_merge(const ClusterRounds& rounds, const RateBudget& rate_budget, double tolerance,
                     const Progress& progress, ClusterState& state) {
    const Moves moves(rounds, rate_budget, state);
    ClusterState next = state;
    // Only clusters whose cost is above the mean are considered.
    const double mean = state.cost / static_cast<double>(state.fits.size());
    if (!moves.apply(moves.splits(mean), moves.merges(), next.clusters))
        return false;
    next.moments.update(rounds.points, rounds.significance, state.clusters, next.clusters, rounds.threads);
    for (int r = 0; r < tuning::kRoundsAfterMoves; ++r) {
        progress.update(static_cast<double>(r) / tuning::kRoundsAfterMoves);
        rounds.round(next, rate_budget);
    }
    rounds.refit(next, rate_budget);
    const bool kept = next.cost < state.cost * (1 - tolerance);
    rounds.tell(MovesTried{state.cost, next.cost, kept});
    if (kept)
        state = std::move(next);
    return kept;
}

void resize(const ClusterRounds& rounds, const RateBudget& rate_budget, std::size_t wanted,
            ClusterState& state) {
    rounds.refit(state, rate_budget);
    while (state.fits.size() != wanted) {
        const Moves moves(rounds, rate_budget, state);
        std::vector<std::uint32_t> next = state.clusters;
        const std::size_t count =
            state.fits.size() < wanted ? moves.split_most(wanted, next) : moves.merge_least(wanted, next);
        if (count == state.fits.size())
            return;
        state = rounds.start(std::move(next), count);
        rounds.round(state, rate_budget);
    }
}

} // namespace prt
