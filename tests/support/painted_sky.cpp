// Paints environment maps from functions and discs.

#include "support/painted_sky.h"

#include "runtime/core/support/parallel.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace prt::test {
namespace {

using std::numbers::pi;

/// The direction at (x, y) in pixels from the image's upper left corner.
glm::dvec3 direction_at(const Environment& e, double x, double y) {
    const double size = e.image.width;
    if (e.layout == EnvironmentLayout::lat_long)
        return lat_long_direction(e.image.width, e.image.height, x, y);
    const int face = std::min(static_cast<int>(y / size), 5);
    const double u = x, v = y - face * size;
    if (e.layout == EnvironmentLayout::angular)
        return angular_direction(2 * u / size - 1, 2 * v / size - 1);
    if (e.layout == EnvironmentLayout::cube_faces)
        return cube_face_direction(face, 2 * u / size - 1, 2 * v / size - 1);
    // The centers of border texels are on the border; directions beyond belong to the neighbour.
    const auto at = [&](double t) { return std::clamp((2 * t - 1) / (size - 1) - 1, -1.0, 1.0); };
    return cube_direction(face, at(u), at(v));
}

/// How much of the pixel a disc covers.
double covered(const Environment& e, int x, int y, const PaintedDisc& disc, double reach) {
    const double separate = glm::distance(direction_at(e, x + 0.5, y + 0.5), disc.towards),
                 radius = 2 * std::sin(0.5 * disc.half_angle);
    if (separate > radius + reach)
        return 0;
    if (separate < radius - reach)
        return 1;
    constexpr int kSteps = 32;
    // Each pixel has its own offsets, so that edges along a row are no coarser than others.
    const double right = std::fmod(0.618 * y, 1), down = std::fmod(0.618 * x, 1);
    double inside = 0, all = 0;
    for (int j = 0; j < kSteps; ++j)
        for (int i = 0; i < kSteps; ++i) {
            const glm::dvec3 w = direction_at(e, x + (i + right) / kSteps, y + (j + down) / kSteps);
            // Rows of lat-long images narrow towards the poles.
            const double area = e.layout == EnvironmentLayout::lat_long ? std::hypot(w.x, w.z) : 1;
            all += area;
            if (glm::distance(w, disc.towards) < radius)
                inside += area;
        }
    return inside / all;
}

} // namespace

glm::dvec3 PaintedDisc::irradiance() const {
    return pi * std::sin(half_angle) * std::sin(half_angle) * radiance;
}

Environment painted_sky(EnvironmentLayout layout, int width, int height, const Radiance& sky,
                        const std::vector<PaintedDisc>& discs) {
    Environment e;
    e.layout = layout;
    const bool cube = layout == EnvironmentLayout::cube || layout == EnvironmentLayout::cube_faces;
    e.image.width = width;
    e.image.height = cube ? 6 * width : layout == EnvironmentLayout::angular ? width : height;
    e.image.pixels.resize(static_cast<std::size_t>(e.image.width) * static_cast<std::size_t>(e.image.height));
    // More than half the diagonal of any texel.
    const double reach = layout == EnvironmentLayout::angular ? 2 * pi / width * 1.5
                         : cube                               ? 3.0 / width
                                : 1.5 * pi * std::max(1.0 / height, 2.0 / width);
    parallel_for(static_cast<std::size_t>(e.image.height), 8, 0, [&](std::size_t begin, std::size_t end) {
        for (int y = static_cast<int>(begin); y < static_cast<int>(end); ++y)
            for (int x = 0; x < width; ++x) {
                glm::dvec3 color = sky(direction_at(e, x + 0.5, y + 0.5));
                for (const PaintedDisc& disc : discs)
                    color += covered(e, x, y, disc, reach) * disc.radiance;
                e.image.at(x, y) = glm::vec3(color);
            }
    });
    return e;
}

glm::dvec3 gradient_sky(const glm::dvec3& w) {
    const double up = 0.5 * (1 + w.y), ahead = std::exp(2 * (w.z - 1));
    return glm::dvec3(0.1, 0.2, 0.4) * (1 + 6 * up * up) + glm::dvec3(1.5, 1.2, 0.8) * ahead;
}

glm::dvec3 cloudy_sky(const glm::dvec3& w) {
    double waves = 0;
    double scale = 3;
    for (int octave = 0; octave < 5; ++octave, scale *= 2.3)
        waves += std::sin(scale * w.x + 1.7 * octave) * std::sin(scale * w.y + 2.9 * octave) *
                 std::sin(scale * w.z + 0.6 * octave) / (1 + octave);
    return gradient_sky(w) * (1.5 + std::clamp(waves, -0.5, 0.5));
}

} // namespace prt::test
