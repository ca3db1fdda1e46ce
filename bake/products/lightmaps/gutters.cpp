// Fills texels without values from their neighbours.

#include "bake/products/lightmaps/gutters.h"

#include <algorithm>
#include <cstdint>

namespace prt {
namespace {

template <class Visit>
void for_neighbours(const Atlas& atlas, std::uint32_t texel, Visit&& visit) {
    const int width = atlas.width, height = atlas.height, i = static_cast<int>(texel) % width,
              j = static_cast<int>(texel) / width;
    for (int y = j - 1; y <= j + 1; ++y)
        for (int x = i - 1; x <= i + 1; ++x) {
            const bool inside = x >= 0 && x < width && y >= 0 && y < height;
            if ((x != i || y != j) && (inside || atlas.repeats))
                visit(static_cast<std::uint32_t>((y + height) % height * width + (x + width) % width));
        }
}

} // namespace

void fill_gutters(const Atlas& atlas, std::vector<bool> filled, std::span<float> values, std::size_t stride) {
    std::vector<std::uint32_t> ring, next;
    std::vector<bool> waiting = filled; // or filled
    const auto wait_beside = [&](std::uint32_t texel) {
        for_neighbours(atlas, texel, [&](std::uint32_t n) {
            if (!waiting[n]) {
                waiting[n] = true;
                next.push_back(n);
            }
        });
    };
    for (std::uint32_t texel = 0; texel < atlas.texels(); ++texel)
        if (filled[texel])
            wait_beside(texel);
    while (!next.empty()) {
        ring.swap(next);
        next.clear();
        for (const std::uint32_t texel : ring) {
            float sources = 0;
            float* const to = &values[texel * stride];
            std::fill_n(to, stride, 0.0f);
            for_neighbours(atlas, texel, [&](std::uint32_t n) {
                if (!filled[n])
                    return;
                ++sources;
                for (std::size_t k = 0; k < stride; ++k)
                    to[k] += values[n * stride + k];
            });
            for (std::size_t k = 0; k < stride; ++k)
                to[k] /= sources;
        }
        for (const std::uint32_t texel : ring)
            filled[texel] = true;
        for (const std::uint32_t texel : ring)
            wait_beside(texel);
    }
}

} // namespace prt
