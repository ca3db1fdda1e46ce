#pragma once

#include "prt/support/error.h"

namespace prt {

/// A GPU fails on the way, and through no fault of the work: a CPU can go on.
struct GpuFailure : Error {
    using Error::Error;
};
/// The device is gone: its driver was reset, or it was taken away.
struct GpuLost : GpuFailure {
    using GpuFailure::GpuFailure;
};
struct GpuMemoryError : GpuFailure {
    using GpuFailure::GpuFailure;
};

} // namespace prt
