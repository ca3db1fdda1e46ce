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
/// A device cuts long loops short, so that what it computes is wrong.
struct GpuLoopsCutShort : GpuFailure {
    GpuLoopsCutShort()
        : GpuFailure("the GPU ends long loops before their time, so that what it computes is wrong (software "
                     "devices of older drivers do): bake on the CPU") {}
};

} // namespace prt
