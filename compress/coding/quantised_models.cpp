#include "coding/quantised_models.h"

#include "clusters/cluster_neighbours.h"
#include "prt/support/parallel.h"
#include "prt/support/vector_lanes.h"

#include <Eigen/Dense>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace prt {
namespace {

/// A cluster as the kernel reads it.
struct ClusterRows {
    const float* mean;
    const float* rows;
    const float* halves;
    const float* inverse_norms;
    std::size_t components;
};

/// Adding and taking away 1.5 · 2^23 rounds to the nearest integer what is far smaller.
[[gnu::always_inline]] inline Lanes rounded(const Lanes& v) {
    constexpr float kMagic = 12582912.0f;
    return (v + kMagic) - kMagic;
}

/// Squared distance of a block's points to what their codes in this cluster stand for; the weights go to
/// `weights` [components][kLanes] unless it is null.
[[gnu::always_inline]] inline Lanes code_block(const float* block, std::size_t dimension,
                                               const ClusterRows& k, float* weights) {
    Lanes d[kMostDimensions];
    for (std::size_t i = 0; i < dimension; ++i)
        d[i] = lanes_at(block + i * kLanes) - k.mean[i];
    for (std::size_t j = 0; j < k.components; ++j) {
        const float* row = k.rows + j * dimension;
        Lanes dot = {};
        for (std::size_t i = 0; i < dimension; ++i)
            dot += row[i] * d[i];
        Lanes w = dot * k.inverse_norms[j];
        if (const float half = k.halves[j]; half > 0) {
            w = w < -1.0f ? Lanes{} - 1.0f : w;
            w = w > 1.0f ? Lanes{} + 1.0f : w;
            w = rounded((w + 1.0f) * half) / half - 1.0f;
        }
        for (std::size_t i = 0; i < dimension; ++i)
            d[i] -= w * row[i];
        if (weights)
            for (std::size_t lane = 0; lane < kLanes; ++lane)
                weights[j * kLanes + lane] = w[lane];
    }
    Lanes total = {};
    for (std::size_t i = 0; i < dimension; ++i)
        total += d[i] * d[i];
    return total;
}

PRT_TARGET_CLONES
void best_of_block(const float* block, std::size_t dimension, std::span<const ClusterRows> clusters,
                   std::span<const std::uint32_t> candidates, std::uint32_t* best, float* errors) {
    for (std::size_t lane = 0; lane < kLanes; ++lane)
        errors[lane] = std::numeric_limits<float>::infinity();
    for (const std::uint32_t k : candidates) {
        const Lanes distance = code_block(block, dimension, clusters[k], nullptr);
        for (std::size_t lane = 0; lane < kLanes; ++lane) {
            const bool nearer = distance[lane] < errors[lane];
            errors[lane] = nearer ? distance[lane] : errors[lane];
            best[lane] = nearer ? k : best[lane];
        }
    }
}

PRT_TARGET_CLONES
void weights_of_block(const float* block, std::size_t dimension, const ClusterRows& cluster, float* weights,
                      float* errors) {
    const Lanes distance = code_block(block, dimension, cluster, weights);
    for (std::size_t lane = 0; lane < kLanes; ++lane)
        errors[lane] = distance[lane];
}

std::vector<float> inverse_norms(const QuantisedModels& models) {
    std::vector<float> result(models.clusters() * models.max_components, 0.0f);
    for (std::size_t k = 0; k < models.clusters(); ++k)
        for (std::size_t j = 0; j < static_cast<std::size_t>(models.components[k]); ++j) {
            double squared = 0;
            for (std::size_t i = 0; i < models.dimension; ++i)
                squared +=
                    static_cast<double>(models.row(k, j)[i]) * static_cast<double>(models.row(k, j)[i]);
            // A row that rounding has emptied codes nothing.
            result[k * models.max_components + j] = squared > 1e-30 ? static_cast<float>(1 / squared) : 0.0f;
        }
    return result;
}

std::vector<ClusterRows> cluster_rows(const QuantisedModels& models, std::span<const float> norms) {
    std::vector<ClusterRows> result;
    for (std::size_t k = 0; k < models.clusters(); ++k) {
        const std::size_t first = k * models.max_components;
        result.push_back({models.means.data() + k * models.dimension,
                          models.rows.data() + first * models.dimension, models.halves.data() + first,
                          norms.data() + first, static_cast<std::size_t>(models.components[k])});
    }
    return result;
}

/// The length of a row along a principal axis at which rounding the weights `along` loses least.
double best_length(std::span<const double> along, std::span<const double> weights, float half) {
    double largest = 0;
    for (const double a : along)
        largest = std::max(largest, std::abs(a));
    double best = largest, least = std::numeric_limits<double>::infinity();
    for (const double share : {1.0, 0.9, 0.8, 0.7, 0.6, 0.5, 0.4, 0.3}) {
        const double length = share * largest, h = static_cast<double>(half);
        double error = 0;
        for (std::size_t p = 0; p < along.size(); ++p) {
            const double w = std::clamp(length > 0 ? along[p] / length : 0.0, -1.0, 1.0);
            const double lost = along[p] - length * (std::round((w + 1) * h) / h - 1);
            error += weights[p] * lost * lost;
        }
        if (error < least) {
            least = error;
            best = length;
        }
    }
    return best;
}

std::vector<std::vector<std::uint32_t>> members_of(std::span<const std::uint32_t> clusters,
                                                   std::size_t count) {
    std::vector<std::vector<std::uint32_t>> members(count);
    for (std::uint32_t p = 0; p < clusters.size(); ++p)
        members[clusters[p]].push_back(p);
    return members;
}

} // namespace

