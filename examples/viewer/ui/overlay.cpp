// Draws names, legends and light handles over the pictures.

#include "ui/overlay.h"

#include "core/budget_work.h"
#include "ui/controls.h"

#include "compress/study/receiver_colors.h"
#include "prt/render/tone_map.h"

#include <fmt/core.h>
#include <imgui.h>

#include <algorithm>
#include <cmath>
#include <string>

namespace viewer {
namespace {

constexpr float kUnscaledFont = 13;
constexpr ImU32 kWhite = IM_COL32(255, 255, 255, 255), kShade = IM_COL32(0, 0, 0, 150);

/// Converts pixels of the picture, which may be finer, to units of the interface.
ImVec2 to_interface(const glm::vec2& pixel) {
    const ImVec2 finer = ImGui::GetIO().DisplayFramebufferScale;
    return {pixel.x / finer.x, pixel.y / finer.y};
}

void draw_handles(const Viewer& viewer, ImDrawList& list) {
    for (const RigLight& light : viewer.lights.lights) {
        const auto pixel = pixel_of(viewer.screen(), handle_position(viewer, light));
        if (!light.on || !pixel)
            continue;
        const ImVec2 at = to_interface(*pixel);
        const ImU32 color = ImGui::ColorConvertFloat4ToU32({light.color.r, light.color.g, light.color.b, 1});
        list.AddCircleFilled(at, scaled(9), color);
        list.AddCircle(at, scaled(10), IM_COL32(0, 0, 0, 200), 0, scaled(2));
        if (light.kind == LightKind::sun)
            for (int ray = 0; ray < 8; ++ray) {
                const float angle = 0.785398f * static_cast<float>(ray), x = std::cos(angle),
                            y = std::sin(angle);
                list.AddLine({at.x + scaled(12) * x, at.y + scaled(12) * y},
                             {at.x + scaled(17) * x, at.y + scaled(17) * y}, color, scaled(2));
            }
    }
}

void draw_label(ImDrawList& list, float x, float y, const std::string& text) {
    const ImVec2 size = ImGui::CalcTextSize(text.c_str());
    const float dx = scaled(4), dy = scaled(2);
    list.AddRectFilled({x - dx, y - dy}, {x + size.x + dx, y + size.y + dy}, kShade, scaled(3));
    list.AddText({x, y}, kWhite, text.c_str());
}

std::string title_of(const Viewer& viewer, const SidePicture& picture) {
    const bool lightmap = shows_transfer(picture.kind) && viewer.document().shown_by(picture).of_texels();
    return name_of(picture.kind).title + std::string(lightmap ? ", lightmap" : "");
}

std::string side_label(const Viewer& viewer, const SidePicture& picture) {
    const Viewer::Shown shown = viewer.shown(picture);
    const std::string title = title_of(viewer, picture);
    if (shown.kind == picture.kind)
        return title + (shown.note.empty() ? "" : ": " + shown.note);
    return fmt::format("{}: {}. Meanwhile: {}", title, shown.note, name_of(shown.kind).title);
}

/// Returns the name of the picture and a note about missing light.
std::string brief_label(const Viewer& viewer, const SidePicture& picture) {
    const Viewer::Shown shown = viewer.shown(picture);
    const bool partly = shown.kind == picture.kind && !shown.note.empty();
    return title_of(viewer, picture) + (partly ? " (" + shown.note + ")" : "");
}

/// Meaning of the colors of a number picture.
struct Legend {
    bool heat = true; ///< a ramp from `low` to `high`; otherwise colors that only distinguish
    std::string low, high, note;
};

Legend legend_of(const Viewer& viewer, const SidePicture& picture) {
    const LoadedModel& loaded = viewer.document().shown_by(picture);
    switch (picture.kind) {
    case PictureKind::clusters:
        return {false, "", "",
                fmt::format("{} clusters, one colour each",
                            loaded.compressed ? loaded.compressed->bases.clusters() : 0)};
    case PictureKind::components:
        return {true, "0",
                fmt::format("{}", loaded.compressed ? loaded.compressed->bases.max_components() : 0),
                fmt::format("components of the cluster of a {}", loaded.of_texels() ? "texel" : "vertex")};
    case PictureKind::error:
        return {true, "0", fmt::format("{:.0f} %", 100 * prt::kWhiteError),
                "contrast error under this light"};
    case PictureKind::seams:
        return {true, "0", fmt::format("{:.0f} %", 100 * prt::kWhiteSeam),
                "step of contrast between clusters; blue: inside a cluster"};
    case PictureKind::surface_error:
        return {true, "0", fmt::format("{:.0f} %", 100 * kWhiteSurfaceError),
                "error relative to the RMS radiance, by path tracing"};
    default:
        return {};
    }
}

ImU32 display_color(const glm::vec3& linear) {
    return ImGui::ColorConvertFloat4ToU32(
        {prt::srgb_encode(linear.r), prt::srgb_encode(linear.g), prt::srgb_encode(linear.b), 1});
}

/// Draws the color steps between (x, y) and (x + width, y + height).
void draw_colors(ImDrawList& list, const Legend& legend, float x, float y, float width, float height) {
    const int steps = legend.heat ? 60 : 12;
    for (int i = 0; i < steps; ++i) {
        const float left = x + width * static_cast<float>(i) / static_cast<float>(steps),
                    right = x + width * static_cast<float>(i + 1) / static_cast<float>(steps);
        const glm::vec3 color =
            legend.heat ? prt::heat_color((i + 0.5) / steps) : prt::label_color(static_cast<std::size_t>(i));
        list.AddRectFilled({left, y}, {right, y + height}, display_color(color));
    }
}

/// Draws the legend; its lower left corner is (x, bottom).
void draw_legend(ImDrawList& list, const Legend& legend, float x, float bottom, float width) {
    const float line = ImGui::GetTextLineHeight(), bar = scaled(12), gap = scaled(3);
    const float height = bar + (legend.heat ? 2 : 1) * (line + gap), top = bottom - height;
    width = std::max(width, ImGui::CalcTextSize(legend.note.c_str()).x);
    list.AddRectFilled({x - scaled(6), top - scaled(5)}, {x + width + scaled(6), bottom + scaled(3)}, kShade,
                       scaled(3));
    list.AddText({x, top}, kWhite, legend.note.c_str());
    draw_colors(list, legend, x, top + line + gap, width, bar);
    const float numbers = top + line + bar + 2 * gap - scaled(1);
    list.AddText({x, numbers}, kWhite, legend.low.c_str());
    list.AddText({x + width - ImGui::CalcTextSize(legend.high.c_str()).x, numbers}, kWhite,
                 legend.high.c_str());
}

void draw_difference(const Viewer& viewer, ImDrawList& list, const ImVec2& size) {
    const Settings& s = viewer.settings;
    const std::string text =
        fmt::format("{} - {}: relative L2 {:.2f} %", brief_label(viewer, left_picture(s)),
                    brief_label(viewer, right_picture(s)), 100 * viewer.figures().difference.relative_l2);
    const float width = ImGui::CalcTextSize(text.c_str()).x;
    draw_legend(list, {true, "0", fmt::format("{:.0f} % of the mean", 100 * s.white), text},
                size.x - width - scaled(16), size.y - scaled(12), width);
}

/// Draws the name of a side's picture and its legend above, next to the split.
void draw_side(const Viewer& viewer, ImDrawList& list, const SidePicture& picture, bool left, float split,
               const ImVec2& size) {
    const std::string text = side_label(viewer, picture);
    const auto start = [&](float width) {
        return left ? std::max(scaled(6), split - width - scaled(12)) : split + scaled(12);
    };
    draw_label(list, start(ImGui::CalcTextSize(text.c_str()).x), size.y - scaled(28), text);
    const PictureKind shown = viewer.shown(picture).kind;
    if (!shows_numbers(shown))
        return;
    const Legend legend = legend_of(viewer, {shown, picture.receivers});
    const float width = std::max(scaled(160), ImGui::CalcTextSize(legend.note.c_str()).x);
    draw_legend(list, legend, start(width), size.y - scaled(42), width);
}

} // namespace

float scaled(float pixels) {
    return pixels * ImGui::GetFontSize() / kUnscaledFont;
}

void draw_overlay(const Viewer& viewer) {
    if (!viewer.document().model())
        return;
    ImDrawList& list = *ImGui::GetBackgroundDrawList();
    const ImVec2 size = ImGui::GetIO().DisplaySize;
    const Settings& s = viewer.settings;
    draw_handles(viewer, list);
    if (s.difference)
        return draw_difference(viewer, list, size);
    const float split = s.split * size.x;
    if (s.split > 0 && s.split < 1)
        list.AddLine({split, 0}, {split, size.y}, IM_COL32(255, 255, 255, 200), scaled(1.5f));
    if (s.split > 0.02f)
        draw_side(viewer, list, left_picture(s), true, split, size);
    if (s.split < 0.98f)
        draw_side(viewer, list, right_picture(s), false, split, size);
}

} // namespace viewer
