// Cuts the rays of receivers into pieces for the device, keeps two of them under way, and makes transfer of
// what comes back, with the open lobe as control variate (docs/math.md, eq. 9).

#include "trace/gpu/vulkan_tracer.h"

#include "prt/sh.h"
#include "prt/support/parallel.h"
#include "prt/support/stopwatch.h"
#include "trace/gpu/gpu_gather.h"
#include "trace/gpu/gpu_receivers.h"
#include "trace/gpu/vulkan_lamp_light.h"
#include "trace/sample_sequence.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace prt {
namespace {

constexpr double kPieceSeconds =
    0.05; ///< of the device: a desktop stays smooth, and its driver kills what takes seconds
constexpr std::size_t kMostReceivers = 1 << 17; ///< of a call, whose vectors the caller holds

} // namespace

/// What Tracer::trace is asked.
struct VulkanTracer::Job {
    const Receivers& receivers;
    std::span<const std::uint32_t> indices;
    const TraceOptions& options;
    bool hits;
    SobolChunk whole, last; ///< all chunks but the last, and the last
    TracePiece::Room room = {};

    Job(const Receivers& all, std::span<const std::uint32_t> some, const TraceOptions& trace, bool with_hits)
        : receivers(all), indices(some), options(trace), hits(with_hits), whole(kChunk, stride()),
          last((trace.rays - 1) % kChunk + 1, stride()) {}

    int stride() const { return hits ? options.hit_stride : 1; }
    std::size_t chunks() const { return (static_cast<std::size_t>(options.rays) + kChunk - 1) / kChunk; }
    std::vector<glm::uvec2> samples() const {
        std::vector<glm::uvec2> table;
        for (const SobolChunk* chunk : {&whole, &last}) {
            for (std::size_t i = 0; i < chunk->x.size(); ++i)
                table.emplace_back(chunk->x[i], chunk->y[i]);
            table.resize(chunk == &whole ? kChunk : 2 * kChunk);
        }
        return table;
    }
};

/// What the pieces give, put together.
class VulkanTracer::Results {
public:
    Results(const Job& job, std::span<float> vectors, const HitSink& sink, bool has_alpha)
        : job_(job), vectors_(vectors), sink_(sink), has_alpha_(has_alpha), control_(job.indices.size(), 0.0),
          hits_(sink ? job.indices.size() : 0) {
        std::ranges::fill(vectors, 0.0f);
    }

    /// Where in the job a piece begins.
    struct Place {
        std::size_t receiver = 0, chunk = 0;
    };

    void add_hits(Place at, const TracePiece& piece, std::span<const gpu::HitRecord> records) {
        if (has_alpha_)
            for (const gpu::HitRecord& r : records)
                add(at.receiver + r.row / piece.push().chunks, r, r.weight);
        else
            add_followed(at, piece, records);
    }

    /// The sums of a piece; after its last chunk a receiver's hits are all there.
    void add_sums(Place at, const TracePiece& piece, int threads) {
        const gpu::TracePush& push = piece.push();
        const std::size_t coefficients = vectors_.size() / job_.indices.size();
        if (!std::ranges::all_of(piece.sums().first(push.receivers * (coefficients + 1)),
                                 [](float v) { return std::isfinite(v); }))
            throw GpuFailure("the GPU computes numbers that are none: its driver fails on this scene");
        parallel_for(push.receivers, 64, threads, [&](std::size_t begin, std::size_t end) {
            for (std::size_t i = begin; i < end; ++i) {
                const float* const sums = &piece.sums()[i * (coefficients + 1)];
                for (std::size_t k = 0; k < coefficients; ++k)
                    vectors_[(at.receiver + i) * coefficients + k] += sums[k];
                control_[at.receiver + i] += static_cast<double>(sums[coefficients]);
                if (at.chunk + push.chunks == job_.chunks())
                    finish(at.receiver + i, coefficients);
            }
        });
    }

private:
    void add(std::size_t i, const gpu::HitRecord& r, float weight) {
        hits_[i].push_back(
            {r.triangle & ~PRT_HIT_BACK, r.u, r.v, weight, r.footprint, (r.triangle & PRT_HIT_BACK) != 0});
    }

    /// Those that were followed of a chunk stand for all that is blocked of it.
    void add_followed(Place at, const TracePiece& piece, std::span<const gpu::HitRecord> records) {
        const std::size_t slots = piece.push().whole_followed + 1;
        for (std::size_t row = 0; row * slots < records.size(); ++row) {
            const std::span<const gpu::HitRecord> slots_of_row = records.subspan(row * slots, slots);
            const std::size_t chunk = at.chunk + row % piece.push().chunks;
            const std::size_t followed = chunk + 1 == job_.chunks() ? piece.push().last_followed : slots - 1;
            const auto there = [](const gpu::HitRecord& r) { return r.triangle != PRT_NO_HIT; };
            const auto found = std::ranges::count_if(slots_of_row.first(followed), there) +
                               (there(slots_of_row.back()) ? 1 : 0);
            const float weight = static_cast<float>(piece.blocked_rays()[row]) / static_cast<float>(found);
            for (std::size_t s = 0; s < slots; ++s)
                if ((s < followed || s + 1 == slots) && there(slots_of_row[s]))
                    add(at.receiver + row / piece.push().chunks, slots_of_row[s], weight);
        }
    }

