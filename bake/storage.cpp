#include "storage.h"

#include "prt/sh.h"

#include <glm/gtc/packing.hpp>

#include <algorithm>
#include <cmath>

namespace prt {

double half_rounding_error(const Transfer& transfer, std::span<const float> areas) {
    double error = 0, norm = 0;
    for (std::size_t p = 0; p < transfer.receivers(); ++p) {
        double point_error = 0, point_norm = 0;
        for (const float value : transfer.vector(p)) {
            const auto lost = static_cast<double>(value - glm::unpackHalf1x16(glm::packHalf1x16(value)));
            point_error += lost * lost;
            point_norm += static_cast<double>(value * value);
        }
        error += static_cast<double>(areas[p]) * point_error;
        norm += static_cast<double>(areas[p]) * point_norm;
    }
    return norm > 0 ? std::sqrt(error / norm) : 0;
}

double estimate_memory(const BakeOptions& options, std::size_t receivers, std::size_t triangles,
                       int channels) {
    const auto count = static_cast<double>(receivers);
    const double vector = 4.0 * channels * coefficient_count(options.order);
    // The transfer itself, once more in the file being written and once more joined to it.
    double bytes = 3 * count * vector;
    if (options.target_error)
        bytes += 3 * count * vector;
    // Embree's tree of high quality, our tables of triangles, the scene, its neighbours.
    bytes += 400.0 * static_cast<double>(triangles) + 150 * count;
    if (options.bounces == kEndlessBounces)
        bytes +=
            40 * count * 4 * channels * coefficient_count(std::min(options.order, 3)); // the solver's steps
    else if (options.bounces != 0)
        bytes += 2 * count * vector;
    return bytes;
}

} // namespace prt
