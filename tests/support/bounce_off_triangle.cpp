// Computes one bounce off a triangle by the baker and by quadrature.

#include "support/bounce_off_triangle.h"

#include "prt/bake/bake.h"
#include "prt/image/image_file.h"
#include "support/scene_builder.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <ostream>
#include <vector>

namespace prt::test {
namespace {

constexpr std::size_t kCoefficients = 4;
using Vector = std::array<double, 3 * kCoefficients>; // [channels][order²]

/// Corners of a tilted triangle: the receiver at the origin sees much of the first, less of the second and
/// little of the third, so that exchanged corners are detected.
const std::array<glm::dvec3, 3> kCorners = {{{-0.3, 0.4, -0.3}, {1.2, 0.7, -1}, {0, 1.4, 3.5}}};
const std::array<glm::dvec3, 3> kColors = {{{0.9, 0.2, 0.1}, {0.1, 0.8, 0.3}, {0.3, 0.1, 0.7}}};
const std::array<glm::dvec2, 3> kTexcoords = {{{0.15, 0.2}, {0.9, 0.3}, {0.35, 0.85}}};

bool seen_from_behind(Varying varying) {
    return varying == Varying::light_on_the_back || varying == Varying::vertex_colors_of_the_back;
}

bool has_vertex_colors(Varying varying) {
    return varying == Varying::vertex_colors || varying == Varying::vertex_colors_of_the_back;
}

/// Unit, towards the receiver, where the triangle is meant to face.
glm::dvec3 face() {
    const glm::dvec3 n = glm::normalize(glm::cross(kCorners[1] - kCorners[0], kCorners[2] - kCorners[0]));
    return glm::dot(n, kCorners[0]) > 0 ? -n : n;
}

/// Red grows along s, green along t, from 0 to 1 of linear color.
EncodedImage ramps() {
    constexpr int kSize = 64;
    const auto code = [](int i) {
        const double linear = (i + 0.5) / kSize;
        return static_cast<unsigned char>(std::lround(255 * (1.055 * std::pow(linear, 1 / 2.4) - 0.055)));
    };
    std::vector<glm::u8vec3> pixels;
    for (int y = 0; y < kSize; ++y)
        for (int x = 0; x < kSize; ++x)
            pixels.emplace_back(code(x), code(y), 0);
    return {"ramps.png", encode_png(kSize, kSize, pixels)};
}

/// Vertices 0 to 2 belong to the receiver, 3 to 5 to the triangle. Normals at its corners diverge, so that
/// they are lit from different sides.
Scene scene_of(Varying varying, bool behind) {
    const Scene receiver = SceneBuilder().triangle({0, 0, 0}, {0, 0, 0.01f}, {0.01f, 0, 0}).build();
    const bool rotated =
        (glm::dot(face(), glm::cross(kCorners[1] - kCorners[0], kCorners[2] - kCorners[0])) < 0) != behind;
    Scene sheet = SceneBuilder()
                      .triangle(glm::vec3(kCorners[0]), glm::vec3(kCorners[1]), glm::vec3(kCorners[2]))
                      .build();
    if (rotated)
        std::swap(sheet.primitives[0].triangles[0].y, sheet.primitives[0].triangles[0].z);
    VertexArray& v = sheet.vertex_arrays[0];
    const glm::dvec3 middle = (kCorners[0] + kCorners[1] + kCorners[2]) / 3.0;
    for (std::size_t i = 0; i < 3; ++i) {
        const glm::dvec3 normal = glm::normalize(face() + 0.7 * glm::normalize(kCorners[i] - middle));
        v.normals[i] = glm::vec3(behind ? -normal : normal);
        if (has_vertex_colors(varying))
            v.colors.emplace_back(glm::vec3(kColors[i]), 1.0f);
    }
    if (varying == Varying::texture) {
        v.texcoords.resize(1);
        for (const glm::dvec2& t : kTexcoords)
            v.texcoords[0].emplace_back(t);
        sheet.images.push_back(ramps());
        sheet.materials[0].base_color_texture = {.image = 0, .wrap_u = Wrap::clamp, .wrap_v = Wrap::clamp};
    }
    sheet.materials[0].double_sided = behind;
    return join({receiver, sheet});
}

Transfer baked(const Scene& scene, Backend backend, int bounces) {
    BakeOptions options;
    options.order = 2;
    options.rays = 16384;
    options.bounces = bounces;
    options.tracer.backend = backend;
    return bake(scene, options).baked.transfer;
}

glm::dvec3 reflectance(Varying varying, const std::array<double, 3>& at,
                       const std::array<std::size_t, 3>& corner) {
    glm::dvec3 color(0);
    glm::dvec2 st(0);
    for (std::size_t i = 0; i < 3; ++i) {
        color += at[i] * kColors[corner[i]];
        st += at[i] * kTexcoords[corner[i]];
    }
    return has_vertex_colors(varying)    ? color
           : varying == Varying::texture ? glm::dvec3(st, 0)
                                         : glm::dvec3(1);
}

/// Returns (1/pi) ∫ rho T cos cos' / d² dA by the midpoint rule. T and rho are those of the corners in
/// `corner`, instead of 0, 1 and 2.
Vector quadrature(Varying varying, const Transfer& direct, const std::array<std::size_t, 3>& corner) {
    constexpr int kSteps = 200;
    Vector sum{};
    const double area = glm::length(glm::cross(kCorners[1] - kCorners[0], kCorners[2] - kCorners[0])) / 2;
    for (int i = 0; i < kSteps; ++i)
        for (int j = 0; j < 2 * (kSteps - i) - 1; ++j) { // triangles of a row, upright and upside down
            const double third = j % 2 == 0 ? 1.0 / 3 : 2.0 / 3;
            const int column = j / 2;
            const double v = (i + third) / kSteps, u = (column + third) / kSteps;
            const std::array<double, 3> at = {1 - u - v, u, v};
            const glm::dvec3 x = at[0] * kCorners[0] + at[1] * kCorners[1] + at[2] * kCorners[2];
            const double d2 = glm::dot(x, x);
            const double kernel =
                x.y * -glm::dot(face(), x) / (d2 * d2 * std::numbers::pi) * area / (kSteps * kSteps);
            const glm::dvec3 rho = reflectance(varying, at, corner);
            for (std::size_t k = 0; k < kCoefficients; ++k) {
                double light = 0;
                for (std::size_t c = 0; c < 3; ++c)
                    light += at[c] * static_cast<double>(direct.vector(3 + corner[c])[k]);
                for (std::size_t channel = 0; channel < 3; ++channel)
                    sum[channel * kCoefficients + k] += rho[static_cast<int>(channel)] * light * kernel;
            }
        }
    return sum;
}

double largest_difference(const Vector& a, const Vector& b) {
    double largest = 0;
    for (std::size_t i = 0; i < a.size(); ++i)
        largest = std::max(largest, std::abs(a[i] - b[i]));
    return largest;
}

} // namespace

std::ostream& operator<<(std::ostream& out, Varying varying) {
    static constexpr const char* kNames[] = {"light", "vertex colors", "texture", "light on the back",
                                             "vertex colors of the back"};
    return out << kNames[static_cast<std::size_t>(varying)];
}

BounceError bounce_off_triangle(Varying varying, Backend backend) {
    const Scene scene = scene_of(varying, seen_from_behind(varying));
    const Transfer direct = baked(scene_of(varying, false), Backend::cpu, 0), none = baked(scene, backend, 0),
                   once = as_combined(baked(scene, backend, 1));
    Vector bounce{};
    for (std::size_t i = 0; i < bounce.size(); ++i)
        bounce[i] = static_cast<double>(once.vector(0)[once.layout.channels() == 1 ? i % kCoefficients : i]) -
                    static_cast<double>(none.vector(0)[i % kCoefficients]);
    const Vector expected = quadrature(varying, direct, {0, 1, 2});
    const double scale = largest_difference(expected, {});
    const auto swapped = [&](const std::array<std::size_t, 3>& corner) {
        return largest_difference(quadrature(varying, direct, corner), expected) / scale;
    };
    return {largest_difference(bounce, expected) / scale,
            std::min({swapped({0, 2, 1}), swapped({1, 0, 2}), swapped({2, 1, 0})})};
}

} // namespace prt::test
