#pragma once

// Parallel loop over receivers.

#include "prt/core/progress.h"
#include "runtime/core/support/parallel.h"

#include <algorithm>
#include <cstdint>
#include <span>

namespace prt {

/// Calls `work(p)` with each of `indices` from several threads (0: all), and checks `progress` between
/// batches: throws `Cancelled` when asked to stop.
template <class Work>
void for_each_receiver(std::span<const std::uint32_t> indices, int threads, const Progress& progress,
                       Work&& work) {
    constexpr std::size_t kBatch = 1 << 11; // between two checks
    for (std::size_t first = 0; first < indices.size(); first += kBatch) {
        progress.update(static_cast<double>(first) / static_cast<double>(indices.size()));
        const auto batch = indices.subspan(first, std::min(kBatch, indices.size() - first));
        parallel_for(batch.size(), 64, threads, [&](std::size_t begin, std::size_t end) {
            for (std::size_t i = begin; i < end; ++i)
                work(batch[i]);
        });
    }
}

} // namespace prt
