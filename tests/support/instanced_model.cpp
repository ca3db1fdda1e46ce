// Builds a file whose instances share transfer.

#include "support/instanced_model.h"

#include "bake/gltf/encode_glb.h"
#include "prt/gltf/gltf.h"
#include "prt/gltf/transfer_gltf.h"

#include <random>
#include <string>

namespace prt::test {

GlbFile instanced_triangles() {
    GlbFile file = triangle_file();
    file.json["nodes"] = nlohmann::ordered_json::array();
    for (const float x : {0.0f, 2.0f, 5.0f}) // rotated by 45 degrees, one of the yaw bins
        file.json["nodes"].push_back(
            {{"mesh", 0}, {"translation", {x, 1, 0}}, {"rotation", {0, 0.38268343, 0, 0.92387953}}});
    file.json["nodes"].push_back({{"mesh", 1}, {"translation", {0, 0, 9}}});
    file.json["materials"] = {{{"doubleSided", true}}};
    file.json["meshes"][0]["primitives"][0]["material"] = 0;
    file.json["meshes"].push_back(file.json["meshes"][0]);
    file.json["scenes"] = {{{"nodes", {0, 1, 2, 3}}}};
    const std::string text = file.bytes();
    const GltfDocument document = parse_gltf(std::as_bytes(std::span(text)), "scene.glb");
    const SharedMeshes meshes = shared_meshes(document, extract_scene(document));
    SharedDocument shared = with_shared_meshes(document, meshes.meshes);
    const Scene stored = extract_scene(shared.document);

    std::mt19937 random(5);
    std::normal_distribution<float> normal;
    ClusteredTransfer transfer;
    transfer.bases.layout = {
        3, {{TermKind::direct, 1}, {TermKind::indirect, 3}, {TermKind::lamp, 3, "Lantern"}}};
    transfer.bases.components = {1, 2};
    for (std::size_t i = 0; i < 5 * transfer.bases.dimension(); ++i)
        transfer.bases.rows.push_back(normal(random));
    transfer.receivers.format = WeightFormat::float32;
    transfer.receivers.components = 4;
    std::vector<float> weights;
    for (std::size_t p = 0; p < stored.receivers(); ++p) {
        transfer.receivers.clusters.push_back(p < 3 ? 0 : 1);
        for (int j = 0; j < 4; ++j)
            weights.push_back(j < (p < 3 ? 1 : 2) ? normal(random) : 0);
    }
    const auto bytes = std::as_bytes(std::span(weights));
    transfer.receivers.weights.assign(bytes.begin(), bytes.end());
    write_clustered(shared.document, stored, {std::move(transfer), {}});
    StoredInstances instances;
    instances.boxes = {{glm::vec3(0.5f), glm::vec3(1)}};
    for (int i = 0; i < 3; ++i) {
        std::array<float, kInstanceNumbers> numbers;
        for (float& number : numbers)
            number = normal(random);
        instances.factors.push_back(factors_of(numbers));
        InstanceLampLight& light = instances.lamps.emplace_back().emplace_back();
        for (auto& colors : light.functions)
            for (glm::vec4& color : colors)
                for (int a = 0; a < 4; ++a)
                    color[a] = normal(random);
    }
    write_instances(shared.document, instances);
    return glb_of(encode_glb(shared.document));
}

} // namespace prt::test
