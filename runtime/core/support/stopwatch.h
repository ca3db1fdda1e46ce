#pragma once

// Measurement of wall time. Experimental.

#include <chrono>

namespace prt {

/// Measures the wall time since its construction with a monotonic clock, which changes of the system time do
/// not affect.
class Stopwatch {
public:
    /// Returns the wall time since the construction of this stopwatch, in seconds.
    double seconds() const { return std::chrono::duration<double>(Clock::now() - start_).count(); }

private:
    using Clock = std::chrono::steady_clock;
    Clock::time_point start_ = Clock::now();
};

} // namespace prt
