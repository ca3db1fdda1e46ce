#pragma once

#include "clusters/component_plan.h"
#include "clusters/points.h"

namespace prt {

/// Moments of every cluster's points by significance, in double: what a local PCA needs. Points that change
/// their cluster are subtracted here and added there, so that a round costs what has moved.
class ClusterMoments {
public:
    ClusterMoments(std::size_t clusters, std::size_t dimension, std::size_t guides = 0);

    /// Sums over all points from nothing.
    void build(const PointBlocks& points, std::span<const float> significance,
               std::span<const std::uint32_t> clusters, int threads);
    /// Takes `before` to `after`.
    void update(const PointBlocks& points, std::span<const float> significance,
                std::span<const std::uint32_t> before, std::span<const std::uint32_t> after, int threads);

    /// A cluster's moments: significance, sums [width], lower triangle of products by rows; coordinates, then
    /// guides.
    struct View {
        std::size_t dimension, guides;
        std::span<const double> values;
        std::size_t width() const { return dimension + guides; }
        double significance() const { return values[0]; }
    };
    View view(std::size_t k) const {
        return {dimension_, guides_, std::span(values_).subspan(k * stride_, stride_)};
    }
    std::size_t stride() const { return stride_; }
    static void add(std::span<const float> point, double significance, std::span<double> moments);

private:
    std::size_t dimension_, guides_, stride_;
    std::vector<double> values_; ///< [clusters][stride]
};

/// Mean, principal axes and plan of one set of points.
struct ClusterFit {
    std::vector<float> mean;       ///< [dimension]
    std::vector<float> center;     ///< [guides], their mean
    std::vector<float> slopes;     ///< [guides][dimension]
    std::vector<float> directions; ///< [components][dimension], orthonormal
    std::vector<double> variances; ///< [dimension] along all principal axes, descending, of what guides leave
    std::vector<double> guide_variances; ///< [guides]
    ComponentPlan plan;
    double significance = 0;

    /// Of all points of the cluster, prices included.
    double cost(const Spending& spending) const { return cost_of(plan, significance, spending); }
};

/// Regression on the guides, and local PCA of what they leave, from moments. Directions without variance
/// beyond the rounding of the points are left out.
ClusterFit fit_cluster(const ClusterMoments::View& moments, const Spending& spending);

/// The cost that such a fit would have, without its directions: five times as fast.
double cluster_cost(const ClusterMoments::View& moments, const Spending& spending);

} // namespace prt
