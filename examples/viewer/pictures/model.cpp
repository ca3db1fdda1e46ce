// Loads models and computes their derived data.

#include "pictures/model.h"

#include "cli/pipeline/model.h"
#include "prt/bake/bake.h"
#include "prt/core/error.h"
#include "runtime/load/mesh_edges.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <bit>

namespace viewer {
namespace {

/// Enough for a picture: one step of 8 bits of occlusion is 0.4 %.
constexpr int kOcclusionRays = 256;

/// Returns an FNV-1a hash of three corners, in their order, one word at a time.
std::uint64_t triangle_hash(const glm::vec3& a, const glm::vec3& b, const glm::vec3& c) {
    std::uint64_t hash = 0xcbf29ce484222325;
    for (const glm::vec3* corner : {&a, &b, &c})
        for (int axis = 0; axis < 3; ++axis)
            hash = (hash ^ std::bit_cast<std::uint32_t>((*corner)[axis] + 0.0f)) * 0x100000001b3;
    hash = (hash ^ hash >> 32) * 0xd6e8feb86659fd93;
    return hash ^ hash >> 32;
}

/// Returns the sum of hashes over triangles and their possible first corners, so that the order of both does
/// not matter.
std::uint64_t surface_id(const prt::Scene& scene) {
    std::uint64_t sum = 0;
    for (const prt::Primitive& primitive : scene.primitives) {
        const std::vector<glm::vec3>& p = scene.vertex_arrays[primitive.vertices].positions;
        for (const glm::uvec3& t : primitive.triangles)
            sum += triangle_hash(p[t.x], p[t.y], p[t.z]) + triangle_hash(p[t.y], p[t.z], p[t.x]) +
                   triangle_hash(p[t.z], p[t.x], p[t.y]);
    }
    return sum;
}

/// Takes the transfer of instances: compressed transfer as it is stored, raw transfer for all vertices.
void take_instances(prt::pipeline::SceneFile& file, LoadedModel& loaded) {
    prt::InstancedModel& instanced = *file.instanced;
    loaded.record = instanced.baked ? instanced.baked->record : instanced.compressed->record;
    if (instanced.baked)
        loaded.raw = std::make_shared<const prt::Transfer>(
            prt::expanded(file.document, file.scene, instanced.stored, instanced.baked->transfer));
    else
        loaded.instanced = std::make_shared<const prt::InstancedModel>(std::move(instanced));
}

} // namespace

std::shared_ptr<const Model> make_model(prt::Scene scene, std::filesystem::path path) {
    auto model = std::make_shared<Model>();
    model->path = std::move(path);
    model->scene = std::move(scene);
    model->areas = prt::receiver_areas(model->scene);
    model->edges = prt::mesh_edges(model->scene);
    model->box = prt::bounds(model->scene);
    model->center = 0.5f * (model->box.low + model->box.high);
    model->radius = std::max(0.5f * glm::distance(model->box.low, model->box.high), 1e-30f);
    model->receivers_id = prt::receivers_id(model->scene);
    model->surface_id = surface_id(model->scene);
    for (prt::Primitive& primitive : model->scene.primitives)
        model->clusters.push_back(
            make_triangle_clusters(primitive, model->scene.vertex_arrays[primitive.vertices]));
    model->trace.emplace(model->scene, prt::load_textures(model->scene, prt::BadTextures::ignore));
    model->trace->rays(); // build it now, not in the first frame
    return model;
}

void LoadedModel::set(std::shared_ptr<const prt::BakedLightmap> baked) {
    raw = {baked, &baked->baked.transfer};
    record = baked->baked.record;
    lightmap.baked = std::move(baked);
}

void LoadedModel::set(std::shared_ptr<const prt::CompressedLightmap> of_all_texels) {
    compressed = {of_all_texels, &of_all_texels->compressed.transfer};
    record = of_all_texels->compressed.record;
    lightmap.compressed = std::move(of_all_texels);
}

LoadedModel load_model(const std::filesystem::path& path) {
    prt::pipeline::ReadingOptions reading;
    reading.shared = prt::pipeline::SharedTransfer::keep;
    reading.leave_out_lobes = true;
    prt::pipeline::SceneFile file = prt::pipeline::load_scene_file(path, reading);
    LoadedModel loaded;
    if (file.instanced) {
        take_instances(file, loaded);
    } else if (file.lightmap && file.baked) {
        loaded.set(std::make_shared<const prt::BakedLightmap>(take_baked_lightmap(file)));
    } else if (file.lightmap) {
        loaded.set(std::make_shared<const prt::CompressedLightmap>(
            prt::CompressedLightmap{std::move(file.lightmap->layout), std::move(*file.compressed)}));
    } else {
        if (const prt::BakeRecord* record = file.record())
            loaded.record = *record;
        if (file.baked)
            loaded.raw = std::make_shared<const prt::Transfer>(std::move(file.baked->transfer));
        if (file.compressed)
            loaded.compressed =
                std::make_shared<const prt::ClusteredTransfer>(std::move(file.compressed->transfer));
    }
    loaded.model = make_model(std::move(file.scene), path);
    return loaded;
}

prt::Picture picture_of(const Model& model, std::span<const glm::vec3> radiance, const prt::Camera& camera,
                        int width, int height) {
    prt::Picture picture;
    picture.scene = &model.scene;
    picture.textures = model.trace->textures();
    picture.radiance = radiance;
    picture.camera = camera;
    picture.width = width;
    picture.height = height;
    picture.samples = 1;
    return picture;
}

std::vector<float> ambient_occlusion(const Model& model, const prt::Progress& progress) {
    prt::BakeOptions options;
    options.order = 1;
    options.rays = kOcclusionRays;
    options.tracer.backend = prt::Backend::cpu; // does not touch the window's OpenGL context
    options.repairs.bad_textures = prt::BadTextures::ignore;
    options.memory.storage = prt::TransferStorage::float32;
    options.lamps.mode = prt::LampMode::none; // ambient occlusion ignores lamps
    const prt::Transfer direct = prt::bake(model.scene, options, progress).baked.transfer;
    // Exit radiance under uniform light of radiance 1 is the open fraction.
    const auto radiance = prt::exit_radiance(direct, prt::constant_light(1, glm::vec3(1)));
    std::vector<float> open;
    for (const glm::vec3& r : radiance)
        open.push_back(r.x);
    return open;
}

prt::Transfer truncated(const prt::Transfer& transfer, int order) {
    if (order >= transfer.layout.order)
        return transfer;
    prt::Transfer result = prt::zero_transfer({order, transfer.layout.terms}, transfer.receivers());
    for (std::size_t p = 0; p < transfer.receivers(); ++p) {
        const float* from = transfer.vector(p).data();
        float* to = result.vector(p).data();
        for (const prt::TransferTerm& term : transfer.layout.terms)
            for (int c = 0; c < term.channels; ++c, from += transfer.layout.columns_of(term))
                to = std::copy_n(from, result.layout.columns_of(term), to);
    }
    return result;
}

} // namespace viewer
