// Few bits for the axes of a frame.

#include "rounded_frame.h"

#include <glm/gtc/packing.hpp>

#include <cmath>

namespace prt {

RoundedFrame rounded(const Frame& frame, const LightMetric& metric, double error) {
    RoundedFrame result{{}, frame.synthesis, 2 * static_cast<double>(frame.full())};
    for (const double value : frame.origin)
        result.origin.push_back(
            static_cast<double>(glm::unpackHalf1x16(glm::packHalf1x16(static_cast<float>(value)))));
    double trace = 0; // cost of an error of 1 in every number
    for (std::size_t i = 0; i < frame.full(); ++i)
        trace += metric.moments[i * frame.full() + i] * frame.scale * frame.scale;
    // The deviation of coordinates is their size: every axis has an equal loss.
    const double step = std::sqrt(12 * error / (trace * static_cast<double>(frame.dimension)));
    for (std::size_t i = 0; i < frame.dimension; ++i) {
        if (!(error > 0)) {
            result.bytes += static_cast<double>(frame.full() * sizeof(float));
            continue;
        }
        const double own = step / std::sqrt(frame.variances[i]);
        double most = 0;
        for (std::size_t a = 0; a < frame.full(); ++a) {
            double& value = result.synthesis[i * frame.full() + a];
            const double q = std::round(value / own);
            most = std::max(most, std::abs(q));
            value = q * own;
        }
        // Adds the step of each axis.
        result.bytes += std::ceil(std::log2(2 * most + 1)) * static_cast<double>(frame.full()) / 8 + 4;
    }
    return result;
}

} // namespace prt
