// Gives receivers to a tracer in batches, so that progress shows and work stops.

#include "prt/trace_receivers.h"

#include "prt/sh_basis.h"
#include "trace/vector_sums.h"
#include "transport/gather_product.h"

#include <algorithm>
#include <cassert>

namespace prt {

std::unique_ptr<GatherProduct> Tracer::gather_product(const GatherOperator&) {
    return nullptr;
}

std::unique_ptr<VectorSums> Tracer::vector_sums(int, std::span<const float>) {
    return nullptr;
}

HitSink sink_of(std::span<const std::uint32_t> batch, const ReceiverSink& sink) {
    if (!sink)
        return {};
    return [batch, &sink](std::size_t i, std::span<const Hit> hits) { sink(batch[i], hits); };
}

void in_batches(const Tracer& tracer, std::span<const std::uint32_t> indices, const TraceOptions& options,
                const Progress& progress,
                const std::function<void(std::span<const std::uint32_t>, const Progress&)>& work) {
    const auto share = [&](std::size_t done) {
        return static_cast<double>(done) / static_cast<double>(indices.size());
    };
    for (std::size_t begin = 0; begin < indices.size();) {
        progress.update(share(begin));
        const auto part =
            indices.subspan(begin, std::min(tracer.batch_size(options), indices.size() - begin));
        work(part, progress.part(share(begin), share(begin + part.size())));
        begin += part.size();
    }
    progress.update(1);
}

void trace_receivers(Tracer& tracer, const Receivers& receivers, std::span<const std::uint32_t> indices,
                     const TraceOptions& options, const VectorSink& take, const Progress& progress,
                     const ReceiverSink& sink) {
    assert(!sink || tracer.notes_hits());
    const auto dimension = static_cast<std::size_t>(coefficient_count(options.order));
    std::vector<float> vectors;
    in_batches(tracer, indices, options, progress,
               [&](std::span<const std::uint32_t> part, const Progress& part_progress) {
                   vectors.resize(part.size() * dimension);
                   tracer.trace(receivers, part, options, vectors, sink_of(part, sink), part_progress);
                   for (std::size_t i = 0; i < part.size(); ++i)
                       take(part[i], std::span<const float>(&vectors[i * dimension], dimension));
               });
}

void trace_receivers(Tracer& tracer, const Receivers& receivers, std::span<const std::uint32_t> indices,
                     const TraceOptions& options, Transfer& transfer, const Progress& progress,
                     const ReceiverSink& sink) {
    const VectorSink take = [&](std::uint32_t p, std::span<const float> vector) {
        std::copy(vector.begin(), vector.end(), transfer.vector(p).begin());
    };
    trace_receivers(tracer, receivers, indices, options, take, progress, sink);
}

} // namespace prt
