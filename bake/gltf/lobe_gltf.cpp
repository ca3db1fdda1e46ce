// Writes zonal lobes in glTF files: PRTKIT_lobes of docs/format.md.

#include "prt/gltf/transfer_gltf.h"

#include "bake/gltf/make_meshes_unique.h"
#include "bake/gltf/write_set.h"
#include "runtime/load/lobe_transfer.h"

#include <string>

namespace prt {
namespace {

/// Writes one lobe of the vertices of an array.
std::size_t write_lobe_words(GltfContents& contents, const LobeModel& model, const VertexArray& vertices,
                             std::size_t lobe) {
    std::vector<LobeWord> words(vertices.size());
    for (std::size_t v = 0; v < words.size(); ++v)
        words[v] = model.words[(vertices.first_receiver + v) * model.lobes + lobe];
    return contents.add_accessor(
        {{"bufferView", contents.add_buffer_view(std::as_bytes(std::span(words)), sizeof(LobeWord), true)},
         {"componentType", kUnsignedByte},
         {"count", words.size()},
         {"type", "VEC4"}});
}

Json profiles_json(GltfContents& contents, const LobeModel& model) {
    std::vector<float> gains;
    for (const LobeProfile& profile : model.profiles)
        gains.insert(gains.end(), profile.begin(), profile.begin() + model.order);
    Json json = write_float_view(contents, gains);
    json["count"] = model.profiles.size();
    return json;
}

} // namespace

void write_lobes(GltfDocument& document, const Scene& scene, const StoredLobes& lobes) {
    check_lobes(lobes.model);
    named(document, [&](GltfContents& contents) {
        contents.remove_lobes();
        const std::vector<Json*> primitives =
            meshes_without_transfer(contents, scene, ChangedMeshes::with_lobes);
        std::vector<Json> attributes;
        for (const VertexArray& vertices : scene.vertex_arrays) {
            Json& added = attributes.emplace_back(Json::object());
            for (std::size_t k = 0; vertices.lobes && k < lobes.model.lobes; ++k)
                added[lobe_name(k)] = write_lobe_words(contents, lobes.model, vertices, k);
        }
        for (std::size_t i = 0; i < primitives.size(); ++i)
            (*primitives[i])["attributes"].update(attributes[scene.primitives[i].vertices]);
        extensions_of(contents.json)[kLobeExtension] = {{"version", kLobeVersion},
                                                        {"order", lobes.model.order},
                                                        {"lobes", lobes.model.lobes},
                                                        {"profiles", profiles_json(contents, lobes.model)},
                                                        {"bake",
                                                         {{"poses", lobes.record.poses},
                                                          {"raysPerReceiver", lobes.record.rays},
                                                          {"bounces", lobes.record.bounces},
                                                          {"seed", lobes.record.seed}}}};
        contents.use_extension(kLobeExtension);
    });
}

bool has_lobes(const GltfDocument& document) {
    return extension_of(document.contents().json, kLobeExtension) != nullptr;
}

std::optional<StoredLobes> read_lobes(const GltfDocument& document, const Scene& scene) {
    return named(document, [&](const GltfContents& contents) { return read_lobes(contents, scene); });
}

} // namespace prt
