#include "coding/seams.h"

#include "prt/support/parallel.h"

#include <Eigen/Dense>

#include <algorithm>
#include <cmath>
#include <limits>

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

using Vector = Eigen::VectorXf;

/// Nothing is kept per receiver but its weights: vectors in the space of the frame are formed where they are
/// needed, for a receiver and its neighbours, since all of them together would take as much memory as the
/// points.
class SeamSmoother {
public:
    SeamSmoother(const PointBlocks& points, std::span<const float> weights, std::span<const Edge> edges,
                 const QuantisedModels& models, const SeamOptions& options, Codes& codes)
        : points_(points), weights_(weights), models_(models), options_(options), codes_(codes),
          neighbours_(edges, weights), dimension_(static_cast<Eigen::Index>(points.dimension)),
          mean_error_(total_error(weights, codes.errors)) {}

    void solve_weights();
    void reassign();
    /// How many components more receivers may have in all.
    std::ptrdiff_t spare_components() const;

private:
    Eigen::Map<const Vector> row(std::uint32_t k, std::size_t j) const {
        return {models_.row(k, j), dimension_};
    }
    std::size_t components(std::size_t p) const {
        return static_cast<std::size_t>(models_.components[codes_.clusters[p]]);
    }
    /// sum_j w_j row_j in the cluster of receiver p.
    void add_combination(std::size_t p, std::span<const float> w, Vector& to) const {
        for (std::size_t j = 0; j < components(p); ++j)
            to += w[j] * row(codes_.clusters[p], j);
    }
    /// Code minus point.
    void error_of(std::size_t p, Vector& error) const {
        points_.copy_point(p, error.data());
        error = Eigen::Map<const Vector>(models_.mean(codes_.clusters[p]), dimension_) - error;
        add_combination(p, codes_.of(p), error);
    }

    /// What a change of the weights of each receiver changes: the quadratic form of eq. 31 applied to the
    /// vectors that `vector_of(p, to)` gives, and then the rows. [points][max_components]
    template <class VectorOf>
    std::vector<float> gradient(VectorOf&& vector_of) const;
    std::vector<float> inverse_diagonal() const;
    double dot(std::span<const float> a, std::span<const float> b) const;
    /// The code nearest to `target` in cluster k; returns its error vector.
    Vector code_in(std::uint32_t k, const Vector& target, std::span<float> code) const;

    const PointBlocks& points_;
    std::span<const float> weights_;
    const QuantisedModels& models_;
    const SeamOptions& options_;
    Codes& codes_;
    Neighbours neighbours_;
    Eigen::Index dimension_;
    double mean_error_;
};

template <class VectorOf>
std::vector<float> SeamSmoother::gradient(VectorOf&& vector_of) const {
    std::vector<float> result(points_.count * models_.max_components, 0.0f);
    parallel_for(points_.count, 1024, options_.threads, [&](std::size_t begin, std::size_t end) {
        Vector g(dimension_), own(dimension_), other(dimension_);
        for (std::size_t p = begin; p < end; ++p) {
            vector_of(p, own);
            g.setZero();
            g += weights_[p] * own;
            for (const Neighbours::Link& link : neighbours_.of(p)) {
                vector_of(link.other, other);
                g += static_cast<float>(options_.seam_weight * link.weight) * (own - other);
            }
            for (std::size_t j = 0; j < components(p); ++j)
                result[p * models_.max_components + j] = g.dot(row(codes_.clusters[p], j));
        }
    });
    return result;
}

std::vector<float> SeamSmoother::inverse_diagonal() const {
    std::vector<float> result(points_.count * models_.max_components, 1.0f);
    for (std::size_t p = 0; p < points_.count; ++p) {
        auto weight = static_cast<double>(weights_[p]);
        for (const Neighbours::Link& link : neighbours_.of(p))
            weight += options_.seam_weight * link.weight;
        for (std::size_t j = 0; j < components(p); ++j) {
            const double d = weight * static_cast<double>(row(codes_.clusters[p], j).squaredNorm());
            result[p * models_.max_components + j] = d > 1e-30 ? static_cast<float>(1 / d) : 1.0f;
        }
    }
    return result;
}

double SeamSmoother::dot(std::span<const float> a, std::span<const float> b) const {
    double sum = 0;
    for (std::size_t i = 0; i < a.size(); ++i)
        sum += static_cast<double>(a[i]) * static_cast<double>(b[i]);
    return sum;
}

