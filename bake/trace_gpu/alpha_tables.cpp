// Builds tables of surfaces that do not stop all light.

#include "bake/trace_gpu/alpha_tables.h"

#include "runtime/load/light_passing.h"

#include <glm/geometric.hpp>

#include <cmath>
#include <map>
#include <utility>

namespace prt {
namespace {

using gpu::AlphaMaterial, gpu::AlphaTriangle;

static_assert(PRT_WRAP_REPEAT == static_cast<int>(Wrap::repeat) &&
              PRT_WRAP_MIRROR == static_cast<int>(Wrap::mirror) &&
              PRT_WRAP_CLAMP == static_cast<int>(Wrap::clamp));

/// One property that determines the share of a ray that a surface stops.
struct AlphaLayer {
    std::uint32_t mode;
    float cutoff, factor;
    const TextureUse* use;
    int channel;       ///< channel of the texture
    bool vertex_alpha; ///< multiply by the alpha of the vertices
};

/// Returns the layers of a material. Glass is first; its mode marks a surface that stops rays partially.
std::vector<AlphaLayer> alpha_layers(const Material& m) {
    std::vector<AlphaLayer> layers;
    if (m.glass.factor > 0)
        layers.push_back({PRT_ALPHA_GLASS, 0, glass_transmittance(m), &m.glass.texture, 0, false});
    if (m.alpha_mode != AlphaMode::opaque)
        layers.push_back({static_cast<std::uint32_t>(m.alpha_mode), m.alpha_cutoff, m.base_color.a,
                          &m.base_color_texture, 3, true});
    return layers;
}

/// Channels of images as bytes, stored once for all materials that use them.
class AlphaTexels {
public:
    explicit AlphaTexels(const std::vector<Texture>& textures) : textures_(textures) {}

    /// Returns the index of the first texel of the finest level; the other levels follow.
    std::uint32_t first(int image, int channel) {
        const auto [found, is_new] =
            first_.try_emplace({image, channel}, static_cast<std::uint32_t>(texels.size()));
        if (is_new)
            for (const Image8& level : textures_[static_cast<std::size_t>(image)].levels)
                for (const glm::u8vec4& texel : level.pixels)
                    texels.push_back(texel[channel]);
        return found->second;
    }

