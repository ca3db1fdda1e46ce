#include "seams.h"

#include "prt/parallel.h"

#include <Eigen/Dense>

#include <algorithm>
#include <cmath>

namespace prt {
namespace {

/// Mesh neighbours of every receiver, with the weight of the edge.
class Neighbours {
public:
    struct Link {
        std::uint32_t other;
        double weight;
    };

    /// The weight of an edge is the mean of what its ends have per edge, so that all edges together weigh
    /// about as much as all receivers.
    Neighbours(std::span<const Edge> edges, std::span<const float> weights) : first_(weights.size() + 1, 0) {
        std::vector<std::uint32_t> degree(weights.size(), 0);
        for (const Edge& e : edges) {
            ++degree[e.first];
            ++degree[e.second];
        }
        for (std::size_t p = 0; p < weights.size(); ++p)
            first_[p + 1] = first_[p] + degree[p];
        links_.resize(first_.back());
        std::vector<std::size_t> next(first_.begin(), first_.end() - 1);
        for (const Edge& e : edges) {
            const double weight = static_cast<double>(weights[e.first]) / degree[e.first] +
                                  static_cast<double>(weights[e.second]) / degree[e.second];
            links_[next[e.first]++] = {e.second, weight};
            links_[next[e.second]++] = {e.first, weight};
        }
    }
    std::span<const Link> of(std::size_t p) const {
        return std::span(links_).subspan(first_[p], first_[p + 1] - first_[p]);
    }

private:
    std::vector<std::size_t> first_;
    std::vector<Link> links_;
};

using Vector = Eigen::VectorXd;
using ErrorMatrix = Eigen::Matrix<float, Eigen::Dynamic, Eigen::Dynamic>; // [dimension][points]

class SeamSmoother {
public:
    SeamSmoother(const PointBlocks& points, std::span<const float> weights, std::span<const Edge> edges,
                 const QuantisedModels& models, const SeamOptions& options, Codes& codes)
        : points_(points), weights_(weights), models_(models), options_(options), codes_(codes),
          neighbours_(edges, weights), dimension_(static_cast<Eigen::Index>(points.dimension)) {
        double total = 0;
        for (std::size_t p = 0; p < points.count; ++p)
            total += static_cast<double>(weights[p]) * static_cast<double>(codes.errors[p]);
        mean_error_ = total;
    }

    void solve_weights();
    void reassign();

private:
    Eigen::Map<const Eigen::VectorXf> row(std::uint32_t k, std::size_t j) const {
        return {models_.row(k, j), dimension_};
    }
    std::size_t components(std::size_t p) const {
        return static_cast<std::size_t>(models_.components[codes_.clusters[p]]);
    }

    /// Error vectors of all receivers, code minus point.
    ErrorMatrix errors() const;
    /// sum_j w_pj row_j for all receivers.
    ErrorMatrix combined(const std::vector<double>& all_weights) const;
    /// Its transpose, applied to the gradient of the quadratic form at `errors`.
    std::vector<double> gradient(const ErrorMatrix& errors) const;
    /// The code nearest to `target` in cluster k; returns its error vector.
    Eigen::VectorXf code_in(std::uint32_t k, const Eigen::VectorXf& target, std::span<float> code) const;

