// The C interface: instances that share transfer.

#include "runtime/c/model.h"

#include "prt/shader/shader_source.h"
#include "runtime/support/counted.h"

#include <glm/gtc/matrix_transform.hpp>
#include <glm/gtc/type_ptr.hpp>
#include <glm/matrix.hpp>

#include <algorithm>

namespace {

using namespace prt::c;
using prt::Error;

const prt_shared_instances& instances_of(const prt_model& model) {
    if (!model.instances)
        throw Error("the model has no instances that share transfer");
    return *model.instances;
}

/// Sorts instances by mesh.
void sort_by_mesh(std::vector<prt::FileInstance>& instances) {
    std::ranges::stable_sort(
        instances, {}, [](const prt::FileInstance& instance) { return instance.stored_arrays.front(); });
}

/// Returns the range of instances that draw each primitive of the scene; an empty range means it is drawn
/// once.
std::vector<prt_shared_instances::Range> ranges_of(const prt::Model& model) {
    std::vector<prt_shared_instances::Range> of_arrays(model.scene.vertex_arrays.size()), result;
    for (std::size_t i = 0; i < model.instances.size(); ++i)
        for (const std::size_t array : model.instances[i].stored_arrays) {
            if (of_arrays[array].count++ == 0)
                of_arrays[array].first = i;
        }
    for (const prt::Primitive& primitive : model.scene.primitives)
        result.push_back(of_arrays[primitive.vertices]);
    return result;
}

} // namespace

std::optional<prt_shared_instances> prt::c::shared_instances(Model& model) {
    if (model.instances.empty())
        return std::nullopt;
    sort_by_mesh(model.instances);
    const ClusteredTransfer& transfer = model.vertices->transfer;
    InstanceRelighter relighter(transfer, relit_instances(model.instances, model.scene, transfer));
    std::vector<glm::vec4> worlds;
    for (const FileInstance& instance : model.instances) {
        const glm::mat4 rotated(glm::transpose(glm::translate(instance.world, model.scene.origin)));
        worlds.insert(worlds.end(), {rotated[0], rotated[1], rotated[2]});
    }
    std::vector<glm::vec4> tables = relighter.table();
    return prt_shared_instances{std::move(relighter), std::move(worlds), std::move(tables), ranges_of(model)};
}

extern "C" {

prt_status prt_instances_get_info(const prt_model* model, prt_instances_info* out, prt_message* message) {
    return guarded(message, [&] {
        check_pointers(model, out);
        *out = {};
        if (!model->instances)
            return;
        const prt_shared_instances& instances = *model->instances;
        out->count = instances.tables.size() / 2;
        out->constants = instances.relighter.size();
        out->worlds = glm::value_ptr(instances.worlds.front());
        out->tables = glm::value_ptr(instances.tables.front());
        out->max_degrees = instances.relighter.max_degrees();
    });
}

prt_status prt_instances_of_mesh(const prt_model* model, size_t mesh, size_t* first, size_t* count,
                                 prt_message* message) {
    return guarded(message, [&] {
        check_pointers(model, first, count);
        *first = *count = 0;
        if (!model->instances)
            return;
        const auto& of_meshes = model->instances->of_meshes;
        if (mesh >= of_meshes.size())
            throw Error("the model has only " + prt::counted(of_meshes.size(), "mesh", "meshes"));
        *first = of_meshes[mesh].first;
        *count = of_meshes[mesh].count;
    });
}

prt_status prt_instances_update_constants(const prt_model* model, const prt_lighting* lighting, int threads,
                                          float* constants, prt_message* message) {
    return guarded(message, [&] {
        check_pointers(model, lighting, constants);
        check_pointers(lighting->sky);
        const prt::InstanceRelighter& relighter = instances_of(*model).relighter;
        const prt::LightingView light =
            lighting_of({lighting->order, lighting->sky, lighting->suns, lighting->lamps},
                        model->relighter.layout().lamps());
        prt::Lighting copy{{lighting->order, {light.sky.begin(), light.sky.end()}}};
        if (lighting->suns)
            copy.suns = prt::Light{lighting->order, {light.suns.begin(), light.suns.end()}};
        copy.lamps.assign(light.lamps.begin(), light.lamps.end());
        relighter.update(copy, {reinterpret_cast<glm::vec4*>(constants), relighter.size()}, threads);
        if (!within(kMaxConstant, constants, 4 * relighter.size()))
            throw Error("the light is too bright for the model: constants exceed 1e30");
    });
}

prt_status prt_instances_shader(const prt_model* model, int language, int constants, char* source,
                                size_t* size, prt_message* message) {
    return guarded(message, [&] {
        check_pointers(model, size);
        instances_of(*model);
        write_text(prt::instance_shader(model->transfer, source_of(constants), language_of(language)), source,
                   size);
    });
}

} // extern "C"
