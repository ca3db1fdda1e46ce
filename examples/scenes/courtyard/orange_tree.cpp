// An orange tree in a planter.

#include "chance.h"
#include "courtyard_parts.h"
#include "leaf.h"
#include "shapes.h"

#include <glm/geometric.hpp>

#include <array>
#include <cmath>

namespace examples {
namespace {

const glm::vec3 kTree(2.7f, 0, -7.4f);
constexpr float kPlanter = 0.5f; ///< height

/// Adds a branch that bends upwards; returns the position of its end.
glm::vec3 add_branch(Mesh& bark, const glm::vec3& from, const glm::vec3& along, float radius,
                     float end_radius, int segments) {
    constexpr std::size_t kPoints = 6;
    std::array<glm::vec3, kPoints> points;
    std::array<float, kPoints> radii;
    for (std::size_t i = 0; i < kPoints; ++i) {
        const float t = static_cast<float>(i) / (kPoints - 1);
        points[i] = from + t * along + glm::vec3(0, 0.22f * glm::length(along) * (t * t - t), 0);
        radii[i] = std::lerp(radius, end_radius, t);
    }
    append(bark, with_scaled_texcoords(bar(points, radii, segments), {2, 1}));
    return points.back();
}

/// Adds leaves around the end of a twig, each facing outwards.
void add_leaves(Mesh& leaves, Chance& growth, const glm::vec3& middle, const glm::vec3& crown, int count) {
    for (int i = 0; i < count; ++i) {
        const glm::vec3 base =
            middle + growth.between(0.08f, 0.55f) * growth.direction() * glm::vec3(1.1f, 0.75f, 1.1f);
        const glm::vec3 out = glm::normalize(base - crown);
        const glm::vec3 along = glm::normalize(out + 0.8f * growth.direction() + glm::vec3(0, -0.15f, 0));
        const glm::vec3 side = glm::normalize(glm::cross(along, growth.direction()));
        append(leaves, leaf(base, along, side, growth.between(0.16f, 0.24f), 2, 2));
    }
}

} // namespace

void add_orange_tree(Courtyard& to) {
    append(to.building.stone, polygonal_lathe(kTree,
                                              {{0.92f, 0},
                                               {0.92f, 0.08f},
                                               {0.92f, 0.08f},
                                               {0.86f, 0.11f},
                                               {0.86f, kPlanter - 0.08f},
                                               {0.86f, kPlanter - 0.08f},
                                               {0.92f, kPlanter - 0.05f},
                                               {0.92f, kPlanter},
                                               {0.92f, kPlanter},
                                               {0.74f, kPlanter},
                                               {0.74f, kPlanter},
                                               {0.74f, kPlanter - 0.15f}},
                                              4));
    append(to.garden.soil, rectangle(kTree + glm::vec3(-0.74f, kPlanter - 0.1f, 0.74f), {1.48f, 0, 0},
                                     {0, 0, -1.48f}, 0.14f));
    Chance growth(7);
    const glm::vec3 root = kTree + glm::vec3(0, kPlanter - 0.12f, 0), crown = kTree + glm::vec3(0, 3.2f, 0);
    const glm::vec3 fork = add_branch(to.garden.bark, root, {0.12f, 1.6f, 0.06f}, 0.12f, 0.095f, 12);
    constexpr int kLimbs = 6, kTwigs = 5, kLeaves = 84;
    for (int limb = 0; limb < kLimbs; ++limb) {
        const float angle = kTurn * (static_cast<float>(limb) + growth.between(-0.2f, 0.2f)) / kLimbs;
        const float lean = limb == 0 ? 0.2f : growth.between(0.9f, 1.4f);
        const glm::vec3 along(lean * std::sin(angle), growth.between(0.7f, 1.4f), lean * std::cos(angle));
        const glm::vec3 end = add_branch(to.garden.bark, fork, along, 0.07f, 0.035f, 8);
        for (int twig = 0; twig < kTwigs; ++twig) {
            const glm::vec3 out = glm::normalize(along + growth.direction() + glm::vec3(0, 0.25f, 0)) *
                                  growth.between(0.45f, 0.85f);
            const glm::vec3 tip = add_branch(to.garden.bark, end, out, 0.03f, 0.01f, 5);
            add_leaves(to.garden.leaves, growth, tip, crown, kLeaves);
            append(to.garden.oranges,
                   sphere(tip + 0.42f * growth.direction() + glm::vec3(0, -0.1f, 0), 0.052f, 10));
        }
    }
}

} // namespace examples
