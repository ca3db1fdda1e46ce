#pragma once

#include "prt/support/error.h"

namespace prt {

/// A GPU failed during the work, for a reason that is not in the work itself. The work can continue on a CPU.
struct GpuFailure : Error {
    using Error::Error;
};
/// The device was lost: its driver was reset, or the device was removed.
struct GpuLost : GpuFailure {
    using GpuFailure::GpuFailure;
};
/// The device has too little memory.
struct GpuMemoryError : GpuFailure {
    using GpuFailure::GpuFailure;
};
/// The device ends long loops early, so that its results are wrong.
struct GpuLoopsCutShort : GpuFailure {
    GpuLoopsCutShort()
        : GpuFailure(
              "the GPU ends long loops early, so its results are wrong (known from software devices of "
              "older drivers); bake on the CPU with --device cpu") {}
};

} // namespace prt
