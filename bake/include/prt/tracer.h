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

/// Rays of one call of `Tracer::trace`. The rays of a receiver form a sequence that depends only on the seed:
/// tracing [0, 64) and then [64, 128) is the same as tracing [0, 128).
struct TraceOptions {
    int order = 6;
    int rays = 1024; ///< rays per receiver
    std::uint64_t seed = 0;
    /// First ray in the sequence; a multiple of the smallest power of two that is at least `rays` or
    /// kRayChunk.
    std::uint32_t first_ray = 0;
    /// One of `hit_stride` rays is traced to its hit and represents the others, because light from surfaces
    /// varies less over directions than visibility does. In scenes with alpha every ray is traced to its hit.
    int hit_stride = 1;
};

/// A surface that a ray hit.
struct Hit {
    std::uint32_t triangle; ///< index in the order of the scene's primitives and their triangles
    float u, v;             ///< barycentric coordinates of corners 1 and 2
    float weight; ///< number of rays that the hit represents; the sum over all hits is the number of blocked
                  ///< rays
    float footprint; ///< area of the surface that a ray represents, m²; 0 if no texture needs it
    bool back;       ///< the triangle was hit from behind
};

/// Function that gets the hits of receivers[indices[i]], all hits of one call together. Called from several
/// threads.
using HitSink = std::function<void(std::size_t i, std::span<const Hit> hits)>;

/// Wall-clock time of each stage in seconds. Stages that a tracer cannot separate are in `trace`.
struct TraceSeconds {
    double trace = 0;      ///< tracing rays
    double accumulate = 0; ///< spherical harmonics, and processing of the hits
    double transfer = 0;   ///< transfers to and from a device
};

/// Interface of the methods that compute visibility, on a CPU or a GPU. All implementations that trace rays
/// use the same samples, so that their results agree except for grazing rays.
class Tracer {
public:
    virtual ~Tracer() = default;
    virtual Backend backend() const = 0; ///< never automatic
    virtual BakeMethod method() const { return BakeMethod::trace; }
    /// Returns whether `trace` supports a sink and ranges of rays.
    virtual bool notes_hits() const { return true; }
    virtual std::string device() const = 0; ///< device name for reports
    /// Returns the number of receivers to pass to `trace` at once, so that a call takes about a tenth of a
    /// second.
    virtual std::size_t batch_size(const TraceOptions& options) const = 0;
    /// Computes shadowed direct transfer (docs/math.md, eq. 9) of receivers[indices[i]] for each i and writes
    /// it to `vectors` [indices][order²]; `sink` gets the hits of the rays. Tracers with long calls report to
    /// `progress`.
    virtual void trace(const Receivers& receivers, std::span<const std::uint32_t> indices,
                       const TraceOptions& options, std::span<float> vectors, const HitSink& sink = {},
                       const Progress& progress = {}) = 0;
    /// Computes direct light of lamps (bake/trace/lamp_light.h), with the same samples for every tracer.
    /// Throws `Cancelled` after a stop request.
    virtual LampLight lamp_light(const LampTask& task, const Progress& progress) = 0;
    /// Creates the object that computes bounces (bake/trace/gather_product.h) on a device. It keeps a
    /// reference to `gather`. Returns null if the CPU is as fast.
    virtual std::unique_ptr<GatherProduct> gather_product(const GatherOperator& gather);
    /// Creates sums of vectors (bake/trace/vector_sums.h) on a device, one for each entry of `weights`, which
    /// is the total weight of the vectors that are added to it. Returns null if the CPU is as fast or the
    /// device has too little memory.
    virtual std::unique_ptr<VectorSums> vector_sums(int order, std::span<const float> weights);
    /// Time of all calls.
    TraceSeconds seconds() const { return seconds_; }

protected:
    TraceSeconds seconds_;
};

} // namespace prt
