// Cloth: striped awnings over arches, one of them and pennants so thin that the sun shines through, and a
// cloth over the balcony.

#include "courtyard_parts.h"
#include "plan.h"
#include "shapes.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <array>
#include <cmath>
#include <utility>

namespace examples {
namespace {

using namespace plan;

/// Returns both faces of an opaque cloth. Each face is one-sided and has separate transfer; a double-sided
/// sheet would show the light of its front on both sides.
Mesh both_faces(const Mesh& cloth) {
    constexpr float kThickness = 0.012f;
    Mesh back = cloth;
    for (std::size_t i = 0; i < back.positions.size(); ++i) {
        back.positions[i] -= kThickness * back.normals[i];
        back.normals[i] = -back.normals[i];
    }
    for (std::size_t t = 0; t < back.indices.size(); t += 3)
        std::swap(back.indices[t + 1], back.indices[t + 2]);
    Mesh mesh = cloth;
    append(mesh, back);
    return mesh;
}

/// An awning in front of the wall z = 0: its middle, its width and the positions of its edges.
struct Awning {
    float middle, width, out, high, low;
};

Mesh awning_cloth(const Awning& a) {
    const float stripe = 0.5f; // metres, one of each color
    const int columns = static_cast<int>(a.width / 0.1f);
    Mesh mesh = parametric_surface(columns, 14, [&](float u, float v) {
        const float sag = 0.1f * std::sin(kTurn / 2 * v);
        return glm::vec3(a.middle + (u - 0.5f) * a.width, std::lerp(a.low, a.high, v) - sag,
                         a.out * (1 - v) + 0.03f);
    });
    // A flap along the front edge, cut in scallops.
    const float scallops = std::round(a.width / (stripe / 2));
    append(mesh, parametric_surface(4 * static_cast<int>(scallops), 3, [&](float u, float v) {
               const float depth = 0.2f + 0.09f * std::abs(std::sin(kTurn / 2 * u * scallops));
               return glm::vec3(a.middle + (u - 0.5f) * a.width, a.low - depth * (1 - v),
                                a.out + 0.03f + 0.02f * (1 - v) * std::sin(kTurn * 3 * u));
           }));
    return with_scaled_texcoords(mesh, {a.width / stripe, 2});
}

/// Rods that hold an awning.
Mesh awning_rods(const Awning& a) {
    Mesh mesh = bar({a.middle - a.width / 2, a.low - 0.02f, a.out},
                    {a.middle + a.width / 2, a.low - 0.02f, a.out}, 0.018f);
    for (const float side : {-0.46f, 0.46f}) {
        const float x = a.middle + side * a.width;
        append(mesh, bar({x, a.low - 0.1f, 0}, {x, a.low - 0.03f, a.out}, 0.014f));
    }
    return mesh;
}

void add_awning(Mesh& cloth, Mesh& iron, const Awning& a, const glm::mat4& position) {
    append(cloth, placed(both_faces(awning_cloth(a)), position));
    append(iron, placed(awning_rods(a), position));
}

/// A rope that hangs between two points.
struct Rope {
    glm::vec3 from, to;

    glm::vec3 at(float t) const { return glm::mix(from, to, t) - glm::vec3(0, 3.6f * t * (1 - t), 0); }
};

/// Every third pennant on a rope, from number `first` on.
Mesh pennants(const Rope& rope, int first) {
    const int count = static_cast<int>(glm::distance(rope.from, rope.to) / 0.42f);
    Mesh mesh;
    for (int i = first; i < count; i += 3) {
        const float begin = (static_cast<float>(i) + 0.12f) / static_cast<float>(count),
                    end = (static_cast<float>(i) + 0.88f) / static_cast<float>(count);
        append(mesh, parametric_surface(2, 3, [&](float u, float v) {
                   const float narrow = 0.5f + (u - 0.5f) * (0.06f + 0.94f * v);
                   const float blown = 0.05f * std::sin(static_cast<float>(i) * 2.1f) * (1 - v) * (1 - v);
                   return rope.at(std::lerp(begin, end, narrow)) + glm::vec3(blown, -0.42f * (1 - v), blown);
               }));
    }
    return mesh;
}

void add_bunting(Courtyard& to, const Rope& rope) {
    append(to.cloth.saffron_pennants, pennants(rope, 0));
    append(to.cloth.red_pennants, pennants(rope, 1));
    append(to.cloth.blue_pennants, pennants(rope, 2));
    std::array<glm::vec3, 25> points;
    std::array<float, points.size()> radii;
    radii.fill(0.008f);
    for (std::size_t i = 0; i < points.size(); ++i)
        points[i] = rope.at(static_cast<float>(i) / (points.size() - 1));
    append(to.building.iron, bar(points, radii, 4));
}

/// A cloth that hangs over the balcony's rail.
Mesh hung_cloth(float middle, float width) {
    return parametric_surface(12, 14, [&](float u, float v) {
        const float x = middle + (u - 0.5f) * width, y = std::lerp(kStorey - 0.45f, kStorey + 1.11f, v);
        const float fold = 0.025f * std::sin(kTurn * 2.5f * u) * (1 - v);
        return glm::vec3(x, y, 0.96f + 0.06f + fold);
    });
}

} // namespace

void add_awnings(Courtyard& to) {
    const Awning over_arch = {1.5f * kBay, 2.0f, 1.5f, 3.85f, 3.05f};
    add_awning(to.cloth.red_cloth, to.building.iron, over_arch, left_wing());
    Awning thin = over_arch;
    thin.middle = 3.5f * kBay;
    append(to.cloth.thin_cloth, placed(awning_cloth(thin), left_wing()));
    append(to.building.iron, placed(awning_rods(thin), left_wing()));
    add_awning(to.cloth.blue_cloth, to.building.iron, over_arch, back_wing());
    add_bunting(to, {{-kHalf + 0.05f, 6.55f, -0.9f}, {-0.3f, 6.6f, -kDeep + 0.05f}});
    add_bunting(to, {{-kHalf + 0.05f, 6.55f, -5.6f}, {kHalf + 0.15f, 4.1f, -4.6f}});
    append(to.building.iron, bar({kHalf + 0.15f, kGardenWall, -4.6f}, {kHalf + 0.15f, 4.13f, -4.6f}, 0.02f));
    append(to.cloth.banner, placed(hung_cloth(2.5f * kBay, 1.1f), back_wing()));
}

} // namespace examples
