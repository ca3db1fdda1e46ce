// Exit radiance and visibility from raw transfer vectors.
#include "prt/transfer.h"

#include "prt/support/parallel.h"

namespace prt {

glm::vec3 exit_radiance(std::span<const float> transfer, int channels, const Light& light) {
    const std::size_t count = light.coefficients.size();
    glm::vec3 sum(0);
    if (channels == 1) {
        for (std::size_t i = 0; i < count; ++i)
            sum += transfer[i] * light.coefficients[i];
    } else {
        for (std::size_t i = 0; i < count; ++i)
            sum +=
                glm::vec3(transfer[i], transfer[count + i], transfer[2 * count + i]) * light.coefficients[i];
    }
    return sum;
}

std::vector<glm::vec3> exit_radiance(const Transfer& transfer, const Light& light, int threads) {
    const Light bands = truncated(light, transfer.order);
    std::vector<glm::vec3> result(transfer.receivers());
    parallel_for(result.size(), 4096, threads, [&](std::size_t begin, std::size_t end) {
        for (std::size_t p = begin; p < end; ++p)
            result[p] = exit_radiance(transfer.vector(p), transfer.channels, bands);
    });
    return result;
}

double mean_visibility(const Transfer& transfer, std::span<const float> areas) {
    double sum = 0, area = 0;
    const auto stride = static_cast<std::size_t>(coefficient_count(transfer.order));
    for (std::size_t p = 0; p < areas.size(); ++p) {
        for (int c = 0; c < transfer.channels; ++c)
            sum += static_cast<double>(areas[p]) *
                   static_cast<double>(transfer.vector(p)[static_cast<std::size_t>(c) * stride]) /
                   transfer.channels;
        area += static_cast<double>(areas[p]);
    }
    return area > 0 ? sum / (area * kY00) : 0;
}

} // namespace prt
