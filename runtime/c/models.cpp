// The C interface: models written by prt compress.

#include "runtime/c/model.h"

#include "prt/shader/shader_source.h"
#include "runtime/core/support/counted.h"
#include "runtime/load/predictors.h"

#include <glm/gtc/type_ptr.hpp>

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <span>
#include <string>

const prt::ClusteredTransfer& prt_model::transfer_for_cpu() const {
    std::call_once(has_coordinates, [&] {
        transfer.receivers.predictors = prt::predictor_coordinates(scene, transfer.bases.predictors);
    });
    return transfer;
}

prt::ConstantSource prt::c::source_of(int constants) {
    if (constants < PRT_CONSTANTS_IN_BUFFER || constants > PRT_CONSTANTS_IN_TEXTURE)
        throw Error("the kind of storage for constants is unknown");
    return static_cast<ConstantSource>(constants);
}

namespace {

using namespace prt::c;
using prt::Error;

static_assert(static_cast<int>(prt::ConstantSource::texture) == PRT_CONSTANTS_IN_TEXTURE);
static_assert(sizeof(prt::ClusterLayout) == 4 * sizeof(std::uint32_t) &&
              sizeof(glm::uvec3) == 3 * sizeof(std::uint32_t));

prt_model* make_model(prt::Model model, const std::string& name) {
    if (!model.vertices)
        throw Error(name + ": contains no compressed transfer; run prt compress first");
    std::erase_if(model.scene.primitives, [&](const prt::Primitive& primitive) {
        return model.scene.vertex_arrays[primitive.vertices].lobes;
    });
    auto instances = shared_instances(model);
    prt::ClusteredTransfer& transfer = model.vertices->transfer;
    prt::ClusterLighting relighter(transfer);
    auto layouts = prt::cluster_layouts(transfer.bases);
    prt::free_rows(transfer);
    return new prt_model{std::move(model.scene), std::move(transfer), std::move(relighter),
                         std::move(layouts), std::move(instances)};
}

} // namespace

