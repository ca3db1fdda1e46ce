#include "pictures/model.h"

#include "prt/bake.h"

#include <glm/geometric.hpp>

#include <algorithm>

namespace viewer {
namespace {

/// Enough for a picture: 8 bits of occlusion are 0.4 %.
constexpr int kOcclusionRays = 256;

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
    for (prt::Primitive& primitive : model->scene.primitives)
        model->clusters.push_back(
            make_triangle_clusters(primitive, model->scene.vertex_arrays[primitive.vertices]));
    model->trace.emplace(model->scene, prt::load_textures(model->scene, prt::BadTextures::ignore));
    model->trace->rays(); // now rather than in the first frame
    return model;
}

LoadedModel load_model(const std::filesystem::path& path) {
    const prt::GltfDocument document = prt::load_gltf(path);
    prt::Scene scene = prt::extract_scene(document);
    LoadedModel loaded;
    if (auto baked = prt::read_transfer(document, scene)) {
        loaded.raw = std::make_shared<const prt::Transfer>(std::move(baked->transfer));
        loaded.record = baked->record;
    }
    if (auto compressed = prt::read_clustered(document, scene)) {
        loaded.compressed = std::make_shared<const prt::ClusteredTransfer>(std::move(compressed->transfer));
        loaded.record = compressed->record;
    }
    loaded.model = make_model(std::move(scene), path);
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
    options.tracer.backend = prt::Backend::cpu; // beside the window's own context
    options.repairs.bad_textures = prt::BadTextures::ignore;
    options.memory.storage = prt::TransferStorage::float32;
    options.lamps.mode = prt::LampMode::none; // how open a place is, whatever shines there
    const prt::Transfer direct = prt::bake(model.scene, options, progress).baked.transfer;
    // R under uniform light of radiance 1.
    const auto radiance = prt::exit_radiance(direct, prt::constant_light(1, glm::vec3(1)));
    std::vector<float> open;
    for (const glm::vec3& r : radiance)
        open.push_back(r.x);
    return open;
}

prt::Transfer truncated(const prt::Transfer& transfer, int order) {
    if (order >= transfer.layout.order)
        return transfer;
    prt::Transfer result = prt::zero_transfer({order, transfer.layout.parts}, transfer.receivers());
    for (std::size_t p = 0; p < transfer.receivers(); ++p) {
        const float* from = transfer.vector(p).data();
        float* to = result.vector(p).data();
        for (const prt::TransferPart& part : transfer.layout.parts)
            for (int c = 0; c < part.channels; ++c, from += transfer.layout.columns_of(part))
                to = std::copy_n(from, result.layout.columns_of(part), to);
    }
    return result;
}

} // namespace viewer
