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
#include <array>
#include <cmath>
#include <cstring>
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

/// sin(pi r) / r and cos(pi r) as power series in r² < 2. At (s, t) of an angular map the direction is
/// (s sin(pi r) / r, t sin(pi r) / r, cos(pi r)), and the solid angle sin(pi r) pi dr dalpha, over r dr
/// dalpha of the image.
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

/// Half of the lanes: sums of four functions in three colours fit the registers.
constexpr std::size_t kHalfLanes = 8;
using HalfLanes [[gnu::vector_size(sizeof(float) * kHalfLanes)]] = float;

[[gnu::always_inline]] inline HalfLanes half_lanes_at(const float* values) {
    HalfLanes lanes;
    std::memcpy(&lanes, values, sizeof lanes);
    return lanes;
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
    /// From directions and weights to `texels`.
    void integrate(int order);
};

/// Sums over the points of texels that have few.
PRT_TWO_CLONES
void sum_few_points(std::size_t functions, std::size_t points, std::size_t stride, const float* basis,
                    const float* weights, float* texels) {
    for (std::size_t i = 0; i < functions; ++i)
        for (std::size_t x = 0; x < stride; x += kHalfLanes) {
            HalfLanes sum{};
            for (std::size_t p = 0; p < points; ++p)
                sum += half_lanes_at(weights + p * stride + x) *
                       half_lanes_at(basis + (i * points + p) * stride + x);
            std::memcpy(texels + i * stride + x, &sum, sizeof sum);
        }
}

/// The same over the hundreds that large texels have, which takes doubles.
void sum_many_points(std::size_t functions, std::size_t points, std::size_t stride, const float* basis,
                     const float* weights, float* texels) {
    for (std::size_t i = 0; i < functions; ++i)
        for (std::size_t x = 0; x < stride; ++x) {
            double sum = 0;
            for (std::size_t p = 0; p < points; ++p)
                sum += static_cast<double>(weights[p * stride + x]) *
                       static_cast<double>(basis[(i * points + p) * stride + x]);
            texels[i * stride + x] = static_cast<float>(sum);
        }
}

void RowOfTexels::integrate(int order) {
    evaluate_sh(order, directions, basis);
    const auto sum = points <= 9 ? sum_few_points : sum_many_points;
    sum(static_cast<std::size_t>(coefficient_count(order)), points, stride, basis.data(), weights.data(),
        texels.data());
}

/// Directions of the points (s, t) of an angular map, and their solid angle per area of the image.
PRT_TWO_CLONES
void put_disc_nodes(const float* s, const float* t, std::size_t stride, glm::vec3* directions,
                    float* weights) {
    for (std::size_t x = 0; x < stride; x += kLaneCount) {
        Lanes sine, cosine;
        disc_factors(lanes_at(s + x) * lanes_at(s + x) + lanes_at(t + x) * lanes_at(t + x), sine, cosine);
        const Lanes away = sine * lanes_at(s + x), down = sine * lanes_at(t + x);
        *reinterpret_cast<LanesInMemory*>(weights + x) = sine * static_cast<float>(kPi);
        for (int lane = 0; lane < kLaneCount; ++lane)
            directions[x + static_cast<std::size_t>(lane)] = {away[lane], down[lane], cosine[lane]};
    }
}

