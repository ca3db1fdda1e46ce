#pragma once

#include <array>
#include <cstdint>

namespace viewer {

/// Measures the GPU time between `begin` and `end` by timestamps. It does not wait, so a result is some
/// frames old.
class GpuTimer {
public:
    GpuTimer();
    ~GpuTimer();
    GpuTimer(const GpuTimer&) = delete;
    GpuTimer& operator=(const GpuTimer&) = delete;

    void begin();
    void end();
    double milliseconds() const { return milliseconds_; } ///< newest result; 0 before the first

private:
    static constexpr std::size_t kRounds = 4;
    std::array<std::uint32_t, 2 * kRounds> queries_{};
    std::size_t started_ = 0, read_ = 0;
    bool measuring_ = false;
    double milliseconds_ = 0;
};

} // namespace viewer
