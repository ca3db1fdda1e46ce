// Exit radiance and visibility from raw transfer vectors.
#include "prt/transfer.h"

#include "prt/support/parallel.h"
#include "prt/transfer_view.h"

#include <algorithm>

namespace prt {

glm::vec3 exit_radiance(std::span<const float> transfer, const TransferLayout& layout,
                        std::span<const glm::vec3> columns) {
    glm::vec3 sum(0);
    const float* t = transfer.data();
    const glm::vec3* light = columns.data();
    for (const TransferPart& part : layout.parts) {
        const std::size_t count = layout.columns_of(part);
        if (part.channels == 1)
            for (std::size_t i = 0; i < count; ++i)
                sum += t[i] * light[i];
        else
            for (std::size_t i = 0; i < count; ++i)
                sum += glm::vec3(t[i], t[count + i], t[2 * count + i]) * light[i];
        t += layout.numbers_of(part);
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

TransferLayout as_whole(const TransferLayout& layout) {
    const std::span<const TransferPart> distant = layout.distant_parts(), lamps = layout.lamp_parts();
    TransferLayout whole{layout.order, {lamps.begin(), lamps.end()}};
    if (distant.empty())
        return whole;
    int channels = 1;
    for (const TransferPart& part : distant)
        channels = std::max(channels, part.channels);
    whole.parts.insert(whole.parts.begin(), {PartKind::whole, channels});
    return whole;
}

namespace {

/// Adds the parts of `from`, which has `layout`, to `to`, which is zero and has the layout `whole` =
/// as_whole(layout).
void add_parts(std::span<const float> from, const TransferLayout& layout, const TransferLayout& whole,
               std::span<float> to) {
    const auto count = static_cast<std::size_t>(coefficient_count(layout.order));
    for (const TransferPart& part : layout.distant_parts()) {
        for (int c = 0; c < whole.parts.front().channels; ++c)
            for (std::size_t i = 0; i < count; ++i)
                to[static_cast<std::size_t>(c) * count + i] +=
                    from[static_cast<std::size_t>(std::min(c, part.channels - 1)) * count + i];
        from = from.subspan(layout.numbers_of(part));
    }
    std::ranges::copy(from, to.last(from.size()).begin()); // lamps
}

} // namespace

std::vector<float> as_whole(std::span<const float> transfer, const TransferLayout& layout) {
    const TransferLayout whole = as_whole(layout);
    std::vector<float> sum(whole.dimension(), 0.0f);
    add_parts(transfer, layout, whole, sum);
    return sum;
}

Transfer as_whole(const Transfer& transfer, int threads) {
    Transfer whole = zero_transfer(as_whole(transfer.layout), transfer.receivers());
    parallel_for(transfer.receivers(), 4096, threads, [&](std::size_t begin, std::size_t end) {
        for (std::size_t p = begin; p < end; ++p)
            add_parts(transfer.vector(p), transfer.layout, whole.layout, whole.vector(p));
    });
    return whole;
}

TransferView as_whole(TransferView transfer) {
    const TransferLayout whole = as_whole(transfer.layout());
    const std::size_t receivers = transfer.receivers();
    return {whole, receivers, [from = std::move(transfer), whole](std::size_t first, std::span<float> to) {
                const std::size_t numbers = whole.dimension(), count = to.size() / numbers;
                std::vector<float> parts(count * from.dimension());
                from.read(first, parts);
                std::ranges::fill(to, 0.0f);
                for (std::size_t p = 0; p < count; ++p)
                    add_parts(std::span(parts).subspan(p * from.dimension(), from.dimension()), from.layout(),
                              whole, to.subspan(p * numbers, numbers));
            }};
}

double mean_visibility(const Transfer& transfer, std::span<const float> areas) {
    double sum = 0, area = 0;
    for (std::size_t p = 0; p < areas.size(); ++p) {
        const float* from = transfer.vector(p).data();
        for (const TransferPart& part : transfer.layout.distant_parts())
            for (int c = 0; c < part.channels; ++c, from += transfer.layout.columns_of(part))
                sum += static_cast<double>(areas[p]) * static_cast<double>(*from) / part.channels;
        area += static_cast<double>(areas[p]);
    }
    return area > 0 ? sum / (area * kY00) : 0;
}

} // namespace prt