float round_weight(float weight, float half) {
    return half > 0 ? std::round((std::clamp(weight, -1.0f, 1.0f) + 1) * half) / half - 1 : weight;
}

QuantisedModels quantised_models(const PointBlocks& points, std::span<const float> weights,
                                 const Clustering& clustering, bool free_weights, float half, int threads) {
    const std::vector<ClusterFit>& fits = clustering.fits;
    QuantisedModels models;
    models.dimension = points.dimension;
    for (const ClusterFit& fit : fits)
        models.max_components = std::max(models.max_components, fit.plan.bits.size());
    models.means.resize(fits.size() * models.dimension);
    models.rows.resize(fits.size() * models.max_components * models.dimension);
    models.halves.resize(fits.size() * models.max_components);
    models.components.resize(fits.size());
    const auto members = members_of(clustering.clusters, fits.size());
    parallel_for(fits.size(), 1, threads, [&](std::size_t begin, std::size_t end) {
        std::vector<float> point(models.dimension);
        for (std::size_t k = begin; k < end; ++k) {
            const ClusterFit& fit = fits[k];
            std::copy(fit.mean.begin(), fit.mean.end(), models.mean(k));
            models.components[k] = static_cast<int>(fit.plan.bits.size());
            const std::size_t count = fit.plan.bits.size(), n = members[k].size();
            std::vector<double> along(count * n, 0), member_weights;
            for (std::size_t r = 0; r < n; ++r) {
                points.copy_point(members[k][r], point.data());
                member_weights.push_back(static_cast<double>(weights[members[k][r]]));
                for (std::size_t j = 0; j < count; ++j)
                    for (std::size_t i = 0; i < models.dimension; ++i)
                        along[j * n + r] += static_cast<double>(fit.directions[j * models.dimension + i]) *
                                            static_cast<double>(point[i] - fit.mean[i]);
            }
            for (std::size_t j = 0; j < count; ++j) {
                const float h = free_weights ? 0 : half > 0 ? half : half_of_bits(fit.plan.bits[j]);
                const double length =
                    free_weights ? 1 : best_length(std::span(along).subspan(j * n, n), member_weights, h);
                models.halves[k * models.max_components + j] = h;
                for (std::size_t i = 0; i < models.dimension; ++i)
                    models.row(k, j)[i] = static_cast<float>(
                        length * static_cast<double>(fit.directions[j * models.dimension + i]));
            }
        }
    });
    return models;
}

namespace {

/// All clusters as the kernel reads them, and what they point to.
struct KernelRows {
    std::vector<float> norms;
    std::vector<ClusterRows> clusters;

