// Finds seams by the places and normals of edges, and closes them by a sparse least-squares problem.

#include "texels/seams.h"

#include "texels/charts.h"

#include <Eigen/SparseCholesky>
#include <Eigen/SparseCore>
#include <glm/geometric.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <map>
#include <tuple>

namespace prt {
namespace {

/// What a squared jump costs at most and at least, against squared changes of texels that were measured, and
/// of others.
constexpr double kJump = 1e4, kLeastJump = 0.1, kFree = 0.01;
/// How much of the jumps texels may change by, root mean squares: each side of a seam goes half of the way.
/// Where charts have hardly a texel, seams that close would flatten them.
constexpr double kMostChange = 0.75;

using SeamCorner = std::array<float, 6>; ///< position and normal

struct SeamSide {
    glm::dvec2 first, second; ///< of the edge, in texels
};

/// Edges by their corners, the lesser first, with every side that they have in the atlas.
std::map<std::pair<SeamCorner, SeamCorner>, std::vector<SeamSide>> sides_of_edges(const Scene& scene,
                                                                                  const Atlas& atlas) {
    std::map<std::pair<SeamCorner, SeamCorner>, std::vector<SeamSide>> edges;
    const std::vector<ChartTriangle> charts = chart_triangles(scene, atlas);
    auto chart = charts.begin();
    for (const std::size_t p : atlas.primitives) {
        const VertexArray& vertices = scene.vertex_arrays[scene.primitives[p].vertices];
        const auto corner_of = [&](std::uint32_t v) {
            const glm::vec3 &at = vertices.positions[v], &n = vertices.normals[v];
            return SeamCorner{at.x, at.y, at.z, n.x, n.y, n.z};
        };
        for (const glm::uvec3& t : scene.primitives[p].triangles) {
            const bool flat = in_triangle(*chart, chart->corners[0]).depth < 0; // without an area
            for (int i = 0; i < 3 && !flat; ++i) {
                const int j = (i + 1) % 3;
                const SeamCorner a = corner_of(t[i]), b = corner_of(t[j]);
                const SeamSide side{chart->corners[static_cast<std::size_t>(i)],
                                    chart->corners[static_cast<std::size_t>(j)]};
                if (a == b)
                    continue;
                if (a < b)
                    edges[{a, b}].push_back(side);
                else
                    edges[{b, a}].push_back({side.second, side.first});
            }
            ++chart;
        }
    }
    return edges;
}

/// The unknowns of a least-squares problem: texels that filters read at seams.
class SeamProblem {
public:
    SeamProblem(const Atlas& atlas, std::span<const SeamPoint> seams, const std::vector<bool>& measured) {
        std::map<std::uint32_t, int> number;
        std::vector<Eigen::Triplet<double>> entries;
        const auto unknown = [&](std::uint32_t texel) {
            const auto [found, is_new] = number.try_emplace(texel, static_cast<int>(texels_.size()));
            if (is_new)
                texels_.push_back(texel);
            return found->second;
        };
        int row = 0;
        for (const SeamPoint& point : seams) {
            for (const auto& [place, sign] : {std::pair(point.here, 1.0), std::pair(point.there, -1.0)}) {
                const Bilinear filter = bilinear_at(atlas, place);
                for (std::size_t i = 0; i < 4; ++i)
                    entries.emplace_back(row, unknown(filter.texels[i]), sign * filter.weights[i]);
            }
            ++row;
        }
        const auto size = static_cast<int>(texels_.size());
        jumps_.resize(row, size);
        jumps_.setFromTriplets(entries.begin(), entries.end());
        weights_.resize(size);
        for (int i = 0; i < size; ++i)
            weights_[i] = measured[texels_[static_cast<std::size_t>(i)]] ? 1 : kFree;
        squares_ = jumps_.transpose() * jumps_;
    }

