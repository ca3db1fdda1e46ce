// Projection of environment maps into SH (docs/math.md, section 3).
//
// A lat-long image is a product of rows and columns about its own poles, so its integral separates: per row a
// short Fourier sum of the pixels, then the associated Legendre functions integrated over the row. That costs
// 2N-1 instead of N² multiply-adds per pixel and channel. The image's pole is +Y and the basis's is +Z, hence
// one exact rotation at the end.

#include "prt/environment.h"
#include "prt/error.h"
#include "prt/parallel.h"
#include "prt/sh.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <array>
#include <cmath>

namespace prt {

using detail::kPi;

namespace {

using Coefficients = std::array<glm::dvec3, kMaxOrder * kMaxOrder>;

/// Nodes and weights of Gauss-Legendre quadrature on [-1, 1], by Newton's method on P_n.
struct Quadrature {
    std::vector<double> nodes, weights;

    explicit Quadrature(int n) {
        for (int i = 0; i < n; ++i) {
            double t = std::cos(kPi * (i + 0.75) / (n + 0.5));
            double derivative = 0;
            for (int iteration = 0; iteration < 100; ++iteration) {
                double previous = 1, current = t;
                for (int l = 2; l <= n; ++l) {
                    const double next = ((2 * l - 1) * t * current - (l - 1) * previous) / l;
                    previous = current;
                    current = next;
                }
                derivative = n * (t * current - previous) / (t * t - 1);
                const double step = current / derivative;
                t -= step;
                if (std::abs(step) < 1e-16)
                    break;
            }
            nodes.push_back(t);
            weights.push_back(2 / ((1 - t * t) * derivative * derivative));
        }
    }
};

/// How many quadrature points a texel that spans `angle` radians needs: over half a sphere 24 points
/// integrate order 10 to rounding, over small texels 3 leave an error of order angle^7.
int points_for(double angle) {
    return angle > 0.2 ? 24 : 3;
}

/// Per row of a lat-long image, Fourier sums over its pixels, exact for pixels of constant colour:
/// sum over pixels of L(pixel) ∫ cos(m phi) dphi, and the same with sin.
struct RowFourier {
    std::array<glm::dvec3, kMaxOrder> cosine{}, sine{};
};

/// The azimuth in the image's polar frame (x', y', z') = (z, x, y) equals the longitude. `tables` holds for
/// each m and column cos(m phi) and sin(m phi) at the column's centre.
struct ColumnTables {
    std::vector<double> cosine, sine; // [m][column]

