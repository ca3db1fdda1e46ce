#include "volume/light_error.h"

#include <cmath>

namespace prt {

LightError::LightError(const IncidentLayout& layout) : layout_(layout) {
    // A band's power falls with its number in outdoor and indoor skies alike.
    for (int l = 0; l < layout.sky.order; ++l)
        bands_.insert(bands_.end(), static_cast<std::size_t>(2 * l + 1), 1.0 / std::pow(1 + l, 2));
}

/// Of one coefficient of what comes in, over skies that may light the scene.
double LightError::under_skies(std::span<const float> of_coefficient) const {
    const std::size_t direct = layout_.direct(), channels = layout_.sky.dimension() / direct - 1;
    double sum = 0;
    for (std::size_t i = 0; i < direct; ++i) {
        double square = channels == 0 ? std::pow(static_cast<double>(of_coefficient[i]), 2) : 0.0;
        for (std::size_t c = 1; c <= channels; ++c)
            square += std::pow(static_cast<double>(of_coefficient[i] + of_coefficient[c * direct + i]), 2) /
                      static_cast<double>(channels);
        sum += bands_[i] * square;
    }
    return sum;
}

double LightError::under_lamps(std::span<const float> of_coefficient) const {
    double sum = 0;
    for (const float light : of_coefficient.subspan(layout_.sky.dimension()))
        sum += static_cast<double>(light * light);
    return sum;
}

BrickError LightError::operator()(const VolumeCorners& corners, const ProbeStates& states,
                                  std::span<const float> measured) const {
    const std::size_t numbers = layout_.numbers();
    std::vector<float> missing(numbers);
    BrickError error;
    for (std::size_t o = 0; o < layout_.coefficients(); ++o) {
        const std::span<const float> right = measured.subspan(o * numbers, numbers);
        for (std::size_t i = 0; i < numbers; ++i)
            missing[i] = -right[i];
        for (std::size_t c = 0; c < 8; ++c) {
            const float* from = &states.values[corners.probes[c] * states.stride + o * numbers];
            for (std::size_t i = 0; i < numbers; ++i)
                missing[i] += corners.weights[c] * from[i];
        }
        error.error[0] += under_skies(missing);
        error.error[1] += under_lamps(missing);
        error.norm[0] += under_skies(right);
        error.norm[1] += under_lamps(right);
    }
    return error;
}

} // namespace prt