    explicit KernelRows(const QuantisedModels& models)
        : norms(inverse_norms(models)), clusters(cluster_rows(models, norms)) {}
};

void make_room(const PointBlocks& points, const QuantisedModels& models, Codes& codes) {
    codes.max_components = models.max_components;
    codes.errors.resize(points.count);
    codes.weights.resize(points.count * models.max_components);
}

/// Weights and errors of the points of block `b` in the clusters that they have.
void code_in_clusters(const PointBlocks& points, std::size_t b, std::span<const ClusterRows> clusters,
                      Codes& codes, std::span<float> weights) {
    const std::size_t first = b * kLanes, n = std::min(kLanes, points.count - first);
    const std::span<const std::uint32_t> own = std::span(codes.clusters).subspan(first, n);
    alignas(64) std::array<float, kLanes> errors{};
    for (std::size_t lane = 0; lane < n; ++lane) {
        if (std::find(own.begin(), own.begin() + static_cast<std::ptrdiff_t>(lane), own[lane]) !=
            own.begin() + static_cast<std::ptrdiff_t>(lane))
            continue; // done with an earlier lane
        const ClusterRows& cluster = clusters[own[lane]];
        weights_of_block(points.block(b), points.dimension, cluster, weights.data(), errors.data());
        for (std::size_t other = lane; other < n; ++other) {
            if (own[other] != own[lane])
                continue;
            codes.errors[first + other] = errors[other];
            float* to = codes.weights.data() + (first + other) * codes.max_components;
            for (std::size_t j = 0; j < codes.max_components; ++j)
                to[j] = j < cluster.components ? weights[j * kLanes + other] : 0.0f;
        }
    }
}

} // namespace

void encode_in_place(const PointBlocks& points, const QuantisedModels& models, Codes& codes, int threads) {
    const KernelRows kernel(models);
    make_room(points, models, codes);
    parallel_for(points.blocks(), 32, threads, [&](std::size_t begin, std::size_t end) {
        std::vector<float> weights(models.max_components * kLanes);
        for (std::size_t b = begin; b < end; ++b)
            code_in_clusters(points, b, kernel.clusters, codes, weights);
    });
}

void encode_points(const PointBlocks& points, const QuantisedModels& models,
                   std::span<const std::vector<std::uint32_t>> candidates, Codes& codes, int threads) {
    const KernelRows kernel(models);
    make_room(points, models, codes);
    parallel_for(points.blocks(), 32, threads, [&](std::size_t begin, std::size_t end) {
        alignas(64) std::array<std::uint32_t, kLanes> best{};
        alignas(64) std::array<float, kLanes> errors{};
        std::vector<float> weights(models.max_components * kLanes);
        std::vector<std::uint32_t> tried;
        for (std::size_t b = begin; b < end; ++b) {
            const std::size_t first = b * kLanes, n = std::min(kLanes, points.count - first);
            candidates_of_block(candidates, codes.clusters, b, tried);
            best_of_block(points.block(b), points.dimension, kernel.clusters, tried, best.data(),
                          errors.data());
            std::copy_n(best.begin(), n, &codes.clusters[first]);
            code_in_clusters(points, b, kernel.clusters, codes, weights);
        }
    });
}

void keep_better(const PointBlocks& points, const QuantisedModels& models, const Codes& before, Codes& codes,
                 int threads) {
    parallel_for(points.count, 1024, threads, [&](std::size_t begin, std::size_t end) {
        std::vector<float> rest(models.dimension);
        for (std::size_t p = begin; p < end; ++p) {
            const std::size_t k = before.clusters[p];
            const std::span<const float> w = before.of(p);
            points.copy_point(p, rest.data());
            for (std::size_t i = 0; i < models.dimension; ++i)
                rest[i] -= models.mean(k)[i];
            for (std::size_t j = 0; j < static_cast<std::size_t>(models.components[k]); ++j)
                for (std::size_t i = 0; i < models.dimension; ++i)
                    rest[i] -= w[j] * models.row(k, j)[i];
            float error = 0;
            for (const float r : rest)
                error += r * r;
            if (!(error < codes.errors[p]))
                continue;
            codes.clusters[p] = before.clusters[p];
            codes.errors[p] = error;
            std::copy(w.begin(), w.end(), codes.weights.begin() + static_cast<std::ptrdiff_t>(p * w.size()));
        }
    });
}

