#include "volume/probe_fit.h"

#include "prt/support/parallel.h"
#include "prt/volume_weights.h"

#include <Eigen/SparseCore>

#include <algorithm>
#include <array>
#include <cmath>

namespace prt {
namespace {

using Sparse = Eigen::SparseMatrix<float, Eigen::RowMajor>;
using Columns = Eigen::Matrix<float, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

/// What a probe's own measurement counts beside points: one point that stands where it is has 1.
constexpr float kOwnWeight = 0.3f;
constexpr int kMostGradientSteps = 40;
/// Residual at which a column is solved, over what it began with.
constexpr float kSolved = 1e-3f;
constexpr std::size_t kColumnsAtOnce = 32;

using Shares = std::vector<std::pair<std::uint32_t, float>>;

/// Of each hanging probe those that it is interpolated from, with their shares; of others themselves.
std::vector<Shares> shares_of(const VolumeGrid& grid, const VolumeProbes& probes) {
    std::vector<Shares> shares(probes.size());
    for (std::uint32_t p = 0; p < probes.size(); ++p)
        shares[p] = {{p, 1.0f}};
    for (const VolumeProbes::Hanging& h : probes.hanging) {
        const VolumeCorners corners =
            corners_in(grid, probes, h.brick, position_of(grid, probes.corners[h.probe]));
        Shares mixed;
        for (std::size_t i = 0; i < 8; ++i)
            if (corners.weights[i] > 0)
                for (const auto& [probe, share] : shares[corners.probes[i]])
                    mixed.emplace_back(probe, share * corners.weights[i]);
        shares[h.probe] = std::move(mixed);
    }
    return shares;
}

/// Weights of probes that are no others' mixture, [points][probes].
Sparse weights_of(const FitPoints& points, const std::vector<Shares>& shares) {
    std::vector<Eigen::Triplet<float>> triplets;
    for (std::size_t r = 0; r < points.corners.size(); ++r)
        for (std::size_t i = 0; i < 8; ++i)
            for (const auto& [probe, share] : shares[points.corners[r].probes[i]])
                triplets.emplace_back(static_cast<int>(r), static_cast<int>(probe),
                                      points.corners[r].weights[i] * share);
    Sparse weights(static_cast<Eigen::Index>(points.corners.size()),
                   static_cast<Eigen::Index>(shares.size()));
    weights.setFromTriplets(triplets.begin(), triplets.end());
    return weights;
}

/// Solves A x = b for some columns side by side by conjugate gradients with the diagonal as preconditioner.
void solve(const Sparse& a, const Eigen::ArrayXf& inverse_diagonal, const Columns& b, Columns& x) {
    Columns r = b - a * x;
    Columns z = inverse_diagonal.matrix().asDiagonal() * r;
    Columns d = z;
    const Eigen::ArrayXf start = b.colwise().squaredNorm().array().max(1e-30f);
    Eigen::ArrayXf rz = (r.array() * z.array()).colwise().sum();
    for (int step = 0; step < kMostGradientSteps; ++step) {
        if ((r.colwise().squaredNorm().transpose().array() <= kSolved * kSolved * start).all())
            return;
        const Columns ad = a * d;
        const Eigen::ArrayXf dad = (d.array() * ad.array()).colwise().sum();
        const Eigen::ArrayXf alpha = (dad > 0).select(rz / dad.max(1e-30f), 0);
        x += d * alpha.matrix().asDiagonal();
        r -= ad * alpha.matrix().asDiagonal();
        z = inverse_diagonal.matrix().asDiagonal() * r;
        const Eigen::ArrayXf next = (r.array() * z.array()).colwise().sum();
        const Eigen::ArrayXf beta = (rz > 0).select(next / rz.max(1e-30f), 0);
        d = z + d * beta.matrix().asDiagonal();
        rz = next;
    }
}

} // namespace

void fill_blind(const VolumeProbes& probes, const std::vector<bool>& blind, const ProbeVectors& vectors) {
    std::vector<std::vector<std::uint32_t>> beside(probes.size());
    for (const auto& brick : probes.of_brick)
        for (std::size_t i = 0; i < kBrickProbes; ++i)
            for (const std::size_t step :
                 {std::size_t{1}, std::size_t{kBrickSide}, std::size_t{kBrickSide} * kBrickSide})
                if (i / step % kBrickSide + 1 < kBrickSide) {
                    beside[brick[i]].push_back(brick[i + step]);
                    beside[brick[i + step]].push_back(brick[i]);
                }
    std::vector<bool> dark = blind;
    for (;;) {
        std::vector<std::uint32_t> filled;
        for (std::uint32_t p = 0; p < probes.size(); ++p) {
            if (!dark[p])
                continue;
            float count = 0;
            for (const std::uint32_t q : beside[p])
                if (!dark[q]) {
                    if (count++ == 0)
                        std::ranges::fill(vectors.of(p), 0.0f);
                    for (std::size_t i = 0; i < vectors.stride; ++i)
                        vectors.of(p)[i] += vectors.of(q)[i];
                }
            if (count == 0)
                continue;
            for (float& v : vectors.of(p))
                v /= count;
            filled.push_back(p);
        }
        if (filled.empty())
            return;
        for (const std::uint32_t p : filled)
            dark[p] = false;
    }
}

void settle_hanging(const VolumeGrid& grid, const VolumeProbes& probes, const ProbeVectors& vectors) {
    for (const VolumeProbes::Hanging& h : probes.hanging) {
        const VolumeCorners corners =
            corners_in(grid, probes, h.brick, position_of(grid, probes.corners[h.probe]));
        std::vector<float> mixed(vectors.stride, 0.0f);
        for (std::size_t c = 0; c < 8; ++c)
            if (corners.weights[c] > 0)
                for (std::size_t i = 0; i < vectors.stride; ++i)
                    mixed[i] += corners.weights[c] * vectors.of(corners.probes[c])[i];
        std::ranges::copy(mixed, vectors.of(h.probe).begin());
    }
}

double error_at(const FitPoints& points, const ProbeVectors& vectors) {
    double error = 0, norm = 0;
    for (std::size_t r = 0; r < points.corners.size(); ++r) {
        const VolumeCorners& corners = points.corners[r];
        for (std::size_t i = 0; i < vectors.stride; ++i) {
            float sum = 0;
            for (std::size_t c = 0; c < 8; ++c)
                sum += corners.weights[c] * vectors.values[corners.probes[c] * vectors.stride + i];
            const float truth = points.vectors[r * vectors.stride + i];
            error += static_cast<double>((sum - truth) * (sum - truth));
            norm += static_cast<double>(truth * truth);
        }
    }
    return norm > 0 ? std::sqrt(error / norm) : 0;
}

void fit_probes(const VolumeGrid& grid, const VolumeProbes& probes, const FitPoints& points,
                const ProbeVectors& vectors, int threads, const Progress& progress) {
    const Sparse weights = weights_of(points, shares_of(grid, probes));
    Sparse a = Sparse(weights.transpose()) * weights;
    Sparse own(a.rows(), a.cols());
    own.setIdentity();
    a += kOwnWeight * own;
    const Eigen::ArrayXf inverse_diagonal = a.diagonal().array().inverse();
    const Sparse back = weights.transpose();
    const auto count = static_cast<Eigen::Index>(probes.size()),
               of_points = static_cast<Eigen::Index>(points.corners.size());
    progress.check();
    parallel_for(vectors.stride, kColumnsAtOnce, threads, [&](std::size_t begin, std::size_t end) {
        const auto width = static_cast<Eigen::Index>(end - begin);
        Columns e(of_points, width), x(count, width);
        for (Eigen::Index r = 0; r < of_points; ++r)
            for (Eigen::Index c = 0; c < width; ++c)
                e(r, c) = points.vectors[static_cast<std::size_t>(r) * vectors.stride + begin +
                                         static_cast<std::size_t>(c)];
        for (Eigen::Index p = 0; p < count; ++p)
            for (Eigen::Index c = 0; c < width; ++c)
                x(p, c) = vectors.values[static_cast<std::size_t>(p) * vectors.stride + begin +
                                         static_cast<std::size_t>(c)];
        const Columns b = back * e + kOwnWeight * x;
        solve(a, inverse_diagonal, b, x);
        for (Eigen::Index p = 0; p < count; ++p)
            for (Eigen::Index c = 0; c < width; ++c)
                vectors.values[static_cast<std::size_t>(p) * vectors.stride + begin +
                               static_cast<std::size_t>(c)] = x(p, c);
    });
    progress.update(1);
}

} // namespace prt
