// A bougainvillea over the garden wall, and pots.

#include "chance.h"
#include "courtyard_parts.h"
#include "leaf.h"
#include "plan.h"
#include "shapes.h"

#include <glm/geometric.hpp>

#include <cmath>

namespace examples {
namespace {

using namespace plan;

void add_blade(Mesh& mesh, Chance& chance, const glm::vec3& base, const glm::vec3& towards, float length) {
    const glm::vec3 along = glm::normalize(towards + 0.7f * chance.direction());
    append(mesh, leaf(base, along, glm::normalize(glm::cross(along, chance.direction())), length, 2, 2));
}

/// Tufts that hang from the top of the wall towards the court.
void add_bougainvillea(Courtyard& to) {
    Chance chance(19);
    constexpr int kTufts = 64;
    for (int tuft = 0; tuft < kTufts; ++tuft) {
        const float along = chance.between(-1, 1), z = -6.9f + 2.7f * along;
        const float hang = chance.between(0, 1) * (1.5f - 1.1f * along * along);
        const glm::vec3 middle(kHalf - 0.12f - 0.25f * chance.between(0, 1) * (1 - 0.5f * hang),
                               kGardenWall + 0.25f - hang, z);
        for (int i = 0; i < 22; ++i) {
            const glm::vec3 out = chance.direction();
            const glm::vec3 base = middle + 0.26f * chance.between(0.3f, 1) * out;
            if (base.x > kHalf - 0.03f && base.y < kGardenWall)
                continue; // inside the wall
            const bool is_leaf = i % 3 == 2;
            add_blade(is_leaf ? to.garden.vine_leaves : to.garden.flowers, chance, base,
                      out + glm::vec3(-0.3f, 0.1f, 0), is_leaf ? 0.13f : 0.11f);
        }
    }
}

/// Adds a clay pot with soil and a plant with long leaves.
void add_pot(Courtyard& to, const glm::vec3& position, float size, bool flowering, unsigned seed) {
    Outline outline = {{0.15f, 0},      {0.17f, 0.02f}, {0.21f, 0.2f},  {0.235f, 0.36f},
                       {0.235f, 0.36f}, {0.26f, 0.37f}, {0.27f, 0.41f}, {0.26f, 0.44f},
                       {0.26f, 0.44f},  {0.22f, 0.44f}, {0.22f, 0.44f}, {0.215f, 0.38f}};
    for (glm::vec2& point : outline)
        point *= size;
    append(to.garden.clay, lathe(position, outline, 20));
    append(
        to.garden.soil,
        lathe(position, {{0.22f * size, 0.39f * size}, {0.1f * size, 0.4f * size}, {0, 0.41f * size}}, 20));
    Chance chance(seed);
    for (int i = 0; i < 70; ++i) {
        const glm::vec3 out = chance.direction() * glm::vec3(1, 0, 1);
        const glm::vec3 base =
            position + glm::vec3(0, 0.4f * size + chance.between(0, 0.3f) * size, 0) + 0.12f * size * out;
        const bool blooms = flowering && i % 3 == 0;
        const glm::vec3 head = blooms ? base + size * (0.2f * out + glm::vec3(0, 0.28f, 0)) : base;
        add_blade(blooms ? to.garden.flowers : to.garden.vine_leaves, chance, head,
                  out + glm::vec3(0, blooms ? 0.3f : 1.1f, 0),
                  size * (blooms ? 0.13f : chance.between(0.28f, 0.42f)));
    }
}

} // namespace

void add_plants(Courtyard& to) {
    add_bougainvillea(to);
    const float inside = kHalf - 0.5f;
    add_pot(to, {-inside + 0.15f, 0, -kDeep + 0.65f}, 1.35f, true, 3);
    add_pot(to, {-inside + 0.2f, 0, -2 * kBay}, 1.1f, false, 4);
    add_pot(to, {-inside + 0.75f, 0, -2 * kBay + 0.2f}, 0.8f, true, 5);
    add_pot(to, {inside, 0, -0.7f}, 1.4f, false, 6);
    add_pot(to, {inside - 0.75f, 0, -0.5f}, 1.0f, true, 7);
    add_pot(to, {inside - 0.2f, 0, -1.5f}, 0.9f, true, 8);
    add_pot(to, {-kHalf + 0.7f, 0, 0.55f}, 1.2f, true, 9);
    add_pot(to, {0.2f, 0, -kDeep + 0.6f}, 1.0f, false, 10);
    add_pot(to, {4.2f, 0, -kDeep + 0.7f}, 1.2f, true, 11);
}

} // namespace examples
