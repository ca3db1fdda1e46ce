// Gives receivers to a tracer in batches, so that progress shows and work stops.

#include "prt/trace_receivers.h"

#include <algorithm>
#include <cassert>

namespace prt {

void trace_receivers(Tracer& tracer, const Receivers& receivers, std::span<const std::uint32_t> indices,
                     const TraceOptions& options, Transfer& transfer, const Progress& progress,
                     const ReceiverSink& sink) {
    assert(!sink || tracer.notes_hits());
    const auto share = [&](std::size_t done) {
        return static_cast<double>(done) / static_cast<double>(indices.size());
    };
    std::vector<float> vectors;
    for (std::size_t begin = 0; begin < indices.size();) {
        progress.update(share(begin));
        const auto part =
            indices.subspan(begin, std::min(tracer.batch_size(options), indices.size() - begin));
        vectors.resize(part.size() * transfer.dimension());
        HitSink batch_sink;
        if (sink)
            batch_sink = [&](std::size_t i, std::span<const Hit> hits) { sink(part[i], hits); };
        tracer.trace(receivers, part, options, vectors, batch_sink,
                     progress.part(share(begin), share(begin + part.size())));
        for (std::size_t i = 0; i < part.size(); ++i)
            std::copy_n(&vectors[i * transfer.dimension()], transfer.dimension(),
                        transfer.vector(part[i]).begin());
        begin += part.size();
    }
    progress.update(1);
}

} // namespace prt
