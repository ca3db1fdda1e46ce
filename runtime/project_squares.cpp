// Projection of square images: the faces of a cube, and angular maps (docs/math.md, section 3).
//
// In the frame of a square (x right, y down, z where its centre looks) the basis functions are even or odd in
// x and in y. So the basis is integrated over the texels of a quarter, once for all faces, and four mirrored
// pixels are added up with their signs before they are multiplied with it. A rotation per face ends it.

#include "gauss_legendre.h"
#include "projection.h"
#include "prt/parallel.h"
#include "prt/sh.h"
#include "prt/sh_rotation.h"
#include "prt/vector_lanes.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <vector>

namespace prt {
namespace {

using detail::kPi;

/// A stretch along one axis, in coordinates [-1, 1] of a square.
struct Cell {
    double begin, end;

    double at(double node) const { return 0.5 * (begin + end + (end - begin) * node); }
    double half() const { return 0.5 * (end - begin); }
};

Cell even_cell(int size, int i) {
    return {2.0 * i / size - 1, 2.0 * (i + 1) / size - 1};
}

/// The part of a texel's cell that lies on the face, where border texels are centred on the border.
Cell centred_cell(int size, int i) {
    if (size == 1)
        return {-1, 1};
    const double half = 1.0 / (size - 1), centre = 2.0 * i / (size - 1) - 1;
    return {std::max(-1.0, centre - half), std::min(1.0, centre + half)};
}

/// A direction in the frame of the square, and its share of the solid angle.
struct Node {
    glm::dvec3 direction;
    double weight;
};

/// At (s, t) of a cube's face, which is at distance sqrt(1 + s² + t²).
Node on_face(double s, double t, double area) {
    const double inverse = 1 / std::sqrt(1 + s * s + t * t);
    return {{s * inverse, t * inverse, inverse}, area * inverse * inverse * inverse};
}

/// At (s, t) of an angular map: solid angle sin(pi r) pi dr dalpha, over r dr dalpha of the image.
Node on_disc(double s, double t, double area) {
    const double r = std::sqrt(s * s + t * t), factor = r > 0 ? std::sin(kPi * r) / r : kPi;
    return {{factor * s, factor * t, std::cos(kPi * r)}, area * kPi * factor};
}

/// sin(pi r) / r and cos(pi r) as power series in r² < 2.
[[gnu::always_inline]] inline void disc_factors(const Lanes& r2, Lanes& sine, Lanes& cosine) {
    constexpr int kTerms = 13;
    constexpr auto kSeries = [] {
        std::array<std::array<double, kTerms>, 2> series{};
        double term = 1; // pi^n / n!
        for (int n = 0; n < 2 * kTerms; ++n) {
            series[static_cast<std::size_t>(n % 2)][static_cast<std::size_t>(n / 2)] =
                n / 2 % 2 == 0 ? term : -term;
            term *= kPi / (n + 1);
        }
        return series;
    }();
    sine = cosine = Lanes{};
    for (std::size_t k = kTerms; k-- > 0;) {
        cosine = cosine * r2 + static_cast<float>(kSeries[0][k]);
        sine = sine * r2 + static_cast<float>(kSeries[1][k]);
    }
}

/// The basis integrated over the texels of half a row; the stride is a multiple of the lanes.
struct RowOfTexels {
    std::size_t count, stride, points;
    std::vector<glm::vec3> directions; ///< [points][stride]
    std::vector<float> weights;        ///< [points][stride]
    std::vector<float> basis;          ///< [order²][points][stride]
    std::vector<float> texels;         ///< [order²][stride]

    RowOfTexels(int order, std::size_t texels_of_row, std::size_t points_of_texel)
        : count(texels_of_row), stride((count + kLaneCount - 1) / kLaneCount * kLaneCount),
          points(points_of_texel), directions(points * stride, glm::vec3(0, 0, 1)),
          weights(points * stride, 0.0f),
          basis(static_cast<std::size_t>(coefficient_count(order)) * points * stride),
          texels(static_cast<std::size_t>(coefficient_count(order)) * stride) {}

