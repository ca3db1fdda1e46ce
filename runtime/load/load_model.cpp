// Reads a file with compressed transfer in one pass: JSON, views, geometry, transfer.
#include "prt/load/model.h"

#include "prt/core/error.h"
#include "runtime/core/support/file.h"
#include "runtime/core/support/lfs_pointer.h"
#include "runtime/load/accessor.h"
#include "runtime/load/allowance.h"
#include "runtime/load/check_data.h"
#include "runtime/load/check_shape.h"
#include "runtime/load/coded_vertices.h"
#include "runtime/load/deduplicated_meshes.h"
#include "runtime/load/expand_nodes.h"
#include "runtime/load/extensions.h"
#include "runtime/load/fallback.h"
#include "runtime/load/geometry.h"
#include "runtime/load/glb.h"
#include "runtime/load/json_text.h"
#include "runtime/load/light_passing.h"
#include "runtime/load/lobe_transfer.h"
#include "runtime/load/meshopt_views.h"
#include "runtime/load/occluder_nodes.h"
#include "runtime/load/predictors.h"
#include "runtime/load/probe_transfer.h"
#include "runtime/load/shared_instances.h"
#include "runtime/load/supported_extensions.h"
#include "runtime/load/texel_transfer.h"
#include "runtime/load/vertex_transfer.h"

#include <algorithm>
#include <map>
#include <utility>

namespace prt {
namespace {

/// Checks that all data are in the file.
void check_is_complete(const Json& json) {
    if (json.contains("buffers"))
        for (const Json& buffer : json["buffers"])
            if (buffer.contains("uri"))
                throw Error("has a buffer outside the .glb file; write it with prt compress");
    for_each_primitive(json, [](const Json& primitive) {
        if (extension_of(primitive, kDracoExtension))
            throw Error(
                "is compressed with Draco, which loading does not support; write it with prt compress");
    });
}

/// Refers to the bytes of `file`.
GltfData read_data(std::span<const std::byte> file) {
    if (is_lfs_pointer(file))
        throw Error(kLfsRemedy);
    if (!is_glb(file))
        throw Error("is not a .glb file");
    GltfData data;
    const std::string_view text = glb_json(file);
    data.json = parse_json(text);
    data.file_bytes = file.size();
    remove_nulls(data.json);
    use_ext_meshopt(data.json);
    check_shape(data.json, text.size());
    check_required_extensions(data.json);
    check_is_complete(data.json);
    data.model = read_model(data.json);
    data.model.buffers.resize(data.json.contains("buffers") ? data.json["buffers"].size() : 0);
    if (!data.model.buffers.empty())
        data.model.buffers[0].outside = glb_binary(file);
    decompress_views(data);
    check_data(data);
    decode_vertices(data);
    set_fallback_aside(data);
    return data;
}

/// Adds the vertex arrays that each instance draws.
std::vector<FileInstance> placed_instances(std::vector<MeshInstance> instances, const Scene& scene,
                                           std::size_t file_bytes) {
    std::map<int, std::vector<std::size_t>> arrays_of_mesh;
    for (const Primitive& primitive : scene.primitives) {
        std::vector<std::size_t>& arrays = arrays_of_mesh[primitive.mesh];
        if (std::ranges::find(arrays, primitive.vertices) == arrays.end())
            arrays.push_back(primitive.vertices);
    }
    double bytes = 0;
    for (const MeshInstance& one : instances)
        bytes +=
            static_cast<double>(sizeof(FileInstance) + arrays_of_mesh[one.mesh].size() * sizeof(std::size_t));
    check_allowed(bytes, file_bytes, "its instances");
    std::vector<FileInstance> placed;
    for (auto& [instance, mesh] : instances) {
        instance.stored_arrays = arrays_of_mesh[mesh];
        if (instance.stored_arrays.empty())
            throw Error("node " + std::to_string(instance.node) + " draws a mesh without triangles");
        placed.push_back(std::move(instance));
    }
    return placed;
}

std::span<const std::byte> image_bytes(const GltfData& data, std::size_t image) {
    const Json& json = data.json["images"].at(image);
    if (!json.contains("bufferView"))
        throw Error("image " + std::to_string(image) + " of its lightmap is not in the file");
    return buffer_view_bytes(data.model, json["bufferView"].get<int>());
}

Model read_contents(GltfData& data) {
    Model model;
    std::vector<MeshInstance> instances;
    expand_instances(data);
    if (extension_of(data.json, kInstancesExtension)) {
        instances = mesh_instances(data);
        deduplicate_meshes(data);
    }
    UnitRange range;
    model.scene = extract_geometry(data, range).scene;
    model.instances = placed_instances(std::move(instances), model.scene, data.file_bytes);
    model.vertices = read_clustered(data, model.scene);
    if (model.vertices) {
        mark_media(model.scene, model.vertices->record);
        check_instance_lamps(model.vertices->transfer.bases.layout, model.instances);
    }
    model.lightmap = read_encoded_lightmap(data, model.scene,
                                           data.json.contains("images") ? data.json["images"].size() : 0,
                                           [&](std::size_t image) { return image_bytes(data, image); });
    model.volume = read_compressed_volume(data, model.scene);
    model.lobes = read_lobes(data, model.scene);
    model.occluders = read_occluders(data);
    return model;
}

} // namespace

Model parse_model(std::span<const std::byte> file, const std::filesystem::path& name) {
    try {
        GltfData data = read_data(file);
        return read_contents(data);
    } catch (const std::exception& error) { // errors of prtkit, the standard library and the JSON library
        throw Error(name.string() + ": " + in_plain_words(error));
    }
}

void add_coordinates(Model& model) {
    if (model.vertices)
        model.vertices->transfer.receivers.predictors =
            predictor_coordinates(model.scene, model.vertices->transfer.bases.predictors);
}

Model load_model(const std::filesystem::path& path) {
    return parse_model(read_file(path), path);
}

} // namespace prt
