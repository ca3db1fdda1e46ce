// The table of settings and keys.

#include "ui/commands.h"

#include "ui/controls.h"

#include "prt/core/error.h"

#include <algorithm>
#include <string>
#include <utility>

namespace viewer {
namespace {

/// Returns the member reached by following the member pointers in turn.
template <auto... members>
SettingPointer pointer_to(Settings& settings) {
    return &(settings.*....*members);
}

constexpr auto kDrawing = &Settings::drawing;
constexpr auto kLit = &Settings::lit;
constexpr auto kMoving = &DrawSettings::moving;
constexpr auto kLamps = &LitBy::lamps;
constexpr auto kLightmap = &DrawSettings::lightmap;
constexpr auto kSsao = &DrawSettings::ssao;

void swap_sides(Controls& c) {
    Settings& settings = c.viewer().settings;
    std::swap(settings.left, settings.right);
    std::swap(settings.drawing.lightmap.left, settings.drawing.lightmap.right);
}

void switch_samples(Controls& c) {
    int& samples = c.viewer().settings.drawing.samples;
    samples = samples == 1 ? 2 : 1;
}

constexpr const char* kSideTip = "Picture on this side of the line. Keys 1 and 2 select the next one.";

constexpr const char* kLightmapTip =
    "Use the transfer of the lightmap instead of the vertices; both are open.";

constexpr Command kCommands[] = {
    {"left", '1', "next left picture", "left", kSideTip, pointer_to<&Settings::left>},
    {"right", '2', "next right picture", "right", kSideTip, pointer_to<&Settings::right>},
    {"", 'X', "swap left and right", "", "", nullptr, swap_sides},
    {"difference", 'D', "difference of both pictures", "difference",
     "Difference of both pictures as heat colours, with its relative L2. Key D.",
     pointer_to<&Settings::difference>},
    {"wireframe", 'W', "wireframe", "wireframe", "Triangle edges over both pictures. Key W.",
     pointer_to<kDrawing, &DrawSettings::wireframe>},
    {"texel_grid", 'M', "grid of the lightmap's texels", "texel grid",
     "Borders of lightmap texels that cover several pixels; not shown over a difference. Key M.",
     pointer_to<kDrawing, &DrawSettings::texel_grid>},
    {"lobe", 'L', "lobe of the transfer vector under the pointer", "lobe",
     "Transfer vector of the vertex under the pointer: red is positive, blue negative. Key L.",
     pointer_to<&Settings::lobe>},
    {"deferred", 'G', "deferred shading", "deferred", "Draw through a G-buffer, like many games. Key G.",
     pointer_to<kDrawing, &DrawSettings::deferred>},
    {"culling", 'C', "culling outside the view", "culling",
     "Skip clusters of triangles outside the view. Key C.", pointer_to<kDrawing, &DrawSettings::culling>},
    {"background", 'B', "background", "background", "Show the sky behind the model. Key B.",
     pointer_to<kDrawing, &DrawSettings::background>},
    {"textured", 'T', "base colour", "base colour", "Use textures and colours; off: light only. Key T.",
     pointer_to<kDrawing, &DrawSettings::textured>},
    {"separate_suns", 'U', "separate suns with sharp shadows", "separate suns",
     "Remove suns from the sky and shadow them per pixel; off: all light is in bands. "
     "The reference is unaffected. Key U.",
     pointer_to<kLit, &LitBy::separate_suns>},
    {"lamps", 'O', "lamps of the model on or off", "on", "Switch all lamps of the model. Key O.",
     pointer_to<kLit, kLamps, &LampSettings::on>},
    {"", 'N', "clear day or environment", "", "", nullptr,
     [](Controls& c) { c.viewer().lights.day = !c.viewer().lights.day; }},
    {"", ' ', "run the day", "run the day", "Advance one hour per second. Space.",
     pointer_to<&Settings::day_runs>},
    {"figure", 'F', "walking figure", "figure",
     "Show the animated model that was opened in addition to the scene, lit by its volume. Key F.",
     pointer_to<kDrawing, kMoving, &MovingSettings::figure>},
    {"walks", 'V', "walk or pause", "walks",
     "Off: the figure keeps its current pose. It also keeps its pose while the reference is shown. Key V.",
     pointer_to<kDrawing, kMoving, &MovingSettings::walks>},
    {"spheres", 'E', "matte and mirroring spheres", "spheres",
     "Two spheres that show the light of the volume. Key E.",
     pointer_to<kDrawing, kMoving, &MovingSettings::spheres>},
    {"probes", 'K', "probes of the volume", "probes",
     "Probes of the volume in their own light; probes inside geometry are red. Key K.",
     pointer_to<kDrawing, kMoving, &MovingSettings::probes>},
    {"contact", 0, "", "contact shadows",
     "The figure and the spheres darken surfaces near them (prt ao --occluders).",
     pointer_to<kDrawing, kMoving, &MovingSettings::contact>},
    {"samples", 'A', "samples per pixel: 1, 4", "", "", pointer_to<kDrawing, &DrawSettings::samples>,
     switch_samples},
    {"", '[', "darker", "", "", nullptr, [](Controls& c) { c.viewer().settings.exposure_stops -= 0.25f; }},
    {"", ']', "brighter", "", "", nullptr, [](Controls& c) { c.viewer().settings.exposure_stops += 0.25f; }},
    {"", 'R', "reset the camera to show the whole model", "", "", nullptr,
     [](Controls& c) { c.viewer().reset_camera(); }},
    {"", 'P', "screenshot", "", "", nullptr, [](Controls& c) { c.screenshot(); }},
    {"", 'S', "save the compressed model", "", "", nullptr, [](Controls& c) { c.viewer().save(); }},
    {"", 'Q', "quit", "", "", nullptr, [](Controls& c) { c.quit(); }},
    {"help", 'H', "this help; Tab hides the panels", "", "", pointer_to<&Settings::help>},
    {"panels", '\t', "", "", "", pointer_to<&Settings::panels>},
    {"left_lightmap", 0, "", "lightmap", kLightmapTip, pointer_to<kDrawing, kLightmap, &LightmapSides::left>},
    {"right_lightmap", 0, "", "lightmap", kLightmapTip,
     pointer_to<kDrawing, kLightmap, &LightmapSides::right>},
    {"split", 0, "", "", "", pointer_to<&Settings::split>},
    {"white",
     0,
     "",
     "white",
     "Difference that is shown white, relative to the mean radiance of the right picture.",
     pointer_to<&Settings::white>,
     nullptr,
     {0.01f, 2, "%.2f of the mean", true}},
    {"dithered", 0, "", "dithered AO", "Dither the five bits of occlusion in the G-buffer, to hide steps.",
     pointer_to<kDrawing, &DrawSettings::dithered>},
    {"exposure_stops",
     0,
     "",
     "exposure",
     "Stops added to the automatic exposure. Keys [ and ].",
     pointer_to<&Settings::exposure_stops>,
     nullptr,
     {-6, 6, "%+.2f stops"}},
    {"walk_speed",
     0,
     "",
     "speed",
     "Speed of the figure, relative to its walking speed.",
     pointer_to<kDrawing, kMoving, &MovingSettings::speed>,
     nullptr,
     {0, 3, "%.2f", false, true}},
    {"lamp_strength",
     0,
     "",
     "all",
     "Factor on the strength of every lamp; 1: as in the scene.",
     pointer_to<kLit, kLamps, &LampSettings::strength>,
     nullptr,
     {0, 10, "%.2f", true, true}},
    {"ssao_radius",
     0,
     "",
     "AO radius",
     "Radius of screen-space occlusion, relative to the radius of the scene.",
     pointer_to<kDrawing, kSsao, &SsaoSettings::radius>,
     nullptr,
     {0.005f, 0.5f, "%.3f", true}},
    {"ssao_bias",
     0,
     "",
     "AO bias",
     "Minimum depth difference of an occluder, relative to the AO radius; prevents acne on flat walls.",
     pointer_to<kDrawing, kSsao, &SsaoSettings::bias>,
     nullptr,
     {0, 0.2f}},
    {"ssao_intensity",
     0,
     "",
     "AO intensity",
     "Exponent of the occlusion; above 1: darker.",
     pointer_to<kDrawing, kSsao, &SsaoSettings::intensity>,
     nullptr,
     {0.25f, 4}},
    {"ssao_samples",
     0,
     "",
     "AO samples",
     "Number of depth samples per pixel.",
     pointer_to<kDrawing, kSsao, &SsaoSettings::samples>,
     nullptr,
     {2, 64}},
};

} // namespace

std::span<const Command> commands() {
    return kCommands;
}

const Command& setting(std::string_view id) {
    const auto found = std::ranges::find_if(
        kCommands, [&](const Command& command) { return command.setting && command.id == id; });
    if (found == std::end(kCommands) || id.empty())
        throw prt::Error("unknown setting '" + std::string(id) + "'");
    return *found;
}

void switch_setting(const SettingPointer& setting) {
    if (bool* const* value = std::get_if<bool*>(&setting))
        **value = !**value;
    else if (PictureKind* const* kind = std::get_if<PictureKind*>(&setting))
        **kind = next(**kind);
}

} // namespace viewer
