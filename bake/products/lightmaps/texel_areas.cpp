// Computes the area of the surface that filters read from each texel.

#include "bake/products/lightmaps/texel_areas.h"

#include "bake/products/lightmaps/seams.h"

#include <algorithm>
#include <cmath>
#include <unordered_map>

namespace prt {
namespace {

/// A filter reads a texel's neighbours in all eight directions.
void mark_round(const Atlas& atlas, std::uint32_t texel, std::vector<bool>& marked) {
    const int width = atlas.width, height = atlas.height, i = static_cast<int>(texel) % width,
              j = static_cast<int>(texel) / width;
    for (int y = j - 1; y <= j + 1; ++y)
        for (int x = i - 1; x <= i + 1; ++x)
            if (atlas.repeats || (x >= 0 && x < width && y >= 0 && y < height))
                marked[static_cast<std::size_t>((y + height) % height * width + (x + width) % width)] = true;
}

} // namespace

double area_in_texels(const ChartTriangle& t) {
    const glm::dvec2 a = t.corners[1] - t.corners[0], b = t.corners[2] - t.corners[0];
    return std::abs(a.x * b.y - a.y * b.x) / 2;
}

double area_of_sample(const ChartTriangle& t, const TexelPositions& positions) {
    return positions.area(t.triangle) / std::max(kSamplesOfTexel * area_in_texels(t), 1.0);
}

TexelAreas texel_areas(const Atlas& atlas, std::span<const ChartTriangle> charts,
                       const TexelPositions& positions, std::span<const TexelSample> samples) {
    std::unordered_map<std::uint32_t, const ChartTriangle*> chart_of;
    double surface = 0, read = 0;
    for (const ChartTriangle& t : charts) {
        chart_of.emplace(t.triangle, &t);
        surface += positions.area(t.triangle);
    }
    std::vector<double> areas(atlas.texels());
    std::vector<bool> marked(atlas.texels());
    for (const TexelSample& sample : samples) {
        mark_round(atlas, sample.texel, marked);
        const ChartTriangle& chart = *chart_of.at(sample.triangle);
        const double area = area_of_sample(chart, positions);
        read += area;
        const BilinearTexels filter = bilinear_at(atlas, position_of(chart, glm::dvec2(sample.uv)));
        for (std::size_t i = 0; i < 4; ++i) {
            areas[filter.texels[i]] += filter.weights[i] * area;
            marked[filter.texels[i]] = true;
        }
    }
    TexelAreas result;
    for (std::uint32_t texel = 0; texel < atlas.texels(); ++texel)
        if (marked[texel]) {
            result.texels.push_back(texel);
            result.areas.push_back(static_cast<float>(read > 0 ? areas[texel] * surface / read : 0));
        }
    return result;
}

} // namespace prt
