#pragma once

// How much a bake errs by sampling.

#include "prt/tracer.h"

#include <stop_token>

namespace prt {

struct SamplingError {
    double error = 0;     ///< estimated relative L2
    std::size_t rays = 0; ///< traced to find out
};

/// The error of `transfer`, which was sampled with `options`: some of its receivers are sampled again,
/// independently.
SamplingError sampling_error(Tracer& tracer, const Receivers& receivers, const TraceOptions& options,
                             const Transfer& transfer, const std::stop_token& stop);

} // namespace prt
