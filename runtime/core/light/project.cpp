// Projects environment maps into SH (docs/math.md, section 3).
//
// A lat-long image is a product of rows and columns about its own poles, so that its integral separates: a
// short Fourier sum of the pixels per row, then the associated Legendre functions integrated over the row.
// This costs 2N-1 instead of N² multiply-adds per pixel and channel. The pole of the image is +Y and that of
// the basis is +Z; one exact rotation at the end converts between them.

#include "prt/core/environment.h"
#include "prt/core/sh.h"
#include "prt/core/sh_rotation.h"
#include "runtime/core/light/check_light.h"
#include "runtime/core/light/projection.h"
#include "runtime/core/sh/gauss_legendre.h"
#include "runtime/core/support/parallel.h"
#include "runtime/core/support/vector_lanes.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <span>

namespace prt {

using std::numbers::pi;

namespace {

/// Fourier sums over the pixels of a row of a lat-long image, exact for pixels of constant color: sum over
/// pixels of L(pixel) ∫ cos(m phi) dphi, and the sine counterpart.
struct RowFourier {
    std::array<glm::dvec3, kMaxOrder> cosine{}, sine{};
};

/// Tables of cos(m phi) and sin(m phi) at the column centers. The azimuth in the image's polar frame (x', y',
/// z') = (z, x, y) equals the longitude. If the width is a multiple of four, columns at phi, -phi, pi - phi
/// and phi - pi share values up to signs: a quarter of the columns suffices.
struct ColumnTables {
    bool folded;
    std::size_t columns;
    std::vector<double> cosine, sine; ///< [m][columns]