    ColumnTables(int order, int width) {
        for (int m = 0; m < order; ++m) {
            for (int x = 0; x < width; ++x) {
                const double phi = 2 * kPi * (0.5 - (x + 0.5) / width);
                cosine.push_back(std::cos(m * phi));
                sine.push_back(std::sin(m * phi));
            }
        }
    }
};

RowFourier row_fourier(const Image& image, int y, int order, const ColumnTables& tables) {
    RowFourier result;
    const auto width = static_cast<std::size_t>(image.width);
    const glm::vec3* row = &image.pixels[static_cast<std::size_t>(y) * width];
    for (int m = 0; m < order; ++m) {
        const auto mi = static_cast<std::size_t>(m);
        const double* cosine = &tables.cosine[mi * width];
        const double* sine = &tables.sine[mi * width];
        glm::dvec3 cosine_sum(0), sine_sum(0);
        for (std::size_t x = 0; x < width; ++x) {
            const glm::dvec3 pixel(row[x]);
            cosine_sum += pixel * cosine[x];
            sine_sum += pixel * sine[x];
        }
        // ∫ over a column of width d about phi: cos(m phi) 2 sin(m d / 2) / m.
        const double d = 2 * kPi / image.width;
        const double extent = m == 0 ? d : 2 * std::sin(0.5 * m * d) / m;
        result.cosine[mi] = cosine_sum * extent;
        result.sine[mi] = sine_sum * extent;
    }
    return result;
}

/// ∫ over the row of Q_l^m(cos theta) sin^m(theta) sin(theta) dtheta, at [sh_index(l, m)], m >= 0: the basis
/// at azimuth 0 holds the Legendre part.
std::array<double, kMaxOrder * kMaxOrder> row_legendre(int order, double theta0, double theta1,
                                                       const Quadrature& quadrature) {
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

Coefficients project_lat_long(const Image& image, int order, int threads) {
    const ColumnTables tables(order, image.width);
    const Quadrature quadrature(points_for(kPi / image.height));
    const auto height = static_cast<std::size_t>(image.height);
    std::vector<Coefficients> rows(height);
    parallel_for(height, 8, threads, [&](std::size_t begin, std::size_t end) {
        for (std::size_t y = begin; y < end; ++y) {
            const RowFourier fourier = row_fourier(image, static_cast<int>(y), order, tables);
            const double row = static_cast<double>(y);
            const auto legendre =
                row_legendre(order, kPi * row / image.height, kPi * (row + 1) / image.height, quadrature);
            for (int l = 0; l < order; ++l) {
                for (int m = 0; m <= l; ++m) {
                    const auto i = static_cast<std::size_t>(sh_index(l, m));
                    rows[y][i] = legendre[i] * fourier.cosine[static_cast<std::size_t>(m)];
                    if (m > 0)
                        rows[y][static_cast<std::size_t>(sh_index(l, -m))] =
                            legendre[i] * fourier.sine[static_cast<std::size_t>(m)];
                }
            }
        }
    });
    Coefficients polar{};
    for (const Coefficients& row : rows)
        for (std::size_t i = 0; i < polar.size(); ++i)
            polar[i] += row[i];

    // From the image's polar frame (z, x, y) to ours: columns are the images of x', y', z'.
    const ShRotation to_world(order,
                              glm::dmat3(glm::dvec3(0, 0, 1), glm::dvec3(1, 0, 0), glm::dvec3(0, 1, 0)));
    Coefficients result{};
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

/// The part of a cube texel's cell that lies on the face, along one axis, in face coordinates [-1, 1].
struct Cell {
    double begin, end;
};

Cell cube_cell(int size, int i) {
    if (size == 1)
        return {-1, 1};
    const double half = 1.0 / (size - 1), centre = 2.0 * i / (size - 1) - 1;
    return {std::max(-1.0, centre - half), std::min(1.0, centre + half)};
}

Coefficients project_cube(const Image& image, int order, int threads) {
    const int size = image.width;
    const Quadrature quadrature(points_for(2.0 / size));
    const auto height = static_cast<std::size_t>(image.height);
    const auto count = static_cast<std::size_t>(coefficient_count(order));
    std::vector<Coefficients> rows(height);
    parallel_for(height, 4, threads, [&](std::size_t begin, std::size_t end) {
        std::array<double, kMaxOrder * kMaxOrder> basis{}, texel{};
        for (std::size_t row = begin; row < end; ++row) {
            const int face = static_cast<int>(row) / size;
            const Cell v = cube_cell(size, static_cast<int>(row) % size);
            for (int x = 0; x < size; ++x) {
                const Cell u = cube_cell(size, x);
                texel.fill(0);
                for (std::size_t i = 0; i < quadrature.nodes.size(); ++i) {
                    for (std::size_t j = 0; j < quadrature.nodes.size(); ++j) {
                        const double s = 0.5 * (u.begin + u.end + (u.end - u.begin) * quadrature.nodes[i]);
                        const double t = 0.5 * (v.begin + v.end + (v.end - v.begin) * quadrature.nodes[j]);
                        const double area = 0.25 * (u.end - u.begin) * (v.end - v.begin) *
                                            quadrature.weights[i] * quadrature.weights[j];
                        // Solid angle of a patch of the face at distance sqrt(1 + s² + t²).
                        const double weight = area / std::pow(1 + s * s + t * t, 1.5);
                        evaluate_sh(order, cube_direction(face, s, t), std::span<double>(basis));
                        for (std::size_t k = 0; k < count; ++k)
                            texel[k] += weight * basis[k];
                    }
                }
                const glm::dvec3 pixel(image.at(x, static_cast<int>(row)));
                for (std::size_t k = 0; k < count; ++k)
                    rows[row][k] += pixel * texel[k];
            }
        }
    });
    Coefficients result{};
    for (const Coefficients& row : rows)
        for (std::size_t i = 0; i < result.size(); ++i)
            result[i] += row[i];
    return result;
}

} // namespace

Light project(const Environment& environment, int order, int threads) {
    check_order(order);
    const Image& image = environment.image;
    if (image.width < 1 || image.height < 1)
        throw Error("the environment has no pixels");
    const Coefficients coefficients = environment.layout == EnvironmentLayout::cube
                                          ? project_cube(image, order, threads)
                                          : project_lat_long(image, order, threads);
    Light light{order, std::vector<glm::vec3>(static_cast<std::size_t>(coefficient_count(order)))};
    for (std::size_t i = 0; i < light.coefficients.size(); ++i)
        light.coefficients[i] = glm::vec3(coefficients[i]);
    return light;
}

} // namespace prt
