// Projects angular maps (docs/math.md, section 3).

#include "prt/core/sh.h"
#include "runtime/core/light/square_sums.h"
#include "runtime/core/sh/gauss_legendre.h"

#include <cmath>
#include <numbers>

namespace prt {
namespace {

using std::numbers::pi;

/// Evaluates sin(pi r) / r and cos(pi r) as power series in r² < 2. At (s, t) of an angular map the direction
/// is (s sin(pi r) / r, t sin(pi r) / r, cos(pi r)), and the solid angle is sin(pi r) pi dr dalpha per r dr
/// dalpha of the image.
[[gnu::always_inline]] inline void disc_factors(const Lanes& r2, Lanes& sine, Lanes& cosine) {
    constexpr int kTerms = 13;
    constexpr auto kSeries = [] {
        std::array<std::array<double, kTerms>, 2> series{};
        double term = 1; // pi^n / n!
        for (int n = 0; n < 2 * kTerms; ++n) {
            series[static_cast<std::size_t>(n % 2)][static_cast<std::size_t>(n / 2)] =
                n / 2 % 2 == 0 ? term : -term;
            term *= pi / (n + 1);
        }
        return series;
    }();
    sine = cosine = Lanes{};
    for (std::size_t k = kTerms; k-- > 0;) {
        cosine = cosine * r2 + static_cast<float>(kSeries[0][k]);
        sine = sine * r2 + static_cast<float>(kSeries[1][k]);
    }
}

/// Computes directions of the points (s, t) of an angular map, and their solid angle per image area.
PRT_TWO_CLONES
void put_disc_nodes(const float* s, const float* t, std::size_t stride, glm::vec3* directions,
                    float* weights) {
    for (std::size_t x = 0; x < stride; x += kLaneCount) {
        Lanes sine, cosine;
        disc_factors(lanes_at(s + x) * lanes_at(s + x) + lanes_at(t + x) * lanes_at(t + x), sine, cosine);
        const Lanes away = sine * lanes_at(s + x), down = sine * lanes_at(t + x);
        *reinterpret_cast<LanesInMemory*>(weights + x) = sine * static_cast<float>(pi);
        for (int lane = 0; lane < kLaneCount; ++lane)
            directions[x + static_cast<std::size_t>(lane)] = {away[lane], down[lane], cosine[lane]};
    }
}

/// Computes the mean of a function over a cell of width 1 from its values at the centers of the surrounding
/// cells: 1 + d²/24 of central differences, and - 17 d⁴/5760 to order 6. The operator is applied to the
/// pixels instead of the functions, which is equivalent because only their products are summed. The functions
/// are then needed at the centers only.
struct MeanOfCell {
    int reach;
    double factor[3]; ///< for cells at distance 0, 1, 2
};
constexpr MeanOfCell kMeansOfCell[] = {
    {0, {1}},
    {1, {1 - 2.0 / 24, 1.0 / 24}},
    {2, {1 - 2.0 / 24 - 6 * 17.0 / 5760, 1.0 / 24 + 4 * 17.0 / 5760, -17.0 / 5760}}};
constexpr int kLongestReach = 2;

/// Returns the operator for texels that span at most `angle` radians. The error is of order angle^4 or
/// angle^6.
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

/// Applies the operator to `count` floats of adjacent pixels.
PRT_TWO_CLONES
void mean_along(const float* from, const MeanOfCell& mean, std::size_t count, float* to) {
    const auto center = static_cast<float>(mean.factor[0]), near = static_cast<float>(mean.factor[1]),
               far = static_cast<float>(mean.factor[2]);
    const auto at = [&](std::size_t i) __attribute__((always_inline)) {
        return lanes_at(from + i);
    };
    const auto before = [&](std::size_t i, std::size_t pixels) __attribute__((always_inline)) {
        return lanes_at(from + i - 3 * pixels);
    };
    std::size_t i = 0;
    for (; i + kLaneCount <= count; i += kLaneCount)
        *reinterpret_cast<LanesInMemory*>(to + i) =
            center * at(i) + near * (before(i, 1) + at(i + 3)) + far * (before(i, 2) + at(i + 6));
    for (; i < count; ++i)
        to[i] =
            center * from[i] + near * (*(from + i - 3) + from[i + 3]) + far * (*(from + i - 6) + from[i + 6]);
}

class AngularMap {
public:
    explicit AngularMap(const Image& image) : image_(image), size_(image.width) {}

    int size() const { return size_; }
    const glm::vec3* row(int y) const { return &image_.at(0, y); }
    Cell cell(int i) const { return even_cell(size_, i); }

    /// Returns the first texel of row `y` that is entirely inside the circle; the last one mirrors it. If no
    /// texel is inside, returns the center of the row or more.
    int first_inside(int y) const {
        const Cell v = cell(y);
        return std::min((size_ + 1) / 2, static_cast<int>(std::ceil(edge(std::max(-v.begin, v.end)))));
    }

    /// Returns the first texel of row `y` that is partly inside the circle.
    int first_touched(int y) const {
        const Cell v = cell(y);
        return static_cast<int>(edge(std::max({0.0, v.begin, -v.end})));
    }

