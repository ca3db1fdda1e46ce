// Exit radiance and visibility from raw transfer vectors.
#include "prt/transfer.h"

#include "prt/support/parallel.h"

#include <algorithm>

namespace prt {

glm::vec3 exit_radiance(std::span<const float> transfer, const TransferLayout& layout,
                        std::span<const glm::vec3> columns) {
    const auto count = static_cast<std::size_t>(coefficient_count(layout.order));
    glm::vec3 sum(0);
    const float* t = transfer.data();
    const glm::vec3* light = columns.data();
    for (const TransferPart& part : layout.parts) {
        if (part.channels == 1)
            for (std::size_t i = 0; i < count; ++i)
                sum += t[i] * light[i];
        else
            for (std::size_t i = 0; i < count; ++i)
                sum += glm::vec3(t[i], t[count + i], t[2 * count + i]) * light[i];
        t += static_cast<std::size_t>(part.channels) * count;
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

std::vector<float> as_whole(std::span<const float> transfer, const TransferLayout& layout) {
    const auto count = static_cast<std::size_t>(coefficient_count(layout.order)),
               channels = static_cast<std::size_t>(layout.channels());
    std::vector<float> sum(channels * count, 0.0f);
    const float* from = transfer.data();
    for (const TransferPart& part : layout.parts) {
        const auto stored = static_cast<std::size_t>(part.channels);
        for (std::size_t c = 0; c < channels; ++c)
            for (std::size_t i = 0; i < count; ++i)
                sum[c * count + i] += from[std::min(c, stored - 1) * count + i];
        from += stored * count;
    }
    return sum;
}

Transfer as_whole(const Transfer& transfer, int threads) {
    Transfer whole = zero_transfer(transfer.layout.order, transfer.layout.channels(), transfer.receivers());
    parallel_for(transfer.receivers(), 4096, threads, [&](std::size_t begin, std::size_t end) {
        for (std::size_t p = begin; p < end; ++p)
            std::ranges::copy(as_whole(transfer.vector(p), transfer.layout), whole.vector(p).begin());
    });
    return whole;
}

double mean_visibility(const Transfer& transfer, std::span<const float> areas) {
    double sum = 0, area = 0;
    const auto count = static_cast<std::size_t>(coefficient_count(transfer.layout.order));
    for (std::size_t p = 0; p < areas.size(); ++p) {
        std::size_t block = 0;
        for (const TransferPart& part : transfer.layout.parts)
            for (int c = 0; c < part.channels; ++c)
                sum += static_cast<double>(areas[p]) *
                       static_cast<double>(transfer.vector(p)[block++ * count]) / part.channels;
        area += static_cast<double>(areas[p]);
    }
    return area > 0 ? sum / (area * kY00) : 0;
}

} // namespace prt
