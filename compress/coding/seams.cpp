// Smooths the error over the mesh, docs/math.md, eq. 28: weights by conjugate gradients on its normal
// equations, clusters receiver by receiver, by iterated conditional modes (Besag 1986).

#include "compress/coding/seams.h"

#include "compress/coding/conjugate_gradients.h"
#include "compress/coding/seam_jumps.h"
#include "prt/core/adjacency.h"

#include <Eigen/Dense>

#include <array>
#include <cstdint>
#include <numeric>
#include <span>
#include <vector>

namespace prt {
namespace {

/// Returns the significance of receivers per edge. The significance of an edge is the sum over its ends, so
/// that all edges together have that of all receivers.
std::vector<double> significance_per_edge(const Adjacency& neighbours, std::span<const float> significance) {
    std::vector<double> shares(significance.size());
    for (std::size_t p = 0; p < shares.size(); ++p)
        shares[p] = static_cast<double>(significance[p]) /
                    static_cast<double>(std::max<std::size_t>(neighbours.degree(p), 1));
    return shares;
}

using PointVector = Eigen::VectorXf;

double mean_of(std::span<const float> values) {
    return std::accumulate(values.begin(), values.end(), 0.0) /
           static_cast<double>(std::max<std::size_t>(values.size(), 1));
}

/// Returns the order of all receivers. If there are more than `solved_together`, neighbours are close to each
/// other: breadth-first from the first receiver of each connected component.
std::vector<std::uint32_t> order_of_stretches(const Adjacency& neighbours, std::size_t solved_together) {
    std::vector<std::uint32_t> order;
    if (neighbours.receivers() <= solved_together) {
        order.resize(neighbours.receivers());
        std::iota(order.begin(), order.end(), 0u);
        return order;
    }
    order.reserve(neighbours.receivers());
    std::vector<bool> met(neighbours.receivers(), false);
    const auto meet = [&](std::uint32_t p) {
        if (!met[p])
            order.push_back(p);
        met[p] = true;
    };
    std::size_t next = 0;
    for (std::uint32_t start = 0; start < neighbours.receivers(); ++start)
        for (meet(start); next < order.size(); ++next)
            for (const std::uint32_t q : neighbours.of(order[next]))
                meet(q);
    return order;
}

/// Receivers whose weights are solved for together.
struct Stretch {
    std::span<const std::uint32_t> receivers;
    std::size_t unknowns = 0;
};
constexpr std::uint32_t kElsewhere = ~0u; ///< the receiver has no unknowns in the stretch

/// Returns the products of each cluster's rows with each other, along the axes of each group of points.
std::vector<Eigen::MatrixXf> products_of_rows(const QuantisedClusters& clusters, const PointScales& scales) {
    std::vector<Eigen::MatrixXf> result;
    for (std::size_t k = 0; k < clusters.clusters(); ++k)
        for (std::size_t g = 0; g < std::max<std::size_t>(scales.groups, 1); ++g) {
            Eigen::MatrixXf rows = Eigen::Map<const Eigen::MatrixXf>(
                clusters.row(k, 0), static_cast<Eigen::Index>(clusters.dimension),
                static_cast<Eigen::Index>(clusters.components[k]));
            for (std::size_t i = 0; i < scales.group_of.size(); ++i)
                if (scales.group_of[i] != g)
                    rows.row(static_cast<Eigen::Index>(i)).setZero();
            result.emplace_back(rows.transpose() * rows);
        }
    return result;
}

/// Smooths seams. Only weights are stored per receiver: vectors in the space of the frame are computed when
/// needed, for a receiver and its neighbours, because all of them together would take the memory of the
/// points.
class SeamSmoother {
public:
    SeamSmoother(const PointBlocks& points, std::span<const float> significance, std::span<const Edge> edges,
                 std::span<const SeamJump> jumps, const QuantisedClusters& clusters,
                 const SeamOptions& options, Codes& codes)
        : points_(points), significance_(significance), clusters_(clusters), options_(options), codes_(codes),
          neighbours_(edges, significance.size()),
          edge_shares_(significance_per_edge(neighbours_, significance)),
          dimension_(static_cast<Eigen::Index>(points.dimension)),
          jumps_(jumps,
                 {tuning::kJumpMultiplier * mean_of(significance),
                  tuning::kJumpBorder * mean_of(significance) * total_error(significance, codes.errors)}) {}

