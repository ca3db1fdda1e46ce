#pragma once

// Estimates the sampling error of a bake.

#include "bake/trace/tracer.h"

#include <stop_token>

namespace prt {

struct SamplingError {
    double error = 0;     ///< estimated relative L2 error
    std::size_t rays = 0; ///< rays of the estimate
};

/// Estimates the error of `transfer`, which was sampled with `options`: samples some of its receivers again,
/// independently.
SamplingError sampling_error(Tracer& tracer, const Receivers& receivers, const TraceOptions& options,
                             const Transfer& transfer, const std::stop_token& stop);

} // namespace prt