    const PointBlocks& points_;
    std::span<const float> weights_;
    const QuantisedModels& models_;
    const SeamOptions& options_;
    Codes& codes_;
    Neighbours neighbours_;
    Eigen::Index dimension_;
    double mean_error_ = 0;
};

ErrorMatrix SeamSmoother::errors() const {
    ErrorMatrix result(dimension_, static_cast<Eigen::Index>(points_.count));
    parallel_for(points_.count, 1024, options_.threads, [&](std::size_t begin, std::size_t end) {
        Eigen::VectorXf point(dimension_);
        for (std::size_t p = begin; p < end; ++p) {
            const std::uint32_t k = codes_.clusters[p];
            points_.copy_point(p, point.data());
            Eigen::VectorXf e = Eigen::Map<const Eigen::VectorXf>(models_.mean(k), dimension_) - point;
            for (std::size_t j = 0; j < components(p); ++j)
                e += codes_.of(p)[j] * row(k, j);
            result.col(static_cast<Eigen::Index>(p)) = e;
        }
    });
    return result;
}

ErrorMatrix SeamSmoother::combined(const std::vector<double>& all_weights) const {
    ErrorMatrix result = ErrorMatrix::Zero(dimension_, static_cast<Eigen::Index>(points_.count));
    parallel_for(points_.count, 1024, options_.threads, [&](std::size_t begin, std::size_t end) {
        for (std::size_t p = begin; p < end; ++p)
            for (std::size_t j = 0; j < components(p); ++j)
                result.col(static_cast<Eigen::Index>(p)) +=
                    static_cast<float>(all_weights[p * models_.max_components + j]) *
                    row(codes_.clusters[p], j);
    });
    return result;
}

std::vector<double> SeamSmoother::gradient(const ErrorMatrix& errors) const {
    std::vector<double> result(points_.count * models_.max_components, 0);
    parallel_for(points_.count, 1024, options_.threads, [&](std::size_t begin, std::size_t end) {
        Vector g(dimension_);
        for (std::size_t p = begin; p < end; ++p) {
            const Vector own = errors.col(static_cast<Eigen::Index>(p)).cast<double>();
            g.setZero();
            g += static_cast<double>(weights_[p]) * own;
            for (const Neighbours::Link& link : neighbours_.of(p))
                g += options_.seam_weight * link.weight *
                     (own - errors.col(static_cast<Eigen::Index>(link.other)).cast<double>());
            for (std::size_t j = 0; j < components(p); ++j)
                result[p * models_.max_components + j] = g.dot(row(codes_.clusters[p], j).cast<double>());
        }
    });
    return result;
}

/// Conjugate gradients, preconditioned by the diagonal, on the change of all weights. The matrix is never
/// formed: with 1.5 million receivers and 8 components it would have 10^9 entries.
void SeamSmoother::solve_weights() {
    const std::size_t count = points_.count * models_.max_components;
    std::vector<double> diagonal(count, 1.0), change(count, 0.0);
    for (std::size_t p = 0; p < points_.count; ++p) {
        double weight = static_cast<double>(weights_[p]);
        for (const Neighbours::Link& link : neighbours_.of(p))
            weight += options_.seam_weight * link.weight;
        for (std::size_t j = 0; j < components(p); ++j) {
            const double d = weight * static_cast<double>(row(codes_.clusters[p], j).squaredNorm());
            diagonal[p * models_.max_components + j] = d > 0 ? d : 1.0;
        }
    }
    const auto dot = [count](const std::vector<double>& a, const std::vector<double>& b) {
        double sum = 0;
        for (std::size_t i = 0; i < count; ++i)
            sum += a[i] * b[i];
        return sum;
    };
    std::vector<double> residual = gradient(errors());
    for (double& r : residual)
        r = -r;
    std::vector<double> scaled(count), direction(count, 0.0);
    double before = 0, start = 0;
    constexpr int kMostSteps = 30;
    for (int step = 0; step < kMostSteps; ++step) {
        for (std::size_t i = 0; i < count; ++i)
            scaled[i] = residual[i] / diagonal[i];
        const double norm = dot(residual, scaled);
        if (step == 0)
            start = norm;
        if (!(norm > 1e-6 * start)) // weights are rounded afterwards, to steps far larger
            break;
        const double beta = step == 0 ? 0 : norm / before;
        before = norm;
        for (std::size_t i = 0; i < count; ++i)
            direction[i] = scaled[i] + beta * direction[i];
        const std::vector<double> product = gradient(combined(direction));
        const double alpha = norm / dot(direction, product);
        for (std::size_t i = 0; i < count; ++i) {
            change[i] += alpha * direction[i];
            residual[i] -= alpha * product[i];
        }
    }
    for (std::size_t p = 0; p < points_.count; ++p)
        for (std::size_t j = 0; j < components(p); ++j) {
            float& w = codes_.weights[p * models_.max_components + j];
            w = round_weight(
                static_cast<float>(static_cast<double>(w) + change[p * models_.max_components + j]),
                models_.halves[codes_.clusters[p] * models_.max_components + j]);
        }
}

Eigen::VectorXf SeamSmoother::code_in(std::uint32_t k, const Eigen::VectorXf& target,
                                      std::span<float> code) const {
    Eigen::VectorXf left = target - Eigen::Map<const Eigen::VectorXf>(models_.mean(k), dimension_);
    for (std::size_t j = 0; j < static_cast<std::size_t>(models_.components[k]); ++j) {
        const auto direction = row(k, j);
        const float norm = direction.squaredNorm();
        code[j] = round_weight(norm > 1e-30f ? left.dot(direction) / norm : 0.0f,
                               models_.halves[k * models_.max_components + j]);
        left -= code[j] * direction;
    }
    return -left;
}

void SeamSmoother::reassign() {
    ErrorMatrix error = errors();
    std::vector<float> code(models_.max_components), best_code(models_.max_components);
    std::vector<std::uint32_t> candidates;
    constexpr int kMostSweeps = 10;
    for (int sweep = 0; sweep < kMostSweeps; ++sweep) {
        std::size_t changed = 0;
        // One after the other, so that each sees what its neighbours have become.
        for (std::size_t p = 0; p < points_.count; ++p) {
            const auto links = neighbours_.of(p);
            double total = static_cast<double>(weights_[p]);
            Vector pull = Vector::Zero(dimension_);
            candidates.assign(1, codes_.clusters[p]);
            for (const Neighbours::Link& link : links) {
                total += options_.seam_weight * link.weight;
                pull += options_.seam_weight * link.weight *
                        error.col(static_cast<Eigen::Index>(link.other)).cast<double>();
                if (std::find(candidates.begin(), candidates.end(), codes_.clusters[link.other]) ==
                    candidates.end())
                    candidates.push_back(codes_.clusters[link.other]);
            }
            if (links.empty() || !(total > 0))
                continue;
            // The sum over the edges is total |e - pull|² and what does not depend on e.
            pull /= total;
            const auto price = [&](std::uint32_t k, const Eigen::VectorXf& e) {
                double cost = total * (e.cast<double>() - pull).squaredNorm();
                for (const Neighbours::Link& link : links)
                    if (codes_.clusters[link.other] != k)
                        cost += options_.potts_weight * mean_error_ * link.weight;
                return cost;
            };
            Eigen::VectorXf point(dimension_);
            points_.copy_point(p, point.data());
            const Eigen::VectorXf target = point + pull.cast<float>();
            double least = price(codes_.clusters[p], error.col(static_cast<Eigen::Index>(p)));
            std::uint32_t best = ~0u;
            Eigen::VectorXf best_error;
            for (const std::uint32_t k : candidates) {
                const Eigen::VectorXf e = code_in(k, target, code) + pull.cast<float>();
                const double cost = price(k, e);
                if (cost < least * (1 - 1e-6)) {
                    least = cost;
                    best = k;
                    best_code = code;
                    best_error = e;
                }
            }
            if (best == ~0u)
                continue;
            codes_.clusters[p] = best;
            std::fill_n(&codes_.weights[p * models_.max_components], models_.max_components, 0.0f);
            std::copy_n(best_code.begin(), models_.components[best],
                        &codes_.weights[p * models_.max_components]);
            error.col(static_cast<Eigen::Index>(p)) = best_error;
            ++changed;
        }
        if (changed * 200 < points_.count)
            break;
    }
    for (std::size_t p = 0; p < points_.count; ++p)
        codes_.errors[p] = error.col(static_cast<Eigen::Index>(p)).squaredNorm();
}

} // namespace

void smooth_seams(const PointBlocks& points, std::span<const float> weights, std::span<const Edge> edges,
                  const QuantisedModels& models, const SeamOptions& options, Codes& codes) {
    if (points.dimension == 0)
        return;
    SeamSmoother smoother(points, weights, edges, models, options, codes);
    if (options.seam_weight > 0 && models.max_components > 0)
        smoother.solve_weights();
    smoother.reassign();
}

} // namespace prt