/// Conjugate gradients, preconditioned by the diagonal, on the change of all weights. The matrix is never
/// formed: with 1.5 million receivers and 8 components it would have 10^9 entries.
void SeamSmoother::solve_weights() {
    const std::size_t most = models_.max_components;
    const std::vector<float> inverse = inverse_diagonal();
    std::vector<float> residual = gradient([&](std::size_t p, Vector& to) { error_of(p, to); });
    std::vector<float> change(residual.size(), 0.0f), direction(residual.size(), 0.0f);
    for (float& r : residual)
        r = -r;
    double before = 0, start = 0;
    constexpr int kMostSteps = 30;
    for (int step = 0; step < kMostSteps; ++step) {
        double norm = 0;
        for (std::size_t i = 0; i < residual.size(); ++i)
            norm += static_cast<double>(residual[i]) * static_cast<double>(residual[i]) *
                    static_cast<double>(inverse[i]);
        if (step == 0)
            start = norm;
        if (!(norm > 1e-6 * start)) // weights are rounded afterwards, to steps far larger
            break;
        const auto beta = static_cast<float>(step == 0 ? 0 : norm / before);
        before = norm;
        for (std::size_t i = 0; i < residual.size(); ++i)
            direction[i] = residual[i] * inverse[i] + beta * direction[i];
        const std::vector<float> product = gradient([&](std::size_t p, Vector& to) {
            to.setZero();
            add_combination(p, std::span<const float>(direction).subspan(p * most, most), to);
        });
        const auto alpha = static_cast<float>(norm / dot(direction, product));
        for (std::size_t i = 0; i < residual.size(); ++i) {
            change[i] += alpha * direction[i];
            residual[i] -= alpha * product[i];
        }
    }
    for (std::size_t p = 0; p < points_.count; ++p)
        for (std::size_t j = 0; j < components(p); ++j) {
            float& w = codes_.weights[p * most + j];
            w = round_weight(w + change[p * most + j], models_.halves[codes_.clusters[p] * most + j]);
        }
}

Vector SeamSmoother::code_in(std::uint32_t k, const Vector& target, std::span<float> code) const {
    Vector left = target - Eigen::Map<const Vector>(models_.mean(k), dimension_);
    for (std::size_t j = 0; j < static_cast<std::size_t>(models_.components[k]); ++j) {
        const auto direction = row(k, j);
        const float norm = direction.squaredNorm();
        code[j] = round_weight(norm > 1e-30f ? left.dot(direction) / norm : 0.0f,
                               models_.halves[k * models_.max_components + j]);
        left -= code[j] * direction;
    }
    return -left;
}

std::ptrdiff_t SeamSmoother::spare_components() const {
    if (!(options_.mean_components > 0))
        return std::numeric_limits<std::ptrdiff_t>::max() / 2; // more than can be used up
    auto spare = static_cast<std::ptrdiff_t>(options_.mean_components * static_cast<double>(points_.count));
    for (std::size_t p = 0; p < points_.count; ++p)
        spare -= static_cast<std::ptrdiff_t>(components(p));
    return spare;
}

void SeamSmoother::reassign() {
    std::vector<float> code(models_.max_components), best_code(models_.max_components);
    std::vector<std::uint32_t> candidates;
    Vector point(dimension_), pull(dimension_), error(dimension_);
    constexpr int kMostSweeps = 10;
    std::ptrdiff_t spare = spare_components();
    for (int sweep = 0; sweep < kMostSweeps; ++sweep) {
        std::size_t changed = 0;
        // One after the other, so that each sees what its neighbours have become.
        for (std::size_t p = 0; p < points_.count; ++p) {
            const auto links = neighbours_.of(p);
            double total = static_cast<double>(weights_[p]);
            pull.setZero();
            candidates.assign(1, codes_.clusters[p]);
            for (const Neighbours::Link& link : links) {
                total += options_.seam_weight * link.weight;
                error_of(link.other, error);
                pull += static_cast<float>(options_.seam_weight * link.weight) * error;
                if (std::find(candidates.begin(), candidates.end(), codes_.clusters[link.other]) ==
                    candidates.end())
                    candidates.push_back(codes_.clusters[link.other]);
            }
            if (links.empty() || !(total > 0))
                continue;
            // The sum over the edges is total |e - pull|² and what does not depend on e.
            pull /= static_cast<float>(total);
            const auto price = [&](std::uint32_t k, const Vector& e) {
                double cost = total * static_cast<double>((e - pull).squaredNorm());
                for (const Neighbours::Link& link : links)
                    if (codes_.clusters[link.other] != k)
                        cost += options_.potts_weight * mean_error_ * link.weight;
                return cost;
            };
            points_.copy_point(p, point.data());
            error_of(p, error);
            double least = price(codes_.clusters[p], error);
            std::uint32_t best = ~0u;
            const int own = models_.components[codes_.clusters[p]];
            for (const std::uint32_t k : candidates) {
                if (models_.components[k] - own > spare)
                    continue;
                const Vector e = code_in(k, point + pull, code) + pull;
                const double cost = price(k, e);
                if (cost < least * (1 - 1e-6)) {
                    least = cost;
                    best = k;
                    best_code = code;
                }
            }
            if (best == ~0u)
                continue;
            spare -= models_.components[best] - own;
            codes_.clusters[p] = best;
            std::fill_n(codes_.weights.data() + p * models_.max_components, models_.max_components, 0.0f);
            std::copy_n(best_code.begin(), models_.components[best],
                        codes_.weights.data() + p * models_.max_components);
            ++changed;
        }
        if (changed * 200 < points_.count)
            break;
    }
    for (std::size_t p = 0; p < points_.count; ++p) {
        error_of(p, error);
        codes_.errors[p] = error.squaredNorm();
    }
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