    /// The open lobe, and what the rays differ from it by.
    void finish(std::size_t i, std::size_t coefficients) {
        std::array<double, kMaxOrder * kMaxOrder> lobe{};
        clamped_cosine_lobe(job_.options.order, glm::dvec3(job_.receivers.normals[job_.indices[i]]), lobe);
        for (std::size_t k = 0; k < coefficients; ++k) {
            float& v = vectors_[i * coefficients + k];
            v = static_cast<float>((control_[i] * lobe[k] + static_cast<double>(v)) / job_.options.rays);
        }
        if (sink_) {
            sink_(i, hits_[i]);
            hits_[i] = {};
        }
    }

    const Job& job_;
    std::span<float> vectors_;
    const HitSink& sink_;
    bool has_alpha_;
    std::vector<double> control_; ///< [indices] rays of the chunks that use the control variate
    std::vector<std::vector<Hit>> hits_;
};

VulkanTracer::VulkanTracer(const TraceScene& scene, const VulkanChoice& choice, std::size_t piece_bytes)
    : device_(choice), queue_(device_), scene_(scene),
      scene_on_gpu_(with_vulkan_errors([&] { return GpuScene(device_, queue_, scene); })),
      piece_bytes_(std::min(piece_bytes, device_.traits().most_bytes)) {}

std::string VulkanTracer::device() const {
    return device_.traits().about.name + (device_.traits().ray_queries ? ", ray queries" : ", compute");
}

std::size_t VulkanTracer::batch_size(const TraceOptions& options) const {
    const double in_two_seconds = rays_per_second_ * 2 / options.rays;
    return static_cast<std::size_t>(std::clamp(in_two_seconds, 1.0, static_cast<double>(kMostReceivers)));
}

TraceKernels& VulkanTracer::kernels(int order, bool hits) {
    const auto found = kernels_.find({order, hits});
    if (found != kernels_.end())
        return found->second;
    return kernels_.emplace(std::pair(order, hits), TraceKernels(device_, queue_, scene_on_gpu_, order, hits))
        .first->second;
}

/// What two pieces can have of this job, by the bytes of what they hold of a row and of a receiver.
TracePiece::Room VulkanTracer::room_for(const Job& job) const {
    const bool alpha = scene_on_gpu_.has_alpha();
    const std::size_t slots = job.hits && !alpha ? static_cast<std::size_t>(job.whole.followed) + 1 : 0;
    const std::size_t row = std::max({PRT_BEAM * sizeof(std::uint32_t), alpha ? kChunk * sizeof(float) : 0,
                                      slots * sizeof(gpu::HitRecord)});
    const std::size_t receiver =
        std::max(sizeof(gpu::Receiver),
                 (static_cast<std::size_t>(coefficient_count(job.options.order)) + 1) * sizeof(float));
    TracePiece::Room room;
    room.rows = std::clamp<std::size_t>(piece_bytes_ / row, 1, job.indices.size() * job.chunks());
    room.receivers = std::min({std::max<std::size_t>(1, room.rows / job.chunks()), job.indices.size(),
                               std::max<std::size_t>(1, piece_bytes_ / receiver),
                               static_cast<std::size_t>(device_.traits().most_groups)});
    room.rows = std::min(room.rows, room.receivers * job.chunks());
    room.hits = room.rows * slots;
    if (job.hits && alpha)
        room.hits = std::clamp<std::size_t>(
            static_cast<std::size_t>(hits_per_ray_ * static_cast<double>(room.rows * kChunk)), PRT_BEAM,
            std::max<std::size_t>(PRT_BEAM, piece_bytes_ / sizeof(gpu::HitRecord)));
    return room;
}

VulkanTracer::Pieces& VulkanTracer::pieces_for(const Job& job) {
    const TraceKernels& wanted = kernels(job.options.order, job.hits);
    const TracePiece::Room& room = job.room;
    const bool same = std::exchange(of_pieces_, nullptr) == &wanted;
    for (std::unique_ptr<TracePiece>& piece : pieces_) {
        const bool fits = piece && same && piece->room().receivers >= room.receivers &&
                          piece->room().rows >= room.rows && piece->room().hits >= room.hits;
        if (!fits) {
            piece.reset(); // before another takes its memory
            piece = std::make_unique<TracePiece>(device_, scene_on_gpu_, wanted, room);
        }
    }
    of_pieces_ = &wanted;
    return pieces_;
}

