#pragma once

#include "prt/receivers.h"

#include <cstdint>
#include <span>
#include <string>

namespace prt {

struct DirectOptions {
    int order = 6;
    int rays = 1024; ///< per receiver
    std::uint64_t seed = 0;
};

/// One way to compute direct transfer: a processor, an API, a method. Every tracer takes the same samples, so
/// that two of them agree but for rays that graze.
class Tracer {
public:
    virtual ~Tracer() = default;
    /// For reports: "cpu".
    virtual std::string backend() const = 0;
    /// How many receivers to give to `direct_transfer` at once so that a batch takes about a tenth of a
    /// second.
    virtual std::size_t batch_size(const DirectOptions& options) const = 0;
    /// Shadowed direct transfer (docs/math.md, eq. 7) of receivers[indices[i]] for each i, to `vectors`
    /// [indices][order²].
    virtual void direct_transfer(const Receivers& receivers, std::span<const std::uint32_t> indices,
                                 const DirectOptions& options, std::span<float> vectors) = 0;
};

} // namespace prt