    ColumnTables(int order, int width)
        : folded(width % 4 == 0), columns(static_cast<std::size_t>(folded ? width / 4 : width)) {
        cosine.reserve(static_cast<std::size_t>(order) * columns);
        sine.reserve(cosine.capacity());
        for (int m = 0; m < order; ++m)
            for (std::size_t x = 0; x < columns; ++x) {
                const double phi = 2 * pi * (0.5 - (static_cast<double>(x) + 0.5) / width);
                cosine.push_back(std::cos(m * phi));
                sine.push_back(std::sin(m * phi));
            }
    }
};

/// Folded pixels that are multiplied with the cosines and sines of even and odd m: [part][channel][columns].
enum Part { even_cosine, odd_cosine, even_sine, odd_sine, kParts };
using Wide [[gnu::vector_size(sizeof(double) * 8)]] = double;
using WideInMemory [[gnu::vector_size(sizeof(double) * 8), gnu::aligned(8), gnu::may_alias]] = double;

/// Returns the sum of `values` times `factors` for three channels at distance `stride`.
[[gnu::always_inline]] inline glm::dvec3 weighted_sum(const double* values, std::size_t stride,
                                                      const double* factors, std::size_t count) {
    Wide wide[3] = {};
    std::size_t x = 0;
    for (; x + 8 <= count; x += 8) {
        const Wide f = *reinterpret_cast<const WideInMemory*>(factors + x);
        for (std::size_t c = 0; c < 3; ++c)
            wide[c] += f * *reinterpret_cast<const WideInMemory*>(values + c * stride + x);
    }
    glm::dvec3 sum(0);
    for (int c = 0; c < 3; ++c)
        for (int lane = 0; lane < 8; ++lane)
            sum[c] += wide[c][lane];
    for (; x < count; ++x)
        for (int c = 0; c < 3; ++c)
            sum[c] += values[static_cast<std::size_t>(c) * stride + x] * factors[x];
    return sum;
}

constexpr std::size_t kMaxColumns = 16384; ///< folded at a time

/// Computes `parts` [kParts][3][count] of columns of the tables from `first` on.
[[gnu::always_inline]] inline void fold_row(const glm::vec3* row, const ColumnTables& tables,
                                            std::size_t first, std::size_t count, double* parts) {
    const std::size_t n = tables.columns;
    for (std::size_t x = first; x < first + count; ++x)
        for (int channel = 0; channel < 3; ++channel) {
            const auto at = [&](std::size_t column) { return static_cast<double>(row[column][channel]); };
            double* to = parts + static_cast<std::size_t>(channel) * count + x - first;
            double value[kParts];
            if (tables.folded) {
                const double ahead = at(x) + at(4 * n - 1 - x), behind = at(2 * n - 1 - x) + at(2 * n + x);
                const double left = at(x) - at(4 * n - 1 - x), right = at(2 * n - 1 - x) - at(2 * n + x);
                value[even_cosine] = ahead + behind;
                value[odd_cosine] = ahead - behind;
                value[even_sine] = left - right;
                value[odd_sine] = left + right;
            } else {
                std::fill_n(value, kParts, at(x));
            }
            for (std::size_t part = 0; part < kParts; ++part)
                to[part * 3 * count] = value[part];
        }
}

/// Computes the Fourier sums of a row. `parts` is a buffer for the columns that are folded at a time.
PRT_TARGET_CLONES
void row_fourier(const glm::vec3* row, int width, int order, const ColumnTables& tables, double* parts,
                 RowFourier& result) {
    const std::size_t n = tables.columns;
    result = {};
    for (std::size_t first = 0; first < n; first += kMaxColumns) {
        const std::size_t count = std::min(kMaxColumns, n - first);
        fold_row(row, tables, first, count, parts);
        for (std::size_t m = 0; m < static_cast<std::size_t>(order); ++m) {
            const std::size_t odd = m % 2, at = m * n + first;
            result.cosine[m] +=
                weighted_sum(parts + (even_cosine + odd) * 3 * count, count, &tables.cosine[at], count);
            result.sine[m] +=
                weighted_sum(parts + (even_sine + odd) * 3 * count, count, &tables.sine[at], count);
        }
    }
    for (std::size_t m = 0; m < static_cast<std::size_t>(order); ++m) {
        // ∫ over a column of width d about phi: cos(m phi) 2 sin(m d / 2) / m.
        const double d = 2 * pi / width, md = static_cast<double>(m);
        const double extent = m == 0 ? d : 2 * std::sin(0.5 * md * d) / md;
        result.cosine[m] *= extent;
        result.sine[m] *= extent;
    }
}

/// Returns ∫ over the row of Q_l^m(cos theta) sin^m(theta) sin(theta) dtheta, at [sh_index(l, m)], m >= 0;
/// the basis at azimuth 0 contains the Legendre part.
std::array<double, kMaxOrder * kMaxOrder> row_legendre(int order, double theta0, double theta1,
                                                       const GaussLegendre& quadrature) {
    std::array<double, kMaxOrder * kMaxOrder> sum{}, basis{};
    for (std::size_t q = 0; q < quadrature.nodes.size(); ++q) {
        const double theta = 0.5 * (theta0 + theta1) + 0.5 * (theta1 - theta0) * quadrature.nodes[q];
        const double weight = 0.5 * (theta1 - theta0) * quadrature.weights[q] * std::sin(theta);
        evaluate_sh(order, glm::dvec3(std::sin(theta), 0, std::cos(theta)), std::span<double>(basis));
        for (std::size_t i = 0; i < sum.size(); ++i)
            sum[i] += weight * basis[i];
    }
    return sum;
}

/// Returns the coefficients of one row: its Legendre integrals times its Fourier sums.
ProjectedColors in_bands(int order, const std::array<double, kMaxOrder * kMaxOrder>& legendre,
                         const RowFourier& fourier) {
    ProjectedColors row{};
    for (int l = 0; l < order; ++l)
        for (int m = 0; m <= l; ++m) {
            const auto i = static_cast<std::size_t>(sh_index(l, m));
            row[i] = legendre[i] * fourier.cosine[static_cast<std::size_t>(m)];
            if (m > 0)
                row[static_cast<std::size_t>(sh_index(l, -m))] =
                    legendre[i] * fourier.sine[static_cast<std::size_t>(m)];
        }
    return row;
}

/// Rotates from the image's polar frame to the world.
ProjectedColors in_world(const ProjectedColors& polar, int order, LatLongCenter center) {
    // The columns are the images of x' (the direction of the center), y' (to its left) and z' (up).
    const glm::dmat3 frame = center == LatLongCenter::z
                                 ? glm::dmat3(glm::dvec3(0, 0, 1), glm::dvec3(1, 0, 0), glm::dvec3(0, 1, 0))
                                 : glm::dmat3(glm::dvec3(1, 0, 0), glm::dvec3(0, 0, -1), glm::dvec3(0, 1, 0));
    const ShRotation to_world(order, frame);
    ProjectedColors result{};
    for (int channel = 0; channel < 3; ++channel) {
        std::array<double, kMaxOrder * kMaxOrder> in{}, out{};
        for (std::size_t i = 0; i < in.size(); ++i)
            in[i] = polar[i][channel];
        to_world.apply(std::span<const double>(in), std::span<double>(out));
        for (std::size_t i = 0; i < in.size(); ++i)
            result[i][channel] = out[i];
    }
    return result;
}

ProjectedColors project_lat_long(const Environment& environment, int order, int threads) {
    const Image& image = environment.image;
    const ColumnTables tables(order, image.width);
    const GaussLegendre quadrature(pi / image.height > 0.2 ? 24 : 3); // same thresholds as points_for
    const auto height = static_cast<std::size_t>(image.height);
    constexpr std::size_t kMaxRows = 4096; // at a time: a row has 2.4 KB, however few its pixels
    std::vector<ProjectedColors> rows(std::min(height, kMaxRows));
    ProjectedColors polar{};
    for (std::size_t first = 0; first < height; first += kMaxRows) {
        const std::size_t count = std::min(kMaxRows, height - first);
        parallel_for(count, 8, threads, [&](std::size_t begin, std::size_t end) {
            std::vector<double> parts(kParts * 3 * std::min(kMaxColumns, tables.columns));
            for (std::size_t r = begin; r < end; ++r) {
                const std::size_t y = first + r;
                RowFourier fourier;
                row_fourier(&image.pixels[y * static_cast<std::size_t>(image.width)], image.width, order,
                            tables, parts.data(), fourier);
                const double row = static_cast<double>(y);
                const auto legendre =
                    row_legendre(order, pi * row / image.height, pi * (row + 1) / image.height, quadrature);
                rows[r] = in_bands(order, legendre, fourier);
            }
        });
        for (const ProjectedColors& row : std::span(rows).first(count))
            for (std::size_t i = 0; i < polar.size(); ++i)
                polar[i] += row[i];
    }
    return in_world(polar, order, environment.center);
}

ProjectedColors project_layout(const Environment& environment, int order, int threads) {
    switch (environment.layout) {
    case EnvironmentLayout::cube:
    case EnvironmentLayout::cube_faces:
        return project_cube(environment, order, threads);
    case EnvironmentLayout::angular:
        return project_angular(environment.image, order, threads);
    case EnvironmentLayout::lat_long:
        break;
    }
    return project_lat_long(environment, order, threads);
}

} // namespace

Light project(const Environment& environment, int order, int threads) {
    check_order(order);
    check_environment(environment);
    const ProjectedColors coefficients = project_layout(environment, order, threads);
    Light light{order, std::vector<glm::vec3>(static_cast<std::size_t>(coefficient_count(order)))};
    for (std::size_t i = 0; i < light.coefficients.size(); ++i)
        light.coefficients[i] = glm::vec3(coefficients[i]);
    check_light(light);
    return light;
}

} // namespace prt
