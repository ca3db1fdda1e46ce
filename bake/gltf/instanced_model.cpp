// Reads a file in two forms: with one node per instance, and with meshes as their transfer is stored.
#include "bake/gltf/contents.h"
#include "bake/gltf/encode_glb.h"
#include "bake/gltf/write_set.h"
#include "prt/core/error.h"
#include "prt/gltf/transfer_gltf.h"
#include "runtime/load/shared_instances.h"

namespace prt {

InstancedModel read_instanced(const GltfDocument& document, const Scene& scene,
                              const std::filesystem::path& path) {
    const GltfContents& contents = document.contents();
    const GltfDocument separate = parse_gltf(encode_glb(document), path,
                                             {.instancing = Instancing::separate,
                                              .leave_out_lobes = contents.leave_out_lobes,
                                              .scene_limit = contents.scene_limit});
    InstancedModel model;
    model.stored = extract_scene(separate);
    model.baked = read_transfer(separate, model.stored);
    model.compressed = read_clustered(separate, model.stored);
    if (!model.baked && !model.compressed)
        throw Error(path.string() +
                    ": its instances share transfer, but the file contains no transfer; run prt bake again");
    model.instances = read_instances(document, scene, model.stored);
    const TransferLayout& layout =
        model.compressed ? model.compressed->transfer.bases.layout : model.baked->transfer.layout;
    named(document, [&](const GltfContents&) { check_instance_lamps(layout, model.instances); });
    return model;
}

std::vector<RelitInstance> relit_instances(const InstancedModel& model, const glm::dvec3& seen_from) {
    return relit_instances(model.instances, model.stored, model.compressed->transfer, seen_from);
}

} // namespace prt