    /// Closes seams as far as texels may change for it.
    void solve(std::span<float> values, std::size_t stride) {
        Eigen::MatrixXd before(weights_.size(), static_cast<int>(stride));
        for (std::size_t i = 0; i < texels_.size(); ++i)
            for (std::size_t k = 0; k < stride; ++k)
                before(static_cast<int>(i), static_cast<int>(k)) =
                    static_cast<double>(values[texels_[i] * stride + k]);
        const double jump = rms(jumps_ * before);
        Eigen::MatrixXd after = before;
        for (double price = kJump; price > kLeastJump; price /= 10) {
            Eigen::SparseMatrix<double> matrix = price * squares_;
            for (int i = 0; i < weights_.size(); ++i)
                matrix.coeffRef(i, i) += weights_[i];
            solver_.compute(matrix);
            const Eigen::MatrixXd solved = solver_.solve(weights_.asDiagonal() * before);
            const Eigen::VectorXd measured = (weights_.array() == 1).cast<double>();
            if (rms(measured.asDiagonal() * (solved - before)) <= kMostChange * jump) {
                after = solved;
                break;
            }
        }
        for (std::size_t i = 0; i < texels_.size(); ++i)
            for (std::size_t k = 0; k < stride; ++k)
                values[texels_[i] * stride + k] =
                    static_cast<float>(after(static_cast<int>(i), static_cast<int>(k)));
    }

private:
    static double rms(const Eigen::MatrixXd& m) {
        return m.rows() > 0 ? m.norm() / std::sqrt(static_cast<double>(m.rows())) : 0;
    }

    std::vector<std::uint32_t> texels_; ///< [unknowns]
    Eigen::SparseMatrix<double> jumps_, squares_;
    Eigen::VectorXd weights_;
    Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> solver_;
};

/// The texel that a filter reads for the i-th.
double in_texture(double i, int size, bool repeats) {
    return repeats ? i - size * std::floor(i / size) : std::clamp(i, 0.0, size - 1.0);
}

} // namespace

Bilinear bilinear_at(const Atlas& atlas, const glm::dvec2& place) {
    const glm::dvec2 at = place - 0.5;
    const double left = std::floor(at.x), top = std::floor(at.y), x = at.x - left, y = at.y - top;
    const auto texel = [&](double i, double j) {
        const double column = in_texture(i, atlas.width, atlas.repeats),
                     row = in_texture(j, atlas.height, atlas.repeats);
        return static_cast<std::uint32_t>(row * atlas.width + column);
    };
    return {{texel(left, top), texel(left + 1, top), texel(left, top + 1), texel(left + 1, top + 1)},
            {(1 - x) * (1 - y), x * (1 - y), (1 - x) * y, x * y}};
}

std::vector<SeamPoint> seam_points(const Scene& scene, const Atlas& atlas) {
    constexpr double kApart = 1e-3, kPointsPerTexel = 2; // texels
    std::vector<SeamPoint> points;
    for (const auto& [corners, sides] : sides_of_edges(scene, atlas))
        for (std::size_t s = 1; s < sides.size(); ++s) {
            const SeamSide &here = sides[0], &there = sides[s];
            if (glm::distance(here.first, there.first) < kApart &&
                glm::distance(here.second, there.second) < kApart)
                continue; // the chart goes on
            const double longest =
                std::max(glm::distance(here.first, here.second), glm::distance(there.first, there.second));
            const int parts = std::max(1, static_cast<int>(std::ceil(kPointsPerTexel * longest)));
            for (int i = 0; i <= parts; ++i) {
                const double along = static_cast<double>(i) / parts;
                points.push_back(
                    {glm::mix(here.first, here.second, along), glm::mix(there.first, there.second, along)});
            }
        }
    return points;
}

void stitch_seams(const Atlas& atlas, std::span<const SeamPoint> seams, const std::vector<bool>& measured,
                  std::span<float> values, std::size_t stride) {
    if (!seams.empty())
        SeamProblem(atlas, seams, measured).solve(values, stride);
}

} // namespace prt
