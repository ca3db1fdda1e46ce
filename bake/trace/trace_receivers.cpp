// Passes receivers to a tracer in batches, for progress reports and cancellation.

#include "bake/trace/trace_receivers.h"

#include "bake/trace/gather_product.h"
#include "bake/trace/vector_sums.h"
#include "prt/core/sh_basis.h"

#include <algorithm>
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
        work(part, progress.range(share(begin), share(begin + part.size())));
        begin += part.size();
    }
    progress.update(1);
}

void trace_receivers(Tracer& tracer, const Receivers& receivers, std::span<const std::uint32_t> indices,
                     const TraceOptions& options, const VectorSink& take, const Progress& progress,
                     const ReceiverSink& sink) {
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
    const auto even = static_cast<int>(std::bit_floor(static_cast<unsigned>(rays)));
    if (rays < kFewest)
        return 0;
    return rays - even >= even / 2 ? even : even / 2;
}

namespace {

/// Returns the first half of the rays and then the others, in ranges that Tracer::trace supports.
std::vector<TraceOptions> terms_of(const TraceOptions& options) {
    std::vector<TraceOptions> parts;
    for (int begin = 0; begin < options.rays;) {
        TraceOptions part = options;
        part.first_ray += static_cast<std::uint32_t>(begin);
        part.rays = std::min(begin == 0 ? first_half(options.rays) : begin, options.rays - begin);
        begin += part.rays;
        parts.push_back(part);
    }
    return parts;
}

} // namespace

void trace_in_halves(Tracer& tracer, const Receivers& receivers, std::span<const std::uint32_t> indices,
                     const TraceOptions& options, const TracedHalves& to, const Progress& progress,
                     const HalvesSink& sink) {
    const auto dimension = static_cast<std::size_t>(coefficient_count(options.order));
    const std::vector<TraceOptions> parts = terms_of(options);
    const auto trace = [&](std::span<const std::uint32_t> batch, const Progress& batch_progress) {
        std::vector<std::vector<Hit>> hits(sink ? batch.size() : 0);
        std::vector<std::size_t> of_half(hits.size());
        std::vector<float> vectors(batch.size() * dimension);
        for (std::size_t k = 0; k < parts.size(); ++k) {
            std::vector<std::size_t> before(hits.size());
            std::ranges::transform(hits, before.begin(), &std::vector<Hit>::size);
            const HitSink keep = [&](std::size_t i, std::span<const Hit> more) {
                hits[i].resize(before[i]); // the CPU repeats a call in which a GPU failed
                hits[i].insert(hits[i].end(), more.begin(), more.end());
                if (k == 0)
                    of_half[i] = hits[i].size();
                if (k + 1 == parts.size())
                    sink(batch[i], hits[i], std::span(hits[i]).first(of_half[i]));
            };
            const auto share = [&](std::size_t done) {
                return static_cast<double>(done) / static_cast<double>(parts.size());
            };
            tracer.trace(receivers, batch, parts[k], vectors, sink ? keep : HitSink(),
                         batch_progress.range(share(k), share(k + 1)));
            const float weight = static_cast<float>(parts[k].rays) / static_cast<float>(options.rays);
            for (std::size_t i = 0; i < batch.size(); ++i)
                for (std::size_t c = 0; c < dimension; ++c) {
                    const float value = vectors[i * dimension + c];
                    if (k == 0)
                        to.half.vector(batch[i])[c] = value;
                    float& all = to.all.vector(batch[i])[c];
                    all = (k == 0 ? 0 : all) + weight * value;
                }
        }
    };
    in_batches(tracer, indices, options, progress, trace);
}

} // namespace prt
