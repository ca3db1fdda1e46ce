// Exit radiance and visibility from raw transfer vectors.
#include "prt/core/transfer.h"

#include "prt/core/transfer_view.h"
#include "runtime/core/support/parallel.h"

#include <algorithm>

namespace prt {

glm::vec3 exit_radiance(std::span<const float> transfer, const TransferLayout& layout,
                        std::span<const glm::vec3> columns) {
    glm::vec3 sum(0);
    const float* t = transfer.data();
    const glm::vec3* light = columns.data();
    for (const TransferTerm& term : layout.terms) {
        const std::size_t count = layout.columns_of(term);
        if (term.channels == 1)
            for (std::size_t i = 0; i < count; ++i)
                sum += t[i] * light[i];
        else
            for (std::size_t i = 0; i < count; ++i)
                sum += glm::vec3(t[i], t[count + i], t[2 * count + i]) * light[i];
        t += layout.numbers_of(term);
        light += count;
    }
    return sum;
}

std::vector<glm::vec3> exit_radiance(const Transfer& transfer, const Lighting& lighting, int threads) {
    const std::vector<glm::vec3> columns = light_columns(transfer.layout, lighting);
    std::vector<glm::vec3> result(transfer.receivers());
    parallel_for(result.size(), 4096, threads, [&](std::size_t begin, std::size_t end) {
        for (std::size_t p = begin; p < end; ++p)
            result[p] = exit_radiance(transfer.vector(p), transfer.layout, columns);
    });
    return result;
}

std::vector<glm::vec3> exit_radiance(const Transfer& transfer, const Light& light, int threads) {
    return exit_radiance(transfer, Lighting{light}, threads);
}

TransferLayout as_combined(const TransferLayout& layout) {
    const std::span<const TransferTerm> distant = layout.distant_terms(), lamps = layout.lamp_terms();
    TransferLayout combined{layout.order, {lamps.begin(), lamps.end()}};
    if (distant.empty())
        return combined;
    int channels = 1;
    for (const TransferTerm& term : distant)
        channels = std::max(channels, term.channels);
    combined.terms.insert(combined.terms.begin(), {TermKind::combined, channels});
    return combined;
}

namespace {

/// Adds the terms of `from`, which has `layout`, to `to`, which is zero and has the layout `combined` =
/// as_combined(layout).
void add_terms(std::span<const float> from, const TransferLayout& layout, const TransferLayout& combined,
               std::span<float> to) {
    const auto count = static_cast<std::size_t>(coefficient_count(layout.order));
    for (const TransferTerm& term : layout.distant_terms()) {
        for (int c = 0; c < combined.terms.front().channels; ++c)
            for (std::size_t i = 0; i < count; ++i)
                to[static_cast<std::size_t>(c) * count + i] +=
                    from[static_cast<std::size_t>(std::min(c, term.channels - 1)) * count + i];
        from = from.subspan(layout.numbers_of(term));
    }
    std::ranges::copy(from, to.last(from.size()).begin()); // lamps
}

} // namespace

std::vector<float> as_combined(std::span<const float> transfer, const TransferLayout& layout) {
    const TransferLayout combined = as_combined(layout);
    std::vector<float> sum(combined.dimension(), 0.0f);
    add_terms(transfer, layout, combined, sum);
    return sum;
}

Transfer as_combined(const Transfer& transfer, int threads) {
    Transfer combined = zero_transfer(as_combined(transfer.layout), transfer.receivers());
    parallel_for(transfer.receivers(), 4096, threads, [&](std::size_t begin, std::size_t end) {
        for (std::size_t p = begin; p < end; ++p)
            add_terms(transfer.vector(p), transfer.layout, combined.layout, combined.vector(p));
    });
    return combined;
}

TransferView as_combined(TransferView transfer) {
    const TransferLayout combined = as_combined(transfer.layout());
    const std::size_t receivers = transfer.receivers();
    return {combined, receivers,
            [from = std::move(transfer), combined](std::size_t first, std::span<float> to) {
                const std::size_t numbers = combined.dimension(), count = to.size() / numbers;
                std::vector<float> terms(count * from.dimension());
                from.read(first, terms);
                std::ranges::fill(to, 0.0f);
                for (std::size_t p = 0; p < count; ++p)
                    add_terms(std::span(terms).subspan(p * from.dimension(), from.dimension()), from.layout(),
                              combined, to.subspan(p * numbers, numbers));
            }};
}

double mean_visibility(const Transfer& transfer, std::span<const float> areas) {
    double sum = 0, area = 0;
    for (std::size_t p = 0; p < areas.size(); ++p) {
        const float* from = transfer.vector(p).data();
        for (const TransferTerm& term : transfer.layout.distant_terms())
            for (int c = 0; c < term.channels; ++c, from += transfer.layout.columns_of(term))
                sum += static_cast<double>(areas[p]) * static_cast<double>(*from) / term.channels;
        area += static_cast<double>(areas[p]);
    }
    return area > 0 ? sum / (area * kY00) : 0;
}

} // namespace prt
