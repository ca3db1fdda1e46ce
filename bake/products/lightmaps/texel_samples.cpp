// Rasterises charts by points within texels, and conservatively where these miss them.

#include "bake/products/lightmaps/texel_samples.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <utility>

namespace prt {
namespace {

/// A rotated grid: points differ in row and in column.
constexpr std::array<glm::dvec2, kSamplesOfTexel> kPoints = {
    {{0.125, 0.625}, {0.375, 0.125}, {0.625, 0.875}, {0.875, 0.375}}};
constexpr std::uint32_t kNobody = ~0u;
constexpr double kEdge = 1e-4; ///< texels: nearer to an edge, two triangles may both have a point

/// Computes the extent in x of a triangle within a row of texels. Returns false if the triangle does not
/// touch the row.
bool extent_in_row(const ChartTriangle& t, int row, double& low, double& high) {
    low = std::numeric_limits<double>::infinity();
    high = -low;
    for (std::size_t i = 0; i < 3; ++i) {
        glm::dvec2 a = t.corners[i], b = t.corners[(i + 1) % 3];
        if (a.y > b.y)
            std::swap(a, b);
        if (b.y < row || a.y > row + 1)
            continue;
        const auto at = [&](double y) {
            return b.y > a.y ? a.x + (b.x - a.x) * (y - a.y) / (b.y - a.y) : a.x;
        };
        const double x[] = {a.y < row ? at(row) : a.x, b.y > row + 1 ? at(row + 1) : b.x};
        low = std::min({low, x[0], x[1]});
        high = std::max({high, x[0], x[1]});
    }
    return low <= high;
}

int texel_of(double at, int size) {
    return std::clamp(static_cast<int>(at), 0, size - 1);
}

/// Calls `visit` with all texels that a triangle touches, and with few others.
template <class Visit>
void for_texels(const ChartTriangle& t, const Atlas& atlas, Visit&& visit) {
    const auto [top, bottom] = std::minmax({t.corners[0].y, t.corners[1].y, t.corners[2].y});
    for (int j = texel_of(top, atlas.height); j <= texel_of(bottom, atlas.height); ++j) {
        double low = 0, high = 0;
        if (extent_in_row(t, j, low, high))
            for (int i = texel_of(low, atlas.width); i <= texel_of(high, atlas.width); ++i)
                visit(static_cast<std::size_t>(j) * static_cast<std::size_t>(atlas.width) +
                          static_cast<std::size_t>(i),
                      glm::dvec2(i, j));
    }
}

/// The triangle that contains each point of each texel.
struct Owners {
    std::vector<std::uint32_t> of; ///< [texels][points], index of a triangle or kNobody
    std::size_t covered = 0, twice = 0;
};

Owners find_owners(std::span<const ChartTriangle> triangles, const Atlas& atlas) {
    Owners owners{std::vector<std::uint32_t>(atlas.texels() * kSamplesOfTexel, kNobody)};
    for (std::uint32_t t = 0; t < triangles.size(); ++t)
        for_texels(triangles[t], atlas, [&](std::size_t texel, const glm::dvec2& corner) {
            for (std::size_t s = 0; s < kSamplesOfTexel; ++s) {
                const glm::dvec2 point = corner + kPoints[s];
                const double depth = in_triangle(triangles[t], point).depth;
                if (depth < 0)
                    continue;
                std::uint32_t& owner = owners.of[texel * kSamplesOfTexel + s];
                if (owner == kNobody) {
                    owner = t;
                    ++owners.covered;
                } else if (depth > kEdge && in_triangle(triangles[owner], point).depth > kEdge) {
                    ++owners.twice;
                }
            }
        });
    return owners;
}

/// For texels that charts touch without containing one of their points: the nearest point, by texel.
std::vector<TexelSample> touched(std::span<const ChartTriangle> triangles, const Atlas& atlas,
                                 const Owners& owners) {
    std::map<std::uint32_t, std::pair<double, TexelSample>> nearest;
    for (const ChartTriangle& t : triangles)
        for_texels(t, atlas, [&](std::size_t texel, const glm::dvec2& corner) {
            const auto own = std::span(owners.of).subspan(texel * kSamplesOfTexel, kSamplesOfTexel);
            if (std::ranges::any_of(own, [](std::uint32_t o) { return o != kNobody; }))
                return;
            const glm::dvec2 middle = corner + 0.5, uv = nearest_in_triangle(t, middle),
                             way = position_of(t, uv) - middle;
            if (std::max(std::abs(way.x), std::abs(way.y)) > 0.5)
                return;
            const auto number = static_cast<std::uint32_t>(texel);
            const std::pair here(std::hypot(way.x, way.y), TexelSample{number, t.triangle, glm::vec2(uv)});
            const auto [found, is_new] = nearest.try_emplace(number, here);
            if (!is_new && here.first < found->second.first)
                found->second = here;
        });
    std::vector<TexelSample> samples;
    for (const auto& [texel, position] : nearest)
        samples.push_back(position.second);
    return samples;
}

} // namespace

TexelSamples sample_texels(std::span<const ChartTriangle> triangles, const Atlas& atlas) {
    const Owners owners = find_owners(triangles, atlas);
    const std::vector<TexelSample> optional_work = touched(triangles, atlas, owners);
    TexelSamples result;
    result.overlapping =
        owners.covered > 0 ? static_cast<double>(owners.twice) / static_cast<double>(owners.covered) : 0;
    auto next = optional_work.begin();
    for (std::uint32_t texel = 0; texel < atlas.texels(); ++texel) {
        const glm::dvec2 corner(texel % static_cast<std::uint32_t>(atlas.width),
                                texel / static_cast<std::uint32_t>(atlas.width));
        for (std::size_t s = 0; s < kSamplesOfTexel; ++s)
            if (const std::uint32_t owner = owners.of[texel * kSamplesOfTexel + s]; owner != kNobody)
                result.samples.push_back({texel, triangles[owner].triangle,
                                          glm::vec2(in_triangle(triangles[owner], corner + kPoints[s]).uv)});
        if (next != optional_work.end() && next->texel == texel)
            result.samples.push_back(*next++);
    }
    return result;
}

} // namespace prt
