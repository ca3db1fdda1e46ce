// Cuts surfaces into charts, packs them, and splits vertices at the ends of charts.

#include "bake/products/lightmaps/unwrap.h"

#include "bake/products/lightmaps/chart_packing.h"
#include "bake/products/lightmaps/surface_charts.h"
#include "prt/core/error.h"

#include <fmt/core.h>
#include <glm/common.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numeric>
#include <utility>

namespace prt {
namespace {

constexpr int kSeparate = 2; ///< number of empty texels on every side of a chart

struct FlatBox {
    glm::dvec2 low, size; ///< metres
};

/// Returns the bounding boxes of charts, from their faces with area. Faces without area are moved into the
/// box.
std::vector<FlatBox> flat_boxes(std::span<const ChartFace> faces, std::span<const SurfaceChart> charts) {
    std::vector<FlatBox> boxes;
    for (const SurfaceChart& chart : charts) {
        glm::dvec2 low(projected(faces[chart.faces.front()].corners[0], chart.axis)), high = low;
        for (const std::uint32_t f : chart.faces)
            for (const glm::dvec3& corner : faces[f].corners) {
                if (faces[f].normal == glm::dvec3(0))
                    break;
                low = glm::min(low, projected(corner, chart.axis));
                high = glm::max(high, projected(corner, chart.axis));
            }
        boxes.push_back({low, high - low});
    }
    return boxes;
}

/// Positions of charts in a texture.
struct Packed {
    std::vector<glm::ivec2> corners;
    int side = 0;
    double density = 0; ///< texels per metre
};

std::optional<Packed> pack(std::span<const FlatBox> boxes, int side, double density) {
    std::vector<glm::ivec2> sizes;
    double texels = 0;
    for (const FlatBox& box : boxes) {
        const glm::dvec2 size = glm::ceil(box.size * density) + 1.0 + 2.0 * kSeparate;
        if (!(size.x <= side && size.y <= side))
            return std::nullopt;
        texels += size.x * size.y;
        sizes.emplace_back(size);
    }
    if (texels > static_cast<double>(side) * side) // packing takes longer
        return std::nullopt;
    std::optional<std::vector<glm::ivec2>> corners = pack_rectangles(sizes, side);
    if (!corners)
        return std::nullopt;
    return Packed{std::move(*corners), side, density};
}

double area_of(std::span<const FlatBox> boxes) {
    return std::accumulate(boxes.begin(), boxes.end(), 0.0,
                           [](double sum, const FlatBox& box) { return sum + box.size.x * box.size.y; });
}

/// Returns the number of charts of minimum size that fit into a texture.
std::size_t max_charts(int side) {
    constexpr std::size_t kMinTexels = (1 + 2 * kSeparate) * (1 + 2 * kSeparate);
    return static_cast<std::size_t>(side) * static_cast<std::size_t>(side) / kMinTexels;
}

[[noreturn]] void refuse_size(std::size_t charts, int side) {
    constexpr double kTexels =
        2 * (2 + 2 * kSeparate) * (2 + 2 * kSeparate); // half of a texture may stay free
    int wanted = 1;
    while (wanted < kMaxTexels &&
           static_cast<double>(wanted) * wanted < kTexels * static_cast<double>(charts))
        wanted *= 2;
    throw Error(
        fmt::format("a texture of {0} x {0} texels is too small for at least {1} charts; use {2} or more "
                    "texels per side, or a separate texture per object (--texels ...,atlas=each)",
                    side, charts, std::max(wanted, std::min(2 * side, kMaxTexels))));
}

/// Packs charts with the maximum number of texels per metre that fits.
Packed pack_into(std::span<const FlatBox> boxes, int side) {
    constexpr double kStep = 0.95;
    constexpr int kMaxTries = 200;
    if (boxes.size() > max_charts(side))
        refuse_size(boxes.size(), side);
    double density = side / std::sqrt(std::max(area_of(boxes), std::numeric_limits<double>::min()));
    for (int step = 0; step < kMaxTries; ++step, density *= kStep)
        if (std::optional<Packed> packed = pack(boxes, side, density))
            return std::move(*packed);
    refuse_size(boxes.size(), side);
}

/// Packs charts into the smallest texture with this number of texels per metre.
Packed pack_by_density(std::span<const FlatBox> boxes, double density) {
    constexpr double kStep = 1.06;
    double side = std::max(4.0, std::sqrt(area_of(boxes)) * density);
    for (; side <= kMaxTexels; side = std::ceil(side * kStep))
        if (std::optional<Packed> packed = pack(boxes, static_cast<int>(side), density))
            return std::move(*packed);
    throw Error(fmt::format(
        "{:.3g} texels per metre need a texture with more than {} texels per side; use fewer texels or "
        "a separate texture per object (--texels ...,atlas=each)",
        density, kMaxTexels));
}

/// Writes the charts of one texture.
class ChartWriter {
public:
    ChartWriter(const Scene& scene, std::vector<VertexSplit>& splits) : scene_(scene), splits_(splits) {}

