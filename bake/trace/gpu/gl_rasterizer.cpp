#include "prt/gl_objects.h"
#include "prt/sh.h"
#include "prt/support/error.h"
#include "prt/support/stopwatch.h"
#include "shared_layout.h"
#include "trace/gpu/gl_tracer.h"
#include "trace/gpu/gpu_receivers.h"
#include "trace/gpu/gpu_scene.h"
#include "trace/gpu/touching_triangles.h"

#include <epoxy/gl.h>
#include <glm/geometric.hpp>
#include <glm/gtc/matrix_transform.hpp>
#include <glm/gtc/quaternion.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <numbers>
#include <random>

namespace prt {
namespace {

// As in shaders/bake_raster.comp.
struct GpuDirection {
    glm::vec4 towards_light;
    glm::mat4 map_from_world;
    float basis[100];
};
static_assert(sizeof(GpuDirection) % 16 == 0);

constexpr std::size_t kMapsAtOnce = 8;
/// Layers of blended surfaces that are peeled; what lies behind more of them is behind as good as everything.
constexpr int kMostLayers = 64;

/// Directions spread evenly over the sphere, turned at random: the spherical Fibonacci lattice.
std::vector<glm::vec3> even_directions(int count, std::uint64_t seed) {
    std::mt19937_64 random(seed);
    const auto unit = [&] { return static_cast<double>(random() >> 11) * 0x1p-53; };
    // A uniform rotation (Shoemake 1992).
    const double u = unit(), v = 2 * std::numbers::pi * unit(), w = 2 * std::numbers::pi * unit();
    const glm::dquat turn(std::sqrt(u) * std::cos(w), std::sqrt(1 - u) * std::sin(v),
                          std::sqrt(1 - u) * std::cos(v), std::sqrt(u) * std::sin(w));
    std::vector<glm::vec3> directions;
    for (int i = 0; i < count; ++i) {
        const double z = 1 - (2 * i + 1.0) / count, phi = 2 * std::numbers::pi * i / std::numbers::phi;
        const double r = std::sqrt(std::max(0.0, 1 - z * z));
        directions.emplace_back(turn * glm::dvec3(r * std::cos(phi), r * std::sin(phi), z));
    }
    return directions;
}

GlObject make_texture_object(GLenum target) {
    GLuint name = 0;
    glCreateTextures(target, 1, &name);
    glTextureParameteri(name, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
    glTextureParameteri(name, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
    return {GlKind::texture, name};
}

GlObject make_framebuffer() {
    GLuint name = 0;
    glCreateFramebuffers(1, &name);
    return {GlKind::framebuffer, name};
}

} // namespace

class GlRasterizer::Implementation {
public:
    Implementation(std::unique_ptr<GlContext> context, const TraceScene& scene, int resolution)
        : context_(std::move(context)), rays_(scene.rays()), surfaces_(scene.surfaces()), scene_(scene),
          blends_(has_blended(scene.scene(), surfaces_)), resolution_(resolution), threads_(scene.threads()) {
        const Bounds box = bounds(scene.scene());
        centre_ = 0.5f * (box.low + box.high);
        // The sphere round the scene, a little larger so that nothing lies on the border.
        radius_ =
            std::max(0.5f * glm::length(box.high - box.low) * 1.001f, std::numeric_limits<float>::min());
        GLint largest = 0;
        glGetIntegerv(GL_MAX_TEXTURE_SIZE, &largest);
        if (resolution > largest)
            throw Error("depth maps of " + std::to_string(resolution) + " texels are larger than the " +
                        std::to_string(largest) + " of this GPU");
        maps_ = make_texture_object(GL_TEXTURE_2D_ARRAY);
        glTextureStorage3D(maps_.name(), 1, GL_DEPTH_COMPONENT32F, resolution, resolution,
                           static_cast<GLsizei>(maps_at_once()));
        check_gl("the depth maps");
        map_target_ = make_framebuffer();
        draw_ = make_program("bake_raster.vert", "bake_raster.frag", scene_.defines());
        GLuint name = 0;
        glCreateVertexArrays(1, &name);
        no_vertices_ = GlObject(GlKind::vertex_array, name);
        if (blends_)
            prepare_peeling();
    }

    std::string device() const { return context_->renderer(); }

    std::size_t batch_size(const TraceOptions& options) const {
        GLint64 largest = 0;
        glGetInteger64v(GL_MAX_SHADER_STORAGE_BLOCK_SIZE, &largest);
        const auto bytes = static_cast<std::size_t>(2 * coefficient_count(options.order) + 2) * sizeof(float);
        return std::max<std::size_t>(
            1, std::min<std::size_t>(static_cast<std::size_t>(largest) / bytes, 65535 * 64));
    }

    void trace(const Receivers& receivers, std::span<const std::uint32_t> indices,
               const TraceOptions& options, std::span<float> vectors, TraceSeconds& seconds,
               const Progress& progress) {
        const auto coefficients = static_cast<std::size_t>(coefficient_count(options.order));
        Stopwatch transfer;
        const GlObject gpu_receivers = upload_receivers(rays_, receivers, indices, options.seed, threads_);
        const TouchingTriangles touching = touching_triangles(rays_, surfaces_, receivers, indices, threads_);
        const GlObject touching_ranges = make_buffer(std::span<const glm::uvec2>(touching.ranges)),
                       touching_corners = make_buffer(std::span<const glm::vec4>(touching.corners));
        std::vector<float> sums(indices.size() * (2 * coefficients + 2));
        const GlObject gpu_sums = make_buffer(std::span<const float>(sums));
        const std::vector<float> ones(blends_ ? indices.size() : 1, 1.0f);
        const GlObject passes = make_buffer(std::span<const float>(ones));
        glFinish();
        seconds.transfer += transfer.seconds();

        const GlObject& look_up = program(options.order, false);
        scene_.bind();
        glBindBufferBase(GL_SHADER_STORAGE_BUFFER, PRT_BINDING_RECEIVERS, gpu_receivers.name());
        glBindBufferBase(GL_SHADER_STORAGE_BUFFER, PRT_BINDING_SUMS, gpu_sums.name());
        glBindBufferBase(GL_SHADER_STORAGE_BUFFER, PRT_BINDING_BLOCKED, passes.name());
        glBindBufferBase(GL_SHADER_STORAGE_BUFFER, PRT_BINDING_TOUCHING_RANGES, touching_ranges.name());
        glBindBufferBase(GL_SHADER_STORAGE_BUFFER, PRT_BINDING_TOUCHING, touching_corners.name());
        glBindTextureUnit(PRT_UNIT_OPAQUE_DEPTH, maps_.name());
        const std::vector<glm::vec3> directions = even_directions(options.rays, options.seed);
        for (std::size_t begin = 0; begin < directions.size(); begin += maps_at_once()) {
            progress.update(static_cast<double>(begin) / static_cast<double>(directions.size()));
            const auto part =
                std::span(directions).subspan(begin, std::min(maps_at_once(), directions.size() - begin));
            const Stopwatch maps;
            const GlObject table = upload_directions(part, options.order);
            glBindBufferBase(GL_SHADER_STORAGE_BUFFER, PRT_BINDING_SAMPLES, table.name());
            for (std::size_t layer = 0; layer < part.size(); ++layer)
                draw_map(part[layer], layer);
            if (blends_)
                peel(part[0], options.order, indices.size());
            glFinish();
            seconds.trace += maps.seconds();
            const Stopwatch accumulate;
            dispatch(look_up, indices.size(), part.size());
            glFinish();
            check_gl("looking up the depth maps");
            seconds.accumulate += accumulate.seconds();
        }
        transfer = Stopwatch();
        glGetNamedBufferSubData(gpu_sums.name(), 0, static_cast<GLsizeiptr>(sums.size() * sizeof(float)),
                                sums.data());
        check_gl("the sums");
        seconds.transfer += transfer.seconds();
        finish(receivers, indices, options.order, sums, vectors);
    }

private:
    static bool has_blended(const Scene& scene, const Surfaces& surfaces) {
        for (std::uint32_t t = 0; t < surfaces.triangles(); ++t) {
            const Material& material = scene.materials[scene.primitives[surfaces.primitive(t)].material];
            if (!surfaces.opaque(t) && (material.alpha_mode == AlphaMode::blend || material.glass.factor > 0))
                return true;
        }
        return false;
    }

    /// Layers belong to one direction at a time.
    std::size_t maps_at_once() const { return blends_ ? 1 : kMapsAtOnce; }

    void prepare_peeling() {
        for (GlObject& depth : layer_depth_) {
            depth = make_texture_object(GL_TEXTURE_2D);
            glTextureStorage2D(depth.name(), 1, GL_DEPTH_COMPONENT32F, resolution_, resolution_);
        }
        layer_coverage_ = make_texture_object(GL_TEXTURE_2D);
        glTextureStorage2D(layer_coverage_.name(), 1, GL_R32F, resolution_, resolution_);
        check_gl("the layers");
        peel_target_ = make_framebuffer();
        glNamedFramebufferTexture(peel_target_.name(), GL_COLOR_ATTACHMENT0, layer_coverage_.name(), 0);
        draw_layer_ =
            make_program("bake_raster.vert", "bake_raster.frag", scene_.defines() + "#define PRT_PEEL\n");
    }

    const GlObject& program(int order, bool peel) {
        GlObject& program = programs_[{order, peel}];
        if (program.name() == 0)
            program = make_compute_program("bake_raster.comp", "#define PRT_ORDER " + std::to_string(order) +
                                                                   "\n" + (peel ? "#define PRT_PEEL\n" : "") +
                                                                   (blends_ ? "#define PRT_ALPHA\n" : ""));
        return program;
    }

    /// World to the map of light that comes from `direction`: [-1, 1]³, nearer to the light first.
    glm::mat4 map_matrix(const glm::vec3& direction) const {
        const glm::vec3 up = std::abs(direction.y) < 0.9f ? glm::vec3(0, 1, 0) : glm::vec3(1, 0, 0);
        return glm::ortho(-radius_, radius_, -radius_, radius_, 0.0f, 2 * radius_) *
               glm::lookAt(centre_ + radius_ * direction, centre_, up);
    }

    GlObject upload_directions(std::span<const glm::vec3> directions, int order) const {
        const glm::mat4 to_unit =
            glm::translate(glm::mat4(1), glm::vec3(0.5f)) * glm::scale(glm::mat4(1), glm::vec3(0.5f));
        std::vector<GpuDirection> table(directions.size());
        for (std::size_t i = 0; i < directions.size(); ++i) {
            table[i].towards_light = glm::vec4(directions[i], 0);
            table[i].map_from_world = to_unit * map_matrix(directions[i]);
            std::array<double, 100> basis{};
            evaluate_sh(order, glm::normalize(glm::dvec3(directions[i])), std::span<double>(basis));
            std::copy(basis.begin(), basis.end(), table[i].basis);
        }
        return make_buffer(std::span<const GpuDirection>(table));
    }

    void draw(const GlObject& program, const GlObject& target, const glm::vec3& direction) const {
        glBindFramebuffer(GL_FRAMEBUFFER, target.name());
        glViewport(0, 0, resolution_, resolution_);
        glEnable(GL_DEPTH_TEST);
        glDepthFunc(GL_LESS);
        glUseProgram(program.name());
        glBindVertexArray(no_vertices_.name());
        const glm::mat4 matrix = map_matrix(direction);
        glUniformMatrix4fv(uniform(program, "map_from_world"), 1, GL_FALSE, &matrix[0][0]);
        const float texel = 2 * radius_ / static_cast<float>(resolution_);
        glUniform1f(uniform(program, "texel_area"), texel * texel);
        glDrawArrays(GL_TRIANGLES, 0, static_cast<GLsizei>(3 * scene_.triangles()));
    }

    void draw_map(const glm::vec3& direction, std::size_t layer) const {
        glNamedFramebufferTextureLayer(map_target_.name(), GL_DEPTH_ATTACHMENT, maps_.name(), 0,
                                       static_cast<GLint>(layer));
        glNamedFramebufferDrawBuffer(map_target_.name(), GL_NONE);
        const float far = 1;
        glClearNamedFramebufferfv(map_target_.name(), GL_DEPTH, 0, &far);
        draw(draw_, map_target_, direction);
    }

    /// Depth peeling (Everitt 2001): blended layers from the light inwards, until one is empty.
    void peel(const glm::vec3& direction, int order, std::size_t receivers) {
        const float far = 1, nothing = 0;
        glClearTexImage(layer_depth_[1].name(), 0, GL_DEPTH_COMPONENT, GL_FLOAT, &nothing);
        GLuint query = 0;
        glGenQueries(1, &query);
        for (int layer = 0; layer < kMostLayers; ++layer) {
            const GlObject &now = layer_depth_[static_cast<std::size_t>(layer % 2)],
                           &last = layer_depth_[static_cast<std::size_t>(1 - layer % 2)];
            glNamedFramebufferTexture(peel_target_.name(), GL_DEPTH_ATTACHMENT, now.name(), 0);
            glClearNamedFramebufferfv(peel_target_.name(), GL_DEPTH, 0, &far);
            glClearNamedFramebufferfv(peel_target_.name(), GL_COLOR, 0, &nothing);
            glBindTextureUnit(PRT_UNIT_LAST_DEPTH, last.name());
            glBeginQuery(GL_ANY_SAMPLES_PASSED, query);
            draw(draw_layer_, peel_target_, direction);
            glEndQuery(GL_ANY_SAMPLES_PASSED);
            GLuint any = 0;
            glGetQueryObjectuiv(query, GL_QUERY_RESULT, &any);
            if (!any)
                break;
            glBindTextureUnit(PRT_UNIT_LAST_DEPTH, now.name());
            glBindTextureUnit(PRT_UNIT_LAYER_COVERAGE, layer_coverage_.name());
            dispatch(program(order, true), receivers, 1);
        }
        glDeleteQueries(1, &query);
    }

    void dispatch(const GlObject& shader, std::size_t receivers, std::size_t directions) const {
        glUseProgram(shader.name());
        glUniform1ui(uniform(shader, "receiver_count"), static_cast<GLuint>(receivers));
        glUniform1ui(uniform(shader, "direction_count"), static_cast<GLuint>(directions));
        glUniform1f(uniform(shader, "texel_depth"), 1 / static_cast<float>(resolution_));
        glDispatchCompute(static_cast<GLuint>((receivers + 63) / 64), 1, 1);
        glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT | GL_BUFFER_UPDATE_BARRIER_BIT);
    }

    /// With the open lobe as control variate, as rays do.
    void finish(const Receivers& receivers, std::span<const std::uint32_t> indices, int order,
                std::span<const float> sums, std::span<float> vectors) const {
        const auto coefficients = static_cast<std::size_t>(coefficient_count(order));
        std::array<double, kMaxOrder * kMaxOrder> lobe{};
        for (std::size_t i = 0; i < indices.size(); ++i) {
            const float* const sum = &sums[i * (2 * coefficients + 2)];
            const auto weight = static_cast<double>(sum[2 * coefficients]),
                       blocked = static_cast<double>(sum[2 * coefficients + 1]);
            clamped_cosine_lobe(order, glm::dvec3(receivers.normals[indices[i]]), lobe);
            for (std::size_t k = 0; k < coefficients; ++k) {
                const auto all = static_cast<double>(sum[k]),
                           stopped = static_cast<double>(sum[coefficients + k]);
                vectors[i * coefficients + k] =
                    static_cast<float>(weight <= 0             ? 0
                                       : 2 * blocked <= weight ? lobe[k] - stopped / weight
                                                               : (all - stopped) / weight);
            }
        }
    }

    std::unique_ptr<GlContext> context_;
    const RayScene& rays_;
    const Surfaces& surfaces_;
    GpuScene scene_;
    bool blends_;
    int resolution_, threads_;
    glm::vec3 centre_{0};
    float radius_ = 1;
    GlObject maps_, map_target_, draw_, no_vertices_;
    std::array<GlObject, 2> layer_depth_; ///< this layer's and the last one's, in turns
    GlObject layer_coverage_, peel_target_, draw_layer_;
    std::map<std::pair<int, bool>, GlObject> programs_; ///< by order, and whether for peeling
};

GlRasterizer::GlRasterizer(std::unique_ptr<GlContext> context, const TraceScene& scene, int resolution)
    : implementation_(std::make_unique<Implementation>(std::move(context), scene, resolution)) {}

GlRasterizer::~GlRasterizer() = default;

std::string GlRasterizer::device() const {
    return implementation_->device();
}

std::size_t GlRasterizer::batch_size(const TraceOptions& options) const {
    return implementation_->batch_size(options);
}

void GlRasterizer::trace(const Receivers& receivers, std::span<const std::uint32_t> indices,
                         const TraceOptions& options, std::span<float> vectors, const HitSink& sink,
                         const Progress& progress) {
    if (sink)
        throw Error("depth maps do not tell what light would meet");
    implementation_->trace(receivers, indices, options, vectors, seconds_, progress);
}

} // namespace prt
