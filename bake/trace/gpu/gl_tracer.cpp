// Rays in a compute shader (shaders/bake_trace.comp): direct transfer with the open lobe as control variate
// (docs/math.md, eq. 9), through the hierarchy of Ylitie, Karras and Laine (2017).

#include "trace/gpu/gl_tracer.h"

#include "prt/gl_objects.h"
#include "prt/sh.h"
#include "prt/support/error.h"
#include "prt/support/parallel.h"
#include "prt/support/stopwatch.h"
#include "trace/gpu/gl_lamp_light.h"
#include "trace/gpu/gpu_receivers.h"
#include "trace/gpu/gpu_structs.h"
#include "trace/sample_sequence.h"

#include <epoxy/gl.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace prt {
namespace {

static_assert(PRT_MOST_ORDER == kMaxOrder);

constexpr double kDispatchSeconds = 0.1;   ///< a desktop's driver kills what takes seconds
constexpr std::size_t kMostGroups = 65535; ///< workgroups that every OpenGL 4.5 takes in one direction

std::vector<glm::vec4> sh_factors() {
    std::vector<glm::vec4> factors(PRT_MOST_COEFFICIENTS, glm::vec4(0));
    const auto& k = detail::kLegendre;
    for (std::size_t m = 0; m < kMaxOrder; ++m) {
        factors[PRT_SH_FACTOR(m, m)].z = static_cast<float>(k.sectoral[m]);
        for (std::size_t l = m + 1; l < kMaxOrder; ++l) {
            factors[PRT_SH_FACTOR(l, m)].x = static_cast<float>(k.a[l][m]);
            factors[PRT_SH_FACTOR(l, m)].y = static_cast<float>(k.b[l][m]);
        }
    }
    return factors;
}

GlObject sample_table(const SobolChunk& whole, const SobolChunk& last) {
    std::vector<glm::uvec2> table;
    for (const SobolChunk* chunk : {&whole, &last}) {
        for (std::size_t i = 0; i < chunk->x.size(); ++i)
            table.emplace_back(chunk->x[i], chunk->y[i]);
        table.resize(table.size() < kChunk ? kChunk : table.size());
    }
    return make_buffer(std::span<const glm::uvec2>(table));
}

} // namespace

/// What Tracer::trace is asked, or a piece of it.
struct GlTracer::Job {
    const Receivers& receivers;
    std::span<const std::uint32_t> indices;
    const TraceOptions& options;
    std::span<float> vectors;
    HitSink sink;

    std::size_t coefficients() const { return static_cast<std::size_t>(coefficient_count(options.order)); }
    Job piece(std::size_t begin, std::size_t count) const {
        HitSink part;
        if (sink)
            part = [this, begin](std::size_t i, std::span<const Hit> hits) { sink(begin + i, hits); };
        return {receivers, indices.subspan(begin, count), options,
                vectors.subspan(begin * coefficients(), count * coefficients()), part};
    }
};

/// The chunks [begin, end) of the rays of every receiver of a batch.
struct GlTracer::Chunks {
    std::size_t begin, end;
    std::size_t size() const { return end - begin; }
};

/// Receivers on the device, their samples, and the sums over their rays.
class GlTracer::Batch {
public:
    Batch(const TraceScene& scene, const Job& job)
        : whole_(kChunk, stride(job)), last_((job.options.rays - 1) % kChunk + 1, stride(job)),
          samples_(sample_table(whole_, last_)),
          receivers_(upload_receivers(scene, job.receivers, job.indices, job.options.seed)),
          sums_(job.indices.size() * (job.coefficients() + 1)),
          gpu_sums_(make_buffer(std::span<const float>(sums_))),
          chunks_((static_cast<std::size_t>(job.options.rays) + kChunk - 1) / kChunk) {
        glFinish();
    }

    std::size_t chunks() const { return chunks_; } ///< of a receiver

    void bind(const GlObject& shader, const Job& job) const {
        bind_storage(PRT_BINDING_SAMPLES, samples_);
        bind_storage(PRT_BINDING_RECEIVERS, receivers_);
        bind_storage(PRT_BINDING_SUMS, gpu_sums_);
        set_uniform(shader, "first_ray", job.options.first_ray);
        set_uniform(shader, "all_chunks", static_cast<std::uint32_t>(chunks_));
        set_uniform(shader, "last_rays", static_cast<std::uint32_t>(last_.rays));
        set_uniform(shader, "whole_followed", static_cast<std::uint32_t>(job.sink ? whole_.followed : 0));
        set_uniform(shader, "last_followed", static_cast<std::uint32_t>(job.sink ? last_.followed : 0));
        set_uniform(shader, "rays", static_cast<float>(job.options.rays) / static_cast<float>(stride(job)));
    }

    void read_sums() { read_buffer(gpu_sums_, std::span(sums_), "the sums"); }

