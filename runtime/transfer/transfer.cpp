// Exit radiance and visibility from raw transfer vectors.
#include "prt/transfer.h"

#include "prt/support/parallel.h"

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
    TransferLayout whole{layout.order, {}};
    int channels = 0;
    for (const TransferPart& part : layout.parts)
        if (part.kind != PartKind::lamp)
            channels = std::max(channels, part.channels);
        else
            whole.parts.push_back(part);
    if (channels > 0)
        whole.parts.insert(whole.parts.begin(), {PartKind::whole, channels});
    return whole;
}

std::vector<float> as_whole(std::span<const float> transfer, const TransferLayout& layout) {
    const TransferLayout whole = as_whole(layout);
    const auto count = static_cast<std::size_t>(coefficient_count(layout.order));
    std::vector<float> sum(whole.dimension(), 0.0f);
    const float* from = transfer.data();
    for (const TransferPart& part : layout.parts) {
        if (part.kind == PartKind::lamp)
            break;
        const int channels = whole.parts.front().channels;
        for (int c = 0; c < channels; ++c)
            for (std::size_t i = 0; i < count; ++i)
                sum[static_cast<std::size_t>(c) * count + i] +=
                    from[static_cast<std::size_t>(std::min(c, part.channels - 1)) * count + i];
        from += layout.numbers_of(part);
    }
    const float* const end = transfer.data() + transfer.size();
    std::copy(from, end, sum.end() - (end - from));
    return sum;
}

Transfer as_whole(const Transfer& transfer, int threads) {
    Transfer whole = zero_transfer(as_whole(transfer.layout), transfer.receivers());
    parallel_for(transfer.receivers(), 4096, threads, [&](std::size_t begin, std::size_t end) {
        for (std::size_t p = begin; p < end; ++p)
            std::ranges::copy(as_whole(transfer.vector(p), transfer.layout), whole.vector(p).begin());
    });
    return whole;
}

double mean_visibility(const Transfer& transfer, std::span<const float> areas) {
    double sum = 0, area = 0;
    for (std::size_t p = 0; p < areas.size(); ++p) {
        const float* from = transfer.vector(p).data();
        for (const TransferPart& part : transfer.layout.parts) {
            if (part.kind == PartKind::lamp)
                break;
            for (int c = 0; c < part.channels; ++c, from += transfer.layout.columns_of(part))
                sum += static_cast<double>(areas[p]) * static_cast<double>(*from) / part.channels;
        }
        area += static_cast<double>(areas[p]);
    }
    return area > 0 ? sum / (area * kY00) : 0;
}

} // namespace prt
