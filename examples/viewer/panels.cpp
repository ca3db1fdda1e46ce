#include "panels.h"

#include "controls.h"

#include <fmt/core.h>
#include <imgui.h>

#include <array>
#include <cmath>
#include <string>

namespace viewer {
namespace {

void line(const char* name, const std::string& value) {
    ImGui::TextDisabled("%s", name);
    ImGui::SameLine(150);
    ImGui::TextUnformatted(value.c_str());
}

void choose_picture(const char* label, PictureKind& kind, const Viewer& viewer) {
    if (ImGui::BeginCombo(label, name_of(kind).title)) {
        for (const PictureName& name : kPictures)
            if (ImGui::Selectable(name.title, name.kind == kind))
                kind = name.kind;
        ImGui::EndCombo();
    }
    const std::string note = viewer.shown(kind).note;
    if (!note.empty())
        ImGui::TextWrapped("%s", note.c_str());
}

void picture_panel(Viewer& viewer) {
    Settings& s = viewer.settings;
    choose_picture("left", s.left, viewer);
    choose_picture("right", s.right, viewer);
    ImGui::Checkbox("difference", &s.difference);
    ImGui::SameLine();
    ImGui::Checkbox("wireframe", &s.wireframe);
    ImGui::SameLine();
    ImGui::Checkbox("lobe", &s.lobe);
    ImGui::SliderFloat("exposure", &s.exposure_stops, -6, 6, "%+.2f stops");
    ImGui::Checkbox("background", &s.background);
    ImGui::SameLine();
    ImGui::Checkbox("base colour", &s.textured);
    ImGui::Checkbox("deferred", &s.deferred);
    ImGui::SameLine();
    ImGui::Checkbox("dithered AO", &s.dithered);
    ImGui::SameLine();
    ImGui::Checkbox("culling", &s.culling);
    if (s.left == PictureKind::ssao || s.left == PictureKind::ssao_normals || s.right == PictureKind::ssao ||
        s.right == PictureKind::ssao_normals) {
        ImGui::SliderFloat("AO radius", &s.ssao.radius, 0.005f, 0.5f, "%.3f", ImGuiSliderFlags_Logarithmic);
        ImGui::SliderFloat("AO bias", &s.ssao.bias, 0, 0.2f);
        ImGui::SliderFloat("AO intensity", &s.ssao.intensity, 0.25f, 4);
        ImGui::SliderInt("AO samples", &s.ssao.samples, 2, 64);
    }
}

void light_panel(Viewer& viewer) {
    LightSettings& l = viewer.lights;
    const auto& environments = viewer.environments();
    if (ImGui::BeginCombo("sky", l.day ? "a clear day" : !l.environment_on ? "none" : "environment")) {
        if (ImGui::Selectable("a clear day", l.day))
            l.day = true;
        if (ImGui::Selectable("none", !l.day && !l.environment_on))
            l.day = l.environment_on = false;
        for (std::size_t i = 0; i < environments.size(); ++i)
            if (ImGui::Selectable(environments[i]->name.c_str()))
                viewer.use_environment(i);
        ImGui::EndCombo();
    }
    if (l.day) {
        auto hour = static_cast<float>(l.time.hour), turbidity = static_cast<float>(l.time.turbidity);
        if (ImGui::SliderFloat("hour", &hour, 0, 24, "%.1f"))
            l.time.hour = static_cast<double>(hour);
        if (ImGui::SliderFloat("haze", &turbidity, 2, 10, "%.1f"))
            l.time.turbidity = static_cast<double>(turbidity);
        ImGui::Checkbox("let the day run", &viewer.day_runs);
    }
    ImGui::SliderAngle("turned", &l.rotation, -180, 180);
    constexpr std::array<std::pair<const char*, LightKind>, 4> kKinds = {
        {{"sun", LightKind::sun},
         {"cone", LightKind::cone},
         {"sphere", LightKind::sphere},
         {"hemisphere", LightKind::hemisphere}}};
    ImGui::TextDisabled("add");
    for (const auto& [name, kind] : kKinds) {
        ImGui::SameLine();
        if (ImGui::SmallButton(name))
            l.lights.push_back(make_light(kind));
    }
    for (std::size_t i = 0; i < l.lights.size(); ++i) {
        RigLight& light = l.lights[i];
        ImGui::PushID(static_cast<int>(i));
        ImGui::Separator();
        ImGui::Checkbox(kKinds[static_cast<std::size_t>(light.kind)].first, &light.on);
        ImGui::SameLine();
        ImGui::ColorEdit3("##colour", &light.color.x,
                          ImGuiColorEditFlags_NoInputs | ImGuiColorEditFlags_Float);
        ImGui::SameLine();
        const bool remove = ImGui::SmallButton("remove");
        ImGui::SliderFloat("strength", &light.strength, 0, 30, "%.2f", ImGuiSliderFlags_Logarithmic);
        if (light.kind == LightKind::cone)
            ImGui::SliderAngle("half angle", &light.size, 1, 90);
        if (light.kind == LightKind::sphere) {
            ImGui::SliderFloat("radius", &light.size, 0.02f, 1.5f);
            ImGui::SliderFloat("distance", &light.distance, 1.6f, 8);
        }
        ImGui::PopID();
        if (remove) {
            l.lights.erase(l.lights.begin() + static_cast<std::ptrdiff_t>(i));
            break;
        }
    }
}

void transfer_panel(Viewer& viewer) {
    const Figures& f = viewer.figures();
    if (viewer.busy()) {
        ImGui::ProgressBar(static_cast<float>(viewer.share()), {-1, 0}, viewer.stage().c_str());
    } else if (viewer.has_model() && ImGui::SmallButton("bake anew")) {
        viewer.bake_anew();
    }
    if (viewer.has_raw()) {
        ImGui::SliderInt("order", &viewer.compression.order, 1, viewer.raw_order());
        ImGui::SliderInt("clusters", &viewer.compression.clusters, 1, 1024, "%d",
                         ImGuiSliderFlags_Logarithmic);
        ImGui::SliderInt("components", &viewer.compression.components, 0, 16);
    }
    line("frame", fmt::format("{:.1f} ms, {:.0f}/s", f.frame_milliseconds,
                              1e3 / std::max(f.frame_milliseconds, 1e-3)));
    line("GPU, frame", fmt::format("{:.2f} ms", f.gpu_milliseconds));
    line("GPU, vertices", fmt::format("{:.3f} ms", f.vertex_milliseconds));
    line("constants", fmt::format("{:.3f} ms", f.constants_milliseconds));
    line("vertices", fmt::format("{}", f.receivers));
    line("triangles", fmt::format("{} of {}", f.triangles_drawn, f.triangles));
    if (f.bytes_per_vertex > 0)
        line("bytes per vertex",
             fmt::format("{:.0f}, {:.2f} with bases", f.bytes_per_vertex, f.bytes_with_bases));
    if (f.raw_bytes > 0)
        line("uncompressed", fmt::format("{:.0f} a vertex", static_cast<double>(f.raw_bytes) /
                                                                static_cast<double>(f.receivers)));
    if (f.reference_passes > 0)
        line("reference", fmt::format("{} paths per pixel", f.reference_passes));
}

void lobe_panel(const Viewer& viewer) {
    const auto& hovered = viewer.hovered();
    if (!hovered)
        return;
    line("vertex", fmt::format("{}", hovered->receiver));
    if (hovered->cluster >= 0) {
        line("cluster", fmt::format("{}", hovered->cluster));
        if (!hovered->weights.empty())
            ImGui::PlotHistogram("weights", hovered->weights.data(),
                                 static_cast<int>(hovered->weights.size()), 0, nullptr, -1, 1, {0, 50});
    }
    if (!hovered->vector.empty())
        ImGui::PlotHistogram("transfer", hovered->vector.data(), static_cast<int>(hovered->vector.size()), 0,
                             nullptr, -0.5f, 0.5f, {0, 60});
}

void draw_handles(const Viewer& viewer) {
    if (!viewer.has_model())
        return;
    ImDrawList* list = ImGui::GetBackgroundDrawList();
    for (const RigLight& light : viewer.lights.lights) {
        const auto at = pixel_of(viewer.screen(), handle_place(viewer, light));
        if (!light.on || !at)
            continue;
        const ImU32 color = ImGui::ColorConvertFloat4ToU32({light.color.r, light.color.g, light.color.b, 1});
        list->AddCircleFilled({at->x, at->y}, 9, color);
        list->AddCircle({at->x, at->y}, 10, IM_COL32(0, 0, 0, 200), 0, 2);
        if (light.kind == LightKind::sun)
            for (int ray = 0; ray < 8; ++ray) {
                const float angle = 0.785398f * static_cast<float>(ray), x = std::cos(angle),
                            y = std::sin(angle);
                list->AddLine({at->x + 12 * x, at->y + 12 * y}, {at->x + 17 * x, at->y + 17 * y}, color, 2);
            }
    }
}

void label(ImDrawList* list, float x, float y, const std::string& text) {
    const ImVec2 size = ImGui::CalcTextSize(text.c_str());
    list->AddRectFilled({x - 4, y - 2}, {x + size.x + 4, y + size.y + 2}, IM_COL32(0, 0, 0, 150), 3);
    list->AddText({x, y}, IM_COL32(255, 255, 255, 255), text.c_str());
}

std::string side_label(const Viewer& viewer, PictureKind kind) {
    const Viewer::Shown shown = viewer.shown(kind);
    if (shown.kind == kind)
        return name_of(kind).title;
    return fmt::format("{}: {}. Meanwhile: {}", name_of(kind).title, shown.note, name_of(shown.kind).title);
}

/// Names of the sides, and the legend of the difference.
void draw_labels(const Viewer& viewer) {
    if (!viewer.has_model())
        return;
    ImDrawList* list = ImGui::GetBackgroundDrawList();
    const ImVec2 size = ImGui::GetIO().DisplaySize;
    const Settings& s = viewer.settings;
    if (s.difference) {
        const Difference& d = viewer.figures().difference;
        label(list, 12, size.y - 64,
              fmt::format("{} - {}: relative L2 {:.2f} %", name_of(s.left).title, name_of(s.right).title,
                          100 * d.relative_l2));
        const float width = std::min(300.0f, size.x - 24);
        constexpr ImU32 kRamp[] = {IM_COL32(0, 0, 0, 255), IM_COL32(255, 0, 0, 255),
                                   IM_COL32(255, 255, 0, 255), IM_COL32(255, 255, 255, 255)};
        for (int i = 0; i < 3; ++i)
            list->AddRectFilledMultiColor({12 + width * static_cast<float>(i) / 3, size.y - 40},
                                          {12 + width * static_cast<float>(i + 1) / 3, size.y - 28}, kRamp[i],
                                          kRamp[i + 1], kRamp[i + 1], kRamp[i]);
        list->AddText({12, size.y - 24}, IM_COL32_WHITE, "0");
        const std::string white = fmt::format("{:.0f} % of the mean", 100 * s.white);
        list->AddText({12 + width - ImGui::CalcTextSize(white.c_str()).x, size.y - 24}, IM_COL32_WHITE,
                      white.c_str());
        return;
    }
    const float split = s.split * size.x;
    if (s.split > 0 && s.split < 1)
        list->AddLine({split, 0}, {split, size.y}, IM_COL32(255, 255, 255, 200), 1.5f);
    const std::string left = side_label(viewer, s.left);
    if (s.split > 0.02f)
        label(list, std::max(6.0f, split - ImGui::CalcTextSize(left.c_str()).x - 12), size.y - 28, left);
    if (s.split < 0.98f)
        label(list, split + 12, size.y - 28, side_label(viewer, s.right));
}

void help_window(bool& open) {
    ImGui::SetNextWindowPos({340, 40}, ImGuiCond_FirstUseEver);
    if (ImGui::Begin("Help", &open, ImGuiWindowFlags_AlwaysAutoResize)) {
        line("left drag", "turn; on a light or the split: move it");
        line("right drag", "turn the environment");
        line("middle drag, wheel", "move, zoom");
        line("drop files", "models and environments");
        for (const KeyHelp& key : kKeys)
            line(key.key == ' ' ? "Space" : std::string(1, key.key).c_str(), key.what);
    }
    ImGui::End();
}

void message_window(Viewer& viewer) {
    if (viewer.messages().empty())
        return;
    const ImVec2 size = ImGui::GetIO().DisplaySize;
    ImGui::SetNextWindowPos({size.x / 2, 20}, ImGuiCond_Always, {0.5f, 0});
    ImGui::SetNextWindowSize({std::min(620.0f, size.x - 20), 0});
    ImGui::Begin("Message", nullptr, ImGuiWindowFlags_NoCollapse | ImGuiWindowFlags_NoSavedSettings);
    for (const std::string& text : viewer.messages())
        ImGui::TextWrapped("%s", text.c_str());
    if (ImGui::Button("OK"))
        viewer.messages().clear();
    ImGui::End();
}

} // namespace

void draw_panels(Viewer& viewer) {
    draw_labels(viewer);
    draw_handles(viewer);
    if (viewer.settings.panels) {
        ImGui::SetNextWindowPos({10, 10}, ImGuiCond_FirstUseEver);
        ImGui::SetNextWindowSize({310, 0}, ImGuiCond_FirstUseEver);
        const std::string title = viewer.has_model() ? viewer.model_name() : "prtkit";
        if (ImGui::Begin((title + "###main").c_str())) {
            if (!viewer.has_model())
                ImGui::TextWrapped(
                    "Drop a model (.glb, .gltf) on this window, and an environment map (.hdr, .exr).");
            if (ImGui::CollapsingHeader("Picture", ImGuiTreeNodeFlags_DefaultOpen))
                picture_panel(viewer);
            if (ImGui::CollapsingHeader("Light", ImGuiTreeNodeFlags_DefaultOpen))
                light_panel(viewer);
            if (ImGui::CollapsingHeader("Transfer", ImGuiTreeNodeFlags_DefaultOpen))
                transfer_panel(viewer);
            if (viewer.settings.lobe)
                lobe_panel(viewer);
            ImGui::TextDisabled("H: help   Tab: hide");
        }
        ImGui::End();
    }
    if (viewer.settings.help)
        help_window(viewer.settings.help);
    message_window(viewer);
}

} // namespace viewer
