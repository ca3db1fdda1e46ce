#pragma once

// Interface of the methods that compute direct transfer: ray tracing on a CPU or a GPU, and depth maps.

#include "bake/scene/ray_scene.h"
#include "bake/scene/receivers.h"
#include "prt/bake/bake_options.h"
#include "prt/core/baked_transfer.h"
#include "prt/core/progress.h"

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

/// Rays of one call of `Tracer::trace`. The rays of a receiver are a part of a fixed sequence, which depends
/// only on the index of the receiver and on `seed`. Tracing rays 0..63 and then rays 64..127 therefore uses
/// the same rays as tracing 0..127. Only BakeMethod::raster has separate directions for each range, the same
/// for all receivers.
struct TraceOptions {
    int order = 6;          ///< order of the transfer
    int rays = 1024;        ///< number of rays per receiver, at least 1; for BakeMethod::raster the number of
                            ///< directions
    std::uint64_t seed = 0; ///< seed of the sequence of rays
    /// Index of the first ray in the sequence: a multiple of the smallest power of two that is at least
    /// `rays`, or a multiple of 1024 if `rays` is larger than 1024.
    std::uint32_t first_ray = 0;
    /// For calls with a sink: one of `hit_stride` rays is traced to its nearest hit, and the sink gets this
    /// hit. All other rays only test whether they are blocked; the weights of the hits represent them. 1: all
    /// rays are traced to their hits. For every value, all rays are traced to their hits in scenes with
    /// cut-out, blended or glass surfaces, and with a distance fall-off.
    int hit_stride = 1;
};

/// Callback that gets all hits of the receiver with index indices[i], for a call of `Tracer::trace` with
/// `indices`. It is called once per receiver, from several threads at the same time; `hits` is valid only
/// during the call. If a GPU fails and the CPU repeats its work, the callback may get a receiver twice.
using HitSink = std::function<void(std::size_t i, std::span<const Hit> hits)>;

/// Interface of the methods that compute direct transfer, on a CPU or a GPU. All implementations that trace
/// rays use the same rays, so that their results differ only by rays that graze an edge. A tracer keeps a
/// reference to its scene. Calls from several threads at the same time are not allowed.
class Tracer {
public:
    virtual ~Tracer() = default;
    /// Returns the hardware that traces: `cpu` or `gpu`, never `automatic`. The value changes to `cpu` if the
    /// GPU fails and the CPU continues.
    virtual Backend backend() const = 0;
    /// Returns the method that samples visibility.
    virtual BakeMethod method() const { return BakeMethod::trace; }
    /// Returns a tracer of rays for the same scene: this one, except for depth maps. Callers that need only
    /// hits use it, because depth maps take no time there.
    virtual Tracer& rays() { return *this; }
    virtual std::string device() const = 0; ///< name of the device, one line for reports
    /// Returns the recommended number of receivers for one call of `trace`, at least 1. A call then takes
    /// about a tenth of a second on a CPU, so that the caller can check for stop requests between calls. On a
    /// GPU a call may take seconds, and checks for stop requests itself.
    virtual std::size_t batch_size(const TraceOptions& options) const = 0;
    /// Computes the direct transfer with shadows (docs/math.md, eq. 9) of the receivers with the indices
    /// `indices`, and writes it to `vectors`: [indices][order²], in the order of `indices`. `sink`, if not
    /// empty, gets the hits of each receiver, from rays also if depth maps compute the transfer. The
    /// receivers must have normals that are not zero. Tracers on a GPU report to `progress` and throw
    /// `Cancelled` after a stop request; the tracer on the CPU ignores `progress`. Throws `Error` if a GPU
    /// fails, unless the tracer continues on the CPU (Backend::automatic).
    virtual void trace(const Receivers& receivers, std::span<const std::uint32_t> indices,
                       const TraceOptions& options, std::span<float> vectors, const HitSink& sink = {},
                       const Progress& progress = {}) = 0;
    /// Computes direct light of lamps at receivers. For the baker only: the types are in the internal header
    /// bake/trace/lamp_light.h. All tracers use the same rays. Throws `Cancelled` after a stop request, and
    /// `Error` if a GPU fails, unless the tracer continues on the CPU.
    virtual LampLight lamp_light(const LampTask& task, const Progress& progress) = 0;
    /// Creates an object that computes bounces on the GPU, and keeps a reference to `gather`. For the baker
    /// only: the types are in the internal header bake/trace/gather_product.h. Returns null if the CPU must
    /// compute the bounces: always unless a GPU traces the rays without a distance fall-off, and on a GPU
    /// with too little memory. Throws `Error` if a GPU fails, unless the tracer continues on the CPU.
    virtual std::unique_ptr<GatherProduct> gather_product(const GatherOperator& gather);
    /// Creates weighted sums of transfer vectors [order²] on the GPU, one sum for each entry of `weights`.
    /// `weights` [sums]: total weight of the vectors that will be added to the sum. For the baker only: the
    /// type is in the internal header bake/trace/vector_sums.h. Returns null and throws under the same
    /// conditions as `gather_product`; the CPU must then compute the sums.
    virtual std::unique_ptr<VectorSums> vector_sums(int order, std::span<const float> weights);
    /// Returns the time of all calls since this tracer was created.
    TraceSeconds seconds() const { return seconds_; }

protected:
    TraceSeconds seconds_; ///< implementations add the time of each call
};

} // namespace prt
