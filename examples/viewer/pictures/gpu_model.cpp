// Lights and draws a model from every kind of transfer.

#include "pictures/gpu_model.h"

#include "prt/core/sh.h"
#include "runtime/core/support/stopwatch.h"
#include "shared_layout.h"

#include <epoxy/gl.h>
#include <glm/gtc/type_ptr.hpp>

#include <algorithm>
#include <string>

namespace viewer {
namespace {

/// Opacity of the grid lines.
constexpr float kGridShare = 0.85f;

void set_matrix(const prt::GlObject& program, const glm::mat4& matrix) {
    glUniformMatrix4fv(prt::uniform(program, "view_projection"), 1, GL_FALSE, glm::value_ptr(matrix));
}

} // namespace

GpuModel::Source GpuModel::source_of(PictureKind kind) {
    if (kind == PictureKind::prt)
        return Source::raw;
    if (kind == PictureKind::prt_compressed)
        return Source::compressed;
    return shows_numbers(kind) ? Source::numbers : Source::normals;
}

GpuModel::GpuModel(std::shared_ptr<const Model> model, std::size_t max_receivers)
    : model_(std::move(model)), max_receivers_(max_receivers),
      scene_(model_->scene, model_->trace->textures()), plain_{scene_.make_vertex_arrays(), {}} {
    numbers_.arrays = scene_.make_vertex_arrays();
    programs_.wires = prt::make_program("viewer_color.vert", "viewer_color.frag");
}

void GpuModel::set_raw(const prt::Transfer& transfer) {
    drop_raw(); // memory may not suffice for two
    RawTransfer raw(transfer, max_receivers_);
    prt::GlVertexArrays arrays = scene_.make_vertex_arrays();
    scene_.attach_receivers(arrays, raw.radiance(), PRT_LOCATION_RADIANCE, 3);
    take_raw({std::move(raw), std::move(arrays), transfer.layout});
}

void GpuModel::set_raw(std::shared_ptr<const prt::BakedLightmap> lightmap) {
    drop_raw();
    const prt::TransferLayout layout = lightmap->baked.transfer.layout;
    take_raw({RawLightmap(std::move(lightmap), max_receivers_), scene_.make_vertex_arrays(), layout});
}

void GpuModel::set_compressed(const prt::ClusteredTransfer& transfer) {
    prt::GlTransfer compressed(transfer);
    prt::GlVertexArrays arrays = scene_.make_vertex_arrays();
    for (std::size_t i = 0; i < arrays.size(); ++i)
        compressed.attach(arrays[i].name(), model_->scene.vertex_arrays[i].first_receiver);
    take_compressed({std::move(compressed), std::move(arrays), transfer.bases.layout});
}

void GpuModel::set_compressed(std::shared_ptr<const prt::CompressedLightmap> lightmap) {
    const prt::TransferLayout layout = lightmap->compressed.transfer.bases.layout;
    take_compressed({LitLightmap(std::move(lightmap)), scene_.make_vertex_arrays(), layout});
}

void GpuModel::set_instanced(std::shared_ptr<const prt::InstancedModel> instanced) {
    instances_.emplace(std::move(instanced), model_->trace->textures(), model_->scene.origin);
    light_instances();
}

/// Removes the programs that depend on the kind of transfer; programs of compressed transfer also depend on
/// its layout.
void GpuModel::take_raw(Raw raw) {
    raw_.emplace(std::move(raw));
    std::erase_if(programs_.surfaces,
                  [](const auto& program) { return program.first.source == Source::raw; });
    light_raw();
}

void GpuModel::take_compressed(Compressed compressed) {
    compressed_.emplace(std::move(compressed));
    std::erase_if(programs_.surfaces,
                  [](const auto& program) { return program.first.source == Source::compressed; });
    light_compressed();
}

void GpuModel::light_raw() {
    if (lights(raw_->layout))
        std::visit([this](auto& transfer) { transfer.set_light(lighting_of(raw_->layout)); }, raw_->transfer);
}

void GpuModel::light_compressed() {
    if (lights(compressed_->layout))
        std::visit([this](auto& transfer) { transfer.set_light(lighting_of(compressed_->layout)); },
                   compressed_->transfer);
}

void GpuModel::light_instances() {
    if (lights(instances_->layout()))
        instances_->set_light(lighting_of(instances_->layout()));
}

prt::GlLightmapTextures GpuModel::any_lightmap() const {
    if (const auto* lit = compressed_ ? std::get_if<LitLightmap>(&compressed_->transfer) : nullptr)
        return lit->textures();
    if (const auto* raw = raw_ ? std::get_if<RawLightmap>(&raw_->transfer) : nullptr)
        return raw->textures();
    return {};
}

prt::GlLightmapTextures GpuModel::lightmap_of(PictureKind kind) const {
    switch (source_of(kind)) {
    case Source::raw:
        if (const auto* raw = std::get_if<RawLightmap>(&raw_->transfer))
            return raw->textures();
        break;
    case Source::compressed:
        if (const auto* lit = compressed_ ? std::get_if<LitLightmap>(&compressed_->transfer) : nullptr)
            return lit->textures();
        break;
    case Source::numbers:
        if (const auto maps = numbers_.maps.find(kind); maps != numbers_.maps.end())
            return {any_lightmap().layout, maps->second};
        break;
    case Source::normals:
        break;
    }
    return {};
}

void GpuModel::set_occlusion(std::span<const float> occlusion) {
    plain_.occlusion = prt::make_buffer(occlusion);
    scene_.attach_receivers(plain_.arrays, *plain_.occlusion, PRT_LOCATION_AO, 1);
}

void GpuModel::set_numbers(PictureKind kind, std::span<const glm::vec3> colors) {
    if (const prt::LightmapLayout* layout = any_lightmap().layout)
        numbers_.maps[kind] = make_unfiltered_maps(*layout, colors);
    else
        numbers_.colors[kind] = prt::make_buffer(colors);
}

/// True if the light has enough bands for the layout.
bool GpuModel::lights(const prt::TransferLayout& layout) const {
    return lit_.lighting && lit_.lighting->sky.order >= layout.order;
}

prt::Lighting GpuModel::lighting_of(const prt::TransferLayout& layout) const {
    return with_lamps(*lit_.lighting, lit_.lamps, layout);
}

void GpuModel::set_lighting(const prt::Lighting& lighting, std::span<const prt::Sun> suns,
                            const LampSettings& lamps) {
    lit_.lighting = lighting;
    lit_.lamps = lamps;
    lit_.suns.assign(suns.begin(), suns.end());
    for (std::size_t i = 0; i < 9; ++i) {
        const int band = i == 0 ? 0 : i < 4 ? 1 : 2;
        lit_.irradiance[i] =
            lighting.sky.coefficients[i] * static_cast<float>(prt::clamped_cosine_factor(band));
    }
    const prt::Stopwatch stopwatch;
    if (compressed_)
        light_compressed();
    if (instances_)
        light_instances();
    measured_.seconds_constants = stopwatch.seconds();
    if (raw_)
        light_raw();
}

const prt::TransferLayout* GpuModel::layout_of(Source source) const {
    if (instances_ && source != Source::raw)
        return &instances_->layout();
    if (compressed_ && source != Source::raw)
        return &compressed_->layout;
    return raw_ ? &raw_->layout : nullptr;
}

/// Returns the emission as `prt render` shows it: emission that no transfer includes keeps the scene's
/// strength, unless all lamps are off.
std::vector<glm::vec3> GpuModel::emission_of(Source source) const {
    if (source == Source::numbers || !lit_.lamps.on)
        return {};
    const prt::TransferLayout none, *layout = layout_of(source);
    return prt::emission_strengths(model_->scene, layout ? *layout : none,
                                   layout ? strengths_of(lit_.lamps, *layout) : std::vector<glm::vec3>());
}

/// Returns the layout of the transfer that a picture shows; null if it shows none.
const prt::TransferLayout* GpuModel::layout_shown(PictureKind kind) const {
    const Source source = source_of(kind);
    return source == Source::raw || source == Source::compressed ? layout_of(source) : nullptr;
}

bool GpuModel::shows_suns(PictureKind kind) const {
    const prt::TransferLayout* layout = layout_shown(kind);
    const bool separate = !layout || layout->has(prt::TermKind::direct);
    return !lit_.suns.empty() && !shows_numbers(kind) && separate;
}

bool GpuModel::takes_suns_as_sky(PictureKind kind) const {
    const prt::TransferLayout* layout = layout_shown(kind);
    return !lit_.suns.empty() && layout && !layout->has(prt::TermKind::direct);
}

void GpuModel::draw_shadows(PictureKind kind, const prt::SunShadows::View& view,
                            const prt::SunShadows::Moving& moving) {
    if (!shows_suns(kind) && (!moving.draw || lit_.suns.empty()))
        return;
    if (!shadows_)
        shadows_.emplace(scene_);
    shadows_->draw(lit_.suns, view, moving);
}

void GpuModel::use_shadows() const {
    if (shadows_)
        shadows_->use();
}

bool GpuModel::can_draw(PictureKind kind) const {
    switch (source_of(kind)) {
    case Source::raw:
        return raw_.has_value();
    case Source::compressed:
        return compressed_ || instances_;
    case Source::numbers:
        return numbers_.colors.contains(kind) || numbers_.maps.contains(kind);
    case Source::normals:
        break;
    }
    return kind != PictureKind::baked_ao || plain_.occlusion;
}

const prt::GlVertexArrays& GpuModel::arrays(Source source) const {
    switch (source) {
    case Source::raw:
        return raw_->arrays;
    case Source::compressed:
        return compressed_->arrays; // instances have separate arrays
    case Source::numbers:
        return numbers_.arrays;
    case Source::normals:
        break;
    }
    return plain_.arrays;
}

/// Returns the defines that select the source of radiance.
std::string GpuModel::defines_of(const Surface& surface) const {
    if (surface.source == Source::normals)
        return surface.instanced ? "#define PRT_INSTANCED\n" : "";
    if (surface.instanced)
        return "#define PRT_VERTEX_RADIANCE\n#define PRT_INSTANCED\n";
    if (any_lightmap().layout)
        return "#define PRT_LIGHTMAP\n";
    return surface.source == Source::compressed ? std::get<prt::GlTransfer>(compressed_->transfer).defines()
                                                : "#define PRT_VERTEX_RADIANCE\n";
}

const prt::GlObject& GpuModel::program(const Surface& surface) {
    prt::GlObject& program = programs_.surfaces[surface];
    if (program.name() == 0)
        program = prt::make_program(
            "viewer_surface.vert", surface.gbuffer ? "viewer_gbuffer.frag" : "viewer_forward.frag",
            defines_of(surface) + surface.occluders + (surface.suns ? "#define PRT_SUNS\n" : ""));
    return program;
}

const prt::GlObject& GpuModel::use(PictureKind kind, const GeometryPass& pass) {
    const Source source = source_of(kind);
    const bool suns = shows_suns(kind);
    const bool occluded = pass.occluders && (source == Source::raw || source == Source::compressed);
    const bool instanced = instances_of(kind);
    const prt::GlObject& chosen =
        program({source, pass.gbuffer, suns, instanced,
                 occluded ? "#define PRT_OCCLUDED\n" + pass.occluders->defines : ""});
    scene_.shine(emission_of(source));
    if (instanced)
        instances_->shine(emission_of(source));
    glUseProgram(chosen.name());
    set_matrix(chosen, pass.view_projection);
    glUniform1i(prt::uniform(chosen, "textured"), pass.textured && source != Source::numbers);
    if (occluded)
        pass.occluders->shadows->use(chosen);
    if (source == Source::normals) {
        glUniform1i(prt::uniform(chosen, "occluded"), kind == PictureKind::baked_ao);
        glUniform1i(prt::uniform(chosen, "dithered"), pass.dithered);
        glUniform3fv(prt::uniform(chosen, "irradiance_sh"), 9, glm::value_ptr(lit_.irradiance.front()));
        glVertexAttrib1f(PRT_LOCATION_AO, 1); // default until the occlusion is computed
    }
    const prt::GlLightmapTextures lightmap = lightmap_of(kind);
    scene_.light_by(lightmap);
    if (source == Source::compressed && !lightmap.layout && !instanced)
        std::get<prt::GlTransfer>(compressed_->transfer).use();
    if (suns)
        shadows_->use();
    if (source == Source::numbers && !lightmap.layout)
        scene_.attach_receivers(numbers_.arrays, numbers_.colors.at(kind), PRT_LOCATION_RADIANCE, 3);
    return chosen;
}

GpuInstances* GpuModel::instances_of(PictureKind kind) {
    const Source source = source_of(kind);
    const bool drawn =
        source == Source::compressed || (source == Source::normals && kind != PictureKind::baked_ao);
    return instances_ && drawn ? &*instances_ : nullptr;
}

void GpuModel::draw_instances(PictureKind kind, const GeometryPass& pass) {
    instances_->look(pass.view_projection, pass.eye, pass.culling);
    const prt::GlObject& chosen = use(kind, pass);
    const bool lit = source_of(kind) == Source::compressed;
    measured_.drawn_triangles = instances_->draw(chosen, lit, false);
    if (!pass.textured)
        measured_.drawn_triangles += instances_->draw(chosen, lit, true);
}

void GpuModel::draw_opaque(PictureKind kind, const GeometryPass& pass) {
    if (instances_of(kind))
        return draw_instances(kind, pass);
    const prt::GlObject& chosen = use(kind, pass);
    const prt::GlVertexArrays& vertex_arrays = arrays(source_of(kind));
    const auto planes = frustum_planes(pass.view_projection);
    measured_.drawn_triangles = 0;
    for (std::size_t p = 0; p < model_->scene.primitives.size(); ++p) {
        const prt::Primitive& primitive = model_->scene.primitives[p];
        if (scene_.is_blended(primitive) && pass.textured && !shows_numbers(kind))
            continue;
        if (!pass.culling) {
            scene_.draw(chosen, vertex_arrays, p);
            measured_.drawn_triangles += primitive.triangles.size();
            continue;
        }
        const auto ranges = visible_ranges(model_->clusters[p], planes);
        scene_.draw(chosen, vertex_arrays, p, ranges);
        for (const prt::TriangleRange& range : ranges)
            measured_.drawn_triangles += range.count;
    }
}

void GpuModel::draw_blended(PictureKind kind, const GeometryPass& pass) {
    const auto blended = scene_.blended_from_far(pass.eye);
    if (blended.empty() || !pass.textured || shows_numbers(kind))
        return;
    GeometryPass forward = pass;
    forward.gbuffer = false;
    const prt::GlObject& chosen = use(kind, forward);
    glEnable(GL_BLEND);
    glBlendFuncSeparate(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA, GL_ONE, GL_ONE_MINUS_SRC_ALPHA);
    glDepthMask(GL_FALSE);
    if (GpuInstances* instances = instances_of(kind))
        instances->draw(chosen, source_of(kind) == Source::compressed, true);
    else
        for (const std::size_t p : blended)
            scene_.draw(chosen, arrays(source_of(kind)), p);
    glDepthMask(GL_TRUE);
    glDisable(GL_BLEND);
}

void GpuModel::draw_wires(const GeometryPass& pass, const glm::vec3& color) {
    const prt::GlObject& wires = programs_.wires;
    glUseProgram(wires.name());
    set_matrix(wires, pass.view_projection);
    glPolygonMode(GL_FRONT_AND_BACK, GL_LINE);
    glEnable(GL_POLYGON_OFFSET_LINE);
    glPolygonOffset(-1, -1);
    glDepthFunc(GL_LEQUAL);
    glUniform4f(prt::uniform(wires, "tint"), color.r, color.g, color.b, 1);
    for (std::size_t p = 0; p < model_->scene.primitives.size(); ++p)
        scene_.draw(wires, plain_.arrays, p);
    glDepthFunc(GL_LESS);
    glDisable(GL_POLYGON_OFFSET_LINE);
    glPolygonMode(GL_FRONT_AND_BACK, GL_FILL);
}

void GpuModel::draw_texel_grid(const GeometryPass& pass, const glm::vec3& color, int samples) {
    const prt::GlLightmapTextures lightmap = any_lightmap();
    if (!lightmap.layout)
        return;
    if (programs_.texel_grid.name() == 0)
        programs_.texel_grid = prt::make_program("viewer_texel_grid.vert", "viewer_texel_grid.frag");
    const prt::GlObject& grid = programs_.texel_grid;
    glUseProgram(grid.name());
    set_matrix(grid, pass.view_projection);
    glUniform1i(prt::uniform(grid, "textured"), pass.textured);
    prt::set_uniform(grid, "samples", static_cast<float>(samples));
    glUniform4f(prt::uniform(grid, "line_tint"), color.r, color.g, color.b, kGridShare);
    scene_.light_by(lightmap);
    glEnable(GL_BLEND);
    glBlendFuncSeparate(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA, GL_ZERO, GL_ONE);
    glEnable(GL_POLYGON_OFFSET_FILL);
    glPolygonOffset(-1, -1);
    glDepthFunc(GL_LEQUAL);
    glDepthMask(GL_FALSE);
    for (std::size_t p = 0; p < model_->scene.primitives.size(); ++p)
        scene_.draw(grid, numbers_.arrays, p); // these vertex arrays bind no other attribute at the location
                                               // of the texel coordinates
    glDepthMask(GL_TRUE);
    glDepthFunc(GL_LESS);
    glDisable(GL_POLYGON_OFFSET_FILL);
    glDisable(GL_BLEND);
}

} // namespace viewer