    void solve_weights();
    void reassign();
    void close_jumps();
    void measure_errors();

private:
    /// Effect of the neighbours on receiver p: eq. 28 at p is total |e - vector|² plus a constant and border
    /// costs, with e the error of p.
    struct Pull {
        double total = 0;
        PointVector vector;
        std::vector<std::uint32_t> candidates; ///< its own cluster and those of its neighbours
    };
    struct BetterCode {
        std::uint32_t cluster = 0;
        std::vector<float> weights; ///< [max_components]
    };

    Eigen::Map<const PointVector> row(std::uint32_t k, std::size_t j) const {
        return {clusters_.row(k, j), dimension_};
    }
    std::size_t components(std::size_t p) const { return clusters_.components_of(codes_.clusters[p]); }
    /// Adds scale · sum_j w_j row_j in the cluster of receiver p.
    void add_combination(std::size_t p, const float* w, PointVector& to, float scale = 1) const {
        for (std::size_t j = 0; j < components(p); ++j)
            to += scale * w[j] * row(codes_.clusters[p], j);
    }
    /// Returns the significance of an edge.
    double edge(std::size_t p, std::size_t q) const { return edge_shares_[p] + edge_shares_[q]; }
    float edge_weight(std::size_t p, std::size_t q) const {
        return static_cast<float>(options_.seam_weight * edge(p, q));
    }
    /// Applies the scales of a receiver, which weigh its errors, to a vector; all vectors except rows are
    /// scaled.
    void multiply_scales(std::size_t p, PointVector& vector) const {
        points_.scales.multiply(p, vector.data());
    }
    /// Returns the residual of receiver p after cluster k's mean and predictors.
    PointVector left_of(std::size_t p, std::uint32_t k) const {
        PointVector point(static_cast<Eigen::Index>(points_.width()));
        points_.copy_point(p, point.data());
        subtract_known(clusters_, k, point.data());
        point.conservativeResize(dimension_);
        multiply_scales(p, point);
        return point;
    }
    /// Computes code minus point.
    void error_of(std::size_t p, PointVector& error) const {
        std::array<float, kMaxDimensions> weights;
        codes_.read(clusters_, p, weights.data());
        error.setZero(dimension_);
        add_combination(p, weights.data(), error);
        multiply_scales(p, error);
        error -= left_of(p, codes_.clusters[p]);
    }
    std::size_t groups() const { return std::max<std::size_t>(points_.scales.groups, 1); }
    float scale(std::size_t p, std::size_t group) const {
        return points_.scales.all_alike() ? 1.0f : points_.scales.of(p)[group];
    }
    const Eigen::MatrixXf& products(std::uint32_t k, std::size_t group) const {
        return products_[k * groups() + group];
    }

    /// Solves for the weights of a stretch as real numbers, then rounds them.
    void solve(std::span<const std::uint32_t> receivers);
    /// Returns half the negative gradient of eq. 28 with respect to the weights of each receiver: [unknowns],
    /// indexed by first_.
    std::vector<float> descent(const Stretch& stretch) const;
    /// Applies the quadratic form of eq. 28 to a change of all weights of the stretch.
    std::vector<float> curvature(const Stretch& stretch, std::span<const float> change) const;
    std::vector<float> inverse_diagonal(const Stretch& stretch) const;
    Eigen::Map<const Eigen::VectorXf> weights_of(std::size_t p, std::span<const float> unknowns) const {
        return {unknowns.data() + first_[p], static_cast<Eigen::Index>(components(p))};
    }

    void pull_at(std::size_t p, Pull& pull) const;
    /// Returns the cost in eq. 28 of an error `e` at p with a code in cluster k.
    double cost_at(std::size_t p, const Pull& pull, std::uint32_t k, const PointVector& e) const;
    /// Computes the code of receiver p in cluster k whose decoded value is nearest to `left`; returns its
    /// error vector.
    PointVector code_in(std::size_t p, std::uint32_t k, PointVector left, std::span<float> code) const;
    /// Finds a code that is cheaper than p's with fixed neighbours, with at most `spare` more components.
    bool find_better(std::size_t p, const Pull& pull, std::ptrdiff_t spare, BetterCode& better) const;
    /// Returns the number of components that receivers may use in addition.
    std::ptrdiff_t spare_components() const;
    std::size_t sweep(std::span<const std::uint32_t> receivers, std::ptrdiff_t& spare);

