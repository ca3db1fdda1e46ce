// Packs lights, emissive triangles, and their textures.

#include "bake/trace_gpu/lamp_tables.h"

#include "bake/scene/punctual.h"
#include "bake/trace/lamp_rays.h"

#include <glm/gtc/packing.hpp>

#include <map>

namespace prt {
namespace {

gpu::PunctualLight packed(const PunctualLight& light) {
    const ConeCosines cone = cone_cosines(light);
    return {.intensity = light.intensity,
            .directional = light.kind == PunctualKind::directional ? 1u : 0u,
            .position = light.position,
            .inverse_range = 1 / light.range,
            .direction = light.direction,
            .inner_cosine = static_cast<float>(cone.inner),
            .outer_cosine = static_cast<float>(cone.outer),
            .unused = {}};
}

/// Emission textures, stored once for all materials that use them.
class EmissionImages {
public:
    explicit EmissionImages(const TraceScene& scene) : scene_(scene) {}

    /// Index of the texture; PRT_NO_TEXELS if `vertices` have no coordinates for it.
    std::uint32_t index(const VertexArray& vertices, const TextureUse& use) {
        if (!scene_.surfaces().has_texture(vertices, use))
            return PRT_NO_TEXELS;
        const std::uint32_t wraps =
            PRT_WRAPS(static_cast<std::uint32_t>(use.wrap_u), static_cast<std::uint32_t>(use.wrap_v));
        const auto [found, is_new] =
            index_.try_emplace({use.image, wraps}, static_cast<std::uint32_t>(images.size()));
        if (is_new)
            add(scene_.textures()[static_cast<std::size_t>(use.image)], wraps);
        return found->second;
    }

    std::vector<gpu::EmissionImage> images;
    std::vector<std::uint32_t> texels;

private:
    void add(const Texture& texture, std::uint32_t wraps) {
        const Image8& finest = texture.levels[0];
        images.push_back({.texels = static_cast<std::uint32_t>(texels.size()),
                          .width = finest.width,
                          .height = finest.height,
                          .wrap = wraps,
                          .linear = texture.encoding == TextureEncoding::linear ? 1u : 0u});
        for (const glm::u8vec4& texel : finest.pixels)
            texels.push_back(glm::packUint4x8(texel));
    }

    const TraceScene& scene_;
    std::map<std::pair<int, std::uint32_t>, std::uint32_t> index_; ///< index by image and wrap modes
};

gpu::ShiningTriangle packed(const ShiningTriangles::Shining& t, const TraceScene& scene, std::uint32_t alpha,
                            EmissionImages& images) {
    const Surfaces& surfaces = scene.surfaces();
    const Emission& emission = surfaces.material(t.triangle).emission;
    const VertexArray& vertices =
        scene.scene().vertex_arrays[scene.scene().primitives[surfaces.primitive(t.triangle)].vertices];
    gpu::ShiningTriangle triangle{.a = glm::vec3(t.a),
                                  .luminance = static_cast<float>(t.luminance),
                                  .b = glm::vec3(t.b),
                                  .offset = scene.rays().triangle_offset(t.triangle),
                                  .c = glm::vec3(t.c),
                                  .two_sided = t.two_sided ? 1u : 0u,
                                  .radiance = emission.radiance,
                                  .alpha = alpha,
                                  .texcoord = {},
                                  .image = images.index(vertices, emission.texture),
                                  .unused = 0};
    if (triangle.image != PRT_NO_TEXELS) {
        const auto& texcoords = vertices.texcoords[static_cast<std::size_t>(emission.texture.texcoord)];
        const glm::uvec3 corners =
            surfaces.corners(t.triangle) - static_cast<unsigned>(vertices.first_receiver);
        for (int i = 0; i < 3; ++i)
            triangle.texcoord[i] = emission.texture.transform * glm::vec3(texcoords[corners[i]], 1);
    }
    return triangle;
}

} // namespace

LampTables make_lamp_tables(const TraceScene& scene, std::span<const Lamp> lamps, const AlphaTables& alpha) {
    LampTables tables;
    EmissionImages emission(scene);
    for (const Lamp& lamp : lamps) {
        LampTables::Ranges ranges{};
        ranges.first_light = static_cast<std::uint32_t>(tables.lights.size());
        for (const std::uint32_t light : lamp.lights)
            tables.lights.push_back(packed(scene.scene().lights[light]));
        ranges.end_light = static_cast<std::uint32_t>(tables.lights.size());
        ranges.first_triangle = static_cast<std::uint32_t>(tables.triangles.size());
        const ShiningTriangles shining(scene, lamp);
        for (const ShiningTriangles::Shining& t : shining.all())
            tables.triangles.push_back(packed(t, scene, alpha.index[t.triangle], emission));
        ranges.end_triangle = static_cast<std::uint32_t>(tables.triangles.size());
        tables.ranges.push_back(ranges);
    }
    tables.images = std::move(emission.images);
    tables.texels = std::move(emission.texels);
    return tables;
}

} // namespace prt
