// A forest with many instances of few trees, used to evaluate transfer that instances share.

#include "chance.h"
#include "example_scenes.h"
#include "noise.h"
#include "shapes.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
#include <array>
#include <cmath>

namespace examples {
namespace {

constexpr float kPitch = 5.2f;   ///< metres from tree to tree, on average
constexpr float kMargin = 12;    ///< margin of the meadow around the trees
constexpr float kGroundStep = 1; ///< from vertex to vertex

float ground_height(float x, float z) {
    return 1.6f * noise(0.05f * x + 31.5f, 0.05f * z + 17.25f);
}

Part trunk(float height, float radius, const glm::vec3& color) {
    const std::array points = {glm::vec3(0, -0.3f, 0), glm::vec3(0.04f, 0.3f * height, 0.02f),
                               glm::vec3(-0.03f, 0.65f * height, 0.03f), glm::vec3(0, height, 0)};
    const std::array radii = {1.3f * radius, radius, 0.8f * radius, 0.5f * radius};
    return {"bark", color, bar(points, radii, 9)};
}

/// Skirts of branches, each with its underside.
std::vector<Part> spruce() {
    Mesh needles;
    constexpr int kSkirts = 5;
    for (int i = 0; i < kSkirts; ++i) {
        const float low = 0.7f + 0.85f * static_cast<float>(i),
                    radius = 1.55f - 0.22f * static_cast<float>(i);
        append(needles, lathe(glm::vec3(0),
                              {{0.12f, low + 0.35f},
                               {0.6f * radius, low + 0.12f},
                               {radius, low},
                               {radius, low},
                               {0.55f * radius, low + 0.55f},
                               {0.06f, low + 1.3f}},
                              8));
    }
    return {{"needles", {0.06f, 0.13f, 0.05f}, needles}, trunk(2.2f, 0.14f, {0.20f, 0.14f, 0.10f})};
}

/// Returns a lumpy crown: an ellipsoid with noise added to its radius.
Mesh crown(const glm::vec3& center, const glm::vec3& radii, float lumps, float seed) {
    return parametric_surface(26, 19, [&](float u, float v) {
        const float polar = 0.5f * kTurn * glm::clamp(0.01f + 0.98f * v, 0.01f, 0.99f), rotation = kTurn * u;
        const glm::vec3 out(std::sin(polar) * std::sin(rotation), -std::cos(polar),
                            std::sin(polar) * std::cos(rotation));
        const float bump = noise(seed + 2.3f * out.x + 3 * out.y, 7.7f * seed + 2.3f * out.z - 2 * out.y);
        return center + radii * out * (1 + lumps * (bump - 0.5f));
    });
}

std::vector<Part> oak() {
    return {{"oak leaves", {0.11f, 0.19f, 0.05f}, crown({0, 3.3f, 0}, {2.0f, 1.7f, 2.0f}, 0.7f, 3.5f)},
            trunk(2.6f, 0.22f, {0.24f, 0.18f, 0.13f})};
}

std::vector<Part> birch() {
    return {{"birch leaves", {0.20f, 0.30f, 0.08f}, crown({0, 3.6f, 0}, {1.15f, 2.0f, 1.15f}, 0.6f, 11.5f)},
            trunk(2.4f, 0.1f, {0.62f, 0.60f, 0.56f})};
}

} // namespace

ExampleScene forest(int trees) {
    const int rows = std::max(1, static_cast<int>(std::sqrt(static_cast<float>(trees))));
    const int columns = (trees + rows - 1) / rows;
    std::array<Model, 3> kinds = {Model{"spruce", spruce(), {}}, Model{"oak", oak(), {}},
                                  Model{"birch", birch(), {}}};
    Chance chance(1789);
    const float width = kPitch * static_cast<float>(columns), depth = kPitch * static_cast<float>(rows);
    for (int i = 0; i < trees; ++i) {
        const auto jittered = [&](int position) {
            return kPitch * (static_cast<float>(position) + 0.5f + chance.between(-0.28f, 0.28f));
        };
        const float x = jittered(i % columns) - 0.5f * width, z = jittered(i / columns) - 0.5f * depth;
        const auto kind = static_cast<std::size_t>(chance.between(0, 2.999f));
        const float degrees = chance.between(0, 360), scale = chance.between(0.8f, 1.2f);
        kinds[kind].placements.push_back({{x, ground_height(x, z), z}, degrees, scale});
    }
    const glm::vec2 size(width + 2 * kMargin, depth + 2 * kMargin);
    const Mesh ground = parametric_surface(static_cast<int>(size.x / kGroundStep),
                                           static_cast<int>(size.y / kGroundStep), [&](float u, float v) {
                                               const float x = (u - 0.5f) * size.x, z = (0.5f - v) * size.y;
                                               return glm::vec3(x, ground_height(x, z), z);
                                           });
    return {.parts = {{"meadow", {0.17f, 0.22f, 0.09f}, ground}}, .models = {kinds.begin(), kinds.end()}};
}

} // namespace examples