    void write(std::span<const ChartFace> faces, const SurfaceChart& chart, const FlatBox& box,
               const glm::ivec2& corner, const Packed& packed) {
        std::map<std::pair<std::size_t, std::uint32_t>, std::uint32_t> vertices; // new vertices of this chart
        for (const std::uint32_t f : chart.faces) {
            const ChartFace& face = faces[f];
            VertexSplit& split = splits_[face.primitive];
            const glm::uvec3& t = scene_.primitives[face.primitive].triangles[face.triangle];
            for (int i = 0; i < 3; ++i) {
                const auto next = static_cast<std::uint32_t>(split.source.size());
                const auto [found, is_new] = vertices.try_emplace({face.primitive, t[i]}, next);
                if (is_new) {
                    const glm::dvec2 at = glm::clamp(projected(face.corners[i], chart.axis) - box.low,
                                                     glm::dvec2(0), box.size) *
                                          packed.density;
                    split.source.push_back(t[i]);
                    split.uv.emplace_back((glm::dvec2(corner) + 0.5 + static_cast<double>(kSeparate) + at) /
                                          static_cast<double>(packed.side));
                }
                split.triangles[face.triangle][i] = found->second;
            }
        }
    }

private:
    const Scene& scene_;
    std::vector<VertexSplit>& splits_;
};

/// The primitives that share each texture.
std::vector<std::vector<std::size_t>> groups(const Scene& scene, const TexelOptions& options) {
    std::map<int, std::vector<std::size_t>> by_node;
    for (const std::size_t p : surfaces_with_texels(scene, options))
        by_node[options.atlases == AtlasMode::each ? scene.primitives[p].node : 0].push_back(p);
    std::vector<std::vector<std::size_t>> result;
    for (auto& [node, primitives] : by_node)
        result.push_back(std::move(primitives));
    return result;
}

} // namespace

Unwrapping unwrap(const Scene& scene, const TexelOptions& options) {
    Unwrapping result;
    for (const Primitive& primitive : scene.primitives)
        result.primitives.emplace_back().triangles.resize(primitive.triangles.size());
    result.texels_per_metre = std::numeric_limits<double>::infinity();
    ChartWriter writer(scene, result.primitives);
    for (const std::vector<std::size_t>& primitives : groups(scene, options)) {
        const std::vector<ChartFace> faces = chart_faces(scene, primitives);
        const std::vector<SurfaceChart> charts =
            cut_into_charts(scene, faces, max_charts(options.size > 0 ? options.size : kMaxTexels));
        const std::vector<FlatBox> boxes = flat_boxes(faces, charts);
        const Packed packed =
            options.size > 0 ? pack_into(boxes, options.size) : pack_by_density(boxes, options.per_metre);
        for (std::size_t c = 0; c < charts.size(); ++c)
            writer.write(faces, charts[c], boxes[c], packed.corners[c], packed);
        result.charts += charts.size();
        result.atlases.push_back({.primitives = primitives, .width = packed.side, .height = packed.side});
        result.texels_per_metre = std::min(result.texels_per_metre, packed.density);
    }
    return result;
}

} // namespace prt
