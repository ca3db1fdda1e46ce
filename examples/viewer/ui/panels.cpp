// Draws the panels of the viewer.

#include "ui/panels.h"

#include "ui/budget_panel.h"
#include "ui/commands.h"
#include "ui/overlay.h"
#include "ui/widgets.h"

#include <fmt/core.h>
#include <imgui.h>
#include <imgui_internal.h>

#include <algorithm>
#include <cfloat>
#include <string>

namespace viewer {
namespace {

/// Shows the controls of a side's picture. `lightmap` is the id of the setting that selects transfer of
/// texels, used if there are both.
void choose_side(Viewer& viewer, const char* id, const char* lightmap,
                 SidePicture (*picture)(const Settings&)) {
    const Receivers receivers = picture(viewer.settings).receivers;
    choose_picture(setting(id), *std::get<PictureKind*>(setting(id).setting(viewer.settings)),
                   [&](PictureKind kind) {
                       return viewer.never_shown({kind, receivers});
                   });
    if (viewer.document().has_both() && shows_transfer(picture(viewer.settings).kind)) {
        ImGui::PushID(id);
        control(viewer.settings, setting(lightmap));
        ImGui::PopID();
    }
    const std::string note = viewer.shown(picture(viewer.settings)).note;
    if (!note.empty())
        ImGui::TextWrapped("%s", note.c_str());
}

void choose_texel_grid(Viewer& viewer) {
    const bool there = viewer.document().lightmap() != nullptr;
    ImGui::BeginDisabled(!there);
    control(viewer.settings, setting("texel_grid"));
    ImGui::EndDisabled();
    show_reason_disabled(there ? "" : "no lightmap is open (prt bake --texels)");
}

void picture_panel(Viewer& viewer) {
    Settings& s = viewer.settings;
    choose_side(viewer, "left", "left_lightmap", left_picture);
    choose_side(viewer, "right", "right_lightmap", right_picture);
    controls(s, {"difference", "wireframe", "lobe"});
    if (s.difference)
        controls(s, {"white"});
    controls(s, {"exposure_stops"});
    line("metered", fmt::format("{:+.2f} stops", viewer.lighting().meter.stops()),
         "Automatic exposure. Pass the sum with the setting above to prt render --exposure.");
    controls(s, {"background", "textured"});
    controls(s, {"deferred", "dithered", "culling"});
    choose_texel_grid(viewer);
    ImGui::SameLine();
    if (ImGui::SmallButton("reset camera"))
        viewer.reset_camera();
    tip("Shows the whole model from the initial camera. Key R.");
    if (is_ssao(s.left) || is_ssao(s.right))
        for (const char* id : {"ssao_radius", "ssao_bias", "ssao_intensity", "ssao_samples"})
            controls(s, {id});
}

std::string sky_name(const Viewer& viewer) {
    if (viewer.lights.day)
        return "clear day";
    const std::string environment = viewer.lighting().rig.environment_name();
    return viewer.lights.environment_on && !environment.empty() ? environment : "none";
}

void choose_sky(Viewer& viewer) {
    LightSettings& l = viewer.lights;
    const std::string current = sky_name(viewer);
    const bool open = ImGui::BeginCombo("sky", current.c_str(), ImGuiComboFlags_HeightLarge);
    if (!open)
        tip("Clear day with a variable hour, no sky, or an environment map. Drop .hdr and .exr files to "
            "add them. Key N.");
    if (!open)
        return;
    if (ImGui::Selectable("clear day", l.day))
        l.day = true;
    if (ImGui::Selectable("none", !l.day && !l.environment_on))
        l.day = l.environment_on = false;
    const auto& environments = viewer.lighting().environments;
    for (std::size_t i = 0; i < environments.size(); ++i) {
        ImGui::PushID(static_cast<int>(i)); // files may have equal names
        if (ImGui::Selectable(environments[i]->name.c_str(), !l.day && environments[i]->name == current))
            viewer.use_environment(i);
        ImGui::PopID();
    }
    ImGui::EndCombo();
}

void choose_window(prt::Window& window) {
    const auto current = std::ranges::find(kWindows, window, &WindowName::window);
    const bool open = ImGui::BeginCombo("window", current->title);
    if (!open)
        tip("Window over the bands: reduces ringing of spherical harmonics around strong lights. The "
            "reference does not use it.");
    if (!open)
        return;
    for (const WindowName& name : kWindows) {
        if (ImGui::Selectable(name.title, name.window == window))
            window = name.window;
        tip(name.tip);
    }
    ImGui::EndCombo();
}

/// Returns false if the light is to be removed.
bool light_controls(RigLight& light) {
    ImGui::Separator();
    check(std::ranges::find(kLights, light.kind, &LightName::kind)->id, light.on,
          "Switches the light. Drag its handle to move it.");
    ImGui::SameLine();
    ImGui::ColorEdit3("##colour", &light.color.x, ImGuiColorEditFlags_NoInputs | ImGuiColorEditFlags_Float);
    ImGui::SameLine();
    const bool remove = ImGui::SmallButton("remove");
    tip("Removes this light.");
    ImGui::SliderFloat("strength", &light.strength, 0, 30, "%.2f", ImGuiSliderFlags_Logarithmic);
    tip("Relative to the mean radiance of the sky.");
    if (light.kind == LightKind::cone) {
        ImGui::SliderAngle("half angle", &light.size, 1, 90);
        tip("Angle from the axis of the cone to its edge, seen from the model.");
    }
    if (light.kind == LightKind::sphere) {
        ImGui::SliderFloat("radius", &light.size, 0.02f, 1.5f);
        tip("Radius of the sphere, in radii of the scene.");
        ImGui::SliderFloat("distance", &light.distance, 1.6f, 8);
        tip("Distance to its center, in radii of the scene. The light is distant: all vertices see it in "
            "the same direction.");
    }
    return !remove;
}

void light_panel(Viewer& viewer) {
    LightSettings& l = viewer.lights;
    choose_sky(viewer);
    if (l.day) {
        auto hour = static_cast<float>(l.time.hour), turbidity = static_cast<float>(l.time.turbidity);
        if (ImGui::SliderFloat("hour", &hour, 0, 24, "%.1f"))
            l.time.hour = static_cast<double>(hour);
        tip("Hour of the equinox at 45 degrees north; at 12 the sun is in the south (+Z).");
        if (ImGui::SliderFloat("haze", &turbidity, 2, 10, "%.1f"))
            l.time.turbidity = static_cast<double>(turbidity);
        tip("Turbidity of the air; 2: clear, 10: hazy.");
        control(viewer.settings, *std::ranges::find(commands(), ' ', &Command::key));
    }
    control(viewer.settings, setting("separate_suns"));
    choose_window(l.window);
    ImGui::SliderAngle("rotation", &l.rotation, -180, 180);
    tip("Rotation of the sky about the vertical axis. Drag the picture with the right button.");
    ImGui::TextDisabled("add");
    for (const auto& [kind, name] : kLights) {
        ImGui::SameLine();
        if (ImGui::SmallButton(name))
            l.lights.push_back(make_light(kind));
        tip("Adds a distant light of this shape. Drag its handle to move it.");
    }
    for (std::size_t i = 0; i < l.lights.size(); ++i) {
        ImGui::PushID(static_cast<int>(i));
        const bool stays = light_controls(l.lights[i]);
        ImGui::PopID();
        if (!stays) {
            l.lights.erase(l.lights.begin() + static_cast<std::ptrdiff_t>(i));
            break;
        }
    }
}

/// Shows the controls of a lamp's strength and color.
void lamp_controls(LampControl& lamp) {
    constexpr float kBrightest = 10; // maximum of the slider; a script may exceed it
    check("##on", lamp.on, "Switches the lamp.");
    ImGui::SameLine();
    ImGui::ColorEdit3("##colour", &lamp.color.x, ImGuiColorEditFlags_NoInputs | ImGuiColorEditFlags_Float);
    tip("Color factor on the light of this lamp.");
    ImGui::SameLine();
    ImGui::SetNextItemWidth(scaled(110)); // leaves equal space for the name
    ImGui::SliderFloat(lamp.name.c_str(), &lamp.strength, 0, std::max(kBrightest, lamp.strength), "%.2f",
                       ImGuiSliderFlags_Logarithmic | ImGuiSliderFlags_AlwaysClamp);
    tip("Strength; 1: as in the scene.");
}

void lamp_panel(Viewer& viewer) {
    controls(viewer.settings, {"lamps", "lamp_strength"});
    std::vector<LampControl>& lamps = viewer.settings.lit.lamps.each;
    for (std::size_t i = 0; i < lamps.size(); ++i) {
        ImGui::PushID(static_cast<int>(i));
        lamp_controls(lamps[i]);
        ImGui::PopID();
    }
}

void compression_controls(Viewer& viewer) {
    if (viewer.jobs().busy())
        ImGui::ProgressBar(static_cast<float>(viewer.jobs().share()), {-1, 0}, viewer.jobs().label().c_str());
    if (!viewer.jobs().busy() && viewer.document().model()) {
        ImGui::BeginDisabled(!viewer.can_bake());
        if (ImGui::SmallButton("bake again"))
            viewer.bake_anew();
        ImGui::EndDisabled();
        show_reason_disabled(
            viewer.can_bake() ? "" : "the viewer bakes only vertices; bake lightmaps with prt bake --texels");
        tip("Bakes the model again with three bounces; ignores the transfer of its file.");
    }
    if (viewer.can_save()) {
        if (!viewer.jobs().busy())
            ImGui::SameLine();
        if (ImGui::SmallButton("save"))
            viewer.save();
        tip("Writes the model with its compressed transfer to NAME.shipped.glb in its folder; existing files "
            "are not overwritten. Key S.");
    }
    if (!viewer.document().raw())
        return;
    ImGui::SliderInt("order", &viewer.compression.order, 1, viewer.document().raw_order());
    tip("Number of spherical harmonic bands; more give sharper shadows.");
    ImGui::SliderInt("clusters", &viewer.compression.clusters, 1, 1024, "%d", ImGuiSliderFlags_Logarithmic);
    tip("Number of groups of receivers with a separate basis. More reduce the error; file and time per frame "
        "grow. Preset u32: 256 with 4 components, fewer for small models.");
    ImGui::SliderInt("components", &viewer.compression.components, 0, 16);
    tip("Weights per vertex. More reduce the error, and need more bytes and shader time.");
}

/// Shows the figures of transfer; `receiver` is the name of one receiver.
void transfer_lines(const TransferFigures& t, const char* receiver, std::size_t baked_receivers) {
    if (t.bytes_per_receiver > 0)
        line(fmt::format("bytes per {}", receiver).c_str(),
             fmt::format("{:.0f}, {:.2f} with bases", t.bytes_per_receiver, t.bytes_with_bases),
             "Compressed transfer per receiver, without and with the shared bases.");
    if (t.clusters > 0)
        line("clusters in use", fmt::format("{}", t.clusters));
    if (t.raw_bytes > 0)
        line("uncompressed",
             fmt::format("{:.0f} bytes per {}",
                         static_cast<double>(t.raw_bytes) / static_cast<double>(baked_receivers), receiver));
}

void lightmap_lines(const LightmapFigures& f) {
    constexpr std::size_t kMaxNamed = 2;
    std::string maps = f.maps.size() == 1 ? "" : fmt::format("{}: ", f.maps.size());
    for (std::size_t m = 0; m < std::min(f.maps.size(), kMaxNamed); ++m)
        maps += fmt::format("{}{} x {}", m == 0 ? "" : ", ", f.maps[m].width, f.maps[m].height);
    line(f.maps.size() == 1 ? "lightmap" : "lightmaps", maps + (f.maps.size() > kMaxNamed ? ", ..." : ""),
         "Width and height in texels.");
    if (f.receivers > 0)
        line("texels",
             fmt::format("{}, {:.0f} % used", f.texels,
                         100 * static_cast<double>(f.receivers) / static_cast<double>(f.texels)),
             "Number of all texels, and the percentage on surfaces.");
    else
        line("texels", fmt::format("{}", f.texels));
    transfer_lines(f.transfer, "texel", f.receivers);
}

void instance_lines(const InstanceFigures& f) {
    line("instances", fmt::format("{} of {} meshes", f.instances, f.meshes),
         "Instances that share the transfer of their mesh.");
    line("bytes per instance",
         fmt::format("{}, {:.0f}, {:.0f}", f.bytes_in_file, f.bytes_of_constants, f.bytes_of_radiance),
         "Bytes in the file; bytes of constants; bytes of vertex radiance, which a frame reads.");
}

void figure_lines(const Figures& f) {
    line("frame",
         fmt::format("{:.1f} ms, {:.0f}/s", f.milliseconds.frame, 1e3 / std::max(f.milliseconds.frame, 1e-3)),
         "Time from one frame to the next.");
    line("GPU, frame", fmt::format("{:.2f} ms", f.milliseconds.gpu),
         "GPU time of both pictures and their overlays.");
    line("GPU, vertices", fmt::format("{:.3f} ms", f.milliseconds.vertices),
         "GPU time of the vertex stage of the right picture.");
    line("constants", fmt::format("{:.3f} ms", f.milliseconds.constants),
         "Time to compute and upload the constants of all clusters after a change of light.");
    line("vertices", fmt::format("{}", f.receivers));
    line("triangles", fmt::format("{} of {}", f.triangles_drawn, f.triangles));
    transfer_lines(f.transfer, "vertex", f.receivers);
    if (f.instances)
        instance_lines(*f.instances);
    if (f.lightmap)
        lightmap_lines(*f.lightmap);
    if (f.reference_passes > 0)
        line("reference", fmt::format("{} paths per pixel", f.reference_passes));
}

void transfer_panel(Viewer& viewer) {
    compression_controls(viewer);
    figure_lines(viewer.figures());
}

std::string volume_words(const Viewer& viewer) {
    const FoundVolume& found = viewer.document().moving.volume();
    if (!found.volume)
        return "not available yet";
    const std::string probes = fmt::format("{} probes", found.volume->visibility.size());
    return found.rays > 0 ? fmt::format("{}, {} rays", probes, found.rays) : probes;
}

void moving_panel(Viewer& viewer) {
    const bool there = viewer.document().moving.figure() != nullptr;
    ImGui::BeginDisabled(!there);
    controls(viewer.settings, {"figure", "walks"});
    controls(viewer.settings, {"walk_speed"});
    ImGui::EndDisabled();
    show_reason_disabled(there ? "" : "drop an animated model to add a figure");
    controls(viewer.settings, {"spheres", "probes", "contact"});
    if (viewer.jobs().busy(JobKind::volume))
        ImGui::ProgressBar(static_cast<float>(viewer.jobs().share(JobKind::volume)), {-1, 0},
                           viewer.jobs().label(JobKind::volume).c_str());
    line("volume", volume_words(viewer), "Volume that lights the moving objects.");
}

void lobe_panel(const Viewer& viewer) {
    const auto& hovered = viewer.hovered();
    if (!hovered)
        return;
    line(hovered->of == Receivers::texels ? "texel" : "vertex", fmt::format("{}", hovered->receiver));
    if (hovered->cluster >= 0) {
        line("cluster", fmt::format("{}", hovered->cluster));
        if (!hovered->weights.empty())
            ImGui::PlotHistogram("weights", hovered->weights.data(),
                                 static_cast<int>(hovered->weights.size()), 0, nullptr, -1, 1,
                                 {0, scaled(50)});
    }
    if (!hovered->vector.empty())
        ImGui::PlotHistogram("transfer", hovered->vector.data(), static_cast<int>(hovered->vector.size()), 0,
                             nullptr, -0.5f, 0.5f, {0, scaled(60)});
}

void help_window(bool& open) {
    ImGui::SetNextWindowPos({scaled(340), scaled(40)}, ImGuiCond_FirstUseEver);
    if (ImGui::Begin("Help", &open, ImGuiWindowFlags_AlwaysAutoResize)) {
        line("left drag", "orbit; on a light or the split: move it");
        line("right drag", "rotate the environment");
        line("middle drag, wheel", "pan, zoom");
        line("drop files", "open models and environments");
        line("Escape", "close list, messages or help");
        for (const Command& command : commands())
            if (*command.help != 0)
                line(command.key == ' ' ? "Space" : std::string(1, command.key).c_str(), command.help);
    }
    ImGui::End();
}

void message_window(Viewer& viewer) {
    if (viewer.messages().empty())
        return;
    const ImVec2 size = ImGui::GetIO().DisplaySize;
    ImGui::SetNextWindowPos({size.x / 2, scaled(20)}, ImGuiCond_Always, {0.5f, 0});
    ImGui::SetNextWindowSize({std::min(scaled(620), size.x - scaled(20)), 0});
    ImGui::Begin("Message", nullptr, ImGuiWindowFlags_NoCollapse | ImGuiWindowFlags_NoSavedSettings);
    for (const std::string& text : viewer.messages())
        ImGui::TextWrapped("%s", text.c_str());
    if (ImGui::Button("OK"))
        viewer.dismiss_messages();
    ImGui::End();
}

} // namespace

void close_topmost(Viewer& viewer) {
    if (!ImGui::GetCurrentContext()->OpenPopupStack.empty())
        ImGui::ClosePopupToLevel(ImGui::GetCurrentContext()->OpenPopupStack.Size - 1, true);
    else if (!viewer.messages().empty())
        viewer.dismiss_messages();
    else
        viewer.settings.help = false;
}

void draw_panels(Viewer& viewer) {
    draw_overlay(viewer);
    if (viewer.settings.panels) {
        const float margin = scaled(10), width = scaled(310);
        ImGui::SetNextWindowPos({margin, margin}, ImGuiCond_FirstUseEver);
        ImGui::SetNextWindowSize({width, 0}, ImGuiCond_FirstUseEver);
        ImGui::SetNextWindowSizeConstraints(
            {0, 0}, {FLT_MAX, std::max(scaled(60), ImGui::GetIO().DisplaySize.y - 2 * margin)});
        const std::string title = viewer.document().model() ? viewer.document().name() : "prtkit";
        if (ImGui::Begin((title + "###main").c_str())) {
            if (!viewer.document().model())
                ImGui::TextWrapped(
                    "Drop a model (.glb, .gltf) on this window, and an environment map (.hdr, .exr).");
            if (ImGui::CollapsingHeader("Picture", ImGuiTreeNodeFlags_DefaultOpen))
                picture_panel(viewer);
            if (ImGui::CollapsingHeader("Light", ImGuiTreeNodeFlags_DefaultOpen))
                light_panel(viewer);
            const bool lamps = !viewer.settings.lit.lamps.each.empty();
            if (lamps && ImGui::CollapsingHeader("Lamps", ImGuiTreeNodeFlags_DefaultOpen))
                lamp_panel(viewer);
            if (ImGui::CollapsingHeader("Transfer", ImGuiTreeNodeFlags_DefaultOpen))
                transfer_panel(viewer);
            if (viewer.document().model() && ImGui::CollapsingHeader("Moving objects"))
                moving_panel(viewer);
            if (viewer.document().model() && ImGui::CollapsingHeader("Budget"))
                budget_panel(viewer);
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
