// The C interface: volumes, and instances that share transfer.

#include "runtime/c/model.h"

#include "prt/core/texture_relighter.h"
#include "prt/load/model.h"
#include "prt/shader/shader_source.h"
#include "runtime/c/boundary.h"
#include "runtime/core/support/counted.h"

#include <glm/geometric.hpp>
#include <glm/gtc/matrix_transform.hpp>
#include <glm/gtc/type_ptr.hpp>
#include <glm/matrix.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <span>
#include <string>

struct prt_volume {
    glm::dvec3 origin;
    prt::CompressedVolume volume;
    prt::VolumeLookup lookup;
    prt::TextureRelighter relighter; // refers to the volume
    std::vector<std::uint32_t> visibility, index;

    prt_volume(const glm::dvec3& of_scene, prt::CompressedVolume&& of_file)
        : origin(of_scene), volume(std::move(of_file)), lookup(volume.grid, volume.visibility),
          relighter(volume),
          visibility(prt::visibility_texels(volume.grid, lookup.probes(), volume.visibility)),
          index(prt::index_texels(volume.grid, lookup.index())) {}

    std::size_t coefficients() const { return relighter.atlas().coefficients(); }
};

namespace {

using namespace prt::c;
using prt::Error;

prt_volume* make_volume(prt::Model model, const std::string& name) {
    if (!model.volume)
        throw Error(name + ": contains no compressed volume; run prt bake --volume and prt compress first");
    return new prt_volume(model.scene.origin, std::move(*model.volume));
}

std::span<const glm::vec4> checked_constants(const prt_volume& volume, const float* constants) {
    if (!within(kMaxConstant, constants, 4 * volume.relighter.rows()))
        throw Error("constants must be finite and at most 1e30");
    return {reinterpret_cast<const glm::vec4*>(constants), volume.relighter.rows()};
}

/// Interpolates the coefficients at `point`.
void mix(const prt_volume& volume, const float* incident, const prt_volume_position& point,
         std::span<glm::vec3> light) {
    if (!finite(point.position, 3) || !finite(point.normal, 3))
        throw Error("a position and a normal must be finite");
    const std::size_t n = volume.coefficients();
    const prt::VolumeCorners corners =
        volume.lookup.find(glm::make_vec3(point.position), glm::make_vec3(point.normal));
    for (const std::uint32_t probe : corners.probes)
        if (!within(kMaxConstant, incident + 3 * n * probe, 3 * n))
            throw Error("the light of probes must be finite and at most 1e30");
    prt::mix_incident(corners, light_colors(incident, n * volume.relighter.units(0)), light);
}

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

prt_status prt_volume_load(const char* path, prt_volume** volume, prt_message* message) {
    return guarded(message, [&] {
        check_pointers(path, volume);
        *volume = nullptr;
        as_file([&] { *volume = make_volume(prt::load_model(path), path); });
    });
}

prt_status prt_volume_load_memory(const void* bytes, size_t size, prt_volume** volume, prt_message* message) {
    return guarded(message, [&] {
        check_pointers(bytes, volume);
        *volume = nullptr;
        const std::span file(static_cast<const std::byte*>(bytes), size);
        as_file([&] { *volume = make_volume(prt::parse_model(file, "memory"), "memory"); });
    });
}

void prt_volume_destroy(prt_volume* volume) {
    delete volume;
}

prt_status prt_volume_get_info(const prt_volume* volume, prt_volume_info* out, prt_message* message) {
    return guarded(message, [&] {
        check_pointers(volume, out);
        const prt::TransferLayout& layout = volume->relighter.layout();
        *out = {};
        out->order = layout.order;
        out->incident_order = volume->volume.order;
        out->probes = volume->relighter.units(0);
        out->rows = volume->relighter.rows();
        out->lamps = layout.lamps();
        out->has_direct_term = layout.has(prt::TermKind::direct);
        std::copy_n(glm::value_ptr(volume->volume.grid.origin), 3, out->corner);
        out->spacing = volume->volume.grid.spacing;
        std::copy_n(glm::value_ptr(volume->origin), 3, out->origin);
    });
}

prt_status prt_volume_get_textures(const prt_volume* volume, prt_volume_textures* out, prt_message* message) {
    return guarded(message, [&] {
        check_pointers(volume, out);
        *out = {};
        const prt::VolumeAtlas& atlas = volume->relighter.atlas();
        const glm::ivec3 light = atlas.light_texels(), visibility = atlas.visibility_texels();
        std::copy_n(glm::value_ptr(light), 3, out->light);
        std::copy_n(glm::value_ptr(visibility), 3, out->visibility);
        std::copy_n(glm::value_ptr(volume->volume.grid.size), 3, out->index);
        out->light_bytes = volume->relighter.bytes(0);
        out->visibility_texels = volume->visibility.data();
        out->index_texels = volume->index.data();
    });
}

prt_status prt_volume_update_constants(const prt_volume* volume, const prt_lighting* lighting,
                                       float* constants, prt_message* message) {
    return guarded(message, [&] {
        check_pointers(volume, lighting, constants);
        check_pointers(lighting->sky);
        std::optional<glm::vec3> sun;
        if (lighting->sun) {
            const glm::dvec3 towards(lighting->sun[0], lighting->sun[1], lighting->sun[2]);
            const double length = glm::length(towards);
            if (!(length > 0 && std::isfinite(length)))
                throw Error("the direction of a sun must be finite and not 0");
            sun = glm::vec3(towards / length);
        }
        const std::size_t rows = volume->relighter.rows();
        volume->relighter.update_constants(
            lighting_of({lighting->order, lighting->sky, lighting->suns, lighting->lamps},
                        volume->relighter.layout().lamps()),
            sun, {reinterpret_cast<glm::vec4*>(constants), rows});
        if (!within(kMaxConstant, constants, 4 * rows))
            throw Error("the light is too bright for the volume: constants exceed 1e30");
    });
}

prt_status prt_volume_update_light(const prt_volume* volume, const float* constants, size_t first,
                                   size_t last, void* texels, prt_message* message) {
    return guarded(message, [&] {
        check_pointers(volume, constants, texels);
        if (first > last || last > volume->relighter.units(0))
            throw Error("the range of probes is invalid: the volume has " +
                        prt::counted(volume->relighter.units(0), "probe"));
        volume->relighter.update_range(0, checked_constants(*volume, constants), first, last,
                                       {static_cast<std::byte*>(texels), volume->relighter.bytes(0)});
    });
}

prt_status prt_volume_evaluate(const prt_volume* volume, const float* constants, float* incident,
                               prt_message* message) {
    return guarded(message, [&] {
        check_pointers(volume, constants, incident);
        prt::evaluate(volume->volume.compressed.transfer, checked_constants(*volume, constants),
                      {colors(incident), volume->relighter.units(0) * volume->coefficients()});
    });
}

prt_status prt_volume_incident(const prt_volume* volume, const float* incident,
                               const prt_volume_position* point, float* light, prt_message* message) {
    return guarded(message, [&] {
        check_pointers(volume, incident, point, light);
        mix(*volume, incident, *point, {colors(light), volume->coefficients()});
    });
}

prt_status prt_volume_irradiance(const prt_volume* volume, const float* incident,
                                 const prt_volume_position* point, float irradiance[3],
                                 prt_message* message) {
    return guarded(message, [&] {
        check_pointers(volume, incident, point, irradiance);
        std::array<glm::vec3, prt::kMaxIncidentOrder * prt::kMaxIncidentOrder> mixed;
        const std::span<glm::vec3> light = std::span(mixed).first(volume->coefficients());
        mix(*volume, incident, *point, light);
        const double length = glm::length(glm::dvec3(glm::make_vec3(point->normal)));
        if (!(length > 0.99 && length < 1.01))
            throw Error("irradiance needs a surface normal of length 1");
        const glm::vec3 found = prt::irradiance_of(light, glm::make_vec3(point->normal));
        std::copy_n(glm::value_ptr(found), 3, irradiance);
    });
}

prt_status prt_volume_functions(const prt_volume* volume, char* source, size_t* size, prt_message* message) {
    return guarded(message, [&] {
        check_pointers(volume, size);
        write_text(prt::volume_functions(volume->volume), source, size);
    });
}

prt_status prt_volume_shader(const prt_volume* volume, int language, char* source, size_t* size,
                             prt_message* message) {
    return guarded(message, [&] {
        check_pointers(volume, size);
        write_text(prt::texel_shader(volume->volume.compressed.transfer, language_of(language)), source,
                   size);
    });
}

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
