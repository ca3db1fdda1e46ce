// Records the commands of a piece: trace, count, sum, and copy back.

#include "bake/trace_gpu/trace_piece.h"

#include <algorithm>

namespace prt {

TracePiece::TracePiece(const VulkanDevice& device, const GpuScene& scene, const TraceKernels& kernels,
                       const Room& room, const Sums* sums)
    : kernels_(kernels), room_(room) {
    const auto mirrored = [&](std::size_t bytes, GpuMemory host, const char* what) -> Mirrored {
        return {{device, bytes, GpuMemory::device, what}, {device, bytes, host, what}};
    };
    const bool alpha = kernels.has_alpha(), hits = notes_hits();
    const std::size_t rows_of_alpha = alpha ? room.rows : 0, threads = hits ? rows_of_alpha * PRT_BEAM : 0;
    buffers_ = {
        .receivers = mirrored(room.receivers * sizeof(gpu::Receiver), GpuMemory::upload, "the receivers"),
        .sum_rows =
            mirrored(sums ? room.receivers * sizeof(gpu::SumRow) : 0, GpuMemory::upload, "the rows of sums"),
        .sums = mirrored(room.receivers * kernels.numbers() * sizeof(float), GpuMemory::download,
                         "the sums over rays"),
        .hits = mirrored(hits ? room.hits * sizeof(gpu::HitRecord) : 0, GpuMemory::download, "the ray hits"),
        .state = mirrored(2 * sizeof(std::uint32_t), GpuMemory::download, "the number of hits"),
        .blocked_rays = mirrored(room.rows * sizeof(std::uint32_t), GpuMemory::download, "the blocked rays"),
        .blocked = {device, room.rows * PRT_BEAM * sizeof(std::uint32_t), GpuMemory::device,
                    "the blocked rays"},
        .shares = {device, rows_of_alpha * PRT_CHUNK * sizeof(float), GpuMemory::device,
                   "the shares of rays"},
        .threads = {device, threads * sizeof(gpu::ThreadProgress), GpuMemory::device,
                    "the progress of threads"},
        .no_sums = {device, 0, GpuMemory::device, "no sums"}};
    bind(device, scene, sums ? *sums : Sums{buffers_.no_sums, buffers_.no_sums});
}

void TracePiece::bind(const VulkanDevice& device, const GpuScene& scene, const Sums& sums) {
    const GpuResources tables = kernels_.tables();
    GpuResources tracing = scene.resources();
    tracing.buffers.merge(std::map<std::uint32_t, const GpuBuffer*>{
        {PRT_BINDING_SAMPLES, tables.buffers.at(PRT_BINDING_SAMPLES)},
        {PRT_BINDING_RECEIVERS, &buffers_.receivers.device},
        {PRT_BINDING_BLOCKED, &buffers_.blocked},
        {PRT_BINDING_HITS, &buffers_.hits.device}});
    if (notes_hits() && !kernels_.has_alpha()) {
        GpuResources counting = tracing;
        counting.buffers[PRT_BINDING_BLOCKED_RAYS] = &buffers_.blocked_rays.device;
        bindings_.count_blocked = {device, kernels_.count_blocked(), counting};
    }
    tracing.buffers.merge(
        std::map<std::uint32_t, const GpuBuffer*>{{PRT_BINDING_SHARES, &buffers_.shares},
                                                  {PRT_BINDING_HIT_COUNT, &buffers_.state.device},
                                                  {PRT_BINDING_PROGRESS, &buffers_.threads}});
    bindings_.trace = {device, kernels_.trace(), tracing};
    GpuResources summing = tables;
    summing.buffers.merge(
        std::map<std::uint32_t, const GpuBuffer*>{{PRT_BINDING_RECEIVERS, &buffers_.receivers.device},
                                                  {PRT_BINDING_SUMS, &buffers_.sums.device},
                                                  {PRT_BINDING_BLOCKED, &buffers_.blocked},
                                                  {PRT_BINDING_SHARES, &buffers_.shares},
                                                  {PRT_BINDING_SUM_ROWS, &buffers_.sum_rows.device},
                                                  {PRT_BINDING_FIXED_SUMS, &sums.plain},
                                                  {PRT_BINDING_SIGNED_SUMS, &sums.with_signs}});
    bindings_.accumulate = {device, kernels_.accumulate(), summing};
}

void TracePiece::trace(const vk::raii::CommandBuffer& commands) const {
    commands.fillBuffer(buffers_.state.device.handle(), 0, VK_WHOLE_SIZE, 0);
    barrier(commands);
    kernels_.trace().dispatch(commands, bindings_.trace.handle(), push_,
                              (push_.receivers + PRT_BEAMS - 1) / PRT_BEAMS, push_.chunks);
    barrier(commands);
    copy(commands, buffers_.state.device, buffers_.state.host, buffers_.state.host.bytes());
}

void TracePiece::sum(const vk::raii::CommandBuffer& commands) const {
    commands.fillBuffer(buffers_.sums.device.handle(), 0, VK_WHOLE_SIZE, 0);
    barrier(commands);
    kernels_.accumulate().dispatch(commands, bindings_.accumulate.handle(), push_, push_.receivers);
    barrier(commands);
    copy(commands, buffers_.sums.device, buffers_.sums.host,
         push_.receivers * kernels_.numbers() * sizeof(float));
}

void TracePiece::copy_hits(const vk::raii::CommandBuffer& commands) const {
    const std::size_t hits = kernels_.has_alpha() ? room_.hits : rows() * (push_.whole_followed + 1);
    copy(commands, buffers_.hits.device, buffers_.hits.host, hits * sizeof(gpu::HitRecord));
    if (!kernels_.has_alpha())
        copy(commands, buffers_.blocked_rays.device, buffers_.blocked_rays.host,
             rows() * sizeof(std::uint32_t));
}

void TracePiece::start(GpuQueue& queue, const gpu::TracePush& push) {
    push_ = push;
    seconds_ = 0;
    push_.hit_room = static_cast<std::uint32_t>(room_.hits);
    ticket_ = queue.submit([&](const vk::raii::CommandBuffer& commands) {
        copy(commands, buffers_.receivers.host, buffers_.receivers.device,
             push_.receivers * sizeof(gpu::Receiver));
        if (kernels_.kind().summed)
            copy(commands, buffers_.sum_rows.host, buffers_.sum_rows.device,
                 push_.receivers * sizeof(gpu::SumRow));
        if (hits_in_any_order())
            commands.fillBuffer(buffers_.threads.handle(), 0, VK_WHOLE_SIZE, 0);
        trace(commands);
        if (notes_hits() && !kernels_.has_alpha()) {
            constexpr std::size_t kThreads = PRT_BEAM * PRT_BEAMS;
            kernels_.count_blocked().dispatch(commands, bindings_.count_blocked.handle(), push_,
                                              (rows() + kThreads - 1) / kThreads);
        }
        if (!sums_at_the_end())
            sum(commands);
        if (notes_hits())
            copy_hits(commands);
        barrier_to_host(commands);
    });
}

std::size_t TracePiece::wanted_hits() const {
    return buffers_.state.host.as<const std::uint32_t>()[0];
}

void TracePiece::check_loops() const {
    if (buffers_.state.host.as<const std::uint32_t>()[1] != 0)
        throw GpuLoopsCutShort();
}

void TracePiece::wait(GpuQueue& queue, GpuQueue::Ticket ticket) {
    queue.wait(ticket);
    check_loops();
    seconds_ += queue.seconds(ticket);
}

void TracePiece::finish(GpuQueue& queue, const TakeHits& take) {
    wait(queue, ticket_);
    const std::span<const gpu::HitRecord> hits = buffers_.hits.host.as<const gpu::HitRecord>();
    if (!notes_hits())
        return;
    if (!kernels_.has_alpha()) {
        take(hits.first(rows() * (push_.whole_followed + 1)));
        return;
    }
    take(hits.first(std::min(room_.hits, wanted_hits())));
    const bool sums_anew = wanted_hits() > room_.hits;
    while (wanted_hits() > room_.hits) {
        wait(queue, queue.submit([&](const vk::raii::CommandBuffer& commands) {
            trace(commands);
            copy_hits(commands);
            barrier_to_host(commands);
        }));
        take(hits.first(std::min(room_.hits, wanted_hits())));
    }
    if (sums_anew || sums_at_the_end())
        wait(queue, queue.submit([&](const vk::raii::CommandBuffer& commands) {
            sum(commands);
            barrier_to_host(commands);
        }));
}

} // namespace prt
