#pragma once

// Loops over several threads. Experimental.

#include <cstddef>
#include <functional>

namespace prt {

/// Returns the number of threads to use: `requested`, or the number of hardware threads if it is 0.
int thread_count(int requested);

/// Calls `body(begin, end)` for consecutive blocks of at most `grain` indices that together cover [0, count),
/// on `threads` threads (0: all). Blocks start at multiples of `grain`, so that results stored per block do
/// not depend on the number of threads. The first exception that `body` throws is rethrown here after all
/// threads have stopped.
void parallel_for(std::size_t count, std::size_t grain, int threads,
                  const std::function<void(std::size_t begin, std::size_t end)>& body);

} // namespace prt
