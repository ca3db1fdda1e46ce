// Compares pictures with path tracing.

#include "prt/picture_error.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <numeric>

namespace prt {

Image mean_of(const std::array<Image, 2>& halves) {
    Image mean = halves[0];
    for (std::size_t i = 0; i < mean.pixels.size(); ++i)
        mean.pixels[i] = 0.5f * (mean.pixels[i] + halves[1].pixels[i]);
    return mean;
}

double noise_of(const std::array<Image, 2>& halves, const std::vector<bool>& surfaces) {
    double squares = 0, norm = 0;
    for (std::size_t i = 0; i < surfaces.size(); ++i)
        if (surfaces[i]) {
            const glm::dvec3 a(halves[0].pixels[i]), b(halves[1].pixels[i]);
            squares += glm::dot(a - b, a - b) / 4;
            norm += glm::dot(a, b);
        }
    return norm > 0 ? std::sqrt(squares / norm) : 0;
}

double relative_l2(const Image& picture, const std::array<Image, 2>& halves,
                   const std::vector<bool>& surfaces) {
    double squares = 0, norm = 0;
    for (std::size_t i = 0; i < surfaces.size(); ++i)
        if (surfaces[i]) {
            const glm::dvec3 p(picture.pixels[i]), a(halves[0].pixels[i]), b(halves[1].pixels[i]);
            squares += glm::dot(p - a, p - b);
            norm += glm::dot(a, b);
        }
    return norm > 0 ? std::sqrt(std::max(0.0, squares / norm)) : 0;
}

PictureError picture_error(const Image& picture, const std::array<Image, 2>& halves,
                           const std::vector<bool>& surfaces, const FlipOptions& options) {
    PictureError error;
    error.flip = hdr_flip(mean_of(halves), picture, options);
    error.relative_l2 = relative_l2(picture, halves, surfaces);
    std::vector<float> sorted = error.flip;
    error.flip_mean = std::accumulate(sorted.begin(), sorted.end(), 0.0) / static_cast<double>(sorted.size());
    const auto at =
        sorted.begin() + static_cast<std::ptrdiff_t>(0.95 * static_cast<double>(sorted.size() - 1));
    std::nth_element(sorted.begin(), at, sorted.end());
    error.flip_percentile_95 = static_cast<double>(*at);
    return error;
}

} // namespace prt
