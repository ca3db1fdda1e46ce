// Reads a file in two forms: with one node per instance, and with meshes as their transfer is stored.
#include "prt/core/error.h"
#include "prt/gltf/transfer_gltf.h"
#include "runtime/scene/gltf/contents.h"
#include "runtime/scene/gltf/encode_glb.h"

namespace prt {

InstancedModel read_instanced(const GltfDocument& document, const Scene& scene,
                              const std::filesystem::path& path) {
    const GltfDocument separate =
        parse_gltf(encode_glb(document), path,
                   {.instancing = Instancing::separate, .scene_limit = document.contents().scene_limit});
    InstancedModel model;
    model.stored = extract_scene(separate);
    model.baked = read_transfer(separate, model.stored);
    model.compressed = read_clustered(separate, model.stored);
    if (!model.baked && !model.compressed)
        throw Error(path.string() +
                    ": its instances share transfer, but the file contains no transfer; run prt bake again");
    model.instances = read_instances(document, scene, model.stored);
    return model;
}

std::vector<RelitInstance> relit_instances(const InstancedModel& model, const glm::dvec3& seen_from) {
    return relit_instances(model.instances, model.stored, model.compressed->transfer, seen_from);
}

std::vector<RelitInstance> relit_instances(std::span<const FileInstance> instances, const Scene& stored,
                                           const ClusteredTransfer& transfer, const glm::dvec3& seen_from) {
    std::vector<ConstantRows> of_arrays;
    for (const VertexArray& vertices : stored.vertex_arrays)
        of_arrays.push_back(rows_of(transfer, vertices.first_receiver, vertices.size()));
    std::vector<RelitInstance> computed;
    for (const FileInstance& instance : instances) {
        RelitInstance one{instance.placed, {}};
        one.placed.box.middle = glm::vec3(glm::dvec3(one.placed.box.middle) - (stored.origin - seen_from));
        for (const std::size_t array : instance.stored_arrays)
            one.rows = joined(one.rows, of_arrays[array]);
        computed.push_back(one);
    }
    return computed;
}

} // namespace prt
