// Fits probes to measured points by preconditioned conjugate gradients, with many columns in parallel.

#include "bake/products/volumes/probe_fit.h"

#include "bake/trace/sparse_rows.h"
#include "runtime/core/support/parallel.h"
#include "runtime/core/support/vector_lanes.h"
#include "runtime/domains/volume_weights.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

namespace prt {
namespace {

using Shares = ProbeFit::Shares;

/// Weight of a probe's own measurement relative to points: a point at the position of a probe has weight 1.
constexpr float kOwnWeight = 1;
constexpr int kMaxGradientSteps = 40;
/// Residual at which a column counts as solved, relative to its right-hand side.
constexpr double kSolved = 1e-3;
/// Columns that the product of sparse rows processes at once.
constexpr int kProductOrder = 4, kProductChannels = 3;
constexpr std::size_t kColumns = kProductChannels * coefficient_count(kProductOrder);

/// Shares of probes: for a hanging probe the probes that it is interpolated from; for other probes
/// themselves.
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

/// The symmetric matrix of a fit, rows one after another.
struct FitMatrix {
    std::vector<SparseRow> rows;
    std::vector<std::uint32_t> sources;
    std::vector<float> weights;
    std::vector<float> inverse_diagonal;

    /// `upper` [rows]: the columns of each row from the diagonal on. `own` is added to the diagonal.
    FitMatrix(std::span<const Shares> upper, float own) : inverse_diagonal(upper.size()) {
        std::vector<std::uint32_t> counts(upper.size(), 0);
        for (std::uint32_t p = 0; p < upper.size(); ++p)
            for (const auto& [q, weight] : upper[p]) {
                ++counts[p];
                counts[q] += q != p ? 1 : 0;
            }
        std::vector<std::size_t> at(upper.size() + 1, 0);
        for (std::size_t p = 0; p < upper.size(); ++p)
            at[p + 1] = at[p] + counts[p];
        sources.resize(at.back());
        weights.resize(at.back());
        for (std::size_t p = 0; p < upper.size(); ++p)
            rows.push_back({counts[p], &sources[at[p]], &weights[at[p]]});
        const auto put = [&](std::uint32_t p, std::uint32_t q, float weight) {
            sources[at[p]] = q;
            weights[at[p]++] = weight;
        };
        for (std::uint32_t p = 0; p < upper.size(); ++p)
            for (const auto& [q, weight] : upper[p]) {
                put(p, q, q == p ? weight + own : weight);
                if (q != p)
                    put(q, p, weight);
                else
                    inverse_diagonal[p] = 1 / (weight + own);
            }
    }

    void multiply(const std::vector<float>& x, std::vector<float>& to) const {
        apply_rows(kProductOrder, kProductChannels, true, rows, x.data(), to.data());
    }
};

using ColumnSums = std::array<double, kColumns>;

/// Computes sums[c] = sum over rows of a[row][c] b[row][c], with float sums over short blocks of rows.
PRT_TARGET_CLONES
void dot_columns(const float* a, const float* b, std::size_t rows, ColumnSums& sums) {
    sums.fill(0);
    for (std::size_t begin = 0; begin < rows; begin += 64) {
        std::array<float, kColumns> some{};
        for (std::size_t r = begin; r < std::min(rows, begin + 64); ++r)
            for (std::size_t c = 0; c < kColumns; ++c)
                some[c] += a[r * kColumns + c] * b[r * kColumns + c];
        for (std::size_t c = 0; c < kColumns; ++c)
            sums[c] += static_cast<double>(some[c]);
    }
}

/// Computes x += alpha d and r -= alpha ad, column by column.
PRT_TARGET_CLONES
void step_columns(const std::array<float, kColumns>& alpha, const float* d, const float* ad, std::size_t rows,
                  float* x, float* r) {
    for (std::size_t i = 0; i < rows; ++i)
        for (std::size_t c = 0; c < kColumns; ++c) {
            x[i * kColumns + c] += alpha[c] * d[i * kColumns + c];
            r[i * kColumns + c] -= alpha[c] * ad[i * kColumns + c];
        }
}

/// Computes z = scale[row] r.
PRT_TARGET_CLONES
void scale_rows(const float* scale, const float* r, std::size_t rows, float* z) {
    for (std::size_t i = 0; i < rows; ++i)
        for (std::size_t c = 0; c < kColumns; ++c)
            z[i * kColumns + c] = scale[i] * r[i * kColumns + c];
}

/// Computes d = z + beta d, column by column.
PRT_TARGET_CLONES
void rotate_columns(const std::array<float, kColumns>& beta, const float* z, std::size_t rows, float* d) {
    for (std::size_t i = 0; i < rows; ++i)
        for (std::size_t c = 0; c < kColumns; ++c)
            d[i * kColumns + c] = z[i * kColumns + c] + beta[c] * d[i * kColumns + c];
}

std::array<float, kColumns> ratios(const ColumnSums& over, const ColumnSums& under) {
    std::array<float, kColumns> ratio;
    for (std::size_t c = 0; c < kColumns; ++c)
        ratio[c] = under[c] > 0 ? static_cast<float>(over[c] / under[c]) : 0.0f;
    return ratio;
}

/// A group of columns, [probes][kColumns].
struct FitColumns {
    std::vector<float> start, b, x, r, d, z, ad;