    void put(std::size_t texel, std::size_t point, const Node& node) {
        directions[point * stride + texel] = glm::vec3(node.direction);
        weights[point * stride + texel] = static_cast<float>(node.weight);
    }
};

/// Weighted sums over the points, of which large texels have hundreds: eight at a time in float.
PRT_TWO_CLONES
void sum_points(std::size_t functions, std::size_t points, std::size_t stride, const float* basis,
                const float* weights, float* texels) {
    using Doubles [[gnu::vector_size(sizeof(double) * kLaneCount)]] = double;
    for (std::size_t i = 0; i < functions; ++i)
        for (std::size_t x = 0; x < stride; x += kLaneCount) {
            Doubles sum{};
            for (std::size_t first = 0; first < points; first += 8) {
                Lanes some{};
                for (std::size_t p = first; p < std::min(points, first + 8); ++p)
                    some +=
                        lanes_at(weights + p * stride + x) * lanes_at(basis + (i * points + p) * stride + x);
                sum += __builtin_convertvector(some, Doubles);
            }
            *reinterpret_cast<LanesInMemory*>(texels + i * stride + x) = __builtin_convertvector(sum, Lanes);
        }
}

/// The nodes of a row of texels of an angular map that lie at height `t`: at s = first + step x, and all of
/// the area `area`.
PRT_TWO_CLONES
void put_disc_nodes(double first, double step, double t, double area, std::size_t stride,
                    glm::vec3* directions, float* weights) {
    for (std::size_t x = 0; x < stride; x += kLaneCount) {
        Lanes s;
        for (int lane = 0; lane < kLaneCount; ++lane)
            s[lane] = static_cast<float>(first + step * (static_cast<double>(x) + lane));
        Lanes sine, cosine;
        disc_factors(s * s + static_cast<float>(t * t), sine, cosine);
        const Lanes away = sine * s, down = sine * static_cast<float>(t);
        *reinterpret_cast<LanesInMemory*>(weights + x) = sine * static_cast<float>(area * kPi);
        for (int lane = 0; lane < kLaneCount; ++lane)
            directions[x + static_cast<std::size_t>(lane)] = {away[lane], down[lane], cosine[lane]};
    }
}

/// Sums of four mirrored pixels: even or odd in x, even or odd in y. [2 y + x][channel][stride]
void fold(const Image& image, int top, int size, int row, std::size_t stride, float* parts) {
    const glm::vec3 *above = &image.at(0, top + row), *below = &image.at(0, top + size - 1 - row);
    const float twice_y = 2 * row + 1 == size ? 0.5f : 1.0f; // the middle row is its own mirror
    for (int x = 0; 2 * x < size; ++x) {
        const float share = twice_y * (2 * x + 1 == size ? 0.5f : 1.0f);
        const int mirrored = size - 1 - x;
        for (int c = 0; c < 3; ++c) {
            const float a = above[x][c], b = above[mirrored][c], d = below[x][c], e = below[mirrored][c];
            float* to = parts + static_cast<std::size_t>(c) * stride + static_cast<std::size_t>(x);
            to[0] = share * ((a + b) + (d + e));
            to[3 * stride] = share * ((a - b) + (d - e));
            to[6 * stride] = share * ((a + b) - (d + e));
            to[9 * stride] = share * ((a - b) - (d - e));
        }
    }
}

/// Adds the products of every function with the part that has its signs: cos(m phi) is even in y and, where m
/// is even, in x; sin(m phi) is odd in y and, where m is odd, even in x.
PRT_TWO_CLONES
void multiply_parts(int order, std::size_t stride, const float* texels, const float* parts,
                    glm::dvec3* sums) {
    for (int l = 0; l < order; ++l)
        for (int m = -l; m <= l; ++m) {
            const auto i = static_cast<std::size_t>(sh_index(l, m));
            const bool odd_y = m < 0, odd_x = (m % 2 != 0) != odd_y;
            const float* part = parts + 3 * stride * static_cast<std::size_t>(2 * odd_y + odd_x);
            const float* texel = texels + i * stride;
            Lanes wide[3] = {};
            for (std::size_t x = 0; x < stride; x += kLaneCount)
                for (std::size_t c = 0; c < 3; ++c)
                    wide[c] += lanes_at(texel + x) * lanes_at(part + c * stride + x);
            for (int c = 0; c < 3; ++c) {
                double sum = 0;
                for (int lane = 0; lane < kLaneCount; ++lane)
                    sum += static_cast<double>(wide[c][lane]);
                sums[i][c] += sum;
            }
        }
}

/// Projects the squares of `size` pixels that lie in a column, each in its own frame. `put_row(row, texels)`
/// fills in directions and weights, `correct(row, texels)` what is not regular.
template <class PutRow, class Correct>
std::vector<ProjectedColours> project_squares(const Image& image, int squares, std::size_t points, int order,
                                              int threads, PutRow&& put_row, Correct&& correct) {
    const int size = image.width;
    const auto half = static_cast<std::size_t>((size + 1) / 2), columns = static_cast<std::size_t>(squares);
    const auto functions = static_cast<std::size_t>(coefficient_count(order));
    std::vector<ProjectedColours> rows(half * columns);
    parallel_for(half, 4, threads, [&](std::size_t begin, std::size_t end) {
        RowOfTexels row(order, half, points);
        std::vector<float> parts(12 * row.stride, 0.0f);
        for (std::size_t y = begin; y < end; ++y) {
            put_row(static_cast<int>(y), row);
            evaluate_sh(order, row.directions, row.basis);
            sum_points(functions, points, row.stride, row.basis.data(), row.weights.data(),
                       row.texels.data());
            correct(static_cast<int>(y), row);
            for (std::size_t square = 0; square < columns; ++square) {
                fold(image, static_cast<int>(square) * size, size, static_cast<int>(y), row.stride,
                     parts.data());
                multiply_parts(order, row.stride, row.texels.data(), parts.data(),
                               rows[y * columns + square].data());
            }
        }
    });
    std::vector<ProjectedColours> result(columns);
    for (std::size_t y = 0; y < half; ++y)
        for (std::size_t square = 0; square < columns; ++square)
            for (std::size_t i = 0; i < functions; ++i)
                result[square][i] += rows[y * columns + square][i];
    return result;
}

/// Adds `square`, whose axes are `right`, `down` and `outward`, to `result`.
void add_square(const ProjectedColours& square, const glm::dvec3& right, const glm::dvec3& down,
                const glm::dvec3& outward, int order, ProjectedColours& result) {
    // In a left-handed frame y changes its sign.
    const double hand = glm::dot(glm::cross(right, down), outward) < 0 ? -1 : 1;
    const ShRotation rotation(order, glm::dmat3(right, hand * down, outward));
    const auto count = static_cast<std::size_t>(coefficient_count(order));
    for (int c = 0; c < 3; ++c) {
        std::array<double, kMaxOrder * kMaxOrder> in{}, out{};
        for (int l = 0; l < order; ++l)
            for (int m = -l; m <= l; ++m) {
                const auto i = static_cast<std::size_t>(sh_index(l, m));
                in[i] = m < 0 ? hand * square[i][c] : square[i][c];
            }
        rotation.apply(std::span<const double>(in), std::span<double>(out));
        for (std::size_t i = 0; i < count; ++i)
            result[i][c] += out[i];
    }
}

} // namespace

int points_for(double angle) {
    return angle > 0.2 ? 24 : angle > 0.04 ? 3 : 2;
}

ProjectedColours project_cube(const Environment& environment, int order, int threads) {
    const int size = environment.image.width;
    const bool exr = environment.layout == EnvironmentLayout::cube;
    const GaussLegendre quadrature(points_for(2.0 / size));
    const std::size_t n = quadrature.nodes.size();
    const auto cell = [&](int i) { return exr ? centred_cell(size, i) : even_cell(size, i); };
    const auto put_row = [&](int y, RowOfTexels& row) {
        const Cell v = cell(y);
        for (std::size_t x = 0; x < row.count; ++x) {
            const Cell u = cell(static_cast<int>(x));
            for (std::size_t j = 0; j < n; ++j)
                for (std::size_t i = 0; i < n; ++i)
                    row.put(x, j * n + i,
                            on_face(u.at(quadrature.nodes[i]), v.at(quadrature.nodes[j]),
                                    u.half() * v.half() * quadrature.weights[i] * quadrature.weights[j]));
        }
    };
    const auto faces =
        project_squares(environment.image, 6, n * n, order, threads, put_row, [](int, RowOfTexels&) {});
    ProjectedColours result{};
    for (int face = 0; face < 6; ++face) {
        const auto at = [&](double u, double v) {
            return exr ? cube_direction(face, u, v) : cube_face_direction(face, u, v);
        };
        const glm::dvec3 outward = at(0, 0), right = std::sqrt(2.0) * at(1, 0) - outward,
                         down = std::sqrt(2.0) * at(0, 1) - outward;
        add_square(faces[static_cast<std::size_t>(face)], right, down, outward, order, result);
    }
    return result;
}

ProjectedColours project_angular(const Image& image, int order, int threads) {
    const int size = image.width;
    const GaussLegendre inner(points_for(2 * kPi / size)), rim(size < 64 ? 24 : 6);
    const std::size_t n = inner.nodes.size();
    const auto beyond = [&](const Cell& u, const Cell& v) {
        return u.begin * u.begin + v.begin * v.begin > 1;
    };
    const auto put_row = [&](int y, RowOfTexels& row) {
        const Cell v = even_cell(size, y), u = even_cell(size, 0);
        for (std::size_t j = 0; j < n; ++j)
            for (std::size_t i = 0; i < n; ++i)
                put_disc_nodes(u.at(inner.nodes[i]), 2.0 / size, v.at(inner.nodes[j]),
                               u.half() * v.half() * inner.weights[i] * inner.weights[j], row.stride,
                               &row.directions[(j * n + i) * row.stride],
                               &row.weights[(j * n + i) * row.stride]);
    };
    // Texels on the rim count as far as they lie inside it: of each of their rows the stretch within the
    // circle.
    const auto correct = [&](int y, RowOfTexels& row) {
        const Cell v = even_cell(size, y);
        std::array<double, kMaxOrder * kMaxOrder> basis{};
        for (std::size_t x = 0; x < row.count; ++x) {
            const Cell u = even_cell(size, static_cast<int>(x));
            if (!beyond(u, v))
                break; // those that follow are nearer to the middle
            std::array<double, kMaxOrder * kMaxOrder> sum{};
            const bool within = u.end * u.end + v.end * v.end < 1 || u.end > 0 || v.end > 0;
            for (std::size_t j = 0; within && j < rim.nodes.size(); ++j) {
                const double t = v.at(rim.nodes[j]), reach = std::sqrt(std::max(0.0, 1 - t * t));
                const Cell chord{std::max(u.begin, -reach), std::min(u.end, reach)};
                if (!(chord.begin < chord.end))
                    continue;
                for (std::size_t i = 0; i < rim.nodes.size(); ++i) {
                    const Node node = on_disc(chord.at(rim.nodes[i]), t,
                                              chord.half() * v.half() * rim.weights[i] * rim.weights[j]);
                    evaluate_sh(order, node.direction, std::span<double>(basis));
                    for (int k = 0; k < coefficient_count(order); ++k)
                        sum[static_cast<std::size_t>(k)] += node.weight * basis[static_cast<std::size_t>(k)];
                }
            }
            for (int k = 0; k < coefficient_count(order); ++k)
                row.texels[static_cast<std::size_t>(k) * row.stride + x] =
                    static_cast<float>(sum[static_cast<std::size_t>(k)]);
        }
    };
    const auto whole = project_squares(image, 1, n * n, order, threads, put_row, correct);
    ProjectedColours result{};
    add_square(whole[0], {1, 0, 0}, {0, -1, 0}, {0, 0, -1}, order, result);
    return result;
}

} // namespace prt
