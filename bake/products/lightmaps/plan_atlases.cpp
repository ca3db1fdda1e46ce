// Decides which surfaces share a texture, and how large it is.

#include "bake/products/lightmaps/texel_samples.h"
#include "prt/core/error.h"

#include <fmt/core.h>
#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <map>

namespace prt {
namespace {

/// Charts that are packed next to each other touch, and programs round: this share may be in two charts.
constexpr double kMaxOverlap = 1e-3;

/// Area of the charts in a texture with one texel per side. Throws `Error` if the coordinates have no area.
double area_in_texture(const Scene& scene, const Atlas& atlas) {
    Atlas unit = atlas;
    unit.width = unit.height = 1;
    double area = 0;
    for (const ChartTriangle& t : chart_triangles(scene, unit)) {
        const glm::dvec2 a = t.corners[1] - t.corners[0], b = t.corners[2] - t.corners[0];
        area += std::abs(a.x * b.y - a.y * b.x) / 2;
    }
    if (!(area > 0))
        throw Error(
            fmt::format("TEXCOORD_{} of mesh {} covers no area; use another set (--texels ...,uv=N) or a "
                        "generated one (--texels ...,unwrap)",
                        atlas.uv_set, scene.primitives[atlas.primitives.front()].mesh));
    return area;
}

double area_on_surfaces(const Scene& scene, const Atlas& atlas) {
    double area = 0;
    for (const std::size_t p : atlas.primitives) {
        const auto& positions = scene.vertex_arrays[scene.primitives[p].vertices].positions;
        for (const glm::uvec3& t : scene.primitives[p].triangles) {
            const glm::dvec3 a(positions[t.x]), b(positions[t.y]), c(positions[t.z]);
            area += glm::length(glm::cross(b - a, c - a)) / 2;
        }
    }
    return area;
}

Atlas sized(const Scene& scene, Atlas atlas, const TexelOptions& options) {
    atlas.uv_set = options.uv_set;
    atlas.repeats = repeats(scene, atlas);
    const double in_texture = area_in_texture(scene, atlas);
    double side = options.size;
    if (options.size == 0) // chosen by the mean number of texels per metre
        side = std::ceil(options.per_metre * std::sqrt(area_on_surfaces(scene, atlas) / in_texture));
    if (!(side <= kMaxTexels))
        throw Error(fmt::format(
            "{:.3g} texels per metre need a texture with {:.3g} texels per side, more than the limit of "
            "{}; use fewer texels or a separate texture per object (--texels ...,atlas=each)",
            options.per_metre, side, kMaxTexels));
    atlas.width = atlas.height = options.size > 0 ? options.size : std::max(4, static_cast<int>(side));
    return atlas;
}

std::vector<Atlas> of_each_object(const Scene& scene, const TexelOptions& options) {
    std::map<int, Atlas> by_node;
    for (const std::size_t p : surfaces_with_texels(scene, options))
        by_node[scene.primitives[p].node].primitives.push_back(p);
    std::vector<Atlas> atlases;
    for (const auto& [node, atlas] : by_node)
        atlases.push_back(sized(scene, atlas, options));
    return atlases;
}

Atlas of_all(const Scene& scene, const TexelOptions& options) {
    return sized(scene, {.primitives = surfaces_with_texels(scene, options)}, options);
}

double overlap(const Scene& scene, const Atlas& atlas) {
    return std::min(1.0, sample_texels(chart_triangles(scene, atlas), atlas).overlapping); // or in three
}

} // namespace

std::vector<std::size_t> surfaces_with_texels(const Scene& scene, const TexelOptions& options) {
    std::vector<std::size_t> primitives;
    for (std::size_t p = 0; p < scene.primitives.size(); ++p)
        if (!options.leave_out_lobes || !scene.vertex_arrays[scene.primitives[p].vertices].lobes)
            primitives.push_back(p);
    return primitives;
}

std::vector<Atlas> plan_atlases(const Scene& scene, const TexelOptions& options) {
    if (options.size > kMaxTexels || options.size < 0)
        throw Error(
            fmt::format("the number of texels per side must be in 1..{}, not {}", kMaxTexels, options.size));
    if (options.size == 0 && !(options.per_metre > 0 && std::isfinite(options.per_metre)))
        throw Error("the number of texels per metre must be finite and greater than 0");
    if (options.atlases != AtlasMode::each) {
        Atlas all = of_all(scene, options);
        const double share = overlap(scene, all);
        if (share <= kMaxOverlap)
            return {std::move(all)};
        if (options.atlases == AtlasMode::one)
            throw Error(fmt::format(
                "{:.1f} % of the area of the charts of TEXCOORD_{} is covered more than once, so "
                "all objects cannot share one texture; use --texels ...,atlas=each or --texels ...,unwrap",
                100 * share, options.uv_set));
    }
    std::vector<Atlas> atlases = of_each_object(scene, options);
    for (const Atlas& atlas : atlases)
        if (const double share = overlap(scene, atlas); share > kMaxOverlap) {
            const Primitive& primitive = scene.primitives[atlas.primitives.front()];
            throw Error(fmt::format(
                "charts of mesh {} (node {}) overlap: {:.1f} % of the area of its TEXCOORD_{} is covered "
                "more than once; use another set (--texels ...,uv=N) or a generated one (--texels "
                "...,unwrap)",
                primitive.mesh, primitive.node, 100 * share, options.uv_set));
        }
    return atlases;
}

} // namespace prt
