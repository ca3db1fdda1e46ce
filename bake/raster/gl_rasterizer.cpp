// Direct transfer from depth maps (S. Hill, "Hardware Accelerating Art Production", Gamasutra 2004): draws
// the scene once for each of many directions; every receiver compares its depth (shaders/bake_raster.comp).

#include "bake/raster/gl_rasterizer.h"

#include "bake/trace/gather_product.h"
#include "bake/trace/lamp_light.h"
#include "bake/trace/trace_receivers.h"
#include "bake/trace_gpu/gpu_receivers.h"
#include "bake/trace_gpu/touching_triangles.h"
#include "prt/core/error.h"
#include "prt/core/sh.h"
#include "runtime/core/support/stopwatch.h"

#include <epoxy/gl.h>
#include <glm/gtc/quaternion.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <random>

namespace prt {
namespace {

/// Returns evenly distributed directions over the sphere with a random rotation: the spherical Fibonacci
/// lattice. Each range of rays has a separate rotation.
std::vector<glm::vec3> even_directions(const TraceOptions& options) {
    constexpr std::uint64_t kRange = 0x9e3779b97f4a7c15; // odd: ranges have different seeds
    const int count = options.rays;
    std::mt19937_64 random(options.seed + kRange * options.first_ray);
    const auto unit = [&] { return static_cast<double>(random() >> 11) * 0x1p-53; };
    // A uniform rotation (Shoemake 1992).
    const double u = unit(), v = 2 * std::numbers::pi * unit(), w = 2 * std::numbers::pi * unit();
    const glm::dquat rotation(std::sqrt(u) * std::cos(w), std::sqrt(1 - u) * std::sin(v),
                              std::sqrt(1 - u) * std::cos(v), std::sqrt(u) * std::sin(w));
    std::vector<glm::vec3> directions;
    for (int i = 0; i < count; ++i) {
        const double z = 1 - (2 * i + 1.0) / count, phi = 2 * std::numbers::pi * i / std::numbers::phi;
        const double r = std::sqrt(std::max(0.0, 1 - z * z));
        directions.emplace_back(rotation * glm::dvec3(r * std::cos(phi), r * std::sin(phi), z));
    }
    return directions;
}

bool has_blended(const Scene& scene, const Surfaces& surfaces) {
    for (std::uint32_t t = 0; t < surfaces.triangles(); ++t) {
        const Material& material = scene.materials[scene.primitives[surfaces.primitive(t)].material];
        if (!surfaces.opaque(t) && (material.alpha_mode == AlphaMode::blend || material.glass.factor > 0))
            return true;
    }
    return false;
}

/// Number of sums per receiver: all directions [order²], blocked directions [order²], weights of both.
std::size_t sums_of(int order) {
    return static_cast<std::size_t>(2 * coefficient_count(order) + 2);
}

/// Converts sums to the transfer of a receiver, with the unshadowed lobe as control variate, as ray tracing
/// does.
void write_transfer(const glm::vec3& normal, int order, std::span<const float> sum, std::span<float> vector) {
    const std::size_t coefficients = vector.size();
    const auto weight = static_cast<double>(sum[2 * coefficients]),
               blocked = static_cast<double>(sum[2 * coefficients + 1]);
    std::array<double, kMaxOrder * kMaxOrder> lobe{};
    clamped_cosine_lobe(order, glm::dvec3(normal), lobe);
    for (std::size_t k = 0; k < coefficients; ++k) {
        const auto all = static_cast<double>(sum[k]), stopped = static_cast<double>(sum[coefficients + k]);
        vector[k] = static_cast<float>(weight <= 0             ? 0
                                       : 2 * blocked <= weight ? lobe[k] - stopped / weight
                                                               : (all - stopped) / weight);
    }
}

} // namespace

/// Receivers on the device, the triangles that touch them, and the sums over directions.
class GlRasterizer::Batch {
public:
    Batch(const TraceScene& scene, const Receivers& receivers, std::span<const std::uint32_t> indices,
          const TraceOptions& options)
        : receivers_(make_buffer(
              std::span<const gpu::Receiver>(gpu_receivers(scene, receivers, indices, options.seed)))),
          sums_(indices.size() * sums_of(options.order)),
          gpu_sums_(make_buffer(std::span<const float>(sums_))) {
        const TouchingTriangles touching = touching_triangles(scene, receivers, indices);
        touching_ranges_ = make_buffer(std::span<const glm::uvec2>(touching.ranges));
        touching_ = make_buffer(std::span<const glm::vec4>(touching.corners));
        const std::vector<float> ones(scene.surfaces().traits().alpha ? indices.size() : 1, 1.0f);
        passes_ = make_buffer(std::span<const float>(ones));
        glFinish();
    }

    void bind() const {
        bind_storage(PRT_BINDING_RECEIVERS, receivers_);
        bind_storage(PRT_BINDING_SUMS, gpu_sums_);
        bind_storage(PRT_BINDING_PASSES, passes_);
        bind_storage(PRT_BINDING_TOUCHING_RANGES, touching_ranges_);
        bind_storage(PRT_BINDING_TOUCHING, touching_);
    }