    const PointBlocks& points_;
    std::span<const float> significance_;
    const QuantisedClusters& clusters_;
    const SeamOptions& options_;
    Codes& codes_;
    Adjacency neighbours_;
    std::vector<double> edge_shares_; ///< [points]
    Eigen::Index dimension_;
    SeamJumps jumps_; ///< count once they are measured, at the end
    // Used while weights are solved for:
    std::vector<std::uint32_t> first_;      ///< [points] a receiver's first unknown; it has one per component
    std::vector<Eigen::MatrixXf> products_; ///< [clusters][groups] of their rows with each other
};

std::vector<float> SeamSmoother::descent(const Stretch& stretch) const {
    std::vector<float> result(stretch.unknowns, 0.0f);
    parallel_for(stretch.receivers.size(), 1024, options_.threads, [&](std::size_t begin, std::size_t end) {
        PointVector sum(dimension_), own(dimension_), other(dimension_);
        for (const std::uint32_t p : stretch.receivers.subspan(begin, end - begin)) {
            error_of(p, own);
            sum = significance_[p] * own;
            for (const std::uint32_t q : neighbours_.of(p)) {
                error_of(q, other);
                sum += edge_weight(p, q) * (own - other);
            }
            multiply_scales(p, sum);
            for (std::size_t j = 0; j < components(p); ++j)
                result[first_[p] + j] = -sum.dot(row(codes_.clusters[p], j));
        }
    });
    return result;
}

/// Multiplies by the quadratic form. Most neighbours are in the same cluster: products of their rows are
/// precomputed, and only weights are summed. Vectors are formed only across borders.
std::vector<float> SeamSmoother::curvature(const Stretch& stretch, std::span<const float> change) const {
    std::vector<float> result(stretch.unknowns, 0.0f);
    parallel_for(stretch.receivers.size(), 1024, options_.threads, [&](std::size_t begin, std::size_t end) {
        PointVector across(dimension_), beyond(dimension_);
        Eigen::MatrixXf within(static_cast<Eigen::Index>(clusters_.max_components),
                               static_cast<Eigen::Index>(groups()));
        for (const std::uint32_t p : stretch.receivers.subspan(begin, end - begin)) {
            const std::uint32_t k = codes_.clusters[p];
            const auto m = static_cast<Eigen::Index>(components(p));
            float own = significance_[p];
            within.topRows(m).setZero();
            const auto add_within = [&](std::uint32_t q, float factor) {
                for (std::size_t g = 0; g < groups(); ++g)
                    within.col(static_cast<Eigen::Index>(g)).head(m) +=
                        factor * scale(q, g) * weights_of(q, change);
            };
            bool at_border = false;
            for (const std::uint32_t q : neighbours_.of(p)) {
                const float multiplier = edge_weight(p, q);
                own += multiplier;
                if (first_[q] == kElsewhere)
                    continue;
                if (codes_.clusters[q] == k) {
                    add_within(q, -multiplier);
                    continue;
                }
                if (!at_border)
                    across.setZero();
                at_border = true;
                beyond.setZero();
                add_combination(q, change.data() + first_[q], beyond, -multiplier);
                multiply_scales(q, beyond);
                across += beyond;
            }
            add_within(p, own);
            Eigen::Map<Eigen::VectorXf> to(result.data() + first_[p], m);
            for (std::size_t g = 0; g < groups(); ++g)
                to += scale(p, g) * (products(k, g) * within.col(static_cast<Eigen::Index>(g)).head(m));
            if (at_border)
                multiply_scales(p, across);
            for (Eigen::Index j = 0; j < m && at_border; ++j)
                to[j] += across.dot(row(k, static_cast<std::size_t>(j)));
        }
    });
    return result;
}

std::vector<float> SeamSmoother::inverse_diagonal(const Stretch& stretch) const {
    std::vector<float> result(stretch.unknowns, 1.0f);
    for (const std::uint32_t p : stretch.receivers) {
        auto total = static_cast<double>(significance_[p]);
        for (const std::uint32_t q : neighbours_.of(p))
            total += options_.seam_weight * edge(p, q);
        for (std::size_t j = 0; j < components(p); ++j) {
            double d = 0;
            const auto at = static_cast<Eigen::Index>(j);
            for (std::size_t g = 0; g < groups(); ++g)
                d += total *
                     static_cast<double>(scale(p, g) * scale(p, g) * products(codes_.clusters[p], g)(at, at));
            result[first_[p] + j] = d > 1e-30 ? static_cast<float>(1 / d) : 1.0f;
        }
    }
    return result;
}

void SeamSmoother::solve(std::span<const std::uint32_t> receivers) {
    Stretch stretch{receivers};
    for (const std::uint32_t p : receivers) {
        first_[p] = static_cast<std::uint32_t>(stretch.unknowns);
        stretch.unknowns += components(p);
    }
    const std::vector<float> change =
        conjugate_gradients([&](std::span<const float> direction) { return curvature(stretch, direction); },
                            inverse_diagonal(stretch), descent(stretch));
    std::vector<float> w(clusters_.max_components);
    for (const std::uint32_t p : receivers) {
        const std::uint32_t k = codes_.clusters[p];
        codes_.read(clusters_, p, w.data());
        for (std::size_t j = 0; j < components(p); ++j)
            w[j] = clusters_.grid(k, j).nearest(w[j] + change[first_[p] + j]);
        codes_.weights.write(clusters_, k, p, w.data());
        first_[p] = kElsewhere;
    }
}

/// Solves stretch by stretch, so that the six vectors of all unknowns in the solver take little memory. The
/// few edges between stretches are handled by the following sweeps.
void SeamSmoother::solve_weights() {
    products_ = products_of_rows(clusters_, points_.scales);
    first_.assign(points_.count, kElsewhere);
    const std::vector<std::uint32_t> order = order_of_stretches(neighbours_, options_.solved_together);
    for (std::size_t begin = 0; begin < order.size(); begin += options_.solved_together)
        solve(std::span(order).subspan(begin, std::min(options_.solved_together, order.size() - begin)));
    first_ = {};
    products_ = {};
}

PointVector SeamSmoother::code_in(std::size_t p, std::uint32_t k, PointVector left,
                                  std::span<float> code) const {
    PointVector direction(dimension_);
    for (std::size_t j = 0; j < clusters_.components_of(k); ++j) {
        direction = row(k, j);
        multiply_scales(p, direction);
        const float norm = direction.squaredNorm();
        code[j] = clusters_.grid(k, j).nearest(norm > 1e-30f ? left.dot(direction) / norm : 0.0f);
        left -= code[j] * direction;
    }
    return -left;
}

std::ptrdiff_t SeamSmoother::spare_components() const {
    if (!(options_.mean_components > 0))
        return std::numeric_limits<std::ptrdiff_t>::max() / 2; // more than can be used
    auto spare = static_cast<std::ptrdiff_t>(options_.mean_components * static_cast<double>(points_.count));
    for (std::size_t p = 0; p < points_.count; ++p)
        spare -= static_cast<std::ptrdiff_t>(components(p));
    return spare;
}

void SeamSmoother::pull_at(std::size_t p, Pull& pull) const {
    PointVector error(dimension_);
    pull.total = static_cast<double>(significance_[p]);
    pull.vector.setZero(dimension_);
    pull.candidates.assign(1, codes_.clusters[p]);
    const auto consider = [&](std::uint32_t k) {
        if (std::find(pull.candidates.begin(), pull.candidates.end(), k) == pull.candidates.end())
            pull.candidates.push_back(k);
    };
    for (const std::uint32_t q : neighbours_.of(p)) {
        pull.total += options_.seam_weight * edge(p, q);
        error_of(q, error);
        pull.vector += static_cast<float>(options_.seam_weight * edge(p, q)) * error;
        consider(codes_.clusters[q]);
    }
    if (jumps_.measured()) {
        error_of(p, error);
        pull.total += jumps_.pull(p, error, pull.vector);
        jumps_.see_partners(p, [&](std::uint32_t q) { consider(codes_.clusters[q]); });
    }
    if (pull.total > 0)
        pull.vector /= static_cast<float>(pull.total);
}

double SeamSmoother::cost_at(std::size_t p, const Pull& pull, std::uint32_t k, const PointVector& e) const {
    double cost = pull.total * static_cast<double>((e - pull.vector).squaredNorm());
    if (jumps_.measured())
        cost += jumps_.borders(p, [&](std::uint32_t q) { return codes_.clusters[q] != k; });
    return cost;
}

bool SeamSmoother::find_better(std::size_t p, const Pull& pull, std::ptrdiff_t spare,
                               BetterCode& better) const {
    std::vector<float> code(clusters_.max_components);
    PointVector error(dimension_);
    error_of(p, error);
    double least = cost_at(p, pull, codes_.clusters[p], error);
    bool found = false;
    for (const std::uint32_t k : pull.candidates) {
        if (clusters_.components[k] - clusters_.components[codes_.clusters[p]] > spare)
            continue;
        const PointVector e = code_in(p, k, left_of(p, k) + pull.vector, code) + pull.vector;
        const double cost = cost_at(p, pull, k, e);
        if (cost < least * (1 - tuning::kMinSeamGain)) {
            least = cost;
            better = {k, code};
            found = true;
        }
    }
    return found;
}

/// Improves receivers one after another, so that each sees the changes of its neighbours. Returns the number
/// of changes.
std::size_t SeamSmoother::sweep(std::span<const std::uint32_t> receivers, std::ptrdiff_t& spare) {
    std::size_t changed = 0;
    Pull pull;
    BetterCode better;
    PointVector before(dimension_), after(dimension_);
    for (const std::size_t p : receivers) {
        if (neighbours_.degree(p) == 0)
            continue;
        pull_at(p, pull);
        if (!(pull.total > 0) || !find_better(p, pull, spare, better))
            continue;
        if (jumps_.measured())
            error_of(p, before);
        spare -= clusters_.components[better.cluster] - clusters_.components[codes_.clusters[p]];
        codes_.clusters[p] = better.cluster;
        codes_.weights.write(clusters_, better.cluster, p, better.weights.data());
        if (jumps_.measured()) {
            error_of(p, after);
            jumps_.move(p, after - before);
        }
        ++changed;
    }
    return changed;
}

void SeamSmoother::reassign() {
    std::ptrdiff_t spare = spare_components();
    std::vector<std::uint32_t> all(points_.count);
    std::iota(all.begin(), all.end(), 0u);
    for (int s = 0; s < tuning::kMaxSeamSweeps; ++s)
        if (sweep(all, spare) * tuning::kReceiversPerSeamChange < points_.count)
            break;
}

/// Closes jumps. A game interpolates light between the texels of a seam, so that all texels read at a point
/// count together.
void SeamSmoother::close_jumps() {
    if (jumps_.receivers().empty())
        return;
    PointVector error(dimension_);
    jumps_.measure(dimension_, [&](std::size_t p) -> const PointVector& {
        error_of(p, error);
        return error;
    });
    std::ptrdiff_t spare = spare_components();
    for (int s = 0; s < tuning::kJumpSweeps; ++s)
        sweep(jumps_.receivers(), spare);
}

void SeamSmoother::measure_errors() {
    PointVector error(dimension_);
    for (std::size_t p = 0; p < points_.count; ++p) {
        error_of(p, error);
        codes_.errors[p] = error.squaredNorm();
    }
}

} // namespace

void smooth_seams(const PointBlocks& points, std::span<const float> significance, std::span<const Edge> edges,
                  std::span<const SeamJump> jumps, const QuantisedClusters& clusters,
                  const SeamOptions& options, Codes& codes) {
    if (points.dimension == 0)
        return;
    SeamSmoother smoother(points, significance, edges, jumps, clusters, options, codes);
    if (options.seam_weight > 0 && clusters.max_components > 0)
        smoother.solve_weights();
    smoother.reassign();
    smoother.close_jumps();
    smoother.measure_errors();
}

} // namespace prt