    /// Writes the transfer: the open lobe, and what its rays differ from it by.
    void add_lobes(const Job& job, int threads) const {
        const std::size_t coefficients = job.coefficients();
        parallel_for(job.indices.size(), 64, threads, [&](std::size_t begin, std::size_t end) {
            std::array<double, kMaxOrder * kMaxOrder> lobe{};
            for (std::size_t i = begin; i < end; ++i) {
                clamped_cosine_lobe(job.options.order, glm::dvec3(job.receivers.normals[job.indices[i]]),
                                    lobe);
                const float* const sum = &sums_[i * (coefficients + 1)];
                for (std::size_t k = 0; k < coefficients; ++k)
                    job.vectors[i * coefficients + k] = static_cast<float>(
                        (static_cast<double>(sum[coefficients]) * lobe[k] + static_cast<double>(sum[k])) /
                        job.options.rays);
            }
        });
    }

private:
    static int stride(const Job& job) { return job.sink ? job.options.hit_stride : 1; }

    SobolChunk whole_, last_;
    GlObject samples_, receivers_;
    std::vector<float> sums_; ///< per receiver [order²], and the rays that use the control variate
    GlObject gpu_sums_;
    std::size_t chunks_;
};

/// Room for what the rays of a dispatch meet.
class GlTracer::HitBuffers {
public:
    HitBuffers(std::size_t capacity, std::size_t receivers, Chunks chunks)
        : chunks_(chunks), capacity_(capacity), blocked_of_(receivers * chunks.size()),
          records_(make_buffer_of(capacity * sizeof(gpu::HitRecord))),
          count_(make_buffer(std::as_bytes(std::span(&found_, 1)))),
          blocked_(make_buffer(std::span<const float>(blocked_of_))) {}

    void bind(const GlObject& shader) const {
        set_uniform(shader, "hit_capacity", static_cast<std::uint32_t>(capacity_));
        bind_storage(PRT_BINDING_HITS, records_);
        bind_storage(PRT_BINDING_HIT_COUNT, count_);
        bind_storage(PRT_BINDING_BLOCKED, blocked_);
    }

    /// How many were met; more than the capacity were not kept.
    std::uint32_t read_count() {
        read_buffer(count_, std::span(&found_, 1), "the number of hits");
        return found_;
    }

    void read() {
        hits_.resize(found_);
        read_buffer(records_, std::span(hits_), "the hits");
        read_buffer(blocked_, std::span(blocked_of_), "the blocked rays");
    }

    /// Appends the records to the hits of their receivers. What was followed of a chunk stands for all that
    /// is blocked of it; where rays pass surfaces, all were followed.
    void sort(bool has_alpha, std::vector<std::vector<Hit>>& hits) const {
        std::vector<std::uint32_t> found(blocked_of_.size());
        const auto place = [&](const gpu::HitRecord& r) {
            return r.receiver * chunks_.size() + r.chunk - chunks_.begin;
        };
        for (const gpu::HitRecord& r : hits_)
            ++found[place(r)];
        for (const gpu::HitRecord& r : hits_) {
            const float weight =
                has_alpha ? r.weight : blocked_of_[place(r)] / static_cast<float>(found[place(r)]);
            hits[r.receiver].push_back({r.triangle & ~PRT_HIT_BACK, r.u, r.v, weight, r.footprint,
                                        (r.triangle & PRT_HIT_BACK) != 0});
        }
    }

private:
    Chunks chunks_;
    std::size_t capacity_;
    std::uint32_t found_ = 0;
    std::vector<gpu::HitRecord> hits_;
    std::vector<float> blocked_of_;
    GlObject records_, count_, blocked_;
};

GlTracer::GlTracer(std::unique_ptr<GlContext> context, const TraceScene& scene, std::size_t hit_bytes)
    : context_(std::move(context)), scene_(scene), gpu_scene_(scene),
      most_hits_(hit_bytes / sizeof(gpu::HitRecord)),
      sh_factors_(make_buffer(std::span<const glm::vec4>(sh_factors()))) {}

std::size_t GlTracer::batch_size(const TraceOptions& options) const {
    const double receivers = rays_per_second_ * kDispatchSeconds / options.rays;
    return static_cast<std::size_t>(std::clamp(receivers, 1.0, static_cast<double>(kMostGroups)));
}

void GlTracer::trace(const Receivers& receivers, std::span<const std::uint32_t> indices,
                     const TraceOptions& options, std::span<float> vectors, const HitSink& sink,
                     const Progress&) {
    const Job job{receivers, indices, options, vectors, sink};
    std::size_t most = kMostGroups;
    for (std::size_t begin = 0; begin < job.indices.size();) {
        std::size_t count = std::min(job.indices.size() - begin, most);
        if (job.sink)
            count = std::min(count, std::max<std::size_t>(1, most_hits_ / hits_per_chunk(job.options)));
        try {
            trace_piece(job.piece(begin, count));
            begin += count;
        } catch (const GpuOutOfMemory&) {
            if (count <= 1)
                throw;
            most = count / 2;
        }
    }
}