    std::span<const float> read_sums() {
        read_buffer(gpu_sums_, std::span(sums_), "the sums");
        return sums_;
    }

private:
    GlObject receivers_, touching_ranges_, touching_, passes_;
    std::vector<float> sums_;
    GlObject gpu_sums_;
};

GlRasterizer::GlRasterizer(std::unique_ptr<GlContext> context, const TraceScene& scene, int resolution,
                           MakeRays make_rays)
    : context_(std::move(context)), scene_(scene), make_rays_(std::move(make_rays)), raster_scene_(scene),
      maps_(raster_scene_, bounds(scene.scene()), resolution, has_blended(scene.scene(), scene.surfaces())) {}

Tracer& GlRasterizer::rays() {
    if (!rays_)
        rays_ = make_rays_();
    return *rays_;
}

std::string GlRasterizer::device() const {
    return context_->renderer() + (rays_ ? "; rays: " + rays_->device() : "");
}

std::size_t GlRasterizer::batch_size(const TraceOptions& options) const {
    GLint64 largest = 0;
    glGetInteger64v(GL_MAX_SHADER_STORAGE_BLOCK_SIZE, &largest);
    const std::size_t bytes = sums_of(options.order) * sizeof(float);
    return std::max<std::size_t>(
        1, std::min<std::size_t>(static_cast<std::size_t>(largest) / bytes, 65535 * 64));
}

void GlRasterizer::trace(const Receivers& receivers, std::span<const std::uint32_t> indices,
                         const TraceOptions& options, std::span<float> vectors, const HitSink& sink,
                         const Progress& progress) {
    if (sink)
        trace_hits(receivers, indices, options, sink, progress.range(0, 0.5));
    const Progress drawing = sink ? progress.range(0.5, 1) : progress;
    Stopwatch transfer;
    Batch batch(scene_, receivers, indices, options);
    seconds_.transfer += transfer.seconds();
    raster_scene_.bind();
    batch.bind();
    maps_.bind();
    const std::vector<glm::vec3> directions = even_directions(options);
    for (std::size_t begin = 0; begin < directions.size(); begin += maps_.at_once()) {
        drawing.update(static_cast<double>(begin) / static_cast<double>(directions.size()));
        const auto part =
            std::span(directions).subspan(begin, std::min(maps_.at_once(), directions.size() - begin));
        look_up(part, options.order, indices.size());
    }
    transfer = Stopwatch();
    const std::span<const float> sums = batch.read_sums();
    seconds_.transfer += transfer.seconds();
    const std::size_t columns = sums_of(options.order), coefficients = columns / 2 - 1;
    for (std::size_t i = 0; i < indices.size(); ++i)
        write_transfer(receivers.normals[indices[i]], options.order, sums.subspan(i * columns, columns),
                       vectors.subspan(i * coefficients, coefficients));
}

/// Calls `sink` with the hits of rays; their own direct light is not used.
void GlRasterizer::trace_hits(const Receivers& receivers, std::span<const std::uint32_t> indices,
                              const TraceOptions& options, const HitSink& sink, const Progress& progress) {
    const Stopwatch watch;
    TraceOptions of_hits = options;
    of_hits.order = 1;
    std::size_t first = 0;
    in_batches(rays(), indices, of_hits, progress,
               [&](std::span<const std::uint32_t> batch, const Progress& part) {
                   std::vector<float> unused(batch.size());
                   rays().trace(
                       receivers, batch, of_hits, unused,
                       [&](std::size_t i, std::span<const Hit> hits) { sink(first + i, hits); }, part);
                   first += batch.size();
               });
    seconds_.trace += watch.seconds();
}

const GlObject& GlRasterizer::program(int order, bool peel) {
    GlObject& program = programs_[{order, peel}];
    if (program.name() == 0)
        program = make_compute_program("bake_raster.comp", "#define PRT_ORDER " + std::to_string(order) +
                                                               "\n" + (peel ? "#define PRT_PEEL\n" : "") +
                                                               (maps_.blends() ? "#define PRT_ALPHA\n" : ""));
    return program;
}

/// Draws the maps of some directions and adds their visibility to the sums.
void GlRasterizer::look_up(std::span<const glm::vec3> directions, int order, std::size_t receivers) {
    const GlObject& shader = program(order, false);
    const Stopwatch maps;
    const GlObject table = maps_.table(directions, order);
    bind_storage(PRT_BINDING_DIRECTIONS, table);
    maps_.draw(directions);
    if (maps_.blends())
        maps_.peel(directions[0], [&] { dispatch(program(order, true), receivers, 1); });
    glFinish();
    seconds_.trace += maps.seconds();
    const Stopwatch accumulate;
    dispatch(shader, receivers, directions.size());
    glFinish();
    check_gl("looking up the depth maps");
    seconds_.accumulate += accumulate.seconds();
}

void GlRasterizer::dispatch(const GlObject& shader, std::size_t receivers, std::size_t directions) const {
    glUseProgram(shader.name());
    set_uniform(shader, "receiver_count", static_cast<std::uint32_t>(receivers));
    set_uniform(shader, "direction_count", static_cast<std::uint32_t>(directions));
    set_uniform(shader, "texel_depth", 1 / static_cast<float>(maps_.resolution()));
    glDispatchCompute(static_cast<GLuint>((receivers + 63) / 64), 1, 1);
    glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT | GL_BUFFER_UPDATE_BARRIER_BIT);
}

LampLight GlRasterizer::lamp_light(const LampTask& task, const Progress& progress) {
    return rays().lamp_light(task, progress);
}

std::unique_ptr<GatherProduct> GlRasterizer::gather_product(const GatherOperator& gather) {
    return rays().gather_product(gather);
}

} // namespace prt
