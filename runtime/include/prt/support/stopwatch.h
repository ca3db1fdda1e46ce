#pragma once

// Wall time. Experimental.

#include <chrono>

namespace prt {

/// Measures the seconds since its construction with a monotonic clock.
class Stopwatch {
public:
    /// Returns the seconds since the construction.
    double seconds() const { return std::chrono::duration<double>(Clock::now() - start_).count(); }

private:
    using Clock = std::chrono::steady_clock;
    Clock::time_point start_ = Clock::now();
};

} // namespace prt
