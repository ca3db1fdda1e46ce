// Computes bounces on a device: exit transfer is in two buffers, and each bounce reads one and writes the
// other.

#include "bake/trace_gpu/gpu_gather.h"

#include "bake/device/staged_writes.h"
#include "bake/trace_gpu/gpu_sum_row.h"
#include "prt/core/sh_basis.h"
#include "runtime/core/support/stopwatch.h"

#include "kernels/bake_energy.h"
#include "kernels/bake_gather.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace prt {
namespace {

constexpr double kGatherSeconds = 0.05;            ///< target time of a dispatch
constexpr std::size_t kRowsAtOnce = 1 << 14;       ///< maximum number of rows per call, if rows are not
                                                   ///< receivers
constexpr const char* kTransfer = "exit transfer"; ///< content of buffers, for errors

GpuBuffer upload_reflectance(const VulkanDevice& device, GpuQueue& queue, const GatherOperator& gather) {
    std::vector<float> values;
    for (const glm::vec3& reflectance : gather.reflectance())
        for (int c = 0; c < gather.channels(); ++c)
            values.push_back(reflectance[c]);
    return uploaded(device, queue, std::as_bytes(std::span(values)), "the reflectance");
}

} // namespace

struct GpuGather::Kernel {
    GpuKernel kernel;
    std::uint32_t threads = 1;                        ///< threads per row
    std::vector<std::array<GpuBindings, 2>> bindings; ///< [blocks] bindings from each of the two buffers to
                                                      ///< the other
};

/// Data that depend on the order: kernels, two buffers of exit transfer, and its sum.
class GpuGather::Values {
public:
    Values(const GpuGather& owner, int for_order, bool with_total)
        : order(for_order),
          columns(static_cast<std::size_t>(owner.gather_.channels() * coefficient_count(order))),
          has_total(with_total), owner_(owner) {
        const VulkanDevice& device = owner.device_;
        const std::size_t receivers = owner.gather_.receivers(),
                          most = std::max(receivers, std::min(kRowsAtOnce, owner.gather_.rows()));
        for (GpuBuffer& position : transfer)
            position = {device, most * columns * sizeof(float), GpuMemory::device, kTransfer};
        total = {device, with_total ? receivers * columns * sizeof(float) : 0, GpuMemory::device, kTransfer};
        sent = {device, transfer[0].bytes(), GpuMemory::upload, kTransfer};
        received = {device, transfer[0].bytes(), GpuMemory::download, kTransfer};
        energy.largest = {device, 2 * sizeof(std::uint32_t), GpuMemory::device, "energies"};
        rows = make_gather(false);
        make_energy(device);
    }

    GpuResources resources(const GatherBlocks::Buffers& block, std::size_t from, bool to_sums) const {
        return {{{PRT_BINDING_ROW_ENDS, &block.row_ends},
                 {PRT_BINDING_SOURCES, &block.sources},
                 {PRT_BINDING_WEIGHTS, &block.weights},
                 {PRT_BINDING_REFLECTANCE, &owner_.reflectance_},
                 {PRT_BINDING_EXIT, &transfer[from]},
                 {PRT_BINDING_GATHERED, &transfer[1 - from]},
                 {PRT_BINDING_TOTAL, &total},
                 {PRT_BINDING_SUM_ROWS, to_sums ? &*owner_.sum_rows_ : &owner_.unused_},
                 {PRT_BINDING_FIXED_SUMS, to_sums ? &sums : &owner_.unused_}}};
    }

    const int order;
    const std::size_t columns;
    const bool has_total;
    std::array<GpuBuffer, 2> transfer;
    GpuBuffer total, sent, received, sums;
    Kernel rows;                  ///< kernel whose rows are stored
    std::optional<Kernel> summed; ///< kernel whose rows are added to `sums`
    struct Energy {
        GpuKernel kernel;
        GpuBuffer largest;
        std::array<GpuBindings, 2> bindings; ///< bindings for each of the two buffers
    };
    Energy energy;

    void make_summed(std::size_t count) {
        sums = {owner_.device_, count * columns * sizeof(std::int32_t), GpuMemory::device, "sums of rows"};
        summed = make_gather(true);
    }

private:
    Kernel make_gather(bool to_sums) const {
        const VulkanDevice& device = owner_.device_;
        Kernel made;
        while (made.threads < columns && made.threads < PRT_GATHER_THREADS)
            made.threads *= 2;
        const GatherOperator& of_rows = owner_.gather_;
        GpuKernel::Source source{
            .spirv = bake_gather,
            .push_bytes = sizeof(gpu::GatherPush),
            .constants = {{PRT_CONSTANT_ORDER, static_cast<std::uint32_t>(order)},
                          {PRT_CONSTANT_CHANNELS, static_cast<std::uint32_t>(of_rows.channels())},
                          {PRT_CONSTANT_ROW_THREADS, made.threads},
                          {PRT_CONSTANT_SUMMED, to_sums},
                          {PRT_CONSTANT_SHARED, !of_rows.reflectance().empty()}}};
        source.take_bindings(resources({}, 0, to_sums));
        made.kernel = GpuKernel(device, source);
        for (std::size_t i = 0; i < owner_.blocks_.all().size(); ++i) {
            made.bindings.emplace_back();
            for (const std::size_t from : {0u, 1u})
                made.bindings.back()[from] = {device, made.kernel,
                                              resources(owner_.blocks_.buffers(i), from, to_sums)};
        }
        return made;
    }