    explicit FitColumns(std::size_t probes)
        : start(probes * kColumns), b(start), x(start), r(start), d(start), z(start), ad(start) {}

    /// Loads `width` columns from `first` on, from the values of probes and from the sums of points.
    void load(const ProbeVectors& vectors, std::span<const float> sums, std::size_t first,
              std::size_t width) {
        for (std::size_t p = 0; p * kColumns < b.size(); ++p) {
            std::fill_n(&start[p * kColumns], kColumns, 0.0f);
            std::fill_n(&b[p * kColumns], kColumns, 0.0f);
            std::copy_n(&vectors.of(p)[first], width, &start[p * kColumns]);
            std::copy_n(&sums[p * vectors.stride + first], width, &b[p * kColumns]);
        }
    }

    /// Computes the residual of the initial values.
    void begin(const FitMatrix& a) {
        x = start;
        a.multiply(x, r);
        for (std::size_t i = 0; i < r.size(); ++i)
            r[i] = b[i] + kOwnWeight * start[i] - r[i];
    }

    /// Returns sum |e|² minus the squared error at points: with g = b - (sum w wᵀ) x it is x·b + x·g.
    double explained() const {
        double sum = 0;
        for (std::size_t i = 0; i < x.size(); ++i)
            sum += static_cast<double>(x[i] * (b[i] + r[i] - kOwnWeight * (start[i] - x[i])));
        return sum;
    }

