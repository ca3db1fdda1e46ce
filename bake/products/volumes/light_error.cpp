// Evaluates errors between probes under assumed skies and lamps.

#include "bake/products/volumes/light_error.h"

#include <cmath>

namespace prt {

LightError::LightError(const IncidentLayout& layout) : layout_(layout) {
    // The power of a band decreases with its number in outdoor and indoor skies.
    for (int l = 0; l < layout.sky.order; ++l)
        bands_.insert(bands_.end(), static_cast<std::size_t>(2 * l + 1), 1.0 / std::pow(1 + l, 2));
}

double LightError::under_skies(std::span<const float> a, std::span<const float> b) const {
    const std::size_t direct = layout_.direct(), channels = layout_.sky.dimension() / direct - 1;
    double sum = 0;
    for (std::size_t i = 0; i < direct; ++i) {
        double product = channels == 0 ? static_cast<double>(a[i] * b[i]) : 0.0;
        for (std::size_t c = 1; c <= channels; ++c)
            product += static_cast<double>((a[i] + a[c * direct + i]) * (b[i] + b[c * direct + i])) /
                       static_cast<double>(channels);
        sum += bands_[i] * product;
    }
    return sum;
}

double LightError::under_lamps(std::span<const float> a, std::span<const float> b) const {
    double sum = 0;
    for (std::size_t i = layout_.sky.dimension(); i < a.size(); ++i)
        sum += static_cast<double>(a[i] * b[i]);
    return sum;
}

BrickError LightError::operator()(const VolumeCorners& corners, const ProbeStates& states,
                                  const std::array<std::span<const float>, 2>& measured) const {
    const std::size_t numbers = layout_.numbers();
    std::vector<float> a(numbers), b(numbers), noise(numbers);
    double squares = 0; // a probe's noise that comes through
    for (const float w : corners.weights)
        squares += static_cast<double>(w * w);
    BrickError error;
    for (std::size_t o = 0; o < layout_.coefficients(); ++o) {
        const std::span<const float> first = measured[0].subspan(o * numbers, numbers),
                                     second = measured[1].subspan(o * numbers, numbers);
        for (std::size_t i = 0; i < numbers; ++i) {
            a[i] = -first[i];
            b[i] = -second[i];
            noise[i] = 0.5f * (first[i] - second[i]);
        }
        for (std::size_t c = 0; c < 8; ++c) {
            const float* from = &states.values[corners.probes[c] * states.stride + o * numbers];
            for (std::size_t i = 0; i < numbers; ++i) {
                a[i] += corners.weights[c] * from[i];
                b[i] += corners.weights[c] * from[i];
            }
        }
        error.error[0] += under_skies(a, b) - squares * under_skies(noise, noise);
        error.error[1] += under_lamps(a, b) - squares * under_lamps(noise, noise);
        error.norm[0] += under_skies(first, second);
        error.norm[1] += under_lamps(first, second);
    }
    return error;
}

} // namespace prt