std::vector<std::vector<std::uint32_t>> neighbour_clusters(const QuantisedModels& models, std::size_t most,
                                                           int threads) {
    const std::vector<float> norms = inverse_norms(models);
    const MeanDistances means(models.clusters(), models.dimension,
                              [&](std::size_t k) { return models.mean(k); });
    return nearest_clusters(means, most, threads, [&](std::size_t k, std::size_t other) {
        std::array<float, kMostDimensions> d;
        for (std::size_t i = 0; i < models.dimension; ++i)
            d[i] = models.mean(k)[i] - models.mean(other)[i];
        for (std::size_t j = 0; j < static_cast<std::size_t>(models.components[other]); ++j) {
            const float* row = models.row(other, j);
            float w = 0;
            for (std::size_t i = 0; i < models.dimension; ++i)
                w += row[i] * d[i];
            w = std::clamp(w * norms[other * models.max_components + j], -1.0f, 1.0f);
            for (std::size_t i = 0; i < models.dimension; ++i)
                d[i] -= w * row[i];
        }
        float squared = 0;
        for (std::size_t i = 0; i < models.dimension; ++i)
            squared += d[i] * d[i];
        return squared;
    });
}

void refit(const PointBlocks& points, std::span<const float> weights, const Codes& codes,
           QuantisedModels& models, int threads) {
    if (points.dimension == 0)
        return;
    const auto members = members_of(codes.clusters, models.clusters());
    const auto d = static_cast<Eigen::Index>(models.dimension);
    parallel_for(models.clusters(), 1, threads, [&](std::size_t begin, std::size_t end) {
        std::vector<float> point(models.dimension);
        for (std::size_t k = begin; k < end; ++k) {
            const auto m = static_cast<Eigen::Index>(models.components[k]);
            Eigen::MatrixXd normal = Eigen::MatrixXd::Zero(m + 1, m + 1),
                            right = Eigen::MatrixXd::Zero(m + 1, d);
            Eigen::VectorXd z(m + 1), residual(d);
            z[0] = 1;
            for (const std::uint32_t p : members[k]) {
                if (!(weights[p] > 0))
                    continue;
                points.copy_point(p, point.data());
                const std::span<const float> w = codes.of(p);
                for (Eigen::Index i = 0; i < d; ++i)
                    residual[i] = static_cast<double>(point[static_cast<std::size_t>(i)]) -
                                  static_cast<double>(models.mean(k)[i]);
                for (Eigen::Index j = 0; j < m; ++j) {
                    z[1 + j] = static_cast<double>(w[static_cast<std::size_t>(j)]);
                    residual -= z[1 + j] * Eigen::Map<const Eigen::VectorXf>(
                                               models.row(k, static_cast<std::size_t>(j)), d)
                                               .cast<double>();
                }
                normal.selfadjointView<Eigen::Lower>().rankUpdate(z, static_cast<double>(weights[p]));
                right += static_cast<double>(weights[p]) * z * residual.transpose();
            }
            if (!(normal(0, 0) > 0))
                continue;
            // What the points do not determine stays as it is.
            normal.diagonal().array() += 1e-9 * normal(0, 0);
            const Eigen::MatrixXd change = normal.selfadjointView<Eigen::Lower>().ldlt().solve(right);
            for (Eigen::Index i = 0; i < d; ++i) {
                models.mean(k)[i] += static_cast<float>(change(0, i));
                for (Eigen::Index j = 0; j < m; ++j)
                    models.row(k, static_cast<std::size_t>(j))[i] += static_cast<float>(change(1 + j, i));
            }
        }
    });
}

void round_rows(QuantisedModels& models, double step) {
    const auto to_grid = [](float v, double grid) {
        return static_cast<float>(std::round(static_cast<double>(v) / grid) * grid);
    };
    for (float& v : models.means)
        v = to_grid(v, step);
    for (float& v : models.rows)
        v = to_grid(v, 2 * step);
}

} // namespace prt