    /// Continues from x with residual r by conjugate gradients, with the diagonal as preconditioner.
    void solve(const FitMatrix& a) {
        const std::size_t rows = a.rows.size();
        ColumnSums rz, next, dad, rest, solved;
        dot_columns(b.data(), b.data(), rows, solved);
        for (double& square : solved)
            square *= kSolved * kSolved;
        scale_rows(a.inverse_diagonal.data(), r.data(), rows, d.data());
        dot_columns(r.data(), d.data(), rows, rz);
        for (int step = 0; step < kMaxGradientSteps; ++step) {
            dot_columns(r.data(), r.data(), rows, rest);
            if (std::ranges::equal(rest, solved, std::ranges::less_equal()))
                return;
            a.multiply(d, ad);
            dot_columns(d.data(), ad.data(), rows, dad);
            step_columns(ratios(rz, dad), d.data(), ad.data(), rows, x.data(), r.data());
            scale_rows(a.inverse_diagonal.data(), r.data(), rows, z.data());
            dot_columns(r.data(), z.data(), rows, next);
            rotate_columns(ratios(next, rz), z.data(), rows, d.data());
            rz = next;
        }
    }
};

} // namespace

void fill_invalid(const VolumeProbes& probes, const std::vector<bool>& invalid, const ProbeVectors& vectors) {
    std::vector<std::vector<std::uint32_t>> optional_work(probes.size());
    for (const auto& brick : probes.of_brick)
        for (std::size_t i = 0; i < kBrickProbes; ++i)
            for (const std::size_t step :
                 {std::size_t{1}, std::size_t{kBrickSide}, std::size_t{kBrickSide} * kBrickSide})
                if (i / step % kBrickSide + 1 < kBrickSide) {
                    optional_work[brick[i]].push_back(brick[i + step]);
                    optional_work[brick[i + step]].push_back(brick[i]);
                }
    std::vector<bool> dark = invalid;
    for (;;) {
        std::vector<std::uint32_t> filled;
        for (std::uint32_t p = 0; p < probes.size(); ++p) {
            if (!dark[p])
                continue;
            float count = 0;
            for (const std::uint32_t q : optional_work[p])
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

ProbeFit::ProbeFit(const VolumeGrid& grid, const VolumeProbes& probes, std::size_t stride)
    : shares_(shares_of(grid, probes)), stride_(stride), rows_(probes.size()),
      sums_(probes.size() * stride, 0.0f) {
    for (std::uint32_t p = 0; p < rows_.size(); ++p)
        rows_[p] = {{p, 0.0f}};
}

ProbeFit::Shares ProbeFit::shares_at(const VolumeCorners& point) const {
    Shares mixed;
    for (std::size_t i = 0; i < 8; ++i)
        for (const auto& [probe, share] : shares_[point.probes[i]])
            mixed.emplace_back(probe, point.weights[i] * share);
    std::ranges::sort(mixed);
    Shares shares;
    for (const auto& [probe, share] : mixed)
        if (!shares.empty() && shares.back().first == probe)
            shares.back().second += share;
        else if (share > 0)
            shares.emplace_back(probe, share);
    return shares;
}

void ProbeFit::add(std::span<const VolumeCorners> points, std::span<const float> vectors, int threads) {
    std::vector<Shares> shares;
    for (const VolumeCorners& point : points)
        shares.push_back(shares_at(point));
    for (const Shares& s : shares)
        for (auto p = s.begin(); p != s.end(); ++p)
            for (auto q = p; q != s.end(); ++q) {
                Shares& row = rows_[p->first];
                const auto at = std::ranges::lower_bound(row, q->first, {}, &Shares::value_type::first);
                if (at != row.end() && at->first == q->first)
                    at->second += p->second * q->second;
                else
                    row.insert(at, {q->first, p->second * q->second});
            }
    // In parallel by columns, so that sums do not depend on the number of threads.
    parallel_for(stride_, kColumns, threads, [&](std::size_t begin, std::size_t end) {
        for (std::size_t r = 0; r < shares.size(); ++r)
            for (const auto& [probe, share] : shares[r])
                for (std::size_t i = begin; i < end; ++i)
                    sums_[probe * stride_ + i] += share * vectors[r * stride_ + i];
    });
    for (const float v : vectors)
        norm_ += static_cast<double>(v) * static_cast<double>(v);
    points_ += points.size();
}

ProbeFit::Errors ProbeFit::solve(const ProbeVectors& vectors, int threads, const Progress& progress) const {
    if (!(norm_ > 0))
        return {};
    const FitMatrix a(rows_, kOwnWeight);
    const std::size_t probes = rows_.size(), blocks = (stride_ + kColumns - 1) / kColumns;
    std::vector<double> before(blocks), after(blocks);
    progress.check();
    parallel_for(blocks, 1, threads, [&](std::size_t first, std::size_t last) {
        FitColumns columns(probes);
        for (std::size_t block = first; block < last; ++block) {
            const std::size_t begin = block * kColumns, width = std::min(kColumns, stride_ - begin);
            columns.load(vectors, sums_, begin, width);
            columns.begin(a);
            before[block] = columns.explained();
            columns.solve(a);
            after[block] = columns.explained();
            for (std::size_t p = 0; p < probes; ++p)
                std::copy_n(&columns.x[p * kColumns], width, &vectors.of(p)[begin]);
        }
    });
    progress.update(1);
    const auto relative = [&](const std::vector<double>& explained) {
        return std::sqrt(std::max(0.0, 1 - std::accumulate(explained.begin(), explained.end(), 0.0) / norm_));
    };
    return {relative(before), relative(after)};
}

} // namespace prt
