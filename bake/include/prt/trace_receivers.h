#pragma once

#include "prt/tracer.h"

namespace prt {

/// Function that gets all hits of a receiver. Called from several threads.
using ReceiverSink = std::function<void(std::uint32_t receiver, std::span<const Hit> hits)>;

/// Function that gets the direct transfer of a receiver, [order²]. Called from one thread, in the order of
/// the receivers.
using VectorSink = std::function<void(std::uint32_t receiver, std::span<const float> vector)>;

/// Traces receivers[indices] and passes the direct transfer of each to `vectors`. Receivers are traced in
/// batches; a stop request is checked between batches. `sink` gets their hits if the tracer reports hits.
void trace_receivers(Tracer& tracer, const Receivers& receivers, std::span<const std::uint32_t> indices,
                     const TraceOptions& options, const VectorSink& vectors, const Progress& progress = {},
                     const ReceiverSink& sink = {});

/// Returns the sink for a call of `Tracer::trace` with the indices `batch`, which passes hits to `sink`. It
/// must not outlive `batch` or `sink`.
HitSink sink_of(std::span<const std::uint32_t> batch, const ReceiverSink& sink);

/// Calls `work` for consecutive parts of `indices`, of the size that `tracer` prefers, each with its part of
/// the progress.
void in_batches(const Tracer& tracer, std::span<const std::uint32_t> indices, const TraceOptions& options,
                const Progress& progress,
                const std::function<void(std::span<const std::uint32_t>, const Progress&)>& work);

/// Traces receivers[indices] and replaces their direct transfer in `transfer`, which has one channel. `sink`
/// gets their hits if the tracer reports hits.
void trace_receivers(Tracer& tracer, const Receivers& receivers, std::span<const std::uint32_t> indices,
                     const TraceOptions& options, Transfer& transfer, const Progress& progress = {},
                     const ReceiverSink& sink = {});

/// Returns how many of the first rays in a sequence of `rays` form the half of `trace_in_halves`; 0: too few
/// rays.
int first_half(int rays);

/// Function that gets all hits of a receiver, and those of the first half of its rays.
using HalvesSink =
    std::function<void(std::uint32_t receiver, std::span<const Hit> all, std::span<const Hit> half)>;

/// Transfer from all rays, and from the first half of them.
struct TracedHalves {
    Transfer &all, &half;
};

/// Traces receivers[indices] and replaces their transfer in both members of `to`. The tracer must support
/// ranges of rays, and `first_half(options.rays)` must not be 0.
void trace_in_halves(Tracer& tracer, const Receivers& receivers, std::span<const std::uint32_t> indices,
                     const TraceOptions& options, const TracedHalves& to, const Progress& progress = {},
                     const HalvesSink& sink = {});

} // namespace prt
