// Rasterises charts by points within texels, and conservatively where these miss them.

#include "texels/texel_samples.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <tuple>

namespace prt {
namespace {

/// A rotated grid: points differ in row and in column.
constexpr std::array<glm::dvec2, kSamplesOfTexel> kPoints = {
    {{0.125, 0.625}, {0.375, 0.125}, {0.625, 0.875}, {0.875, 0.375}}};
constexpr std::uint32_t kNobody = ~0u;
constexpr double kEdge = 0.01; ///< texels: nearer to an edge, two triangles may both have a point

/// Texels that the box of a triangle touches.
struct TexelBox {
    int left, top, right, bottom; ///< ends are outside
};

TexelBox texel_box(const ChartTriangle& t, const Atlas& atlas) {
    const auto [left, right] = std::minmax({t.corners[0].x, t.corners[1].x, t.corners[2].x});
    const auto [top, bottom] = std::minmax({t.corners[0].y, t.corners[1].y, t.corners[2].y});
    const auto first = [](double at, int size) { return std::clamp(static_cast<int>(at), 0, size - 1); };
    return {first(left, atlas.width), first(top, atlas.height), first(right, atlas.width) + 1,
            first(bottom, atlas.height) + 1};
}

template <class Visit>
void for_texels(const TexelBox& box, const Atlas& atlas, Visit&& visit) {
    for (int j = box.top; j < box.bottom; ++j)
        for (int i = box.left; i < box.right; ++i)
            visit(static_cast<std::size_t>(j) * static_cast<std::size_t>(atlas.width) +
                      static_cast<std::size_t>(i),
                  glm::dvec2(i, j));
}

/// Which triangle each point of each texel lies in.
struct Owners {
    std::vector<std::uint32_t> of; ///< [texels][points], index of a triangle or kNobody
    std::size_t covered = 0, twice = 0;
};

Owners find_owners(std::span<const ChartTriangle> triangles, const Atlas& atlas) {
    Owners owners{std::vector<std::uint32_t>(atlas.texels() * kSamplesOfTexel, kNobody)};
    for (std::uint32_t t = 0; t < triangles.size(); ++t)
        for_texels(texel_box(triangles[t], atlas), atlas, [&](std::size_t texel, const glm::dvec2& corner) {
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

struct Nearest {
    std::uint32_t texel;
    double distance;
    TexelSample sample;
};

/// Of texels that charts touch and no point of which lies in one: the nearest place.
std::vector<TexelSample> touched(std::span<const ChartTriangle> triangles, const Atlas& atlas,
                                 const Owners& owners) {
    std::vector<Nearest> found;
    for (const ChartTriangle& t : triangles)
        for_texels(texel_box(t, atlas), atlas, [&](std::size_t texel, const glm::dvec2& corner) {
            const auto own = std::span(owners.of).subspan(texel * kSamplesOfTexel, kSamplesOfTexel);
            if (std::ranges::any_of(own, [](std::uint32_t o) { return o != kNobody; }))
                return;
            const glm::dvec2 middle = corner + 0.5, uv = nearest_in_triangle(t, middle),
                             way = place_of(t, uv) - middle;
            if (std::max(std::abs(way.x), std::abs(way.y)) <= 0.5)
                found.push_back({static_cast<std::uint32_t>(texel),
                                 std::hypot(way.x, way.y),
                                 {static_cast<std::uint32_t>(texel), t.triangle, glm::vec2(uv)}});
        });
    std::stable_sort(found.begin(), found.end(), [](const Nearest& a, const Nearest& b) {
        return std::tie(a.texel, a.distance) < std::tie(b.texel, b.distance);
    });
    std::vector<TexelSample> samples;
    for (const Nearest& n : found)
        if (samples.empty() || samples.back().texel != n.texel)
            samples.push_back(n.sample);
    return samples;
}

} // namespace

TexelSamples sample_texels(std::span<const ChartTriangle> triangles, const Atlas& atlas) {
    const Owners owners = find_owners(triangles, atlas);
    const std::vector<TexelSample> beside = touched(triangles, atlas, owners);
    TexelSamples result;
    result.overlapping =
        owners.covered > 0 ? static_cast<double>(owners.twice) / static_cast<double>(owners.covered) : 0;
    auto next = beside.begin();
    for (std::uint32_t texel = 0; texel < atlas.texels(); ++texel) {
        const glm::dvec2 corner(texel % static_cast<std::uint32_t>(atlas.width),
                                texel / static_cast<std::uint32_t>(atlas.width));
        for (std::size_t s = 0; s < kSamplesOfTexel; ++s)
            if (const std::uint32_t owner = owners.of[texel * kSamplesOfTexel + s]; owner != kNobody)
                result.samples.push_back({texel, triangles[owner].triangle,
                                          glm::vec2(in_triangle(triangles[owner], corner + kPoints[s]).uv)});
        if (next != beside.end() && next->texel == texel)
            result.samples.push_back(*next++);
    }
    return result;
}

} // namespace prt