/// Sums of four mirrored pixels of rows `row` and size - 1 - row: even or odd in x, even or odd in y.
/// [2 y + x][channel][stride]
void fold(const glm::vec3* above, const glm::vec3* below, int size, int row, std::size_t stride,
          float* parts) {
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

/// Sums of the products of functions and pixels that have not been added up yet, lane by lane.
struct LaneSums {
    float at[kMaxOrder * kMaxOrder][3][kHalfLanes] = {};
};

/// Indices of the functions, those of the same signs in x and in y next to one another. cos(m phi) is even in
/// y and, where m is even, in x; sin(m phi) is odd in y and, where m is odd, even in x.
struct BySigns {
    std::array<std::size_t, kMaxOrder * kMaxOrder> index;
    std::array<std::size_t, 5> first{}; ///< of part 2 odd_y + odd_x

    explicit BySigns(int order) {
        std::size_t count = 0;
        for (std::size_t part = 0; part < 4; ++part) {
            for (int l = 0; l < order; ++l)
                for (int m = -l; m <= l; ++m) {
                    const bool odd_y = m < 0, odd_x = (m % 2 != 0) != odd_y;
                    if (part == std::size_t{2} * odd_y + odd_x)
                        index[count++] = static_cast<std::size_t>(sh_index(l, m));
                }
            first[part + 1] = count;
        }
    }
};

/// Adds the products of `Functions` functions with a part.
template <std::size_t Functions>
[[gnu::always_inline]] inline void multiply_part(const std::size_t* index, std::size_t stride,
                                                 const float* texels, const float* part, LaneSums& sums) {
    HalfLanes sum[Functions][3];
#pragma GCC unroll 4
    for (std::size_t f = 0; f < Functions; ++f)
#pragma GCC unroll 3
        for (std::size_t c = 0; c < 3; ++c)
            sum[f][c] = half_lanes_at(sums.at[index[f]][c]);
    for (std::size_t x = 0; x < stride; x += kHalfLanes) {
        const HalfLanes red = half_lanes_at(part + x), green = half_lanes_at(part + stride + x),
                        blue = half_lanes_at(part + 2 * stride + x);
#pragma GCC unroll 4
        for (std::size_t f = 0; f < Functions; ++f) {
            const HalfLanes texel = half_lanes_at(texels + index[f] * stride + x);
            sum[f][0] += texel * red;
            sum[f][1] += texel * green;
            sum[f][2] += texel * blue;
        }
    }
#pragma GCC unroll 4
    for (std::size_t f = 0; f < Functions; ++f)
#pragma GCC unroll 3
        for (std::size_t c = 0; c < 3; ++c)
            std::memcpy(sums.at[index[f]][c], &sum[f][c], sizeof sum[f][c]);
}

/// Adds the products of every function with the part that has its signs.
PRT_TWO_CLONES
void multiply_parts(const BySigns& functions, std::size_t stride, const float* texels, const float* parts,
                    LaneSums& sums) {
    for (std::size_t p = 0; p < 4; ++p) {
        const float* part = parts + 3 * stride * p;
        std::size_t f = functions.first[p];
        for (; f + 4 <= functions.first[p + 1]; f += 4)
            multiply_part<4>(&functions.index[f], stride, texels, part, sums);
        for (; f < functions.first[p + 1]; ++f)
            multiply_part<1>(&functions.index[f], stride, texels, part, sums);
    }
}

/// Adds the products of all functions with one part.
PRT_TWO_CLONES
void multiply_all(const BySigns& functions, std::size_t stride, const float* texels, const float* part,
                  LaneSums& sums) {
    for (std::size_t f = 0; f < functions.first[4]; ++f)
        multiply_part<1>(&functions.index[f], stride, texels, part, sums);
}

void add_lanes(std::size_t functions, const LaneSums& sums, ProjectedColours& result) {
    for (std::size_t i = 0; i < functions; ++i)
        for (std::size_t c = 0; c < 3; ++c)
            for (std::size_t lane = 0; lane < kHalfLanes; ++lane)
                result[i][static_cast<int>(c)] += static_cast<double>(sums.at[i][c][lane]);
}

/// Rows whose sums are added up in float, and blocks of them that share their memory.
constexpr std::size_t kRowsOfBlock = 8, kBlocksOfTask = 2;

/// Projects the squares of `size` pixels that lie in a column, each in its own frame. `put_row(row, texels)`
/// fills in directions and weights; `fold_row(square, row, stride, parts)` folds pixels.
template <class PutRow, class FoldRow>
std::vector<ProjectedColours> project_squares(int size, int squares, std::size_t points, int order,
                                              int threads, PutRow&& put_row, FoldRow&& fold_row) {
    const auto half = static_cast<std::size_t>((size + 1) / 2), columns = static_cast<std::size_t>(squares);
    const auto functions = static_cast<std::size_t>(coefficient_count(order));
    const std::size_t blocks = (half + kRowsOfBlock - 1) / kRowsOfBlock;
    const BySigns by_signs(order);
    std::vector<ProjectedColours> sums(blocks * columns);
    parallel_for(blocks, kBlocksOfTask, threads, [&](std::size_t begin, std::size_t end) {
        RowOfTexels row(order, half, points);
        std::vector<float> parts(12 * row.stride, 0.0f);
        for (std::size_t block = begin; block < end; ++block) {
            std::vector<LaneSums> lanes(columns);
            for (std::size_t y = block * kRowsOfBlock; y < std::min(half, (block + 1) * kRowsOfBlock); ++y) {
                put_row(static_cast<int>(y), row);
                row.integrate(order);
                for (std::size_t square = 0; square < columns; ++square) {
                    fold_row(static_cast<int>(square), static_cast<int>(y), row.stride, parts.data());
                    multiply_parts(by_signs, row.stride, row.texels.data(), parts.data(), lanes[square]);
                }
            }
            for (std::size_t square = 0; square < columns; ++square)
                add_lanes(functions, lanes[square], sums[block * columns + square]);
        }
    });
    std::vector<ProjectedColours> result(columns);
    for (std::size_t block = 0; block < blocks; ++block)
        for (std::size_t square = 0; square < columns; ++square)
            for (std::size_t i = 0; i < functions; ++i)
                result[square][i] += sums[block * columns + square][i];
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
    const auto fold_row = [&](int face, int y, std::size_t stride, float* parts) {
        const Image& image = environment.image;
        fold(&image.at(0, face * size + y), &image.at(0, face * size + size - 1 - y), size, y, stride, parts);
    };
    const auto faces = project_squares(size, 6, n * n, order, threads, put_row, fold_row);
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

namespace {

/// The mean of a function over a cell of width 1, from its values at the middles of the cells around: 1 +
/// d²/24 of central differences, and - 17 d⁴/5760 to order 6. What holds for the functions may as well be
/// done to the pixels, since only their products are summed; the functions are then wanted at the middles
/// alone.
struct MeanOfCell {
    int reach;
    double factor[3]; ///< of cells that far away
};
constexpr MeanOfCell kMeansOfCell[] = {
    {0, {1}},
    {1, {1 - 2.0 / 24, 1.0 / 24}},
    {2, {1 - 2.0 / 24 - 6 * 17.0 / 5760, 1.0 / 24 + 4 * 17.0 / 5760, -17.0 / 5760}}};
constexpr int kLongestReach = 2;

/// For texels that span `angle` radians at most: what is left is of order angle^4 or angle^6.
const MeanOfCell& mean_of_cell(double angle) {
    return kMeansOfCell[points_for(angle) > 2 ? 0 : angle < 0.015 ? 1 : 2];
}

PRT_TWO_CLONES
void add_scaled(const float* from, float factor, std::size_t count, float* to) {
    std::size_t i = 0;
    for (; i + kLaneCount <= count; i += kLaneCount)
        *reinterpret_cast<LanesInMemory*>(to + i) = lanes_at(to + i) + factor * lanes_at(from + i);
    for (; i < count; ++i)
        to[i] += factor * from[i];
}

class AngularMap {
public:
    explicit AngularMap(const Image& image) : image_(image), size_(image.width) {}

    int size() const { return size_; }
    const glm::vec3* row(int y) const { return &image_.at(0, y); }
    Cell cell(int i) const { return even_cell(size_, i); }

    /// The first texel of row `y` that lies within the circle; the last mirrors it. The middle of the row and
    /// more if there is none.
    int first_inside(int y) const {
        const Cell v = cell(y);
        return std::min((size_ + 1) / 2, static_cast<int>(std::ceil(edge(std::max(-v.begin, v.end)))));
    }

    /// The first texel of row `y` of which a part lies within the circle.
    int first_touched(int y) const {
        const Cell v = cell(y);
        return static_cast<int>(edge(std::max({0.0, v.begin, -v.end})));
    }

    /// Pixels of row `y`, those that the rim cuts taken for black, with `mean` done to them. [size] between
    /// kLongestReach on each side.
    void pixels(int y, const MeanOfCell& mean, std::vector<glm::vec3>& result) const {
        std::vector<glm::vec3> column(result.size(), glm::vec3(0));
        for (int step = -mean.reach; step <= mean.reach; ++step)
            if (y + step >= 0 && y + step < size_)
                add_row(y + step, mean.factor[std::abs(step)], column);
        if (mean.reach == 0)
            return column.swap(result);
        std::ranges::fill(result, glm::vec3(0));
        for (int step = -mean.reach; step <= mean.reach; ++step)
            add_scaled(&column[static_cast<std::size_t>(kLongestReach + step)].x,
                       static_cast<float>(mean.factor[std::abs(step)]), 3 * static_cast<std::size_t>(size_),
                       &result[kLongestReach].x);
    }

private:
    /// Where the circle is at height `t`, in texels.
    double edge(double t) const { return 0.5 * (1 - (t < 1 ? std::sqrt(1 - t * t) : 0)) * size_; }

    void add_row(int y, double factor, std::vector<glm::vec3>& to) const {
        const int begin = first_inside(y), end = size_ - begin;
        if (begin < end)
            add_scaled(&row(y)[begin].x, static_cast<float>(factor),
                       static_cast<std::size_t>(3 * (end - begin)),
                       &to[static_cast<std::size_t>(kLongestReach + begin)].x);
    }

    const Image& image_;
    int size_;
};

/// Nodes in the texels of one row that the rim cuts, of each of their rows the stretch within the circle.
struct RimNodes {
    std::vector<float> s, t;
    std::vector<glm::vec3> colours; ///< times the area

    void add(const Cell& u, const Cell& v, const GaussLegendre& rim, const glm::vec3& colour) {
        for (std::size_t j = 0; j < rim.nodes.size(); ++j) {
            const double y = v.at(rim.nodes[j]), reach = std::sqrt(std::max(0.0, 1 - y * y));
            const Cell chord{std::max(u.begin, -reach), std::min(u.end, reach)};
            if (!(chord.begin < chord.end))
                continue;
            for (std::size_t i = 0; i < rim.nodes.size(); ++i) {
                s.push_back(static_cast<float>(chord.at(rim.nodes[i])));
                t.push_back(static_cast<float>(y));
                colours.push_back(
                    static_cast<float>(chord.half() * v.half() * rim.weights[i] * rim.weights[j]) * colour);
            }
        }
    }
};

RimNodes rim_nodes(const AngularMap& map, int y, const GaussLegendre& rim) {
    RimNodes nodes;
    const int begin = map.first_touched(y), inside = map.first_inside(y), end = map.size() - inside;
    for (int x = begin; x < std::min(inside, map.size()); ++x)
        nodes.add(map.cell(x), map.cell(y), rim, map.row(y)[x]);
    for (int x = std::max(inside, end); x < map.size() - begin; ++x)
        nodes.add(map.cell(x), map.cell(y), rim, map.row(y)[x]);
    return nodes;
}

/// Adds the texels of row `y` that the rim cuts.
void add_rim(const AngularMap& map, int y, const GaussLegendre& rim, int order, const BySigns& functions,
             LaneSums& sums) {
    RimNodes nodes = rim_nodes(map, y, rim);
    RowOfTexels row(order, nodes.s.size(), 1);
    std::vector<float> parts(3 * row.stride, 0.0f);
    nodes.s.resize(row.stride, 0.0f);
    nodes.t.resize(row.stride, 0.0f);
    put_disc_nodes(nodes.s.data(), nodes.t.data(), row.stride, row.directions.data(), row.weights.data());
    for (std::size_t i = 0; i < row.count; ++i)
        for (std::size_t c = 0; c < 3; ++c)
            parts[c * row.stride + i] = row.weights[i] * nodes.colours[i][static_cast<int>(c)];
    evaluate_sh(order, row.directions, row.basis);
    multiply_all(functions, row.stride, row.basis.data(), parts.data(), sums);
}

} // namespace

ProjectedColours project_angular(const Image& image, int order, int threads) {
    const AngularMap map(image);
    const int size = map.size();
    const double texel = 2 * kPi / size;
    const MeanOfCell& mean = mean_of_cell(texel);
    const GaussLegendre inner(mean.reach > 0 ? 1 : points_for(texel)), rim(size < 64    ? 24
                                                                           : size < 256 ? 6
                                                                                        : 2);
    const std::size_t n = inner.nodes.size();
    const auto put_row = [&](int y, RowOfTexels& row) {
        std::vector<float> s(row.stride), t(row.stride);
        for (std::size_t j = 0; j < n; ++j)
            for (std::size_t i = 0; i < n; ++i) {
                const std::size_t first = (j * n + i) * row.stride;
                for (std::size_t x = 0; x < row.stride; ++x)
                    s[x] = static_cast<float>(map.cell(static_cast<int>(x)).at(inner.nodes[i]));
                std::ranges::fill(t, static_cast<float>(map.cell(y).at(inner.nodes[j])));
                put_disc_nodes(s.data(), t.data(), row.stride, &row.directions[first], &row.weights[first]);
                const auto area = static_cast<float>(inner.weights[i] * inner.weights[j] / size / size);
                for (std::size_t x = 0; x < row.stride; ++x)
                    row.weights[first + x] *= area;
            }
    };
    const auto fold_row = [&](int, int y, std::size_t stride, float* parts) {
        std::vector<glm::vec3> above(static_cast<std::size_t>(size + 2 * kLongestReach)), below = above;
        map.pixels(y, mean, above);
        map.pixels(size - 1 - y, mean, below);
        fold(&above[kLongestReach], &below[kLongestReach], size, y, stride, parts);
    };
    auto whole = project_squares(size, 1, n * n, order, threads, put_row, fold_row);
    const BySigns functions(order);
    std::vector<ProjectedColours> rims((static_cast<std::size_t>(size) + kRowsOfBlock - 1) / kRowsOfBlock);
    parallel_for(
        static_cast<std::size_t>(size), kRowsOfBlock, threads, [&](std::size_t begin, std::size_t end) {
            LaneSums sums;
            for (std::size_t y = begin; y < end; ++y)
                add_rim(map, static_cast<int>(y), rim, order, functions, sums);
            add_lanes(static_cast<std::size_t>(coefficient_count(order)), sums, rims[begin / kRowsOfBlock]);
        });
    for (const ProjectedColours& row : rims)
        for (std::size_t i = 0; i < row.size(); ++i)
            whole[0][i] += row[i];
    ProjectedColours result{};
    add_square(whole[0], {1, 0, 0}, {0, -1, 0}, {0, 0, -1}, order, result);
    return result;
}

} // namespace prt
