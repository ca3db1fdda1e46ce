#include "trace/gpu/gl_tracer.h"

#include "prt/gl_objects.h"
#include "prt/sh.h"
#include "prt/support/error.h"
#include "prt/support/parallel.h"
#include "prt/support/stopwatch.h"
#include "shared_layout.h"
#include "trace/gpu/gpu_receivers.h"
#include "trace/gpu/gpu_scene.h"
#include "trace/sample_sequence.h"

#include <epoxy/gl.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <utility>

namespace prt {
namespace {

static_assert(PRT_CHUNK == kChunk);

// As in shaders/bake_trace.comp.
struct HitRecord {
    std::uint32_t receiver, chunk, triangle;
    float u, v, weight, footprint;
    std::uint32_t unused;
};
static_assert(sizeof(HitRecord) == 32);
constexpr std::uint32_t kBack = 0x80000000u;

constexpr double kDispatchSeconds = 0.1;   ///< a desktop's driver kills what takes seconds
constexpr std::size_t kMostGroups = 65535; ///< workgroups that every OpenGL 4.5 takes in one direction

std::vector<glm::vec4> sh_factors() {
    std::vector<glm::vec4> factors(100, glm::vec4(0));
    const auto& k = detail::kLegendre;
    for (std::size_t m = 0; m < kMaxOrder; ++m) {
        factors[11 * m].z = static_cast<float>(k.sectoral[m]);
        for (std::size_t l = m + 1; l < kMaxOrder; ++l) {
            factors[10 * l + m].x = static_cast<float>(k.a[l][m]);
            factors[10 * l + m].y = static_cast<float>(k.b[l][m]);
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

template <class T>
void read_buffer(const GlObject& buffer, std::span<T> to, const char* what) {
    glGetNamedBufferSubData(buffer.name(), 0, static_cast<GLsizeiptr>(to.size_bytes()), to.data());
    check_gl(what);
}

void set_uniform(const GlObject& program, const char* name, std::size_t value) {
    glProgramUniform1ui(program.name(), glGetUniformLocation(program.name(), name),
                        static_cast<GLuint>(value));
}

} // namespace

class GlTracer::Implementation {
public:
    Implementation(std::unique_ptr<GlContext> context, const TraceScene& scene, std::size_t hit_bytes)
        : context_(std::move(context)), rays_(scene.rays()), scene_(scene), threads_(scene.threads()),
          most_hits_(hit_bytes / sizeof(HitRecord)),
          sh_factors_(make_buffer(std::span<const glm::vec4>(sh_factors()))) {}

    std::string device() const { return context_->renderer(); }
    std::size_t traced_again() const { return traced_again_; }

    std::size_t batch_size(const TraceOptions& options) const {
        const double receivers = rays_per_second_ * kDispatchSeconds / options.rays;
        return static_cast<std::size_t>(std::clamp(receivers, 1.0, static_cast<double>(kMostGroups)));
    }

    void trace(const Receivers& receivers, std::span<const std::uint32_t> indices,
               const TraceOptions& options, std::span<float> vectors, const HitSink& sink,
               TraceSeconds& seconds) {
        const auto coefficients = static_cast<std::size_t>(coefficient_count(options.order));
        std::size_t most = kMostGroups;
        for (std::size_t begin = 0; begin < indices.size();) {
            const std::size_t count = std::min(
                {indices.size() - begin, most,
                 sink ? std::max<std::size_t>(1, most_hits_ / hits_per_chunk(options)) : kMostGroups});
            HitSink part;
            if (sink)
                part = [&](std::size_t i, std::span<const Hit> hits) { sink(begin + i, hits); };
            bool fits = false;
            try {
                fits = try_trace(receivers, indices.subspan(begin, count), options,
                                 vectors.subspan(begin * coefficients, count * coefficients), part, seconds);
            } catch (const GpuOutOfMemory&) {
                if (count <= 1)
                    throw;
            }
            if (fits)
                begin += count;
            else if (count <= 1)
                throw GpuOutOfMemory("the GPU has no memory for what the rays of a receiver meet");
            else
                most = count / 2;
        }
    }

private:
    const GlObject& program(int order, bool hits) {
        auto& program = programs_[{order, hits}];
        if (program.name() == 0)
            program = make_compute_program("bake_trace.comp", scene_.defines() + "#define PRT_ORDER " +
                                                                  std::to_string(order) + "\n" +
                                                                  (hits ? "#define PRT_HITS\n" : ""));
        return program;
    }

    /// Records that the rays of a chunk need room for. Where surfaces are opaque no more can be: every ray
    /// that is followed, and one that stands for those that are not. Through blended surfaces rays have no
    /// bound: what they needed so far.
    std::size_t hits_per_chunk(const TraceOptions& options) const {
        if (scene_.has_alpha())
            return static_cast<std::size_t>(std::ceil(hits_per_ray_ * kChunk));
        return static_cast<std::size_t>((kChunk + options.hit_stride - 1) / options.hit_stride) + 1;
    }

    /// False where the hits do not fit.
    bool try_trace(const Receivers& receivers, std::span<const std::uint32_t> indices,
                   const TraceOptions& options, std::span<float> vectors, const HitSink& sink,
                   TraceSeconds& seconds) {
        const auto coefficients = static_cast<std::size_t>(coefficient_count(options.order));
        const auto rays = static_cast<std::size_t>(options.rays);
        const std::size_t chunks = (rays + kChunk - 1) / kChunk;
        const int stride = sink ? options.hit_stride : 1;
        const SobolChunk whole(kChunk, stride), last((options.rays - 1) % kChunk + 1, stride);

        Stopwatch transfer;
        const GlObject samples = sample_table(whole, last);
        const GlObject gpu_receivers = upload_receivers(rays_, receivers, indices, options.seed, threads_);
        std::vector<float> sums(indices.size() * (coefficients + 1));
        const GlObject gpu_sums = make_buffer(std::span<const float>(sums));
        glFinish();
        seconds.transfer += transfer.seconds();

        const GlObject& shader = program(options.order, static_cast<bool>(sink));
        glUseProgram(shader.name());
        scene_.bind();
        glBindBufferBase(GL_UNIFORM_BUFFER, PRT_BINDING_SH_FACTORS, sh_factors_.name());
        glBindBufferBase(GL_SHADER_STORAGE_BUFFER, PRT_BINDING_SAMPLES, samples.name());
        glBindBufferBase(GL_SHADER_STORAGE_BUFFER, PRT_BINDING_RECEIVERS, gpu_receivers.name());
        glBindBufferBase(GL_SHADER_STORAGE_BUFFER, PRT_BINDING_SUMS, gpu_sums.name());
        set_uniform(shader, "first_ray", options.first_ray);
        set_uniform(shader, "all_chunks", chunks);
        set_uniform(shader, "last_rays", static_cast<std::size_t>(last.rays));
        set_uniform(shader, "whole_followed", sink ? static_cast<std::size_t>(whole.followed) : 0);
        set_uniform(shader, "last_followed", sink ? static_cast<std::size_t>(last.followed) : 0);
        glProgramUniform1f(shader.name(), glGetUniformLocation(shader.name(), "rays"),
                           static_cast<float>(options.rays) / static_cast<float>(stride));

        std::vector<std::vector<Hit>> hits(sink ? indices.size() : 0);
        for (std::size_t begin = 0; begin < chunks;) {
            const double chunks_wanted = rays_per_second_ * kDispatchSeconds /
                                         (static_cast<double>(kChunk) * static_cast<double>(indices.size()));
            std::size_t count = static_cast<std::size_t>(chunks_wanted);
            if (sink)
                count = std::min(count, most_hits_ / (hits_per_chunk(options) * indices.size()));
            const std::size_t end = std::min(chunks, begin + std::max<std::size_t>(1, count));
            if (!dispatch(shader, indices.size(), begin, end, sink ? &hits : nullptr, hits_per_chunk(options),
                          seconds))
                return false;
            begin = end;
        }
        transfer = Stopwatch();
        read_buffer(gpu_sums, std::span(sums), "the sums");
        seconds.transfer += transfer.seconds();

        const Stopwatch accumulate;
        parallel_for(indices.size(), 64, threads_, [&](std::size_t begin, std::size_t end) {
            std::array<double, kMaxOrder * kMaxOrder> lobe{};
            for (std::size_t i = begin; i < end; ++i) {
                clamped_cosine_lobe(options.order, glm::dvec3(receivers.normals[indices[i]]), lobe);
                const float* const sum = &sums[i * (coefficients + 1)];
                for (std::size_t k = 0; k < coefficients; ++k)
                    vectors[i * coefficients + k] = static_cast<float>(
                        (static_cast<double>(sum[coefficients]) * lobe[k] + static_cast<double>(sum[k])) /
                        options.rays);
                if (sink)
                    sink(i, hits[i]);
            }
        });
        seconds.accumulate += accumulate.seconds();
        return true;
    }

    /// Traces chunks [begin, end) of all receivers of the batch. False where the hits do not fit.
    bool dispatch(const GlObject& shader, std::size_t receivers, std::size_t begin, std::size_t end,
                  std::vector<std::vector<Hit>>* hits, std::size_t hits_per_chunk, TraceSeconds& seconds) {
        set_uniform(shader, "first_chunk", begin);
        set_uniform(shader, "end_chunk", end);
        GlObject records, count, blocked;
        std::size_t capacity = 0;
        const std::vector<float> no_blocked(receivers * (end - begin));
        if (hits) {
            capacity = std::min(most_hits_, receivers * (end - begin) * hits_per_chunk);
            records = make_buffer_of(capacity * sizeof(HitRecord));
            const std::uint32_t zero = 0;
            count = make_buffer(std::span(&zero, 1));
            blocked = make_buffer(std::span<const float>(no_blocked));
            set_uniform(shader, "hit_capacity", capacity);
            glBindBufferBase(GL_SHADER_STORAGE_BUFFER, PRT_BINDING_HITS, records.name());
            glBindBufferBase(GL_SHADER_STORAGE_BUFFER, PRT_BINDING_HIT_COUNT, count.name());
            glBindBufferBase(GL_SHADER_STORAGE_BUFFER, PRT_BINDING_BLOCKED, blocked.name());
        }
        const Stopwatch trace;
        glDispatchCompute(static_cast<GLuint>(receivers), 1, 1);
        glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT | GL_BUFFER_UPDATE_BARRIER_BIT);
        glFinish();
        check_gl("tracing");
        const double took = trace.seconds();
        seconds.trace += took;
        const double rays = static_cast<double>(receivers) * static_cast<double>((end - begin) * kChunk);
        rays_per_second_ = 0.5 * (rays_per_second_ + rays / std::max(took, 1e-6));
        if (!hits)
            return true;

        const Stopwatch transfer;
        std::uint32_t found = 0;
        read_buffer(count, std::span(&found, 1), "the number of hits");
        hits_per_ray_ = std::max(hits_per_ray_, 1.25 * found / rays); // the next batches have room
        if (found > capacity) {
            ++traced_again_;
            return false;
        }
        std::vector<HitRecord> read(found);
        std::vector<float> blocked_of(no_blocked.size());
        read_buffer(records, std::span(read), "the hits");
        read_buffer(blocked, std::span(blocked_of), "the blocked rays");
        seconds.transfer += transfer.seconds();
        sort_hits(read, blocked_of, begin, end, *hits);
        return true;
    }

    /// Appends the records to the hits of their receivers. What was followed of a chunk stands for all that
    /// is blocked of it; where rays pass surfaces, all were followed.
    void sort_hits(std::span<const HitRecord> records, std::span<const float> blocked, std::size_t begin,
                   std::size_t end, std::vector<std::vector<Hit>>& hits) const {
        const std::size_t chunks = end - begin;
        std::vector<std::uint32_t> found(blocked.size());
        const auto place = [&](const HitRecord& r) { return r.receiver * chunks + r.chunk - begin; };
        for (const HitRecord& r : records)
            ++found[place(r)];
        for (const HitRecord& r : records) {
            const float weight =
                scene_.has_alpha() ? r.weight : blocked[place(r)] / static_cast<float>(found[place(r)]);
            hits[r.receiver].push_back(
                {r.triangle & ~kBack, r.u, r.v, weight, r.footprint, (r.triangle & kBack) != 0});
        }
    }

    static GlObject make_buffer_of(std::size_t bytes) {
        GLuint name = 0;
        glCreateBuffers(1, &name);
        GlObject buffer(GlKind::buffer, name);
        glNamedBufferStorage(name, static_cast<GLsizeiptr>(std::max<std::size_t>(bytes, 4)), nullptr, 0);
        check_gl("a buffer");
        return buffer;
    }

    std::unique_ptr<GlContext> context_;
    const RayScene& rays_;
    GpuScene scene_;
    int threads_;
    std::size_t most_hits_; ///< of a dispatch
    std::size_t traced_again_ = 0;
    GlObject sh_factors_;
    std::map<std::pair<int, bool>, GlObject> programs_; ///< by order, and whether hits are noted
    double rays_per_second_ = 1e6;                      ///< until measured, that of a software rasteriser
    double hits_per_ray_ = 1; ///< through blended surfaces, a quarter more than measured
};

GlTracer::GlTracer(std::unique_ptr<GlContext> context, const TraceScene& scene, std::size_t hit_bytes)
    : implementation_(std::make_unique<Implementation>(std::move(context), scene, hit_bytes)) {}

GlTracer::~GlTracer() = default;

std::string GlTracer::device() const {
    return implementation_->device();
}

std::size_t GlTracer::traced_again() const {
    return implementation_->traced_again();
}

std::size_t GlTracer::batch_size(const TraceOptions& options) const {
    return implementation_->batch_size(options);
}

void GlTracer::trace(const Receivers& receivers, std::span<const std::uint32_t> indices,
                     const TraceOptions& options, std::span<float> vectors, const HitSink& sink,
                     const Progress&) {
    implementation_->trace(receivers, indices, options, vectors, sink, seconds_);
}

} // namespace prt