extern "C" {

prt_status prt_model_load(const char* path, prt_model** model, prt_message* message) {
    return guarded(message, [&] {
        check_pointers(path, model);
        *model = nullptr;
        as_file([&] { *model = make_model(prt::load_model(path), path); });
    });
}

prt_status prt_model_load_memory(const void* bytes, size_t size, prt_model** model, prt_message* message) {
    return guarded(message, [&] {
        check_pointers(bytes, model);
        *model = nullptr;
        const std::span file(static_cast<const std::byte*>(bytes), size);
        as_file([&] { *model = make_model(prt::parse_model(file, "memory"), "memory"); });
    });
}

void prt_model_destroy(prt_model* model) {
    delete model;
}

prt_status prt_model_get_info(const prt_model* model, prt_model_info* out, prt_message* message) {
    return guarded(message, [&] {
        check_pointers(model, out);
        const prt::ClusteredReceivers& receivers = model->transfer.receivers;
        *out = {};
        out->order = model->relighter.order();
        out->channels = model->relighter.layout().channels();
        out->has_direct_term = model->relighter.layout().has(prt::TermKind::direct);
        out->receivers = receivers.size();
        out->clusters = model->layouts.size();
        out->rows = model->relighter.rows();
        out->format = receivers.format == prt::WeightFormat::packed ? PRT_PACKED : PRT_FLOAT32;
        out->stride = receivers.stride();
        out->weights = receivers.weights.data();
        out->cluster_of = receivers.clusters.empty() ? nullptr : receivers.clusters.data();
        out->cluster_table = reinterpret_cast<const std::uint32_t*>(model->layouts.data());
        out->meshes = model->scene.primitives.size();
    });
}

prt_status prt_model_get_vertex_inputs(const prt_model* model, prt_vertex_inputs* out, prt_message* message) {
    return guarded(message, [&] {
        check_pointers(model, out);
        *out = {};
        for (const prt::Predictor& predictor : model->transfer.bases.predictors) {
            if (predictor.kind == prt::PredictorKind::normal) {
                out->normals = 1;
                continue;
            }
            out->positions = 1;
            std::copy_n(glm::value_ptr(predictor.origin), 3, out->predictor_origin);
        }
        std::copy_n(glm::value_ptr(model->scene.origin), 3, out->origin);
    });
}

prt_status prt_model_count_lamps(const prt_model* model, size_t* lamps, prt_message* message) {
    return guarded(message, [&] {
        check_pointers(model, lamps);
        *lamps = model->relighter.layout().lamps();
    });
}

prt_status prt_model_lamp_name(const prt_model* model, size_t lamp, const char** name, prt_message* message) {
    return guarded(message, [&] {
        check_pointers(model, name);
        const std::span<const prt::TransferTerm> lamps = model->relighter.layout().lamp_terms();
        if (lamp >= lamps.size())
            throw Error("the model has only " + prt::counted(lamps.size(), "lamp"));
        *name = lamps[lamp].name.c_str();
    });
}

prt_status prt_model_get_mesh(const prt_model* model, size_t mesh, prt_mesh* out, prt_message* message) {
    return guarded(message, [&] {
        check_pointers(model, out);
        if (mesh >= model->scene.primitives.size())
            throw Error("the model has only " +
                        prt::counted(model->scene.primitives.size(), "mesh", "meshes"));
        const prt::Primitive& primitive = model->scene.primitives[mesh];
        const prt::VertexArray& vertices = model->scene.vertex_arrays[primitive.vertices];
        *out = {};
        out->vertices = vertices.size();
        out->first_receiver = vertices.first_receiver;
        out->positions = reinterpret_cast<const float*>(vertices.positions.data());
        out->normals = reinterpret_cast<const float*>(vertices.normals.data());
        if (!vertices.texcoords.empty() && !vertices.texcoords[0].empty())
            out->texcoords = reinterpret_cast<const float*>(vertices.texcoords[0].data());
        out->indices = 3 * primitive.triangles.size();
        out->index = reinterpret_cast<const std::uint32_t*>(primitive.triangles.data());
        const glm::vec4 color = model->scene.materials[primitive.material].base_color;
        std::copy_n(glm::value_ptr(color), 4, out->base_color);
    });
}

prt_status prt_model_update_constants(const prt_model* model, int order, const float* light, float* constants,
                                      prt_message* message) {
    return prt_model_update_constants_separate(model, order, light, nullptr, nullptr, constants, message);
}

prt_status prt_model_update_constants_separate(const prt_model* model, int order, const float* sky,
                                               const float* suns, const float* lamps, float* constants,
                                               prt_message* message) {
    return guarded(message, [&] {
        check_pointers(model, sky, constants);
        const std::size_t rows = model->relighter.rows();
        model->relighter.update(lighting_of({order, sky, suns, lamps}, model->relighter.layout().lamps()),
                                {reinterpret_cast<glm::vec4*>(constants), rows});
        if (!within(kMaxConstant, constants, 4 * rows))
            throw Error("the light is too bright for the model: constants exceed 1e30");
    });
}

prt_status prt_model_evaluate(const prt_model* model, const float* constants, float* radiance,
                              prt_message* message) {
    return guarded(message, [&] {
        check_pointers(model, constants, radiance);
        if (!within(kMaxConstant, constants, 4 * model->relighter.rows()))
            throw Error("constants must be finite and at most 1e30");
        prt::evaluate(model->transfer_for_cpu(),
                      {reinterpret_cast<const glm::vec4*>(constants), model->relighter.rows()},
                      {colors(radiance), model->transfer.receivers.size()});
    });
}

prt_status prt_model_shader(const prt_model* model, int language, int constants, char* source, size_t* size,
                            prt_message* message) {
    return guarded(message, [&] {
        check_pointers(model, size);
        write_text(prt::relight_shader(model->transfer, source_of(constants), language_of(language)), source,
                   size);
    });
}

} // extern "C"
