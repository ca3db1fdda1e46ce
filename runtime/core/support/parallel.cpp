// Splits a range over threads that live for one call. oneTBB would avoid the cost of starting them, but a
// game that links the runtime would also link oneTBB, and have a second thread pool.
#include "runtime/core/support/parallel.h"

#include <algorithm>
#include <atomic>
#include <exception>
#include <mutex>
#include <system_error>
#include <thread>
#include <vector>

namespace prt {

int thread_count(int requested) {
    if (requested > 0)
        return requested;
    return std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
}

void parallel_for(std::size_t count, std::size_t grain, int threads,
                  const std::function<void(std::size_t, std::size_t)>& body) {
    const std::size_t blocks = (count + grain - 1) / grain;
    const std::size_t workers = std::min(blocks, static_cast<std::size_t>(thread_count(threads)));
    std::atomic<std::size_t> next_block = 0;
    std::exception_ptr failure;
    std::mutex failure_mutex;

    const auto work = [&] {
        for (;;) {
            const std::size_t block = next_block.fetch_add(1);
            if (block >= blocks)
                return;
            try {
                body(block * grain, std::min(count, (block + 1) * grain));
            } catch (...) {
                next_block = blocks;
                const std::lock_guard lock(failure_mutex);
                if (!failure)
                    failure = std::current_exception();
                return;
            }
        }
    };

    {
        std::vector<std::jthread> helpers;
        try {
            for (std::size_t i = 1; i < workers; ++i)
                helpers.emplace_back(work);
        } catch (const std::system_error&) { // no more threads available: the existing ones do all the work
        }
        work();
    }
    if (failure)
        std::rethrow_exception(failure);
}

} // namespace prt
