#pragma once

// Traces a list of receivers with any `Tracer`, in batches, with progress reports and cancellation. Receivers
// are identified by their indices in a `Receivers`. "Direct transfer" is the direct term of a receiver with
// one channel, [order²].

#include "bake/trace/tracer.h"

namespace prt {

/// Callback that gets all hits of the rays of one receiver. `receiver` is its index in a `Receivers`. It is
/// called from several threads at the same time; `hits` is valid only during the call.
using ReceiverSink = std::function<void(std::uint32_t receiver, std::span<const Hit> hits)>;

/// Callback that gets the direct transfer of one receiver, `vector` [order²]. `receiver` is its index in a
/// `Receivers`. It is called from the calling thread; `vector` is valid only during the call.
using VectorSink = std::function<void(std::uint32_t receiver, std::span<const float> vector)>;

/// Traces the receivers with the indices `indices` and calls `vectors` with the direct transfer of each, in
/// the order of `indices`. `sink`, if not empty, gets the hits of each receiver. Throws `Cancelled` after a
/// stop request, which is checked before each batch and at the end, and the errors of Tracer::trace.
void trace_receivers(Tracer& tracer, const Receivers& receivers, std::span<const std::uint32_t> indices,
                     const TraceOptions& options, const VectorSink& vectors, const Progress& progress = {},
                     const ReceiverSink& sink = {});

/// Returns a sink for a call of `Tracer::trace` with the indices `batch`. The result calls `sink` with the
/// receiver batch[i] instead of i, and keeps references to the elements of `batch` and to `sink`. Returns an
/// empty function if `sink` is empty.
HitSink sink_of(std::span<const std::uint32_t> batch, const ReceiverSink& sink);

/// Calls `work` for consecutive parts of `indices`, one after another on the calling thread. A part has
/// tracer.batch_size(options) indices, or fewer at the end. The second argument of `work` is the range of
/// `progress` that belongs to the part. Throws `Cancelled` after a stop request, which is checked before each
/// part and at the end, and the errors of `work`.
void in_batches(const Tracer& tracer, std::span<const std::uint32_t> indices, const TraceOptions& options,
                const Progress& progress,
                const std::function<void(std::span<const std::uint32_t>, const Progress&)>& work);

/// Traces the receivers with the indices `indices` and replaces their vectors in `transfer`, which has one
/// term with one channel of options.order: [receivers][order²]. Vectors of other receivers are not changed.
/// `sink`, if not empty, gets the hits of each receiver. Throws `Cancelled` after a stop request, and the
/// errors of Tracer::trace.
void trace_receivers(Tracer& tracer, const Receivers& receivers, std::span<const std::uint32_t> indices,
                     const TraceOptions& options, Transfer& transfer, const Progress& progress = {},
                     const ReceiverSink& sink = {});

/// Returns the number of rays in the first half, as `trace_in_halves` splits a sequence of `rays` rays: a
/// power of two between a third and two thirds of `rays`. Returns 0 if `rays` is less than 8, which is too
/// few to split.
int first_half(int rays);

/// Callback that gets the hits of all rays of one receiver, and the hits of the first half of its rays, which
/// are the first entries of `all`. `receiver` is its index in a `Receivers`. It is called from several
/// threads at the same time; the spans are valid only during the call.
using HalvesSink =
    std::function<void(std::uint32_t receiver, std::span<const Hit> all, std::span<const Hit> half)>;

/// Output of `trace_in_halves`: two transfers with one term of one channel, [receivers][order²].
struct TracedHalves {
    Transfer &all, ///< direct transfer from all rays
        &half;     ///< direct transfer from the first half of the rays alone
};

/// Traces the receivers with the indices `indices` and replaces their vectors in both members of `to`. The
/// difference of the two results serves for an estimate of the noise of the rays. The first half has
/// `first_half(options.rays)` rays, which must not be 0. `sink`, if not empty, gets the hits of each
/// receiver. Throws `Cancelled` after a stop request, and the errors of Tracer::trace.
void trace_in_halves(Tracer& tracer, const Receivers& receivers, std::span<const std::uint32_t> indices,
                     const TraceOptions& options, const TracedHalves& to, const Progress& progress = {},
                     const HalvesSink& sink = {});

} // namespace prt