const GlObject& GlTracer::program(int order, bool hits) {
    auto& program = programs_[{order, hits}];
    if (program.name() == 0)
        program = make_compute_program("bake_trace.comp", gpu_scene_.defines() + "#define PRT_ORDER " +
                                                              std::to_string(order) + "\n" +
                                                              (hits ? "#define PRT_HITS\n" : ""));
    return program;
}

/// Records that the rays of a chunk need room for. Where surfaces are opaque no more can be: every ray
/// that is followed, and one that stands for those that are not. Through blended surfaces rays have no
/// bound: what they needed so far.
std::size_t GlTracer::hits_per_chunk(const TraceOptions& options) const {
    if (gpu_scene_.has_alpha())
        return static_cast<std::size_t>(std::ceil(hits_per_ray_ * kChunk));
    return static_cast<std::size_t>((kChunk + options.hit_stride - 1) / options.hit_stride) + 1;
}

/// What the device does in kDispatchSeconds, and its hits have room for.
std::size_t GlTracer::chunks_at_once(const Job& job) const {
    const auto receivers = static_cast<double>(job.indices.size());
    auto count = static_cast<std::size_t>(rays_per_second_ * kDispatchSeconds /
                                          (static_cast<double>(kChunk) * receivers));
    if (job.sink)
        count = std::min(count, most_hits_ / (hits_per_chunk(job.options) * job.indices.size()));
    return std::max<std::size_t>(1, count);
}

void GlTracer::trace_piece(const Job& job) {
    Stopwatch transfer;
    Batch batch(scene_, job);
    seconds_.transfer += transfer.seconds();

    const GlObject& shader = program(job.options.order, static_cast<bool>(job.sink));
    glUseProgram(shader.name());
    gpu_scene_.bind();
    glBindBufferBase(GL_UNIFORM_BUFFER, PRT_BINDING_SH_FACTORS, sh_factors_.name());
    batch.bind(shader, job);
    std::vector<std::vector<Hit>> hits(job.sink ? job.indices.size() : 0);
    for (std::size_t begin = 0; begin < batch.chunks();) {
        const Chunks chunks{begin, std::min(batch.chunks(), begin + chunks_at_once(job))};
        if (job.sink)
            trace_hits(shader, job, chunks, hits);
        else
            dispatch(shader, job.indices.size(), chunks);
        begin = chunks.end;
    }

    transfer = Stopwatch();
    batch.read_sums();
    seconds_.transfer += transfer.seconds();
    const Stopwatch accumulate;
    batch.add_lobes(job, scene_.threads());
    parallel_for(hits.size(), 64, scene_.threads(), [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i)
            job.sink(i, hits[i]);
    });
    seconds_.accumulate += accumulate.seconds();
}

void GlTracer::dispatch(const GlObject& shader, std::size_t receivers, Chunks chunks) {
    set_uniform(shader, "first_chunk", static_cast<std::uint32_t>(chunks.begin));
    set_uniform(shader, "end_chunk", static_cast<std::uint32_t>(chunks.end));
    const Stopwatch trace;
    glDispatchCompute(static_cast<GLuint>(receivers), 1, 1);
    glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT | GL_BUFFER_UPDATE_BARRIER_BIT);
    glFinish();
    check_gl("tracing");
    const double took = trace.seconds();
    seconds_.trace += took;
    rays_per_second_ = 0.5 * (rays_per_second_ +
                              static_cast<double>(receivers * chunks.size() * kChunk) / std::max(took, 1e-6));
}

/// Throws `GpuOutOfMemory` where the hits do not fit; the next batches have room.
void GlTracer::trace_hits(const GlObject& shader, const Job& job, Chunks chunks,
                          std::vector<std::vector<Hit>>& hits) {
    const std::size_t receivers = job.indices.size(), beams = receivers * chunks.size();
    const std::size_t capacity = std::min(most_hits_, beams * hits_per_chunk(job.options));
    HitBuffers buffers(capacity, receivers, chunks);
    buffers.bind(shader);
    dispatch(shader, receivers, chunks);

    const Stopwatch transfer;
    const std::uint32_t found = buffers.read_count();
    hits_per_ray_ = std::max(hits_per_ray_, 1.25 * found / static_cast<double>(beams * kChunk));
    if (found > capacity) {
        ++traced_again_;
        throw GpuOutOfMemory("the GPU has no memory for what the rays of a receiver meet");
    }
    buffers.read();
    seconds_.transfer += transfer.seconds();
    buffers.sort(gpu_scene_.has_alpha(), hits);
}

LampLight GlTracer::lamp_light(const LampTask& task, const Progress& progress) {
    return lamp_light_on_gpu(gpu_scene_, task, progress);
}

} // namespace prt
