#pragma once

#include "prt/baked_transfer.h"
#include "prt/receivers.h"
#include "prt/support/progress.h"

#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <string>

namespace prt {

class GatherOperator;
class GatherProduct;
class VectorSums;
struct LampLight;
struct LampTask;

/// Rays of one call. Rays of a receiver are a sequence that depends on the seed alone: tracing [0, 64) and
/// then [64, 128) is tracing [0, 128).
struct TraceOptions {
    int order = 6;
    int rays = 1024; ///< per receiver
    std::uint64_t seed = 0;
    /// Of the sequence; a multiple of the least power of two that is at least `rays` or kRayChunk.
    std::uint32_t first_ray = 0;
    /// One ray of so many is followed to what it meets, and stands for the others: light that comes from
    /// surfaces varies less over directions than visibility does. Scenes with alpha follow every ray anyway.
    int hit_stride = 1;
};

/// A surface that a ray met.
struct Hit {
    std::uint32_t triangle; ///< in the order of the scene's primitives and their triangles
    float u, v;             ///< barycentric coordinates of corners 1 and 2
    float weight;           ///< rays that end here; the sum over all hits is what is blocked of all rays
    float footprint;        ///< area of the surface that a ray stands for, m²; 0 where no texture asks
    bool back;              ///< the triangle was met from behind
};

/// Takes the hits of receivers[indices[i]], all of one call at once. Called from several threads.
using HitSink = std::function<void(std::size_t i, std::span<const Hit> hits)>;

/// Where the time went, in seconds of wall clock. What a tracer cannot tell apart is in `trace`.
struct TraceSeconds {
    double trace = 0;      ///< rays
    double accumulate = 0; ///< spherical harmonics, and what is done with the hits
    double transfer = 0;   ///< to and from a device
};

/// One way to compute visibility: a processor, an API, a method. Every tracer that traces takes the same
/// samples, so that two of them agree but for rays that graze.
class Tracer {
public:
    virtual ~Tracer() = default;
    virtual Backend backend() const = 0; ///< never automatic
    virtual BakeMethod method() const { return BakeMethod::trace; }
    /// Whether `trace` takes a sink and ranges of rays.
    virtual bool notes_hits() const { return true; }
    virtual std::string device() const = 0; ///< for reports: what it runs on
    /// How many receivers to give to `trace` at once so that a batch takes about a tenth of a second.
    virtual std::size_t batch_size(const TraceOptions& options) const = 0;
    /// Shadowed direct transfer (docs/math.md, eq. 9) of receivers[indices[i]] for each i, to `vectors`
    /// [indices][order²]; with a `sink`, also what the rays met. `progress` is told by tracers whose calls
    /// take long.
    virtual void trace(const Receivers& receivers, std::span<const std::uint32_t> indices,
                       const TraceOptions& options, std::span<float> vectors, const HitSink& sink = {},
                       const Progress& progress = {}) = 0;
    /// Direct light of lamps (bake/lamps/lamp_light.h), by samples that are the same for every tracer. Throws
    /// `Cancelled` when asked to stop.
    virtual LampLight lamp_light(const LampTask& task, const Progress& progress) = 0;
    /// The products of bounces (bake/transport/gather_product.h), on a device that keeps a reference to
    /// `gather`; null where the processor is as good.
    virtual std::unique_ptr<GatherProduct> gather_product(const GatherOperator& gather);
    /// Sums of vectors (bake/trace/vector_sums.h) on a device, as many as there are `weights`: what is added
    /// to each has so much weight in all. Null where the processor is as good, or the device has no room.
    virtual std::unique_ptr<VectorSums> vector_sums(int order, std::span<const float> weights);
    TraceSeconds seconds() const { return seconds_; }

protected:
    TraceSeconds seconds_;
};

} // namespace prt
