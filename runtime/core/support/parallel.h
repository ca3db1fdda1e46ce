#pragma once

// Loops that run on several threads. Experimental.

#include <cstddef>
#include <functional>

namespace prt {

/// Returns the number of threads to use: `requested` if it is positive, else the number of hardware threads
/// of the processor (at least 1).
int thread_count(int requested);

/// Calls `body(begin, end)` once for each block of indices [begin, end). The blocks cover [0, count); each
/// starts at a multiple of `grain` > 0 and has `grain` indices, the last one possibly fewer. Uses at most
/// `thread_count(threads)` threads including the calling one, fewer if the system cannot start them. They
/// call `body` concurrently and in no fixed sequence. Returns when all calls have returned. If `body` throws,
/// the blocks that have not started are skipped, and the first exception is rethrown after all threads have
/// stopped.
void parallel_for(std::size_t count, std::size_t grain, int threads,
                  const std::function<void(std::size_t begin, std::size_t end)>& body);

} // namespace prt
