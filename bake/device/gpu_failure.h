#pragma once

// Errors of a GPU during a bake. With Backend::automatic the bake catches them and continues on the CPU; with
// Backend::gpu the caller gets them.

#include "prt/core/error.h"

namespace prt {

/// A GPU failed during its work, for a reason that is not in the work itself. The same work can succeed on a
/// CPU.
struct GpuFailure : Error {
    using Error::Error;
};
/// The GPU was lost: its driver was reset, the GPU was removed, or it did not respond within a minute.
struct GpuLost : GpuFailure {
    using GpuFailure::GpuFailure;
};
/// The GPU has too little free memory for its work, or its driver has too little memory of the machine.
struct GpuMemoryError : GpuFailure {
    using GpuFailure::GpuFailure;
};
/// The GPU ends long loops of shaders early, which makes its results wrong.
struct GpuLoopsCutShort : GpuFailure {
    GpuLoopsCutShort()
        : GpuFailure(
              "the GPU ends long loops early, so its results are wrong (known from software devices of "
              "older drivers); bake on the CPU with --device cpu") {}
};

} // namespace prt
