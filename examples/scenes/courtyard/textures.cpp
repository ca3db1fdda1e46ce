// Paints the tiling pictures of the courtyard.

#include "textures.h"

#include "noise.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/vec2.hpp>

#include <array>
#include <cmath>

namespace examples {
namespace {

/// 1 inside |x| < edge, 0 outside, over a soft border.
float inside(float x, float edge, float border) {
    return 1 - glm::smoothstep(edge - border, edge + border, std::abs(x));
}

float fraction(float x) {
    return x - std::floor(x);
}

/// Returns the distance to a star of two squares, one rotated by 45 degrees, of radius `size`; negative
/// inside.
float star_distance(const glm::vec2& p, float size) {
    const glm::vec2 a = glm::abs(p);
    return std::min(std::max(a.x, a.y), (a.x + a.y) * 0.70710678f) - size;
}

} // namespace

SharedPicture plaster_picture() {
    return painted("plaster", 256, 256, [](float u, float v) {
        const float clouds = tiling_noise(u, v, 4, 5), grain = tiling_noise(u, v, 64, 2);
        const float stains = glm::smoothstep(0.55f, 0.8f, tiling_noise(u, v, 3, 4));
        const glm::vec3 color = glm::vec3(0.9f + 0.16f * (clouds - 0.5f) + 0.06f * (grain - 0.5f));
        return glm::mix(color, color * glm::vec3(0.86f, 0.76f, 0.62f), 0.5f * stains);
    });
}

SharedPicture paving_picture() {
    constexpr int kCourses = 5;
    return painted("paving", 512, 512, [](float u, float v) {
        const float y = v * kCourses;
        const int course = static_cast<int>(y);
        const float x = fraction(u + 0.37f * lattice(course, 7)) * 4;
        const int slab = static_cast<int>(x);
        // Borders between slabs are slanted, except at the edge of the picture.
        const auto border = [&](int i) {
            return static_cast<float>(i) + (i % 4 == 0 ? 0 : 0.5f * (lattice(i, course + 20) - 0.5f));
        };
        const bool after = x<border(slab), before = x> border(slab + 1);
        const int own = slab - static_cast<int>(after) + static_cast<int>(before);
        const float wobble = 0.012f * (tiling_noise(u, v, 16, 2) - 0.5f);
        const float to_border = std::min({x - border(own), border(own + 1) - x}) * 0.25f,
                    to_course = std::min(fraction(y), 1 - fraction(y)) / kCourses;
        const float joint = 1 - glm::smoothstep(0.003f, 0.008f, std::min(to_border, to_course) + wobble);
        const float tone = lattice(own + 40, course), warm = lattice(own, course + 60);
        const float grain = tiling_noise(u, v, 12, 5);
        const glm::vec3 stone =
            glm::mix(glm::vec3(0.40f, 0.33f, 0.25f), glm::vec3(0.45f, 0.31f, 0.21f), warm) *
            (0.72f + 0.42f * tone + 0.5f * (grain - 0.5f));
        return glm::mix(stone, glm::vec3(0.16f, 0.14f, 0.11f), joint);
    });
}

SharedPicture glazed_tile_picture() {
    return painted("glazed tiles", 512, 512, [](float u, float v) {
        const glm::vec2 cell(u * 4, v * 4);
        const int i = static_cast<int>(cell.x), j = static_cast<int>(cell.y);
        const glm::vec2 p = glm::fract(cell) - 0.5f;
        constexpr float kSoft = 0.008f;
        const float star = star_distance(p, 0.3f), corner = star_distance(glm::abs(p) - 0.5f, 0.13f);
        const glm::vec3 white(0.78f, 0.76f, 0.68f), blue(0.03f, 0.1f, 0.38f), ochre(0.62f, 0.32f, 0.05f),
            green(0.06f, 0.27f, 0.18f);
        glm::vec3 color = white;
        const auto paint = [&](const glm::vec3& paint_color, float distance) {
            color = glm::mix(paint_color, color, glm::smoothstep(-kSoft, kSoft, distance));
        };
        paint(blue, star);
        paint(white, star + 0.06f);
        paint((i + j) % 2 ? green : blue, star + 0.09f);
        paint(white, glm::length(p) - 0.12f);
        paint(ochre, glm::length(p) - 0.075f);
        paint(ochre, corner);
        paint(blue, corner + 0.05f);
        const float joint = std::max(std::abs(p.x), std::abs(p.y));
        color *= 0.88f + 0.2f * lattice(i + 11, j + 5);
        return glm::mix(color, glm::vec3(0.3f, 0.28f, 0.24f), glm::smoothstep(0.485f, 0.493f, joint));
    });
}

SharedPicture stone_picture() {
    return painted("stone", 256, 256, [](float u, float v) {
        const float beds = tiling_noise(u, v, 3, 5), pores = tiling_noise(u, v, 48, 2);
        const float shade = 0.86f + 0.22f * (beds - 0.5f) - 0.25f * glm::smoothstep(0.72f, 0.85f, pores);
        return shade * glm::vec3(1, 0.96f + 0.04f * beds, 0.86f + 0.1f * beds);
    });
}

SharedPicture plank_picture() {
    return painted("planks", 256, 256, [](float u, float v) {
        const float x = u * 4;
        const int board = static_cast<int>(x);
        const float grain = noise(x * 12 + 3 * noise(x * 3, v * 4, 4), v * 4 + 17 * lattice(board, 3), 4);
        const float joint = inside(std::min(fraction(x), 1 - fraction(x)), 0.03f, 0.02f);
        return glm::vec3((0.75f + 0.2f * lattice(board, 1) + 0.3f * (grain - 0.5f)) * (1 - 0.7f * joint));
    });
}

SharedPicture striped_picture(const std::string& name, const glm::vec3& one, const glm::vec3& other) {
    return painted(name, 256, 256, [&](float u, float v) {
        const float weave = 0.93f + 0.14f * (tiling_noise(u, v, 32, 3) - 0.5f);
        const float stripe = inside(u - 0.5f, 0.25f, 0.004f);
        const float pin = inside(u - 0.06f, 0.012f, 0.004f) + inside(u - 0.94f, 0.012f, 0.004f);
        return weave * glm::mix(one, other, std::max(stripe, pin));
    });
}

SharedPicture roof_tile_picture() {
    return painted("roof tiles", 256, 256, [](float u, float v) {
        const float x = u * 8, y = v * 8;
        const float fired = lattice(static_cast<int>(x), static_cast<int>(y) + 30);
        const float weathered = tiling_noise(u, v, 6, 4);
        const float edge = glm::smoothstep(0.86f, 0.97f, fraction(y)); // the shade under the next course
        const glm::vec3 clay =
            glm::mix(glm::vec3(0.42f, 0.16f, 0.075f), glm::vec3(0.58f, 0.28f, 0.14f), fired);
        const glm::vec3 lichen(0.4f, 0.33f, 0.2f);
        return glm::mix(clay, lichen, 0.7f * glm::smoothstep(0.5f, 0.75f, weathered)) * (1 - 0.55f * edge);
    });
}

SharedPicture bark_picture() {
    return painted("bark", 128, 256, [](float u, float v) {
        const float ridges = tiling_noise(u, 0.2f * tiling_noise(u, v, 4, 2) + v, 4, 2),
                    cracks = noise(u * 12 + 2 * ridges, v * 4, 4);
        return (0.5f + 0.6f * cracks) *
               glm::mix(glm::vec3(0.2f, 0.14f, 0.1f), glm::vec3(0.34f, 0.28f, 0.21f), ridges);
    });
}

SharedPicture leaf_picture() {
    return painted("leaf", 64, 128, [](float u, float v) {
        const float across = std::abs(2 * u - 1);
        const float vein = inside(across, 0.05f, 0.05f);
        const float ribs = inside(fraction(6 * v + 2 * across) - 0.5f, 0.06f, 0.06f);
        const float tone = 0.8f + 0.3f * tiling_noise(u, v, 4, 3);
        return tone * glm::mix(glm::vec3(0.75f, 0.85f, 0.7f), glm::vec3(1), std::max(vein, 0.5f * ribs));
    });
}

} // namespace examples
