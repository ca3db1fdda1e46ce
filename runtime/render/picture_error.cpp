// Compares pictures with path-traced references.

#include "runtime/render/picture_error.h"

#include "prt/core/error.h"
#include "prt/core/error_measures.h"
#include "prt/core/light.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <numeric>

namespace prt {
namespace {

/// Throws `Error` unless both halves have `pixels` pixels.
void check_sizes(const std::array<Image, 2>& halves, std::size_t pixels) {
    if (halves[0].pixels.size() != pixels || halves[1].pixels.size() != pixels)
        throw Error("the two halves of a reference picture, or its mask of surfaces, differ in size");
}

} // namespace

Image mean_of(const std::array<Image, 2>& halves) {
    check_sizes(halves, halves[0].pixels.size());
    Image mean = halves[0];
    for (std::size_t i = 0; i < mean.pixels.size(); ++i)
        mean.pixels[i] = 0.5f * (mean.pixels[i] + halves[1].pixels[i]);
    return mean;
}

double noise_of(const std::array<Image, 2>& halves, const std::vector<bool>& surfaces) {
    check_sizes(halves, surfaces.size());
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

namespace {

/// Sums of luminance over the pixels of a block that show surfaces.
struct Block {
    std::size_t pixels = 0;
    double first = 0, second = 0, picture = 0,
           product = 0; ///< sums of a, of b, of p, and of (p - a)(p - b), with a and b the halves and p the
                        ///< picture

    double reference() const { return 0.5 * (first + second) / static_cast<double>(pixels); }
};

std::vector<Block> blocks_of(const Image& picture, const std::array<Image, 2>& halves,
                             const std::vector<bool>& surfaces) {
    const int columns = (picture.width + kContrastBlock - 1) / kContrastBlock,
              rows = (picture.height + kContrastBlock - 1) / kContrastBlock;
    std::vector<Block> blocks(static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows));
    for (int y = 0; y < picture.height; ++y)
        for (int x = 0; x < picture.width; ++x) {
            const std::size_t i = static_cast<std::size_t>(y) * static_cast<std::size_t>(picture.width) +
                                  static_cast<std::size_t>(x);
            if (!surfaces[i])
                continue;
            Block& block =
                blocks[static_cast<std::size_t>(y / kContrastBlock * columns + x / kContrastBlock)];
            const double p = luminance(glm::dvec3(picture.pixels[i])),
                         a = luminance(glm::dvec3(halves[0].pixels[i])),
                         b = luminance(glm::dvec3(halves[1].pixels[i]));
            ++block.pixels;
            block.first += a;
            block.second += b;
            block.picture += p;
            block.product += (p - a) * (p - b);
        }
    std::erase_if(blocks, [](const Block& block) { return block.pixels == 0; });
    return blocks;
}

/// Returns the adaptation luminance of the blocks, weighted by their number of pixels.
double adaptation_to(const std::vector<Block>& blocks) {
    std::vector<double> luminances;
    std::vector<float> pixels;
    for (const Block& block : blocks) {
        luminances.push_back(block.reference());
        pixels.push_back(static_cast<float>(block.pixels));
    }
    return adaptation_luminance(luminances, pixels);
}

void add_contrast(std::vector<Block> blocks, PictureError& error) {
    const double adaptation = adaptation_to(blocks);
    if (!(adaptation > 0))
        return;
    const auto contrast = [&](const Block& block) {
        return std::abs(block.picture / static_cast<double>(block.pixels) - block.reference()) /
               (std::abs(block.reference()) + adaptation);
    };
    double squares = 0;
    std::size_t pixels = 0;
    for (const Block& block : blocks) {
        const double level = std::abs(block.reference()) + adaptation;
        squares += block.product / (level * level);
        pixels += block.pixels;
    }
    error.contrast_rms = std::sqrt(std::max(0.0, squares / static_cast<double>(pixels)));
    std::ranges::sort(blocks, {}, contrast);
    std::size_t seen = 0;
    for (const Block& block : blocks)
        if (seen += block.pixels; static_cast<double>(seen) >= 0.95 * static_cast<double>(pixels)) {
            error.contrast_percentile_95 = contrast(block);
            break;
        }
}

} // namespace

PictureError picture_error(const Image& picture, const std::array<Image, 2>& halves,
                           const std::vector<bool>& surfaces, const FlipOptions& options) {
    check_sizes(halves, surfaces.size());
    PictureError error;
    error.flip = hdr_flip(mean_of(halves), picture, options);
    error.relative_l2 = relative_l2(picture, halves, surfaces);
    add_contrast(blocks_of(picture, halves, surfaces), error);
    std::vector<float> sorted = error.flip;
    error.flip_mean = std::accumulate(sorted.begin(), sorted.end(), 0.0) / static_cast<double>(sorted.size());
    const auto at =
        sorted.begin() + static_cast<std::ptrdiff_t>(0.95 * static_cast<double>(sorted.size() - 1));
    std::nth_element(sorted.begin(), at, sorted.end());
    error.flip_percentile_95 = static_cast<double>(*at);
    return error;
}

} // namespace prt