    /// Computes the pixels of row `y` with `mean` applied; pixels on the rim count as black. [size], with
    /// kLongestReach extra entries on each side.
    void pixels(int y, const MeanOfCell& mean, std::vector<glm::vec3>& result) const {
        std::vector<glm::vec3> column(result.size(), glm::vec3(0));
        for (int step = -mean.reach; step <= mean.reach; ++step)
            if (y + step >= 0 && y + step < size_)
                add_row(y + step, mean.factor[std::abs(step)], column);
        if (mean.reach == 0)
            return column.swap(result);
        mean_along(&column[kLongestReach].x, mean, 3 * static_cast<std::size_t>(size_),
                   &result[kLongestReach].x);
    }

private:
    /// Returns the x coordinate of the circle at height `t`, in texels.
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

/// Quadrature nodes in the texels of one row that intersect the rim, restricted to the inside of the circle.
struct RimNodes {
    std::vector<float> s, t;
    std::vector<glm::vec3> colors; ///< times the area

    void add(const Cell& u, const Cell& v, const GaussLegendre& rim, const glm::vec3& color) {
        for (std::size_t j = 0; j < rim.nodes.size(); ++j) {
            const double y = v.at(rim.nodes[j]), reach = std::sqrt(std::max(0.0, 1 - y * y));
            const Cell chord{std::max(u.begin, -reach), std::min(u.end, reach)};
            if (!(chord.begin < chord.end))
                continue;
            for (std::size_t i = 0; i < rim.nodes.size(); ++i) {
                s.push_back(static_cast<float>(chord.at(rim.nodes[i])));
                t.push_back(static_cast<float>(y));
                colors.push_back(
                    static_cast<float>(chord.half() * v.half() * rim.weights[i] * rim.weights[j]) * color);
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

/// Adds the texels of row `y` that intersect the rim.
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
            parts[c * row.stride + i] = row.weights[i] * nodes.colors[i][static_cast<int>(c)];
    evaluate_sh(order, row.directions, row.basis);
    multiply_all(functions, row.stride, row.basis.data(), parts.data(), sums);
}

/// Writes directions and weights of the nodes `inner` of every texel of row `y` to `row`.
void put_nodes(const AngularMap& map, int y, const GaussLegendre& inner, RowOfTexels& row) {
    const std::size_t n = inner.nodes.size();
    const int size = map.size();
    std::vector<float> s(row.stride), t(row.stride);
    for (std::size_t j = 0; j < n; ++j)
        for (std::size_t i = 0; i < n; ++i) {
            const std::size_t first = (j * n + i) * row.stride;
            const double left = map.cell(0).at(inner.nodes[i]), step = 2.0 / size;
            for (std::size_t x = 0; x < row.stride; ++x) // clamp to 1 outside the image, where the series
                                                         // diverge
                s[x] = static_cast<float>(std::min(1.0, left + step * static_cast<double>(x)));
            std::ranges::fill(t, static_cast<float>(map.cell(y).at(inner.nodes[j])));
            put_disc_nodes(s.data(), t.data(), row.stride, &row.directions[first], &row.weights[first]);
            const auto area = static_cast<float>(inner.weights[i] * inner.weights[j] / size / size);
            for (std::size_t x = 0; x < row.stride; ++x)
                row.weights[first + x] *= area;
        }
}

} // namespace

ProjectedColors project_angular(const Image& image, int order, int threads) {
    const AngularMap map(image);
    const int size = map.size();
    const double texel = 2 * pi / size;
    const MeanOfCell& mean = mean_of_cell(texel);
    const GaussLegendre inner(mean.reach > 0 ? 1 : points_for(texel)), rim(size < 64    ? 24
                                                                           : size < 256 ? 6
                                                                                        : 2);
    const std::size_t n = inner.nodes.size();
    const auto put_row = [&](int y, RowOfTexels& row) { put_nodes(map, y, inner, row); };
    const auto fold_row = [&](int, int y, std::size_t stride, float* parts) {
        std::vector<glm::vec3> above(static_cast<std::size_t>(size + 2 * kLongestReach)), below = above;
        map.pixels(y, mean, above);
        map.pixels(size - 1 - y, mean, below);
        fold(&above[kLongestReach], &below[kLongestReach], size, y, stride, parts);
    };
    auto whole = project_squares(size, 1, n * n, order, threads, put_row, fold_row);
    const BySigns functions(order);
    std::vector<ProjectedColors> rims((static_cast<std::size_t>(size) + kRowsOfBlock - 1) / kRowsOfBlock);
    parallel_for(
        static_cast<std::size_t>(size), kRowsOfBlock, threads, [&](std::size_t begin, std::size_t end) {
            LaneSums sums;
            for (std::size_t y = begin; y < end; ++y)
                add_rim(map, static_cast<int>(y), rim, order, functions, sums);
            add_lanes(static_cast<std::size_t>(coefficient_count(order)), sums, rims[begin / kRowsOfBlock]);
        });
    for (const ProjectedColors& row : rims)
        for (std::size_t i = 0; i < row.size(); ++i)
            whole[0][i] += row[i];
    ProjectedColors result{};
    add_square(whole[0], {1, 0, 0}, {0, -1, 0}, {0, 0, -1}, order, result);
    return result;
}

} // namespace prt