    void make_energy(const VulkanDevice& device) {
        GpuKernel::Source source{.spirv = bake_energy,
                                 .push_bytes = sizeof(gpu::EnergyPush),
                                 .constants = {{PRT_CONSTANT_ORDER, static_cast<std::uint32_t>(order)}}};
        const auto of = [&](std::size_t position) -> GpuResources {
            return {{{PRT_BINDING_GATHERED, &transfer[position]}, {PRT_BINDING_ENERGY, &energy.largest}}};
        };
        source.take_bindings(of(0));
        energy.kernel = GpuKernel(device, source);
        for (const std::size_t position : {0u, 1u})
            energy.bindings[position] = {device, energy.kernel, of(position)};
    }

    const GpuGather& owner_;
};

GpuGather::GpuGather(const VulkanDevice& device, GpuQueue& queue, const GatherOperator& gather,
                     const GatherBlocks::Room& room)
    : device_(device), queue_(queue), gather_(gather), blocks_(device, queue, gather, room),
      reflectance_(upload_reflectance(device, queue, gather)),
      unused_(device, 0, GpuMemory::device, "unused bindings") {}

GpuGather::~GpuGather() {
    queue_.wait_for_all();
}

GpuGather::Values& GpuGather::values(int order, bool with_total) {
    if (!values_ || values_->order != order || (with_total && !values_->has_total)) {
        queue_.wait_for_all();
        values_.reset(); // before new buffers take its memory
        values_ = std::make_unique<Values>(*this, order, with_total);
    }
    return *values_;
}

void GpuGather::load(int order, std::span<const float> exit) {
    with_vulkan_errors([&] {
        Values& v = values(order, false);
        std::ranges::copy(exit, v.sent.as<float>().begin());
        largest_ = 0;
        for (const float value : exit)
            largest_ = std::max(largest_, std::abs(value));
        queue_.wait(queue_.submit([&](const vk::raii::CommandBuffer& commands) {
            copy(commands, v.sent, v.transfer[0], exit.size_bytes());
        }));
        bytes_moved_ += exit.size_bytes();
    });
}

void GpuGather::apply(std::size_t first, std::span<float> to) {
    with_vulkan_errors([&] {
        const Values& v = *values_;
        gather(v.rows, {.first = first, .end = first + to.size() / v.columns}, {});
        queue_.wait(queue_.submit([&](const vk::raii::CommandBuffer& commands) {
            copy(commands, v.transfer[1], v.received, to.size_bytes());
            barrier_to_host(commands);
        }));
        std::ranges::copy(v.received.as<const float>().first(to.size()), to.begin());
        bytes_moved_ += to.size_bytes();
    });
}

void GpuGather::upload_sum_rows(const SumRows& rows) {
    sum_rows_.emplace(device_, rows.count * sizeof(gpu::SumRow), GpuMemory::device, "sums of rows");
    const GpuBuffer staging(device_, StagedWrites::kBytes, GpuMemory::upload, "sums of rows");
    StagedWrites writes(queue_, staging, *sum_rows_);
    for (std::size_t r = 0; r < rows.count; ++r) {
        const gpu::SumRow row = gpu_sum_row(rows.row(r), rows.weights);
        writes.append(std::span(&row, 1));
    }
    writes.flush();
    bytes_moved_ += rows.count * sizeof(gpu::SumRow);
}

bool GpuGather::apply_to_sums(const SumRows& to, std::span<float> sums) {
    try {
        with_vulkan_errors([&] {
            Values& v = *values_;
            if (!sum_rows_ || sum_rows_->bytes() < to.count * sizeof(gpu::SumRow)) {
                queue_.wait_for_all();
                v.summed.reset(); // its bindings refer to the previous rows
                upload_sum_rows(to);
            }
            if (!v.summed)
                v.make_summed(to.weights.size());
            const std::size_t bytes = sums.size() * sizeof(std::int32_t);
            const GpuBuffer host(device_, bytes, GpuMemory::download, "sums of rows");
            queue_.submit([&](const vk::raii::CommandBuffer& commands) {
                commands.fillBuffer(v.sums.handle(), 0, VK_WHOLE_SIZE, 0);
            });
            gather(*v.summed, {.first = 0, .end = to.count}, {});
            queue_.wait(queue_.submit([&](const vk::raii::CommandBuffer& commands) {
                copy(commands, v.sums, host, bytes);
                barrier_to_host(commands);
            }));
            for (std::size_t i = 0; i < sums.size(); ++i)
                sums[i] +=
                    from_fixed_point(host.as<const std::int32_t>()[i], to.weights[i / v.columns], largest_);
            bytes_moved_ += bytes;
        });
    } catch (const GpuMemoryError&) {
        return false;
    }
    return true;
}

