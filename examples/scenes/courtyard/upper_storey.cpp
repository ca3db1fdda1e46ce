// The upper storey: windows with frames and shutters, cornices; and the outer walls.

#include "courtyard_parts.h"
#include "plan.h"
#include "shapes.h"

#include <cmath>

namespace examples {
namespace {

using namespace plan;

constexpr float kReveal = 0.2f; ///< how deep windows lie in the wall

struct Window {
    Opening opening;
    bool lit;
};

/// The four sides of an opening, from the wall z = 0 to the window.
Mesh reveal(const Opening& o) {
    const glm::vec3 low(o.low, 0), x(o.high.x - o.low.x, 0, 0), y(0, o.high.y - o.low.y, 0),
        in(0, 0, -kReveal);
    Mesh mesh = rectangle(low, in, y, 0.1f);
    append(mesh, rectangle(low + x + in, -in, y, 0.1f));
    append(mesh, rectangle(low, x, in, 0.1f));
    append(mesh, rectangle(low + y + in, x, -in, 0.1f));
    return mesh;
}

/// Bars of wood before a pane.
void add_casement(Courtyard& to, const Window& window, const glm::mat4& wing) {
    const auto& [low, high] = window.opening;
    const float back = -kReveal, front = back + 0.05f, middle = (low.x + high.x) / 2;
    append(
        window.lit ? to.glass.lit_panes : to.glass.dark_panes,
        placed(rectangle({low, back + 0.01f}, {high.x - low.x, 0, 0}, {0, high.y - low.y, 0}, 0.2f), wing));
    const auto add_bar = [&](float x0, float y0, float x1, float y1) {
        append(to.building.painted_wood, placed(box({x0, y0, back}, {x1, y1, front}, 0.3f), wing));
    };
    add_bar(low.x, low.y, low.x + 0.06f, high.y);
    add_bar(high.x - 0.06f, low.y, high.x, high.y);
    add_bar(middle - 0.04f, low.y, middle + 0.04f, high.y);
    const int panes = static_cast<int>((high.y - low.y) / 0.45f);
    for (int i = 0; i <= panes; ++i) {
        const float y = low.y + (high.y - low.y - 0.05f) * static_cast<float>(i) / static_cast<float>(panes);
        add_bar(low.x, y, high.x, y + 0.05f);
    }
}

/// Adds two open shutters of slats between rails.
void add_shutters(Courtyard& to, const Opening& o, const glm::mat4& wing) {
    const float width = (o.high.x - o.low.x) / 2;
    for (const float x : {o.low.x - width - 0.05f, o.high.x + 0.05f}) {
        const auto add_board = [&](const glm::vec3& low, const glm::vec3& high) {
            append(to.building.painted_wood, placed(box({x + low.x, o.low.y + low.y, low.z},
                                                        {x + high.x, o.low.y + high.y, high.z}, 0.3f),
                                                    wing));
        };
        const float height = o.high.y - o.low.y;
        add_board({0, 0, 0.02f}, {0.06f, height, 0.07f});
        add_board({width - 0.06f, 0, 0.02f}, {width, height, 0.07f});
        for (const float y : {0.0f, height / 2 - 0.03f, height - 0.07f})
            add_board({0.06f, y, 0.02f}, {width - 0.06f, y + 0.07f, 0.065f});
        const int slats = static_cast<int>(height / 0.085f);
        for (int i = 1; i < slats; ++i) {
            const float y = height * static_cast<float>(i) / static_cast<float>(slats);
            append(to.building.painted_wood,
                   placed(rectangle({x + 0.05f, o.low.y + y - 0.03f, 0.055f}, {width - 0.1f, 0, 0},
                                    {0, 0.07f, -0.025f}, 0.3f),
                          wing));
        }
    }
}

/// A flat frame of stone round an opening, with a sill.
void add_frame(Courtyard& to, const Opening& o, const glm::mat4& wing) {
    constexpr float kBroad = 0.11f;
    const auto add_stone = [&](float x0, float y0, float x1, float y1, float proud) {
        append(to.building.stone, placed(box({x0, y0, -0.02f}, {x1, y1, proud}), wing));
    };
    add_stone(o.low.x - kBroad, o.low.y, o.low.x, o.high.y, 0.03f);
    add_stone(o.high.x, o.low.y, o.high.x + kBroad, o.high.y, 0.03f);
    add_stone(o.low.x - kBroad, o.high.y, o.high.x + kBroad, o.high.y + kBroad, 0.03f);
    add_stone(o.low.x - kBroad - 0.06f, o.high.y + kBroad, o.high.x + kBroad + 0.06f,
              o.high.y + kBroad + 0.06f, 0.1f);
    if (o.low.y > kStorey + 0.3f)
        add_stone(o.low.x - kBroad - 0.06f, o.low.y - 0.09f, o.high.x + kBroad + 0.06f, o.low.y, 0.12f);
}

void add_front(Courtyard& to, const std::vector<Window>& windows, float width, const glm::mat4& wing) {
    std::vector<Opening> openings;
    for (const Window& window : windows)
        openings.push_back(window.opening);
    append(to.building.plaster, placed(wall_with_openings({0, kStorey}, {width, kEaves}, openings), wing));
    for (const Window& window : windows) {
        append(to.building.plaster, placed(reveal(window.opening), wing));
        add_casement(to, window, wing);
        add_frame(to, window.opening, wing);
        if (window.opening.low.y > kStorey + 0.3f)
            add_shutters(to, window.opening, wing);
    }
}

Window window_at(float bay, bool lit) {
    const float x = bay * kBay;
    return {{{x - 0.5f, kStorey + 0.85f}, {x + 0.5f, kStorey + 2.35f}}, lit};
}

Window balcony_door_at(float bay, bool lit) {
    const float x = bay * kBay;
    return {{{x - 0.55f, kStorey + 0.12f}, {x + 0.55f, kStorey + 2.35f}}, lit};
}

/// Between the storeys, along the court's two fronts and round the end of the left wing.
void add_cornice(Courtyard& to) {
    const Outline outline = {{0, -0.16f},    {0.04f, -0.15f}, {0.04f, -0.15f}, {0.05f, -0.06f},
                             {0.12f, 0},     {0.12f, 0},      {0.15f, 0},      {0.15f, 0},
                             {0.15f, 0.07f}, {0.15f, 0.07f},  {0, 0.1f}};
    const float y = kStorey - 0.02f;
    append(to.building.stone, moulding(outline, straight_way({-kHalf, y, 0.15f}, {-kHalf, y, -kDeep})));
    append(to.building.stone,
           moulding(outline, straight_way({-kHalf, y, -kDeep}, {kHalf + kOuterWall, y, -kDeep})));
    append(to.building.stone,
           moulding(outline, straight_way({-kHalf - kWing, y, 0}, {-kHalf + 0.15f, y, 0})));
}

/// Plain walls to the outside, up to the higher side of the roofs.
void add_outer_walls(Courtyard& to) {
    const float top = kEaves + kRoofSlope * (kWing + 0.1f), outer = kHalf + kWing;
    Mesh& walls = to.building.plaster;
    append(walls, placed(wall_with_openings({0, 0}, {kDeep + kWing, top}, {}, kTall),
                         placement({-outer, 0, -kDeep - kWing}, -90)));
    append(walls, placed(wall_with_openings({0, 0}, {2 * kHalf + kOuterWall + kWing, top}, {}, kTall),
                         placement({kHalf + kOuterWall, 0, -kDeep - kWing}, 180)));
    // Ends of the wings: from the storey (the left one) or the ground up to the slope of the roof.
    const auto add_end = [&](float from, float spacing, const glm::mat4& position) {
        const int rows = static_cast<int>((kEaves - from) / spacing),
                  columns = static_cast<int>(kWing / spacing);
        append(walls, placed(parametric_surface(
                                 columns, rows,
                                 [&](float u, float v) {
                                     return glm::vec3(u * kWing,
                                                      std::lerp(from, kEaves + kRoofSlope * u * kWing, v), 0);
                                 }),
                             position));
    };
    add_end(0, kTall, placement({kHalf + kOuterWall, 0, -kDeep}, 90));
    const int rows = 22, columns = 22;
    append(walls, parametric_surface(columns, rows, [&](float u, float v) {
               return glm::vec3(-kHalf - kWing * (1 - u),
                                std::lerp(kStorey, kEaves + kRoofSlope * (1 - u) * kWing, v), 0);
           }));
}

} // namespace

void add_upper_storeys(Courtyard& to) {
    add_front(to,
              {window_at(0.5f, true), window_at(1.5f, false), window_at(2.5f, false), window_at(3.5f, true),
               window_at(4.5f, false)},
              kDeep, left_wing());
    add_front(to,
              {window_at(0.5f, false), balcony_door_at(1.5f, false), balcony_door_at(2.5f, true),
               balcony_door_at(3.5f, false), window_at(4.5f, true)},
              2 * kHalf + kOuterWall, back_wing());
    add_cornice(to);
    add_outer_walls(to);
}

} // namespace examples
