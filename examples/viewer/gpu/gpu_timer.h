#pragma once

#include <array>
#include <cstdint>

namespace viewer {

/// Time between `begin` and `end` on the GPU, by timestamps, without waiting: a result is some frames old.
class GpuTimer {
public:
    GpuTimer();
    ~GpuTimer();
    GpuTimer(const GpuTimer&) = delete;
    GpuTimer& operator=(const GpuTimer&) = delete;

    void begin();
    void end();
    double milliseconds() const { return milliseconds_; } ///< the newest; 0 before there is one

private:
    static constexpr std::size_t kRounds = 4;
    std::array<std::uint32_t, 2 * kRounds> queries_{};
    std::size_t started_ = 0, read_ = 0;
    bool measuring_ = false;
    double milliseconds_ = 0;
};

} // namespace viewer
