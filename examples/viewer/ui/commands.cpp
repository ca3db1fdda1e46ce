// The table of settings and keys.

#include "ui/commands.h"

#include "ui/controls.h"

#include "prt/support/error.h"

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

constexpr const char* kSideTip = "What this side of the line shows. Keys 1 and 2 take the next.";

constexpr const char* kLightmapTip = "Transfer of the lightmap's texels instead of vertices': both are open.";

constexpr Command kCommands[] = {
    {"left", '1', "left picture: the next", "left", kSideTip, pointer_to<&Settings::left>},
    {"right", '2', "right picture: the next", "right", kSideTip, pointer_to<&Settings::right>},
    {"", 'X', "swap left and right", "", "", nullptr, swap_sides},
    {"difference", 'D', "difference of the two", "difference",
     "How far the two pictures are apart, as heat, with its figure. Key D.",
     pointer_to<&Settings::difference>},
    {"wireframe", 'W', "wireframe", "wireframe", "The triangles over both pictures. Key W.",
     pointer_to<kDrawing, &DrawSettings::wireframe>},
    {"texel_grid", 'M', "grid of the lightmap's texels", "texel grid",
     "Borders of the lightmap's texels, where these are some pixels large. Not over a difference. Key M.",
     pointer_to<kDrawing, &DrawSettings::texel_grid>},
    {"lobe", 'L', "lobe of the transfer vector under the pointer", "lobe",
     "The transfer vector of the vertex under the pointer: red adds light, blue takes it. Key L.",
     pointer_to<&Settings::lobe>},
    {"deferred", 'G', "forward or deferred", "deferred", "Through a G-buffer, as many games draw. Key G.",
     pointer_to<kDrawing, &DrawSettings::deferred>},
    {"culling", 'C', "culling outside the view", "culling",
     "Leaves out clusters of triangles outside the view. Key C.",
     pointer_to<kDrawing, &DrawSettings::culling>},
    {"background", 'B', "background", "background", "The sky behind the model. Key B.",
     pointer_to<kDrawing, &DrawSettings::background>},
    {"textured", 'T', "base colour", "base colour", "Textures and colours; off shows light alone. Key T.",
     pointer_to<kDrawing, &DrawSettings::textured>},
    {"separate_suns", 'U', "suns apart from the sky, with sharp shadows", "suns apart",
     "Suns are taken out of the sky and shadowed at each pixel; off, all light is in bands. Not the "
     "reference, which "
     "has neither. Key U.",
     pointer_to<kLit, &LitBy::separate_suns>},
    {"lamps", 'O', "lamps of the model, on or off", "on", "All lamps of the model. Key O.",
     pointer_to<kLit, kLamps, &LampSettings::on>},
    {"", 'N', "day instead of the environment", "", "", nullptr,
     [](Controls& c) { c.viewer().lights.day = !c.viewer().lights.day; }},
    {"", ' ', "let the day run", "let the day run", "An hour a second. Space.",
     pointer_to<&Settings::day_runs>},
    {"figure", 'F', "figure that walks through the scene", "figure",
     "The animated model that was opened beside the scene, lit by the scene's volume. Key F.",
     pointer_to<kDrawing, kMoving, &MovingSettings::figure>},
    {"walks", 'V', "let the figure walk", "walks",
     "On; off, it stands as it is. While the reference is shown it stands, too. Key V.",
     pointer_to<kDrawing, kMoving, &MovingSettings::walks>},
    {"spheres", 'E', "a matt and a mirroring sphere", "spheres",
     "Two spheres lit by the volume, to judge its light by. Key E.",
     pointer_to<kDrawing, kMoving, &MovingSettings::spheres>},
    {"probes", 'K', "probes of the volume", "probes",
     "The probes of the volume in their own light; those inside of something are red. Key K.",
     pointer_to<kDrawing, kMoving, &MovingSettings::probes>},
    {"contact", 0, "", "contact shadows",
     "The figure and the spheres take light from what they come near to (prt ao --volume).",
     pointer_to<kDrawing, kMoving, &MovingSettings::contact>},
    {"samples", 'A', "samples per pixel: 1, 4", "", "", pointer_to<kDrawing, &DrawSettings::samples>,
     switch_samples},
    {"", '[', "darker", "", "", nullptr, [](Controls& c) { c.viewer().settings.exposure_stops -= 0.25f; }},
    {"", ']', "brighter", "", "", nullptr, [](Controls& c) { c.viewer().settings.exposure_stops += 0.25f; }},
    {"", 'R', "reset the camera: the whole model", "", "", nullptr,
     [](Controls& c) { c.viewer().reset_camera(); }},
    {"", 'P', "screenshot", "", "", nullptr, [](Controls& c) { c.screenshot(); }},
    {"", 'S', "save the compressed model", "", "", nullptr, [](Controls& c) { c.viewer().save(); }},
    {"", 'Q', "quit", "", "", nullptr, [](Controls& c) { c.quit(); }},
    {"help", 'H', "this help; Tab hides the panels", "", "", pointer_to<&Settings::help>},
    {"panels", '\t', "", "", "", pointer_to<&Settings::panels>},
    {"left_lightmap", 0, "", "by the lightmap", kLightmapTip,
     pointer_to<kDrawing, kLightmap, &LightmapSides::left>},
    {"right_lightmap", 0, "", "by the lightmap", kLightmapTip,
     pointer_to<kDrawing, kLightmap, &LightmapSides::right>},
    {"split", 0, "", "", "", pointer_to<&Settings::split>},
    {"white",
     0,
     "",
     "white",
     "The difference that is shown white, over the mean radiance of the right picture.",
     pointer_to<&Settings::white>,
     nullptr,
     {0.01f, 2, "%.2f of the mean", true}},
    {"dithered", 0, "", "dithered AO", "Hides the steps of five bits of occlusion in the G-buffer.",
     pointer_to<kDrawing, &DrawSettings::dithered>},
    {"exposure_stops",
     0,
     "",
     "exposure",
     "Brighter or darker than what is metered on the model. Keys [ and ].",
     pointer_to<&Settings::exposure_stops>,
     nullptr,
     {-6, 6, "%+.2f stops"}},
    {"walk_speed",
     0,
     "",
     "speed",
     "Of the figure, times that of its walk.",
     pointer_to<kDrawing, kMoving, &MovingSettings::speed>,
     nullptr,
     {0, 3, "%.2f", false, true}},
    {"lamp_strength",
     0,
     "",
     "all",
     "What the strength of every lamp is multiplied with; 1 is as in the scene.",
     pointer_to<kLit, kLamps, &LampSettings::strength>,
     nullptr,
     {0, 10, "%.2f", true, true}},
    {"ssao_radius",
     0,
     "",
     "AO radius",
     "How far screen-space occlusion looks, as a share of the radius of the scene.",
     pointer_to<kDrawing, kSsao, &SsaoSettings::radius>,
     nullptr,
     {0.005f, 0.5f, "%.3f", true}},
    {"ssao_bias",
     0,
     "",
     "AO bias",
     "How much nearer a surface must be to count, as a share of that radius; hides acne on flat walls.",
     pointer_to<kDrawing, kSsao, &SsaoSettings::bias>,
     nullptr,
     {0, 0.2f}},
    {"ssao_intensity",
     0,
     "",
     "AO intensity",
     "Exponent of the occlusion: above 1 darker.",
     pointer_to<kDrawing, kSsao, &SsaoSettings::intensity>,
     nullptr,
     {0.25f, 4}},
    {"ssao_samples",
     0,
     "",
     "AO samples",
     "Depths that are read for each pixel.",
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
        throw prt::Error("there is no setting called '" + std::string(id) + "'");
    return *found;
}

void switch_setting(const SettingPointer& setting) {
    if (bool* const* value = std::get_if<bool*>(&setting))
        **value = !**value;
    else if (PictureKind* const* kind = std::get_if<PictureKind*>(&setting))
        **kind = next(**kind);
}

} // namespace viewer
