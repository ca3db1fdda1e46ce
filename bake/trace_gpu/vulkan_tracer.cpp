// Divides the rays of receivers into pieces for the device, keeps two pieces active, and computes transfer
// from their results, with the unshadowed lobe as control variate (docs/math.md, eq. 9).

#include "bake/trace_gpu/vulkan_tracer.h"

#include "bake/trace/sample_sequence.h"
#include "bake/trace_gpu/gpu_gather.h"
#include "bake/trace_gpu/gpu_receivers.h"
#include "bake/trace_gpu/gpu_sum_row.h"
#include "bake/trace_gpu/vulkan_lamp_light.h"
#include "runtime/core/support/stopwatch.h"

#include <algorithm>
#include <numbers>

namespace prt {
namespace {

constexpr double kPieceSeconds =
    0.05; ///< time on the device: a desktop stays responsive, and its driver ends work that takes seconds
constexpr std::size_t kMaxReceivers = 1 << 17; ///< maximum per call; the caller stores their vectors

} // namespace

VulkanTracer::VulkanTracer(const TraceScene& scene, const VulkanChoice& choice, std::size_t piece_bytes)
    : device_(choice), queue_(device_), scene_(scene),
      scene_on_gpu_(with_vulkan_errors([&] { return GpuScene(device_, queue_, scene); })),
      piece_bytes_(std::min(piece_bytes, device_.traits().max_bytes)) {}

std::string VulkanTracer::device() const {
    return device_.traits().about.name + (device_.traits().ray_queries ? ", ray queries" : ", compute");
}

std::size_t VulkanTracer::batch_size(const TraceOptions& options) const {
    const double in_two_seconds = rays_per_second_ * 2 / options.rays;
    return static_cast<std::size_t>(std::clamp(in_two_seconds, 1.0, static_cast<double>(kMaxReceivers)));
}

TraceKernels& VulkanTracer::kernels(const TraceKernels::Kind& kind) {
    const auto found = kernels_.find(kind);
    return found != kernels_.end()
               ? found->second
               : kernels_.emplace(kind, TraceKernels(device_, queue_, scene_on_gpu_, kind)).first->second;
}

/// Computes the size of two pieces for this job, from the bytes per row and per receiver.
TracePiece::Room VulkanTracer::room_for(const TraceJob& job) const {
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
                               static_cast<std::size_t>(device_.traits().max_groups)});
    room.rows = std::min(room.rows, room.receivers * job.chunks());
    room.hits = room.rows * slots;
    if (job.hits && alpha)
        room.hits = std::clamp<std::size_t>(
            static_cast<std::size_t>(hits_per_ray_ * static_cast<double>(room.rows * kChunk)), PRT_BEAM,
            std::max<std::size_t>(PRT_BEAM, piece_bytes_ / sizeof(gpu::HitRecord)));
    return room;
}

/// Creates kernels and pieces that are large enough for the job.
void VulkanTracer::prepare(const TraceJob& job, Pieces& pieces, const TracePiece::Sums* sums) {
    TraceKernels& wanted = kernels({job.options.order, job.hits, sums != nullptr});
    const TracePiece::Room& room = job.room;
    const bool same = std::exchange(pieces.kernels, nullptr) == &wanted;
    for (std::unique_ptr<TracePiece>& piece : pieces.two) {
        const bool fits = piece && same && piece->room().receivers >= room.receivers &&
                          piece->room().rows >= room.rows && piece->room().hits >= room.hits;
        if (!fits) {
            piece.reset(); // before a new piece takes its memory
            piece = std::make_unique<TracePiece>(device_, scene_on_gpu_, wanted, room, sums);
        }
    }
    pieces.kernels = &wanted;
    wanted.set_samples(device_, queue_, job.samples());
}

/// Returns the next piece, sized for the target time of the device: either all chunks of several receivers,
/// or some chunks of one receiver.
gpu::TracePush VulkanTracer::next(const TraceJob& job, std::size_t receiver, std::size_t chunk) const {
    const TracePiece::Room& room =
        job.room; // pieces of the previous job may have more rows, but no memory for their hits
    const auto in_time = static_cast<std::size_t>(rays_per_second_ * kPieceSeconds / kChunk);
    const std::size_t rows = std::clamp<std::size_t>(in_time, 1, room.rows), chunks = job.chunks();
    const bool whole = chunk == 0 && rows >= chunks;
    const std::size_t receivers =
        whole ? std::min({rows / chunks, room.receivers, job.indices.size() - receiver}) : 1;
    gpu::TracePush push{};
    push.receivers = static_cast<std::uint32_t>(receivers);
    push.first_chunk = static_cast<std::uint32_t>(chunk);
    push.chunks = static_cast<std::uint32_t>(std::min({whole ? chunks : rows, chunks - chunk, kMaxGroups}));
    push.all_chunks = static_cast<std::uint32_t>(chunks);
    push.last_rays = static_cast<std::uint32_t>(job.last.rays);
    push.first_ray = job.options.first_ray;
    push.whole_followed = static_cast<std::uint32_t>(job.hits ? job.whole.followed : 0);
    push.last_followed = static_cast<std::uint32_t>(job.hits ? job.last.followed : 0);
    const int stride = scene_on_gpu_.has_alpha() ? 1 : job.stride(); // with alpha every ray has a hit
    push.spread =
        std::numbers::pi_v<float> * static_cast<float>(stride) / static_cast<float>(job.options.rays);
    return push;
}

void VulkanTracer::trace(const Receivers& receivers, std::span<const std::uint32_t> indices,
                         const TraceOptions& options, std::span<float> vectors, const HitSink& sink,
                         const Progress& progress) {
    if (indices.empty())
        return;
    TraceJob job(receivers, indices, options, static_cast<bool>(sink));
    trace(job, pieces_, nullptr, TraceResults(job, scene_, vectors, sink), progress);
}

void VulkanTracer::trace(TraceJob& job, Pieces& pieces, const TracePiece::Sums* sums, TraceResults results,
                         const Progress& progress) {
    with_vulkan_errors([&] {
        job.room = room_for(job);
        const Stopwatch transfer;
        prepare(job, pieces, sums);
        seconds_.transfer += transfer.seconds();
        run(job, pieces, results, progress);
    });
}

void VulkanTracer::run(const TraceJob& job, const Pieces& pieces, TraceResults& results,
                       const Progress& progress) {
    struct UnderWay {
        TracePiece* piece = nullptr;
        TraceResults::Position at;
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
        TraceResults::Position at;
        std::size_t n = 0;
        for (; at.receiver < job.indices.size(); ++n) {
            UnderWay& work = under_way[n % 2];
            end(work);
            TracePiece& piece = *pieces.two[n % 2];
            const gpu::TracePush push = next(job, at.receiver, at.chunk);
            const Stopwatch transfer;
            std::ranges::copy(gpu_receivers(scene_, job.receivers,
                                            job.indices.subspan(at.receiver, push.receivers),
                                            job.options.seed),
                              piece.receivers().begin());
            if (!job.sum_rows.empty())
                std::ranges::transform(job.sum_rows.subspan(at.receiver, push.receivers),
                                       piece.sum_rows().begin(),
                                       [&](const SumRow& row) { return gpu_sum_row(row, job.sum_weights); });
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
    pieces_ = {}; // their memory is needed now
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
