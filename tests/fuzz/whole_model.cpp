// Reads a model as the program does and looks at everything that was read.
#include "whole_model.h"

#include "bake/gltf/rigid_parts.h"
#include "prt/core/light.h"
#include "prt/core/texture_relighter.h"
#include "prt/gltf/transfer_gltf.h"
#include "prt/load/model.h"
#include "runtime/render/lightmap_lookup.h"
#include "target.h"

#include <glm/common.hpp>
#include <glm/gtc/type_ptr.hpp>

#include <algorithm>
#include <functional>
#include <utility>

namespace prt::fuzz {
namespace {

template <class Vector>
void expect_finite_vectors(const std::vector<Vector>& vectors, const char* what) {
    for (const Vector& vector : vectors)
        expect_finite(std::span(glm::value_ptr(vector), Vector::length()), what);
}

void check_materials(const Scene& scene) {
    const auto image_is_there = [&](const TextureUse& use) {
        expect(use.image >= -1 && use.image < static_cast<int>(scene.images.size()), "no such image");
        for (int i = 0; i < 3; ++i)
            expect_finite(std::span<const float>(glm::value_ptr(use.transform[i]), 2), "a texture transform");
    };
    for (const Material& material : scene.materials) {
        for (const TextureUse* use :
             {&material.base_color_texture, &material.metal.texture, &material.transmission.factor_texture,
              &material.transmission.color_texture, &material.glass.texture})
            image_is_there(*use);
        expect_finite(std::span<const float>(glm::value_ptr(material.base_color), 4), "a base color");
        const float factors[] = {material.alpha_cutoff, material.metal.factor, material.transmission.factor,
                                 material.glass.factor, material.volume.thickness};
        expect_finite(std::span<const float>(factors), "a factor of a material");
    }
}

void check_scene(const Scene& scene) {
    expect_finite(std::span<const double>(glm::value_ptr(scene.origin), 3), "the origin");
    for (const VertexArray& vertices : scene.vertex_arrays) {
        expect_finite_vectors(vertices.positions, "positions");
        expect_finite_vectors(vertices.normals, "normals");
        expect_finite_vectors(vertices.colors, "vertex colors");
        for (const auto& set : vertices.texcoords) {
            expect_finite_vectors(set, "texture coordinates");
            expect(set.empty() || set.size() == vertices.size(), "texture coordinates for other vertices");
        }
        expect(vertices.normals.size() == vertices.size(), "normals for other vertices");
    }
    for (const Primitive& primitive : scene.primitives) {
        expect(primitive.vertices < scene.vertex_arrays.size(), "no such vertices");
        expect(primitive.material < scene.materials.size(), "no such material");
        for (const glm::uvec3& triangle : primitive.triangles)
            for (int c = 0; c < 3; ++c)
                expect(triangle[c] < scene.vertex_arrays[primitive.vertices].size(), "an index is outside");
    }
    check_materials(scene);
    expect_finite(std::span<const float>(receiver_areas(scene)), "areas");
}

void check_layout(const Scene& scene, const LightmapLayout& layout) {
    expect(layout.placements.size() == scene.primitives.size(), "texels for other primitives");
    const std::size_t texels = layout.texels();
    const LightmapLookup lookup(scene, layout);
    const glm::vec2 points[] = {{0, 0}, {1, 0}, {0, 1}, {0.3f, 0.3f}};
    for (std::uint32_t triangle = 0; triangle < scene.triangles(); ++triangle)
        for (const glm::vec2& position : points) {
            if (!lookup.has_texels(triangle))
                continue;
            const BilinearTexels filter = lookup.filter(triangle, position);
            for (const std::uint32_t texel : filter.texels)
                expect(texel < texels, "a filter reads outside of the maps");
            expect_finite(std::span<const double>(filter.weights), "weights of a filter");
        }
}

void check_lightmap(const Scene& scene, const BakedLightmap& lightmap) {
    check_layout(scene, lightmap.layout);
    const std::size_t receivers = lightmap.texels.size();
    expect(receivers > 0 && lightmap.texels.back() < lightmap.layout.texels(), "texels outside of the maps");
    expect(std::ranges::adjacent_find(lightmap.texels, std::greater_equal()) == lightmap.texels.end(),
           "texels are not in ascending order");
    expect(lightmap.areas.size() == receivers && lightmap.baked.transfer.receivers() == receivers,
           "values of other texels");
    expect_finite(std::span<const float>(lightmap.areas), "areas of texels");
    expect_finite(std::span<const float>(lightmap.baked.transfer.vectors), "transfer of texels");
    for (const Edge& seam : lightmap.seams)
        expect(seam.first < seam.second && seam.second < receivers, "a seam of other texels");
}

void check_lightmap(const Scene& scene, const CompressedLightmap& lightmap) {
    check_layout(scene, lightmap.layout);
    const ClusteredTransfer& transfer = lightmap.compressed.transfer;
    expect(transfer.receivers.size() == lightmap.layout.texels(), "words for other texels");
    expect_finite(std::span<const float>(transfer.bases.rows), "bases of texels");
    for (const std::uint16_t cluster : transfer.receivers.cluster_indices())
        expect(cluster < transfer.bases.clusters(), "a texel is in no cluster");
}

/// Evaluates occluders of nodes at positions in and around their boxes.
void check_occluders(std::span<const NodeOccluder> occluders) {
    for (const NodeOccluder& occluder : occluders) {
        const PlacedOccluder where = placed(occluder.volume, glm::mat4(1), 0);
        for (const float at : {0.0f, 0.3f, 1.0f, 1.7f, 40.0f}) {
            const glm::vec3 position =
                glm::mix(occluder.volume.low, occluder.volume.high, glm::vec3(at, 0.5f, 0.1f));
            const float blocked = blocked_cosine(blocked_at(occluder.volume, where, position), {0, 1, 0});
            expect(blocked >= 0 && blocked <= 1, "an occluder blocks more than there is");
        }
    }
}

void check_rigid_parts(const GltfDocument& document, const Scene& scene) {
    std::size_t triangles = 0;
    for (const RigidPart& term : rigid_parts(document, scene))
        triangles += term.scene.triangles();
    expect(triangles == scene.triangles(), "parts have other triangles");
}

/// Evaluates every vertex with its lobes, for any bytes.
void check_lobes_of(const std::optional<StoredLobes>& stored, const Scene& scene) {
    if (!stored)
        return;
    expect(stored->model.vertices() == scene.receivers(), "lobes of other vertices");
    const Light light = constant_light(kMaxLobeOrder, glm::vec3(1));
    std::array<Lobe, kMaxLobes> lobes;
    for (std::size_t v = 0; v < stored->model.vertices(); ++v) {
        stored->model.decode(v, lobes);
        const glm::vec3 radiance = lobe_radiance(lobes, light.coefficients, kMaxLobeOrder);
        expect_finite(std::span(&radiance.x, 3), "light by lobes");
    }
}

} // namespace

WholeModel read_whole(std::span<const std::byte> file, const std::filesystem::path& path) {
    GltfDocument document = parse_gltf(file, path);
    Scene scene = extract_scene(document);
    check_scene(scene);
    check_occluders(read_occluders(document));
    check_rigid_parts(document, scene);
    check_lobes_of(read_lobes(document, scene), scene);
    auto baked = read_transfer(document, scene);
    auto compressed = read_clustered(document, scene);
    if (baked) {
        expect(baked->transfer.receivers() == scene.receivers(), "transfer for other vertices");
        expect_finite(std::span<const float>(baked->transfer.vectors), "transfer");
    }
    if (compressed) {
        expect(compressed->transfer.receivers.size() == scene.receivers(), "weights for other vertices");
        expect_finite(std::span<const float>(compressed->transfer.bases.rows), "bases");
        expect_finite(std::span<const float>(compressed->transfer.receivers.predictors), "predictors");
    }
    auto baked_lightmap = read_lightmap(document, scene);
    std::optional<CompressedLightmap> lightmap;
    if (auto encoded = read_encoded_lightmap(document, scene))
        lightmap = decoded_lightmap(std::move(*encoded));
    if (baked_lightmap)
        check_lightmap(scene, *baked_lightmap);
    if (lightmap)
        check_lightmap(scene, *lightmap);
    return {std::move(document),   std::move(scene),          std::move(baked),
            std::move(compressed), std::move(baked_lightmap), std::move(lightmap)};
}

void expect_finite_light(const ClusteredTransfer& transfer) {
    expect_finite(std::span<const float>(decode(transfer, 1).vectors), "decoded transfer");
    const Light light = constant_light(transfer.bases.layout.order, glm::vec3(1));
    for (const glm::vec3& radiance : exit_radiance(transfer, light, 1))
        expect_finite(std::span<const float>(&radiance.x, 3), "exit radiance");
}

void expect_finite_light(const CompressedLightmap& lightmap) {
    constexpr std::size_t kMaxTexels = 100'000;
    if (lightmap.layout.texels() > kMaxTexels)
        return;
    expect_finite_light(lightmap.compressed.transfer);
    const TextureRelighter relighter(lightmap, TexelFormat::rgb9e5);
    std::vector<glm::vec4> computed(relighter.rows());
    relighter.update_constants(constant_light(relighter.layout().order, glm::vec3(1)), {}, computed);
    for (std::size_t m = 0; m < lightmap.layout.maps.size(); ++m) {
        std::vector<std::byte> texels(relighter.bytes(m));
        relighter.update(m, computed, texels, 1);
    }
}

void use_loaded(std::span<const std::byte> file, const std::filesystem::path& path) {
    Model model = parse_model(file, path);
    check_scene(model.scene);
    if (model.vertices) {
        ClusteredTransfer& transfer = model.vertices->transfer;
        expect(transfer.receivers.size() == model.scene.receivers(), "loaded weights for other vertices");
        add_coordinates(model);
        expect_finite_light(transfer);
        for (const FileInstance& instance : model.instances)
            for (const std::size_t array : instance.stored_arrays)
                expect(array < model.scene.vertex_arrays.size(), "an instance draws no vertices");
        if (!model.instances.empty())
            relit_instances(model.instances, model.scene, transfer);
    }
    if (model.lightmap) {
        const CompressedLightmap lightmap = decoded_lightmap(std::move(*model.lightmap));
        check_lightmap(model.scene, lightmap);
        expect_finite_light(lightmap);
    }
    if (model.volume) {
        const Lighting lighting{constant_light(kMaxOrder, glm::vec3(1))};
        for (const glm::vec3& light : incident_light(*model.volume, lighting, 1))
            expect_finite(std::span<const float>(&light.x, 3), "light of probes");
    }
    check_lobes_of(model.lobes, model.scene);
    check_occluders(model.occluders);
}

} // namespace prt::fuzz