/// As many chunks from there as the device traces in its time: of several receivers all chunks, or some of
/// one.
gpu::TracePush VulkanTracer::next(const Job& job, std::size_t receiver, std::size_t chunk) const {
    const TracePiece::Room& room =
        job.room; // pieces of the job before may have more rows, but not hits for them
    const auto in_time = static_cast<std::size_t>(rays_per_second_ * kPieceSeconds / kChunk);
    const std::size_t rows = std::clamp<std::size_t>(in_time, 1, room.rows), chunks = job.chunks();
    const bool whole = chunk == 0 && rows >= chunks;
    const std::size_t receivers =
        whole ? std::min({rows / chunks, room.receivers, job.indices.size() - receiver}) : 1;
    gpu::TracePush push{};
    push.receivers = static_cast<std::uint32_t>(receivers);
    push.first_chunk = static_cast<std::uint32_t>(chunk);
    push.chunks = static_cast<std::uint32_t>(std::min({whole ? chunks : rows, chunks - chunk, kMostGroups}));
    push.all_chunks = static_cast<std::uint32_t>(chunks);
    push.last_rays = static_cast<std::uint32_t>(job.last.rays);
    push.first_ray = job.options.first_ray;
    push.whole_followed = static_cast<std::uint32_t>(job.hits ? job.whole.followed : 0);
    push.last_followed = static_cast<std::uint32_t>(job.hits ? job.last.followed : 0);
    push.spread =
        std::numbers::pi_v<float> * static_cast<float>(job.stride()) / static_cast<float>(job.options.rays);
    return push;
}

void VulkanTracer::trace(const Receivers& receivers, std::span<const std::uint32_t> indices,
                         const TraceOptions& options, std::span<float> vectors, const HitSink& sink,
                         const Progress& progress) {
    if (indices.empty())
        return;
    with_vulkan_errors([&] {
        Job job(receivers, indices, options, static_cast<bool>(sink));
        job.room = room_for(job);
        const Stopwatch transfer;
        pieces_for(job);
        kernels(options.order, job.hits).set_samples(device_, queue_, job.samples());
        seconds_.transfer += transfer.seconds();
        Results results(job, vectors, sink, scene_on_gpu_.has_alpha());
        run(job, results, progress);
    });
}

void VulkanTracer::run(const Job& job, Results& results, const Progress& progress) {
    struct UnderWay {
        TracePiece* piece = nullptr;
        Results::Place at;
        Stopwatch watch = {};
    };
    std::array<UnderWay, 2> under_way;
    const auto end = [&](UnderWay& work) {
        if (!work.piece)
            return;
        TracePiece& piece = *std::exchange(work.piece, nullptr);
        std::size_t found = 0;
        piece.finish(queue_, [&](std::span<const gpu::HitRecord> hits) {
            found += hits.size();
            results.add_hits(work.at, piece, hits);
        });
        const double rays = static_cast<double>(piece.push().receivers) * piece.push().chunks * kChunk;
        const double clock = piece.seconds(), took = clock > 0 ? clock : work.watch.seconds();
        seconds_.trace += took;
        rays_per_second_ = 0.5 * (rays_per_second_ + rays / std::max(took, 1e-6));
        if (scene_on_gpu_.has_alpha())
            hits_per_ray_ = std::max(hits_per_ray_, 1.25 * static_cast<double>(found) / rays);
        const Stopwatch accumulate;
        results.add_sums(work.at, piece, scene_.threads());
        seconds_.accumulate += accumulate.seconds();
        progress.update(static_cast<double>(work.at.receiver) / static_cast<double>(job.indices.size()));
    };
    try {
        Results::Place at;
        std::size_t n = 0;
        for (; at.receiver < job.indices.size(); ++n) {
            UnderWay& work = under_way[n % 2];
            end(work);
            TracePiece& piece = *pieces_[n % 2];
            const gpu::TracePush push = next(job, at.receiver, at.chunk);
            const Stopwatch transfer;
            std::ranges::copy(gpu_receivers(scene_, job.receivers,
                                            job.indices.subspan(at.receiver, push.receivers),
                                            job.options.seed),
                              piece.receivers().begin());
            piece.start(queue_, push);
            seconds_.transfer += transfer.seconds();
            work = {&piece, at, {}};
            at.chunk += push.chunks;
            if (at.chunk == job.chunks())
                at = {at.receiver + push.receivers, 0};
        }
        for (UnderWay* work : {&under_way[n % 2], &under_way[(n + 1) % 2]}) // the older one first
            end(*work);
    } catch (...) {
        queue_.wait_for_all(); // the device still writes to pieces
        throw;
    }
}

std::unique_ptr<GatherProduct> VulkanTracer::gather_product(const GatherOperator& gather) {
    pieces_ = {}; // what they take is wanted now
    try {
        return with_vulkan_errors([&] { return std::make_unique<GpuGather>(device_, queue_, gather); });
    } catch (const GpuMemoryError&) {
        return nullptr;
    }
}

LampLight VulkanTracer::lamp_light(const LampTask& task, const Progress& progress) {
    return with_vulkan_errors(
        [&] { return lamp_light_on_gpu(device_, queue_, scene_on_gpu_, task, progress); });
}

} // namespace prt
