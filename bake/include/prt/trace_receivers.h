#pragma once

#include "prt/tracer.h"

namespace prt {

/// Takes the hits of a receiver. Called from several threads.
using ReceiverSink = std::function<void(std::uint32_t receiver, std::span<const Hit> hits)>;

/// Takes the direct transfer of a receiver, [order²]. Called from one thread, in the order of the receivers.
using VectorSink = std::function<void(std::uint32_t receiver, std::span<const float> vector)>;

/// Gives `vectors` the direct transfer of receivers[indices] that `tracer` finds. They go to it in batches,
/// between which the work can be stopped. `sink` gets their hits, from a tracer that notes them.
void trace_receivers(Tracer& tracer, const Receivers& receivers, std::span<const std::uint32_t> indices,
                     const TraceOptions& options, const VectorSink& vectors, const Progress& progress = {},
                     const ReceiverSink& sink = {});

/// The sink of a batch, which outlives neither `batch` nor `sink`.
HitSink sink_of(std::span<const std::uint32_t> batch, const ReceiverSink& sink);

/// Works on receivers[indices] in the batches that `tracer` likes, each with its part of the progress.
void in_batches(const Tracer& tracer, std::span<const std::uint32_t> indices, const TraceOptions& options,
                const Progress& progress,
                const std::function<void(std::span<const std::uint32_t>, const Progress&)>& work);

/// Replaces the transfer of receivers[indices] in `transfer`, of one channel.
void trace_receivers(Tracer& tracer, const Receivers& receivers, std::span<const std::uint32_t> indices,
                     const TraceOptions& options, Transfer& transfer, const Progress& progress = {},
                     const ReceiverSink& sink = {});

/// Number of the first rays of a sequence of `rays` that trace_in_halves takes as half of them; 0: too few.
int first_half(int rays);

/// Takes the hits of a receiver, and those of the first half of its rays.
using HalvesSink =
    std::function<void(std::uint32_t receiver, std::span<const Hit> all, std::span<const Hit> half)>;

/// Transfer of all rays, and of the first half of them alone.
struct TracedHalves {
    Transfer &all, &half;
};

/// The same from a tracer that takes ranges of rays. There must be a half.
void trace_in_halves(Tracer& tracer, const Receivers& receivers, std::span<const std::uint32_t> indices,
                     const TraceOptions& options, const TracedHalves& to, const Progress& progress = {},
                     const HalvesSink& sink = {});

} // namespace prt
