#include "ui/commands.h"

#include "ui/controls.h"

#include "prt/support/error.h"

#include <algorithm>
#include <string>
#include <utility>

namespace viewer {
namespace {

/// The place that member pointers lead to, one after the other.
template <auto... members>
Place place(Settings& settings) {
    return &(settings.*....*members);
}

constexpr auto kDrawing = &Settings::drawing;
constexpr auto kSsao = &DrawSettings::ssao;

constexpr Command kCommands[] = {
    {.id = "left",
     .key = '1',
     .help = "left picture: the next",
     .label = "left",
     .tip = "What this side of the line shows. Keys 1 and 2 take the next.",
     .place = place<&Settings::left>},
    {.id = "right",
     .key = '2',
     .help = "right picture: the next",
     .label = "right",
     .tip = "What this side of the line shows. Keys 1 and 2 take the next.",
     .place = place<&Settings::right>},
    {.key = 'X',
     .help = "swap left and right",
     .press = [](Controls& c) { std::swap(c.viewer().settings.left, c.viewer().settings.right); }},
    {.id = "difference",
     .key = 'D',
     .help = "difference of the two",
     .label = "difference",
     .tip = "How far the two pictures are apart, as heat, with its figure. Key D.",
     .place = place<&Settings::difference>},
    {.id = "wireframe",
     .key = 'W',
     .help = "wireframe",
     .label = "wireframe",
     .tip = "The triangles over both pictures. Key W.",
     .place = place<kDrawing, &DrawSettings::wireframe>},
    {.id = "lobe",
     .key = 'L',
     .help = "lobe of the transfer vector under the pointer",
     .label = "lobe",
     .tip = "The transfer vector of the vertex under the pointer: red adds light, blue takes it. Key L.",
     .place = place<&Settings::lobe>},
    {.id = "deferred",
     .key = 'G',
     .help = "forward or deferred",
     .label = "deferred",
     .tip = "Through a G-buffer, as many games draw. Key G.",
     .place = place<kDrawing, &DrawSettings::deferred>},
    {.id = "culling",
     .key = 'C',
     .help = "culling outside the view",
     .label = "culling",
     .tip = "Leaves out clusters of triangles outside the view. Key C.",
     .place = place<kDrawing, &DrawSettings::culling>},
    {.id = "background",
     .key = 'B',
     .help = "background",
     .label = "background",
     .tip = "The sky behind the model. Key B.",
     .place = place<kDrawing, &DrawSettings::background>},
    {.id = "textured",
     .key = 'T',
     .help = "base colour",
     .label = "base colour",
     .tip = "Textures and colours; off shows light alone. Key T.",
     .place = place<kDrawing, &DrawSettings::textured>},
    {.key = 'N',
     .help = "day instead of the environment",
     .press = [](Controls& c) { c.viewer().lights.day = !c.viewer().lights.day; }},
    {.key = ' ',
     .help = "let the day run",
     .label = "let the day run",
     .tip = "An hour a second. Space.",
     .place = place<&Settings::day_runs>},
    {.id = "samples",
     .key = 'A',
     .help = "samples per pixel: 1, 4",
     .place = place<kDrawing, &DrawSettings::samples>,
     .press =
         [](Controls& c) {
             int& samples = c.viewer().settings.drawing.samples;
             samples = samples == 1 ? 2 : 1;
         }},
    {.key = '[', .help = "darker", .press = [](Controls& c) { c.viewer().settings.exposure_stops -= 0.25f; }},
    {.key = ']',
     .help = "brighter",
     .press = [](Controls& c) { c.viewer().settings.exposure_stops += 0.25f; }},
    {.key = 'R',
     .help = "reset the camera: the whole model",
     .press = [](Controls& c) { c.viewer().reset_camera(); }},
    {.key = 'P',
     .help = "screenshot",
     .press =
         [](Controls& c) {
             if (c.screenshot)
                 c.screenshot();
         }},
    {.key = 'S', .help = "save the compressed model", .press = [](Controls& c) { c.viewer().save(); }},
    {.key = 'Q',
     .help = "quit",
     .press =
         [](Controls& c) {
             if (c.quit)
                 c.quit();
         }},
    {.id = "help", .key = 'H', .help = "this help; Tab hides the panels", .place = place<&Settings::help>},
    {.id = "panels", .key = '\t', .place = place<&Settings::panels>},
    {.id = "split", .place = place<&Settings::split>},
    {.id = "white",
     .label = "white",
     .tip = "The difference that is shown white, over the mean radiance of the right picture.",
     .place = place<&Settings::white>,
     .range = {0.01f, 2, "%.2f of the mean", true}},
    {.id = "dithered",
     .label = "dithered AO",
     .tip = "Hides the steps of five bits of occlusion in the G-buffer.",
     .place = place<kDrawing, &DrawSettings::dithered>},
    {.id = "exposure_stops",
     .label = "exposure",
     .tip = "Brighter or darker than what is metered on the model. Keys [ and ].",
     .place = place<&Settings::exposure_stops>,
     .range = {-6, 6, "%+.2f stops"}},
    {.id = "ssao_radius",
     .label = "AO radius",
     .tip = "How far screen-space occlusion looks, as a share of the radius of the scene.",
     .place = place<kDrawing, kSsao, &SsaoSettings::radius>,
     .range = {0.005f, 0.5f, "%.3f", true}},
    {.id = "ssao_bias",
     .label = "AO bias",
     .tip =
         "How much nearer a surface must be to count, as a share of that radius; hides acne on flat walls.",
     .place = place<kDrawing, kSsao, &SsaoSettings::bias>,
     .range = {0, 0.2f}},
    {.id = "ssao_intensity",
     .label = "AO intensity",
     .tip = "Exponent of the occlusion: above 1 darker.",
     .place = place<kDrawing, kSsao, &SsaoSettings::intensity>,
     .range = {0.25f, 4}},
    {.id = "ssao_samples",
     .label = "AO samples",
     .tip = "Depths that are read for each pixel.",
     .place = place<kDrawing, kSsao, &SsaoSettings::samples>,
     .range = {2, 64}},
};

} // namespace

std::span<const Command> commands() {
    return kCommands;
}

const Command& setting(std::string_view id) {
    const auto found = std::ranges::find_if(
        kCommands, [&](const Command& command) { return command.place && command.id == id; });
    if (found == std::end(kCommands) || id.empty())
        throw prt::Error("there is no setting called '" + std::string(id) + "'");
    return *found;
}

void switch_setting(const Place& place) {
    if (bool* const* value = std::get_if<bool*>(&place))
        **value = !**value;
    else if (PictureKind* const* kind = std::get_if<PictureKind*>(&place))
        **kind = next(**kind);
}

} // namespace viewer
