#pragma once

// Moments of clusters and local PCA.

#include "compress/clusters/component_plan.h"
#include "compress/clusters/points.h"

namespace prt {

/// Moments of every cluster's points, weighted by significance, in double: the input of local PCA. Points
/// that change their cluster are subtracted and added, so that the cost of a round depends on the number of
/// changes.
class ClusterMoments {
public:
    ClusterMoments(std::size_t clusters, std::size_t dimension, std::size_t predictors = 0);

    /// Computes the sums over all points from scratch.
    void build(const PointBlocks& points, std::span<const float> significance,
               std::span<const std::uint32_t> clusters, int threads);
    /// Updates the sums for the change of clusters from `before` to `after`.
    void update(const PointBlocks& points, std::span<const float> significance,
                std::span<const std::uint32_t> before, std::span<const std::uint32_t> after, int threads);

    /// A cluster's moments: significance, sums [width], lower triangle of products by rows; first
    /// coordinates, then predictors.
    struct View {
        std::size_t dimension, predictors;
        std::span<const double> values;
        std::size_t width() const { return dimension + predictors; }
        double significance() const { return values[0]; }
    };
    View view(std::size_t k) const {
        return {dimension_, predictors_, std::span(values_).subspan(k * stride_, stride_)};
    }
    std::size_t stride() const { return stride_; }
    static void add(std::span<const float> point, double significance, std::span<double> moments);

private:
    std::size_t dimension_, predictors_, stride_;
    std::vector<double> values_; ///< [clusters][stride]
};

/// Mean, principal axes and plan of one set of points.
struct ClusterFit {
    std::vector<float> mean;       ///< [dimension]
    std::vector<float> center;     ///< [predictors], mean of the predictors
    std::vector<float> slopes;     ///< [predictors][dimension]
    std::vector<float> directions; ///< [components][dimension], orthonormal
    std::vector<double> variances; ///< [dimension] along all principal axes, descending, after prediction
    std::vector<double> predictor_variances; ///< [predictors]
    ComponentPlan plan;
    double significance = 0;

    /// Cost of all points of the cluster, including multipliers.
    double cost(const RateBudget& rate_budget) const { return cost_of(plan, significance, rate_budget); }
};

/// Computes regression on the predictors, and local PCA of the residual, from moments. Directions whose
/// variance is only rounding of the points are dropped.
ClusterFit fit_cluster(const ClusterMoments::View& moments, const RateBudget& rate_budget);

/// Computes the cost of `fit_cluster` without its directions: five times as fast.
double cluster_cost(const ClusterMoments::View& moments, const RateBudget& rate_budget);

} // namespace prt
