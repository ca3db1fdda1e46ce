// Gives receivers to a tracer in batches, so that progress shows and work stops.

#include "prt/trace_receivers.h"

#include "prt/sh_basis.h"
#include "trace/vector_sums.h"
#include "transport/gather_product.h"

#include <algorithm>
#include <array>
#include <bit>
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

int first_half(int rays) {
    constexpr int kFewest = 8;
    return rays < kFewest ? 0 : static_cast<int>(std::bit_ceil(static_cast<unsigned>(rays)) / 2);
}

void trace_in_halves(Tracer& tracer, const Receivers& receivers, std::span<const std::uint32_t> indices,
                     const TraceOptions& options, const TracedHalves& to, const Progress& progress,
                     const HalvesSink& sink) {
    const auto dimension = static_cast<std::size_t>(coefficient_count(options.order));
    std::array<TraceOptions, 2> options_of{options, options};
    options_of[0].rays = first_half(options.rays);
    options_of[1].rays = options.rays - options_of[0].rays;
    options_of[1].first_ray += static_cast<std::uint32_t>(options_of[0].rays);
    const float share = static_cast<float>(options_of[0].rays) / static_cast<float>(options.rays);
    in_batches(tracer, indices, options, progress,
               [&](std::span<const std::uint32_t> part, const Progress& part_progress) {
                   std::vector<std::vector<Hit>> hits(sink ? part.size() : 0);
                   const HitSink keep = [&](std::size_t i, std::span<const Hit> first) {
                       hits[i].assign(first.begin(), first.end());
                   };
                   const HitSink join = [&](std::size_t i, std::span<const Hit> second) {
                       const std::size_t first = hits[i].size();
                       hits[i].insert(hits[i].end(), second.begin(), second.end());
                       sink(part[i], hits[i], std::span(hits[i]).first(first));
                   };
                   std::array<std::vector<float>, 2> vectors;
                   for (const std::size_t h : {0u, 1u}) {
                       vectors[h].resize(part.size() * dimension);
                       tracer.trace(receivers, part, options_of[h], vectors[h],
                                    !sink    ? HitSink()
                                    : h == 0 ? keep
                                             : join,
                                    part_progress.part(0.5 * static_cast<double>(h),
                                                       0.5 * static_cast<double>(h + 1)));
                   }
                   for (std::size_t i = 0; i < part.size(); ++i)
                       for (std::size_t k = 0; k < dimension; ++k) {
                           const float first = vectors[0][i * dimension + k];
                           to.half.vector(part[i])[k] = first;
                           to.all.vector(part[i])[k] =
                               share * first + (1 - share) * vectors[1][i * dimension + k];
                       }
               });
}

} // namespace prt
