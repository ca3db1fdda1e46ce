#pragma once

#include "prt/tracer.h"

namespace prt {

/// Takes the hits of a receiver. Called from several threads.
using ReceiverSink = std::function<void(std::uint32_t receiver, std::span<const Hit> hits)>;

/// Takes the direct transfer of a receiver, [order²]. Called from one thread, in the order of the receivers.
using VectorSink = std::function<void(std::uint32_t receiver, std::span<const float> vector)>;

/// Traces receivers[indices] and passes the direct transfer of each to `vectors`. The receivers are traced in
/// batches; the work can be stopped between two batches. `sink` takes their hits if the tracer reports hits.
void trace_receivers(Tracer& tracer, const Receivers& receivers, std::span<const std::uint32_t> indices,
                     const TraceOptions& options, const VectorSink& vectors, const Progress& progress = {},
                     const ReceiverSink& sink = {});

/// Returns the sink of a batch. It must not outlive `batch` or `sink`.
HitSink sink_of(std::span<const std::uint32_t> batch, const ReceiverSink& sink);

/// Calls `work` with receivers[indices] in batches of the size that `tracer` prefers, each with its part of
/// the progress.
void in_batches(const Tracer& tracer, std::span<const std::uint32_t> indices, const TraceOptions& options,
                const Progress& progress,
                const std::function<void(std::span<const std::uint32_t>, const Progress&)>& work);

/// Replaces the transfer of receivers[indices] in `transfer`, which has one channel.
void trace_receivers(Tracer& tracer, const Receivers& receivers, std::span<const std::uint32_t> indices,
                     const TraceOptions& options, Transfer& transfer, const Progress& progress = {},
                     const ReceiverSink& sink = {});

/// Returns the number of the first rays of a sequence of `rays` that trace_in_halves uses as one half; 0: too
/// few rays.
int first_half(int rays);

/// Takes the hits of a receiver, and those of the first half of its rays.
using HalvesSink =
    std::function<void(std::uint32_t receiver, std::span<const Hit> all, std::span<const Hit> half)>;

/// Transfer from all rays, and from the first half of them.
struct TracedHalves {
    Transfer &all, &half;
};

/// Replaces the transfer of receivers[indices] in both members of `to`. The tracer must support ranges of
/// rays, and `first_half` must not be 0.
void trace_in_halves(Tracer& tracer, const Receivers& receivers, std::span<const std::uint32_t> indices,
                     const TraceOptions& options, const TracedHalves& to, const Progress& progress = {},
                     const HalvesSink& sink = {});

} // namespace prt
