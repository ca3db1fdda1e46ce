// Builds files with lightmaps.

#include "support/lightmap_model.h"

#include "bake/gltf/encode_glb.h"
#include "prt/gltf/transfer_gltf.h"
#include "support/scene_builder.h"

#include <string>

namespace prt::test {
namespace {

/// Calls `write` with the document of `file` and its scene.
template <class Write>
GlbFile written(const GlbFile& file, Write write) {
    const std::string text = file.bytes();
    GltfDocument document = parse_gltf(std::as_bytes(std::span(text)), "floor.glb");
    write(document, extract_scene(document));
    return glb_of(encode_glb(document));
}

} // namespace

GlbFile mapped_floor(int cells) {
    const Scene floor = SceneBuilder().floor(glm::vec3(0), 1, cells).build();
    GlbFile file = scene_file(floor);
    nlohmann::ordered_json& primitives = file.json["meshes"][0]["primitives"];
    for (const float scale : {0.5f, 1.0f}) {
        std::vector<float> uv;
        for (const glm::vec3& p : floor.vertex_arrays[0].positions)
            uv.insert(uv.end(), {scale * (p.x + 1), scale * (p.z + 1) - (scale == 1.0f ? 1.0f : 0.0f)});
        primitives[0]["attributes"][scale == 1.0f ? "TEXCOORD_1" : "TEXCOORD_0"] =
            file.accessor(uv, kFloat, "VEC2", 2);
    }
    const nlohmann::ordered_json again = primitives[0];
    primitives.push_back(again);
    return file;
}

LightmapLayout layout_of_floor(const LightmapSize& first, const LightmapSize& second) {
    LightmapLayout layout{{first, second}, {{0, 0}, {1, 1}}};
    layout.maps[1].repeats = true;
    return layout;
}

BakedLightmap made_up_lightmap(const LightmapLayout& layout, const TransferLayout& transfer,
                               std::mt19937& random) {
    BakedLightmap lightmap{.layout = layout,
                           .texels = {},
                           .areas = {},
                           .seams = {{0, 2}},
                           .baked = {{transfer, {}}, {.rays = 16, .receivers = "0123456789abcdef"}}};
    std::uniform_real_distribution<float> value(0.1f, 1.0f);
    for (std::uint32_t t = 0; t < layout.texels(); ++t)
        if (t % 3 != 1) {
            lightmap.texels.push_back(t);
            lightmap.areas.push_back(value(random));
        }
    Transfer& vectors = lightmap.baked.transfer;
    vectors.vectors.resize(lightmap.texels.size() * vectors.dimension());
    for (float& v : vectors.vectors)
        v = value(random);
    return lightmap;
}

GlbFile with_lightmap(const GlbFile& scene, const BakedLightmap& lightmap) {
    return written(scene, [&](GltfDocument& document, const Scene& of_file) {
        write_lightmap(document, of_file, lightmap);
    });
}

GlbFile with_lightmap(const GlbFile& scene, const CompressedLightmap& lightmap) {
    return written(scene, [&](GltfDocument& document, const Scene& of_file) {
        write_encoded_lightmap(document, of_file, encoded_lightmap(lightmap));
    });
}

std::size_t add_image(GlbFile& file, std::span<const std::byte> png, const char* type) {
    const std::size_t view = file.view(png);
    file.json["images"].push_back({{"bufferView", view}, {"mimeType", type}});
    file.json.erase("buffers"); // its length changed: it is rewritten
    return file.json["images"].size() - 1;
}

} // namespace prt::test
