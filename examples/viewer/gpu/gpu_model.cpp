#include "gpu/gpu_model.h"

#include "prt/sh.h"
#include "prt/support/stopwatch.h"
#include "shared_layout.h"

#include <epoxy/gl.h>
#include <glm/gtc/type_ptr.hpp>

#include <algorithm>
#include <string>

namespace viewer {
namespace {

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

GpuModel::GpuModel(std::shared_ptr<const Model> model, std::size_t most_receivers)
    : model_(std::move(model)), most_receivers_(most_receivers),
      scene_(model_->scene, model_->trace->textures()), plain_(scene_.make_vertex_arrays()),
      number_arrays_(scene_.make_vertex_arrays()) {}

void GpuModel::set_raw(const prt::Transfer& transfer) {
    drop_raw(); // there may not be room for two
    const std::string defines = "#define PRT_CHANNELS " + std::to_string(transfer.channels) +
                                "\n#define PRT_COEFFICIENTS " +
                                std::to_string(prt::coefficient_count(transfer.order)) + "\n";
    const std::vector<glm::vec3> nothing(transfer.receivers());
    radiance_ = prt::make_buffer(std::span<const glm::vec3>(nothing));
    const std::vector<glm::vec4> dark(static_cast<std::size_t>(prt::coefficient_count(transfer.order)));
    raw_ = Raw{transfer.order,
               transfer.channels,
               transfer.receivers(),
               prt::make_buffer(std::span<const float>(transfer.vectors)),
               prt::make_buffer(std::span<const glm::vec4>(dark)),
               prt::make_compute_program("viewer_exit_radiance.comp", defines)};
    raw_arrays_ = scene_.make_vertex_arrays();
    scene_.attach_receivers(raw_arrays_, radiance_, PRT_LOCATION_RADIANCE, 3);
    if (light_ && light_->order >= transfer.order)
        form_raw(*light_);
}

void GpuModel::drop_raw() {
    raw_.reset();
    raw_arrays_.clear();
    radiance_ = {};
}

void GpuModel::set_compressed(const prt::ClusteredTransfer& transfer) {
    compressed_.emplace(transfer);
    compressed_arrays_ = scene_.make_vertex_arrays();
    for (std::size_t i = 0; i < compressed_arrays_.size(); ++i)
        compressed_->attach(compressed_arrays_[i].name(), model_->scene.vertex_arrays[i].first_receiver);
    programs_.erase({Source::compressed, false});
    programs_.erase({Source::compressed, true});
    if (light_ && light_->order >= transfer.bases.order)
        compressed_->set_light(*light_);
}

void GpuModel::set_occlusion(std::span<const float> occlusion) {
    occlusion_ = prt::make_buffer(occlusion);
    scene_.attach_receivers(plain_, occlusion_, PRT_LOCATION_AO, 1);
    has_occlusion_ = true;
}

void GpuModel::set_numbers(PictureKind kind, std::span<const glm::vec3> colors) {
    numbers_[kind] = prt::make_buffer(colors);
}

void GpuModel::set_light(const prt::Light& light) {
    light_ = light;
    for (int i = 0; i < 9; ++i) {
        const int band = i == 0 ? 0 : i < 4 ? 1 : 2;
        irradiance_[i] = light.coefficients[static_cast<std::size_t>(i)] *
                         static_cast<float>(prt::clamped_cosine_factor(band));
    }
    if (compressed_) {
        const prt::Stopwatch stopwatch;
        compressed_->set_light(light);
        seconds_constants_ = stopwatch.seconds();
    }
    if (raw_)
        form_raw(light);
}

void GpuModel::form_raw(const prt::Light& light) {
    std::vector<glm::vec4> coefficients;
    for (int i = 0; i < prt::coefficient_count(raw_->order); ++i)
        coefficients.emplace_back(light.coefficients[static_cast<std::size_t>(i)], 0);
    glNamedBufferSubData(raw_->light.name(), 0,
                         static_cast<GLsizeiptr>(coefficients.size() * sizeof(glm::vec4)),
                         coefficients.data());
    // A storage buffer is bound in pieces: a device may allow no more than 128 MB of it. Pieces of a multiple
    // of 256 receivers keep every alignment.
    GLint64 most = 0;
    glGetInteger64v(GL_MAX_SHADER_STORAGE_BLOCK_SIZE, &most);
    const std::size_t stride =
        static_cast<std::size_t>(raw_->channels * prt::coefficient_count(raw_->order)) * sizeof(float);
    const std::size_t piece = std::max<std::size_t>(
        256, std::min<std::size_t>(static_cast<std::size_t>(most) / stride, most_receivers_) / 256 * 256);
    const GLuint name = raw_->program.name();
    glUseProgram(name);
    glBindBufferBase(GL_SHADER_STORAGE_BUFFER, PRT_BINDING_LIGHT, raw_->light.name());
    glBindBufferBase(GL_SHADER_STORAGE_BUFFER, PRT_BINDING_RECEIVERS, radiance_.name());
    for (std::size_t first = 0; first < raw_->receivers; first += piece) {
        const std::size_t count = std::min(piece, raw_->receivers - first);
        glBindBufferRange(GL_SHADER_STORAGE_BUFFER, PRT_BINDING_MATRIX, raw_->vectors.name(),
                          static_cast<GLintptr>(first * stride), static_cast<GLsizeiptr>(count * stride));
        glUniform1ui(prt::uniform(raw_->program, "receivers"), static_cast<GLuint>(count));
        glUniform1ui(prt::uniform(raw_->program, "first"), static_cast<GLuint>(first));
        glDispatchCompute(static_cast<GLuint>((count + 63) / 64), 1, 1);
    }
    glMemoryBarrier(GL_VERTEX_ATTRIB_ARRAY_BARRIER_BIT);
}

bool GpuModel::can_draw(PictureKind kind) const {
    switch (source_of(kind)) {
    case Source::raw:
        return raw_.has_value();
    case Source::compressed:
        return compressed_.has_value();
    case Source::numbers:
        return numbers_.contains(kind);
    case Source::normals:
        break;
    }
    return kind != PictureKind::baked_ao || has_occlusion_;
}

const prt::GlVertexArrays& GpuModel::arrays(Source source) const {
    switch (source) {
    case Source::raw:
        return raw_arrays_;
    case Source::compressed:
        return compressed_arrays_;
    case Source::numbers:
        return number_arrays_;
    case Source::normals:
        break;
    }
    return plain_;
}

const prt::GlObject& GpuModel::program(Source source, bool gbuffer) {
    prt::GlObject& program = programs_[{source, gbuffer}];
    if (program.name() == 0) {
        const std::string defines = source == Source::compressed ? compressed_->defines()
                                    : source == Source::normals  ? ""
                                                                 : "#define PRT_VERTEX_RADIANCE\n";
        program = prt::make_program("viewer_surface.vert",
                                    gbuffer ? "viewer_gbuffer.frag" : "viewer_forward.frag", defines);
    }
    return program;
}

const prt::GlObject& GpuModel::use(PictureKind kind, const GeometryPass& pass) {
    const Source source = source_of(kind);
    const prt::GlObject& chosen = program(source, pass.gbuffer);
    glUseProgram(chosen.name());
    set_matrix(chosen, pass.view_projection);
    glUniform1i(prt::uniform(chosen, "textured"), pass.textured && source != Source::numbers);
    if (source == Source::normals) {
        glUniform1i(prt::uniform(chosen, "occluded"), kind == PictureKind::baked_ao);
        glUniform1i(prt::uniform(chosen, "dithered"), pass.dithered);
        glUniform3fv(prt::uniform(chosen, "irradiance_sh"), 9, glm::value_ptr(irradiance_[0]));
        glVertexAttrib1f(PRT_LOCATION_AO, 1); // until there is an occlusion
    }
    if (source == Source::compressed)
        compressed_->use();
    if (source == Source::numbers)
        scene_.attach_receivers(number_arrays_, numbers_.at(kind), PRT_LOCATION_RADIANCE, 3);
    return chosen;
}

void GpuModel::draw_opaque(PictureKind kind, const GeometryPass& pass) {
    const prt::GlObject& chosen = use(kind, pass);
    const prt::GlVertexArrays& vertex_arrays = arrays(source_of(kind));
    const auto planes = frustum_planes(pass.view_projection);
    drawn_triangles_ = 0;
    for (std::size_t p = 0; p < model_->scene.primitives.size(); ++p) {
        const prt::Primitive& primitive = model_->scene.primitives[p];
        if (scene_.is_blended(primitive) && pass.textured && !shows_numbers(kind))
            continue;
        if (!pass.culling) {
            scene_.draw(chosen, vertex_arrays, p);
            drawn_triangles_ += primitive.triangles.size();
            continue;
        }
        const auto ranges = visible_ranges(model_->clusters[p], planes);
        scene_.draw(chosen, vertex_arrays, p, ranges);
        for (const prt::TriangleRange& range : ranges)
            drawn_triangles_ += range.count;
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
    for (const std::size_t p : blended)
        scene_.draw(chosen, arrays(source_of(kind)), p);
    glDepthMask(GL_TRUE);
    glDisable(GL_BLEND);
}

void GpuModel::draw_wires(const GeometryPass& pass, const glm::vec3& color) {
    if (wires_.name() == 0)
        wires_ = prt::make_program("viewer_color.vert", "viewer_color.frag");
    glUseProgram(wires_.name());
    set_matrix(wires_, pass.view_projection);
    glPolygonMode(GL_FRONT_AND_BACK, GL_LINE);
    glEnable(GL_POLYGON_OFFSET_LINE);
    glPolygonOffset(-1, -1);
    glDepthFunc(GL_LEQUAL);
    glUniform4f(prt::uniform(wires_, "tint"), color.r, color.g, color.b, 1);
    for (std::size_t p = 0; p < model_->scene.primitives.size(); ++p)
        scene_.draw(wires_, plain_, p);
    glDepthFunc(GL_LESS);
    glDisable(GL_POLYGON_OFFSET_LINE);
    glPolygonMode(GL_FRONT_AND_BACK, GL_FILL);
}

} // namespace viewer