void GpuGather::gather(const Kernel& kernel, const Task& task, const Progress& progress) {
    const std::size_t first = task.first, end = task.end;
    const Values& v = *values_;
    const std::size_t rows_of_group = PRT_GATHER_THREADS / kernel.threads;
    GpuQueue::Ticket before = 0;
    double work_before = 0;
    const auto measure = [&](GpuQueue::Ticket ticket, double work) {
        queue_.wait(ticket);
        if (const double took = queue_.seconds(ticket); ticket > 0 && took > 0)
            work_per_second_ = 0.5 * (work_per_second_ + work / took);
    };
    for (std::size_t b = 0; b < blocks_.all().size(); ++b) {
        const GatherBlocks::Block& block = blocks_.all()[b];
        const std::size_t block_end = std::min(end, block.end());
        if (std::max(first, block.first) < block_end && !block.resident) {
            queue_.wait(before); // the shared buffers are read until then
            blocks_.want(b);
        }
        const double work_of_row =
            (static_cast<double>(block.entries) / static_cast<double>(block.rows) + 1) *
            static_cast<double>(v.columns);
        for (std::size_t row = std::max(first, block.first); row < block_end;) {
            progress.check();
            const auto in_time = static_cast<std::size_t>(work_per_second_ * kGatherSeconds / work_of_row);
            const std::size_t count = std::min(
                {block_end - row, std::max<std::size_t>(in_time, rows_of_group), kMaxGroups * rows_of_group});
            const gpu::GatherPush push{.first_row = static_cast<std::uint32_t>(row - block.first),
                                       .end_row = static_cast<std::uint32_t>(row - block.first + count),
                                       .first_gathered = static_cast<std::uint32_t>(block.first - first),
                                       .add = task.add ? 1u : 0u,
                                       .first_sum_row = static_cast<std::uint32_t>(block.first),
                                       .largest = std::max(largest_, std::numeric_limits<float>::min())};
            const GpuQueue::Ticket ticket = queue_.submit([&](const vk::raii::CommandBuffer& commands) {
                kernel.kernel.dispatch(commands, kernel.bindings[b][task.from].handle(), push,
                                       (count + rows_of_group - 1) / rows_of_group);
            });
            measure(before, work_before);
            before = ticket;
            work_before = work_of_row * static_cast<double>(count);
            row += count;
        }
    }
    measure(before, work_before);
}

std::optional<BounceEnergy> GpuGather::bounce(Transfer& transfer, int bounces, const Progress& progress) {
    return with_vulkan_errors([&]() -> std::optional<BounceEnergy> {
        const std::size_t receivers = gather_.receivers();
        try {
            values(transfer.layout.order, true);
        } catch (const GpuMemoryError&) {
            return std::nullopt;
        }
        const Values& v = *values_;
        load(transfer.layout.order, transfer.vectors);
        queue_.submit([&](const vk::raii::CommandBuffer& commands) {
            copy(commands, v.transfer[0], v.total, std::span(transfer.vectors).size_bytes());
            commands.fillBuffer(v.energy.largest.handle(), 0, VK_WHOLE_SIZE, 0);
        });
        const auto vectors =
            static_cast<std::uint32_t>(receivers * static_cast<std::size_t>(gather_.channels()));
        const auto measure = [&](std::size_t position, std::uint32_t bounce) {
            gpu::EnergyPush push{.first = 0, .end = vectors, .position = bounce};
            constexpr std::uint32_t kAtOnce = kMaxGroups * PRT_GATHER_THREADS;
            for (; push.first < vectors; push.first += kAtOnce)
                queue_.submit([&](const vk::raii::CommandBuffer& commands) {
                    v.energy.kernel.dispatch(
                        commands, v.energy.bindings[position].handle(), push,
                        (std::min(kAtOnce, vectors - push.first) + PRT_GATHER_THREADS - 1) /
                            PRT_GATHER_THREADS);
                });
        };
        std::size_t from = 0;
        for (int b = 0; b < bounces; ++b, from = 1 - from) {
            if (b + 1 == bounces)
                measure(from, 0);
            gather(v.rows, {.first = 0, .end = receivers, .from = from, .add = true}, progress);
            progress.update(static_cast<double>(b + 1) / bounces);
        }
        measure(from, 1);
        const std::span<float> sums(transfer.vectors);
        GpuBuffer energies(device_, v.energy.largest.bytes(), GpuMemory::download, "energies");
        queue_.wait(queue_.submit([&](const vk::raii::CommandBuffer& commands) {
            copy(commands, v.total, v.received, sums.size_bytes());
            copy(commands, v.energy.largest, energies, energies.bytes());
            barrier_to_host(commands);
        }));
        std::ranges::copy(v.received.as<const float>().first(sums.size()), sums.begin());
        bytes_moved_ += sums.size_bytes();
        const auto found = energies.as<const float>();
        return BounceEnergy{.before_last = std::sqrt(static_cast<double>(found[0])),
                            .last = std::sqrt(static_cast<double>(found[1]))};
    });
}

} // namespace prt
