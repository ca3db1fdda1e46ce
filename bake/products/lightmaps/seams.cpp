// Finds seams by the positions and normals of edges, and closes them with a sparse least-squares problem.

#include "bake/products/lightmaps/seams.h"

#include "bake/products/lightmaps/charts.h"

#include <Eigen/SparseCholesky>
#include <Eigen/SparseCore>
#include <glm/geometric.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <map>

namespace prt {
namespace {

/// Cost of a squared jump, and of squared changes of unmeasured texels, relative to squared changes of
/// measured ones.
constexpr double kJump = 1e4, kFree = 0.01;
/// Charts with fewer texels consist mainly of seams: closing these would flatten the chart.
constexpr double kTexelsOfChart = 64;

using SeamCorner = std::array<float, 6>; ///< position and normal

struct SeamSide {
    glm::dvec2 first, second; ///< ends of the edge, in texels
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

/// Number of measured texels connected with each texel by their sides; 0: not measured.
std::vector<std::uint32_t> chart_sizes(const Atlas& atlas, const std::vector<bool>& measured) {
    std::vector<std::uint32_t> sizes(atlas.texels());
    std::vector<std::uint32_t> chart;
    const auto width = static_cast<std::uint32_t>(atlas.width);
    std::vector<bool> seen(atlas.texels());
    for (std::uint32_t seed = 0; seed < atlas.texels(); ++seed) {
        if (!measured[seed] || seen[seed])
            continue;
        chart.assign(1, seed);
        seen[seed] = true;
        for (std::size_t i = 0; i < chart.size(); ++i) {
            const std::uint32_t t = chart[i];
            const auto visit = [&](bool inside, std::uint32_t next) {
                if (inside && measured[next] && !seen[next]) {
                    seen[next] = true;
                    chart.push_back(next);
                }
            };
            visit(t % width > 0, t - 1);
            visit(t % width + 1 < width, t + 1);
            visit(t >= width, t - width);
            visit(t + width < atlas.texels(), t + width);
        }
        for (const std::uint32_t t : chart)
            sizes[t] = static_cast<std::uint32_t>(chart.size());
    }
    return sizes;
}

/// The unknowns of a least-squares problem: texels that filters read at seams.
class SeamProblem {
public:
    SeamProblem(const Atlas& atlas, std::span<const SeamPoint> seams, const std::vector<bool>& measured) {
        const std::vector<std::uint32_t> sizes = chart_sizes(atlas, measured);
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
            const BilinearTexels here = bilinear_at(atlas, point.here),
                                 there = bilinear_at(atlas, point.there);
            const double multiplier = std::min(multiplier_of(here, sizes), multiplier_of(there, sizes));
            for (const auto& [filter, sign] : {std::pair(&here, 1.0), std::pair(&there, -1.0)})
                for (std::size_t i = 0; i < 4; ++i)
                    entries.emplace_back(row, unknown(filter->texels[i]),
                                         std::sqrt(multiplier) * sign * filter->weights[i]);
            ++row;
        }
        const auto size = static_cast<int>(texels_.size());
        Eigen::SparseMatrix<double> jumps(row, size);
        jumps.setFromTriplets(entries.begin(), entries.end());
        weights_.resize(size);
        for (int i = 0; i < size; ++i)
            weights_[i] = measured[texels_[static_cast<std::size_t>(i)]] ? 1 : kFree;
        Eigen::SparseMatrix<double> matrix = jumps.transpose() * jumps;
        for (int i = 0; i < size; ++i)
            matrix.coeffRef(i, i) += weights_[i];
        solver_.compute(matrix);
    }

    void solve(std::span<float> values, std::size_t stride) const {
        for (std::size_t k = 0; k < stride; ++k) {
            Eigen::VectorXd b(weights_.size());
            for (std::size_t i = 0; i < texels_.size(); ++i)
                b[static_cast<int>(i)] =
                    weights_[static_cast<int>(i)] * static_cast<double>(values[texels_[i] * stride + k]);
            const Eigen::VectorXd x = solver_.solve(b);
            for (std::size_t i = 0; i < texels_.size(); ++i)
                values[texels_[i] * stride + k] = static_cast<float>(x[static_cast<int>(i)]);
        }
    }

private:
    /// Cost by the size of the chart with the largest weight in the filter.
    static double multiplier_of(const BilinearTexels& filter, std::span<const std::uint32_t> sizes) {
        double texels = 0, most = -1;
        for (std::size_t i = 0; i < 4; ++i)
            if (const std::uint32_t size = sizes[filter.texels[i]]; size > 0 && filter.weights[i] > most) {
                most = filter.weights[i];
                texels = size;
            }
        return kJump * std::pow(std::min(1.0, texels / kTexelsOfChart), 8);
    }

    std::vector<std::uint32_t> texels_; ///< [unknowns]
    Eigen::VectorXd weights_;
    Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> solver_;
};

} // namespace

std::vector<SeamPoint> seam_points(const Scene& scene, const Atlas& atlas) {
    constexpr double kSeparate = 1e-3, kPointsPerTexel = 2; // texels
    std::vector<SeamPoint> points;
    for (const auto& [corners, sides] : sides_of_edges(scene, atlas))
        for (std::size_t s = 1; s < sides.size(); ++s) {
            const SeamSide &here = sides[0], &there = sides[s];
            if (glm::distance(here.first, there.first) < kSeparate &&
                glm::distance(here.second, there.second) < kSeparate)
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

double jump_at(const Atlas& atlas, const SeamPoint& point, std::span<const float> values,
               std::size_t stride) {
    double jump = 0;
    for (const auto& [position, sign] : {std::pair(point.here, 1.0), std::pair(point.there, -1.0)}) {
        const BilinearTexels filter = bilinear_at(atlas, position);
        for (std::size_t i = 0; i < 4; ++i)
            jump += sign * filter.weights[i] * static_cast<double>(values[filter.texels[i] * stride]);
    }
    return jump;
}

} // namespace prt