    std::vector<std::uint8_t> texels;

private:
    const std::vector<Texture>& textures_;
    std::map<std::pair<int, int>, std::uint32_t> first_; ///< index by image and channel
};

AlphaMaterial alpha_material(const AlphaLayer& layer, const Surfaces& surfaces, const VertexArray& vertices,
                             const std::vector<Texture>& textures, AlphaTexels& texels) {
    const TextureUse& use = *layer.use;
    AlphaMaterial result{
        .mode = layer.mode,
        .cutoff = layer.cutoff,
        .factor = layer.factor,
        .texels = PRT_NO_TEXELS,
        .width = 1,
        .height = 1,
        .levels = 1,
        .wrap = PRT_WRAPS(static_cast<std::uint32_t>(use.wrap_u), static_cast<std::uint32_t>(use.wrap_v))};
    if (!surfaces.has_texture(vertices, use))
        return result;
    const Texture& texture = textures[static_cast<std::size_t>(use.image)];
    result.texels = texels.first(use.image, layer.channel);
    result.width = texture.levels[0].width;
    result.height = texture.levels[0].height;
    result.levels = static_cast<std::int32_t>(texture.levels.size());
    return result;
}

AlphaTriangle alpha_triangle(const AlphaLayer& layer, std::uint32_t index, const AlphaMaterial& m,
                             const VertexArray& vertices, const glm::uvec3& corners) {
    AlphaTriangle triangle{
        .texcoord = {}, .vertex_alpha = {1, 1, 1}, .material = index, .texel_density = 0, .next = 0};
    for (int i = 0; i < 3; ++i) {
        if (m.texels != PRT_NO_TEXELS)
            triangle.texcoord[i] =
                layer.use->transform *
                glm::vec3(vertices.texcoords[static_cast<std::size_t>(layer.use->texcoord)][corners[i]], 1);
        if (layer.vertex_alpha && !vertices.colors.empty())
            triangle.vertex_alpha[i] = vertices.colors[corners[i]].a;
    }
    const glm::vec2 size(m.width, m.height);
    const glm::vec2 ab = (triangle.texcoord[1] - triangle.texcoord[0]) * size,
                    ac = (triangle.texcoord[2] - triangle.texcoord[0]) * size;
    const glm::vec3& a = vertices.positions[corners.x];
    const float area =
        glm::length(glm::cross(vertices.positions[corners.y] - a, vertices.positions[corners.z] - a));
    const float density = std::abs(ab.x * ac.y - ab.y * ac.x) / area;
    triangle.texel_density = std::isfinite(density) ? density : 0;
    return triangle;
}

} // namespace

AlphaTables make_alpha_tables(const TraceScene& trace_scene, std::span<const std::uint32_t> triangles) {
    const Scene& scene = trace_scene.scene();
    const Surfaces& surfaces = trace_scene.surfaces();
    AlphaTables tables;
    AlphaTexels texels(trace_scene.textures());
    tables.index.resize(surfaces.triangles());
    std::vector<std::uint32_t> material_of(scene.primitives.size(), PRT_NO_TEXELS); // index of the first
                                                                                    // layer
    for (const std::uint32_t t : triangles) {
        if (surfaces.opaque(t))
            continue;
        const Primitive& primitive = scene.primitives[surfaces.primitive(t)];
        const VertexArray& vertices = scene.vertex_arrays[primitive.vertices];
        const std::vector<AlphaLayer> layers = alpha_layers(scene.materials[primitive.material]);
        std::uint32_t& first = material_of[surfaces.primitive(t)];
        if (first == PRT_NO_TEXELS) {
            first = static_cast<std::uint32_t>(tables.materials.size());
            for (const AlphaLayer& layer : layers)
                tables.materials.push_back(
                    alpha_material(layer, surfaces, vertices, trace_scene.textures(), texels));
        }
        const glm::uvec3 corners = surfaces.corners(t) - static_cast<unsigned>(vertices.first_receiver);
        tables.index[t] = static_cast<std::uint32_t>(tables.triangles.size()) + 1;
        for (std::uint32_t l = 0; l < layers.size(); ++l) {
            tables.triangles.push_back(
                alpha_triangle(layers[l], first + l, tables.materials[first + l], vertices, corners));
            if (l + 1 < layers.size())
                tables.triangles.back().next = static_cast<std::uint32_t>(tables.triangles.size()) + 1;
        }
    }
    tables.texels = std::move(texels.texels);
    tables.texels.resize((tables.texels.size() + 3) / 4 * 4);
    return tables;
}

std::vector<glm::vec4> tagged_corners(const TraceScene& scene, std::span<const std::uint32_t> triangles,
                                      const AlphaTables& alpha) {
    const Surfaces& surfaces = scene.surfaces();
    std::vector<glm::vec4> corners;
    corners.reserve(3 * triangles.size());
    for (const std::uint32_t t : triangles) {
        const VertexArray& vertices =
            scene.scene().vertex_arrays[scene.scene().primitives[surfaces.primitive(t)].vertices];
        const glm::uvec3 indices = surfaces.corners(t) - static_cast<unsigned>(vertices.first_receiver);
        const float tags[3] = {std::bit_cast<float>(t), std::bit_cast<float>(alpha.index[t]), 0};
        for (int i = 0; i < 3; ++i)
            corners.emplace_back(vertices.positions[indices[i]], tags[i]);
    }
    return corners;
}

std::vector<std::uint32_t> shadowing_triangles(const TraceScene& scene) {
    std::vector<std::uint32_t> triangles;
    for (const bool opaque : {true, false})
        for (std::uint32_t t = 0; t < scene.surfaces().triangles(); ++t)
            if (scene.surfaces().opaque(t) == opaque && scene.rays().is_traced(t))
                triangles.push_back(t);
    return triangles;
}

} // namespace prt
