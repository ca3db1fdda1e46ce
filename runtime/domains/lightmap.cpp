// Neighbourhood of lightmap texels: edges, nearest receivers and bilinear samples.

#include "prt/core/lightmap.h"

#include <algorithm>
#include <cmath>

namespace prt {
namespace {

constexpr std::uint32_t kNobody = ~0u;

/// Returns a coordinate modulo the size of a repeating map; fmod is exact for any distance. Returns 0 if it
/// is not finite, as for coordinates close to the range of float.
double near_first_square(double x, int side, bool repeats) {
    if (!std::isfinite(x))
        return 0;
    return repeats ? std::fmod(x, side) : x;
}

/// Returns the texel that a filter reads for index i along a side, repeated or clamped.
std::uint32_t along_side(double i, int side, bool repeats) {
    const double size = side;
    return static_cast<std::uint32_t>(repeats ? i - size * std::floor(i / size)
                                              : std::clamp(i, 0.0, size - 1));
}

} // namespace

std::size_t LightmapLayout::texels() const {
    return first_texels().back();
}

std::vector<std::size_t> LightmapLayout::first_texels() const {
    std::vector<std::size_t> first = {0};
    for (const LightmapSize& map : maps)
        first.push_back(first.back() + map.texels());
    return first;
}

std::vector<Edge> lightmap_edges(const LightmapLayout& layout, std::span<const std::uint32_t> texels,
                                 std::span<const Edge> seams) {
    std::vector<Edge> edges(seams.begin(), seams.end());
    const std::vector<std::size_t> first = layout.first_texels();
    auto begin = texels.begin();
    for (std::size_t m = 0; m < layout.maps.size(); ++m) {
        const LightmapSize& map = layout.maps[m];
        const auto end = std::lower_bound(begin, texels.end(), first[m + 1]);
        std::vector<std::uint32_t> receiver_of(map.texels(), kNobody);
        for (auto t = begin; t != end; ++t)
            receiver_of[*t - first[m]] = static_cast<std::uint32_t>(t - texels.begin());
        const auto join = [&](std::size_t a, std::size_t b) {
            if (receiver_of[a] != kNobody && receiver_of[b] != kNobody)
                edges.push_back({receiver_of[a], receiver_of[b]});
        };
        const auto width = static_cast<std::size_t>(map.width), height = static_cast<std::size_t>(map.height);
        for (std::size_t y = 0; y < height; ++y)
            for (std::size_t x = 0; x < width; ++x) {
                if (x + 1 < width || map.repeats)
                    join(y * width + x, y * width + (x + 1) % width);
                if (y + 1 < height || map.repeats)
                    join(y * width + x, (y + 1) % height * width + x);
            }
        begin = end;
    }
    return unique_edges(std::move(edges));
}

std::vector<std::uint32_t> nearest_receivers(const LightmapSize& size,
                                             std::span<const std::uint32_t> texels) {
    std::vector<std::uint32_t> nearest(size.texels(), kNobody), ring, next;
    for (std::size_t i = 0; i < texels.size(); ++i) {
        nearest[texels[i]] = static_cast<std::uint32_t>(i);
        next.push_back(texels[i]);
    }
    if (texels.empty())
        std::ranges::fill(nearest, 0u);
    while (!next.empty()) {
        ring.swap(next);
        next.clear();
        for (const std::uint32_t t : ring) {
            const int x = static_cast<int>(t) % size.width, y = static_cast<int>(t) / size.width;
            const auto reach = [&](int i, int j) {
                const bool inside = i >= 0 && i < size.width && j >= 0 && j < size.height;
                if (!inside && !size.repeats)
                    return;
                const auto n = static_cast<std::uint32_t>((j + size.height) % size.height * size.width +
                                                          (i + size.width) % size.width);
                if (nearest[n] == kNobody) {
                    nearest[n] = nearest[t];
                    next.push_back(n);
                }
            };
            reach(x - 1, y);
            reach(x + 1, y);
            reach(x, y - 1);
            reach(x, y + 1);
        }
    }
    return nearest;
}

BilinearTexels bilinear_texels(const LightmapSize& size, double x, double y) {
    x = near_first_square(x, size.width, size.repeats);
    y = near_first_square(y, size.height, size.repeats);
    const double left = std::floor(x - 0.5), top = std::floor(y - 0.5);
    const double right = x - 0.5 - left, low = y - 0.5 - top;
    const auto width = static_cast<std::uint32_t>(size.width);
    const std::uint32_t x0 = along_side(left, size.width, size.repeats),
                        x1 = along_side(left + 1, size.width, size.repeats),
                        y0 = along_side(top, size.height, size.repeats),
                        y1 = along_side(top + 1, size.height, size.repeats);
    return {{y0 * width + x0, y0 * width + x1, y1 * width + x0, y1 * width + x1},
            {(1 - right) * (1 - low), right * (1 - low), (1 - right) * low, right * low}};
}

} // namespace prt
