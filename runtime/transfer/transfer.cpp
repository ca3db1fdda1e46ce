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

} // namespace prt
