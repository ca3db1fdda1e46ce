// prt relight: writes vertex colors under one light.

#include "cli/commands/commands.h"

#include "bake/gltf/encode_glb.h"
#include "bake/gltf/vertex_fallback.h"
#include "bake/reference/light_meter.h"
#include "cli/arguments/light_arguments.h"
#include "cli/arguments/options.h"
#include "cli/arguments/view_arguments.h"
#include "cli/pipeline/lamp_strengths.h"
#include "cli/pipeline/loaded_light.h"
#include "cli/pipeline/relit_vertices.h"
#include "cli/pipeline/solid_materials.h"
#include "cli/program/outputs.h"
#include "cli/program/session.h"
#include "prt/core/error.h"
#include "runtime/core/support/stopwatch.h"

#include <fmt/core.h>
#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>

namespace prt::cli {
namespace {

enum class ColorKind {
    radiance, ///< for albedo 1
    albedo,   ///< radiance times base color
    unlit,    ///< with an exposure, for unlit materials
};
constexpr Choice<ColorKind> kColors[] = {
    {"radiance", ColorKind::radiance, "radiance of a surface with albedo 1; linear, float32"},
    {"albedo", ColorKind::albedo, "radiance times the base color of the surface; linear, float32"},
    {"unlit", ColorKind::unlit,
     "radiance times --exposure and existing vertex colors; 16 bits, clipped at 1\n"
     "  materials become unlit; for Blender and viewers\n"
     "  glass, emissive and unlit materials and vertex colors of their surfaces do not change"}};

struct RelightArguments {
    Path model, environment, output, json;
    SunCount suns = {std::nullopt};
    LampChoice lamps;
    int rays = 256; ///< for each vertex and sun
    LightOptions light_options;
    ColorKind colors = ColorKind::radiance;
    Exposure exposure; ///< for unlit colors
    ReadingOptions reading;
    int threads = 0;
};

/// Returns the base color of each vertex, the factor on radiance for albedo 1.
std::vector<glm::vec3> base_colors(const Surfaces& surfaces) {
    std::vector<glm::vec3> colors(surfaces.scene().receivers(), glm::vec3(1));
    const std::vector<float> areas = receiver_areas(surfaces.scene());
    for (std::uint32_t t = 0; t < surfaces.triangles(); ++t)
        for (int corner = 0; corner < 3; ++corner) {
            const std::uint32_t p = surfaces.corners(t)[corner];
            colors[p] = surfaces.base_color({t, glm::vec2(corner == 1, corner == 2), areas[p]});
        }
    return colors;
}

void check_model(const RelightArguments& a, const SceneFile& model) {
    if (!model.record())
        throw Error(a.model.string() + ": contains no transfer; run prt bake first");
    check_of_vertices(model, a.model, "relight writes vertex colors; use prt render");
    if (a.environment.empty() && layout_of(model).lamps() == 0)
        throw Error(a.model.string() + ": has no lamps; light it with --lights");
    if (suns_stay_in_sky(model)) {
        if (a.suns.count.value_or(0) > 0)
            throw Error(a.model.string() + ": " + kNoDirectTerm + ", or light it with --suns 0");
        print_notices(a.model.string(),
                      {"has no separate direct transfer: suns are part of the sky and have no "
                       "sharp shadows"});
    }
}

/// Mean over the surface.
glm::dvec3 mean_of(std::span<const glm::vec3> radiance, std::span<const float> areas) {
    glm::dvec3 sum(0);
    double area = 0;
    for (std::size_t p = 0; p < radiance.size(); ++p) {
        sum += static_cast<double>(areas[p]) * glm::dvec3(radiance[p]);
        area += static_cast<double>(areas[p]);
    }
    return area > 0 ? sum / area : glm::dvec3(0);
}

/// Factor on radiance. Automatic: the mean luminance of radiance times base color becomes that of pictures.
float choose_exposure(const Exposure& exposure, std::span<const glm::vec3> radiance,
                      std::span<const glm::vec3> base_colors, std::span<const float> areas) {
    double factor = std::exp2(exposure.stops);
    if (exposure.automatic) {
        std::vector<glm::vec3> shown(radiance.begin(), radiance.end());
        for (std::size_t p = 0; p < shown.size(); ++p)
            shown[p] *= base_colors[p];
        const double luminance = glm::dot(mean_of(shown, areas), glm::dvec3(0.2126, 0.7152, 0.0722));
        if (luminance > 0)
            factor *= static_cast<double>(exposure_for(static_cast<float>(luminance)));
    }
    return static_cast<float>(std::clamp(factor, 1e-30, 1e30)); // floats hold the product with radiance
}

/// Writes the radiance as colors of unlit materials, which multiply it by their base color.
void write_unlit_light(const RelightArguments& a, const Surfaces& surfaces,
                       std::span<const glm::vec3> radiance, SceneFile& model, Report& report) {
    const float exposure =
        choose_exposure(a.exposure, radiance, base_colors(surfaces), receiver_areas(model.scene));
    const std::size_t shown = write_unlit(model.document, model.scene, radiance, exposure);
    std::vector<float> brightest;
    for (const glm::vec3& color : radiance)
        brightest.push_back(exposure * std::max({color.r, color.g, color.b}));
    const auto clipped = std::ranges::count_if(brightest, [](float value) { return value > 1; });
    add_figures(report, {{"exposure_stops", std::log2(static_cast<double>(exposure))},
                         {"exposure_automatic", a.exposure.automatic},
                         {"unlit_primitives", shown},
                         {"clipped_vertices", clipped}});
    report.sentences.insert(report.sentences.begin() + 1,
                            fmt::format("unlit materials, exposure {{exposure_stops:+.2f}} stops{}: "
                                        "{{clipped_vertices}} vertices are clipped at 1",
                                        a.exposure.automatic ? " (auto)" : ""));
}

Report report_of(const RelightArguments& a, std::size_t suns, std::span<const glm::vec3> radiance,
                 std::span<const float> areas) {
    const glm::dvec3 mean = mean_of(radiance, areas);
    Report report;
    add_figures(report, {{"output", a.output.string()},
                         {"receivers", radiance.size()},
                         {"suns", suns},
                         {"mean_radiance", {mean.r, mean.g, mean.b}}});
    report.sentences = {
        fmt::format("{{output}}: radiance of {{receivers}} vertices{}, {{suns:#separate sun}}, mean "
                    "{{mean_radiance/0:.4g}} {{mean_radiance/1:.4g}} {{mean_radiance/2:.4g}}",
                    a.colors == ColorKind::albedo ? "" : " for albedo 1"),
        "{bytes_file} bytes on disk; {seconds:.2f} s"};
    return report;
}

void run(RelightArguments a, Session& session) {
    a.reading.outputs = check_outputs({{a.output, "--output", {".glb"}}, {a.json, "--json", {".json"}}},
                                      {a.model, a.environment, a.lamps.file});
    const Stopwatch stopwatch;
    SceneFile model = load_scene_file(a.model, a.reading);
    check_model(a, model);
    const SunCount suns = suns_stay_in_sky(model) ? SunCount{0} : a.suns;
    const LoadedLight light =
        a.environment.empty() ? dark_sky(model.order())
                              : load_light(a.environment, model.order(), suns, a.light_options, a.threads);
    const bool needs_colors =
        a.colors == ColorKind::albedo || (a.colors == ColorKind::unlit && a.exposure.automatic);
    std::vector<Texture> textures = about(a.model, [&] {
        return load_textures(model.scene, a.reading.bad_textures,
                             needs_colors ? TextureNeeds::all : TextureNeeds::shadows);
    });
    const std::vector<bool> solid = solid_materials(model.scene);
    ProgressBar bar = session.progress_bar("relighting");
    const bool suns_are_separate = !light.split.suns.empty() && layout_of(model).has(TermKind::direct);
    const Lighting lighting{light.sky, light_of_suns(light), lamp_strengths(a.lamps, layout_of(model))};
    std::vector<glm::vec3> radiance = lit_vertices(model, lighting, a.threads);
    // They need more memory than all later steps.
    model.baked.reset();
    model.compressed.reset();
    discard_transfer(model.document);
    discard_lobes(model.document);
    const TraceScene scene(model.scene, std::move(textures), {.solid = solid, .threads = a.threads});
    if (suns_are_separate)
        add_direct_suns(scene, light.split.suns, {.rays = a.rays, .threads = a.threads}, bar.progress(),
                        radiance);
    if (a.colors == ColorKind::albedo) {
        const std::vector<glm::vec3> colors = base_colors(scene.surfaces());
        for (std::size_t p = 0; p < radiance.size(); ++p)
            radiance[p] *= colors[p];
    }
    Report report = report_of(a, light.split.suns.size(), radiance, receiver_areas(model.scene));
    if (a.colors == ColorKind::unlit)
        write_unlit_light(a, scene.surfaces(), radiance, model, report);
    else
        write_vertex_colors(model.document, model.scene, radiance);
    const std::vector<std::byte> file = about(a.model, [&] { return encode_glb(model.document); });
    add_figures(report, {{"bytes_file", session.write(a.output, file)}, {"seconds", stopwatch.seconds()}});
    publish(report, a.json, session);
}

} // namespace

void add_relight(CLI::App& app, Session& session) {
    CLI::App* command =
        app.add_subcommand("relight", "Write the radiance of every vertex under a light as colors");
    auto& a = arguments_for<RelightArguments>(command, [command, &session](const RelightArguments& given) {
        if (command->count("--exposure") > 0 && given.colors != ColorKind::unlit)
            throw CLI::ValidationError("--exposure", "needs --colors unlit");
        check_light_options(*command, !given.environment.empty());
        run(given, session);
    });
    command
        ->add_option("model", a.model,
                     "model to light: output of prt bake, compress or make, without lightmap")
        ->required()
        ->check(named);
    add_light(command, a.environment);
    add_output(command, a.output,
               "write the model with light as vertex colors to this .glb\n"
               "existing vertex colors are replaced; with --colors unlit they are multiplied or kept\n"
               "the file contains no transfer of vertices; a volume remains\n"
               "levels of detail: only level 0 gets colors; coarser levels have neither light nor transfer");
    add_suns(command, a.suns,
             std::string("number of suns of --lights with sharp shadows, traced by rays\n"
                         "needs --lights\n"
                         "after prt compress --combine-direct: only 0, and auto acts as 0\n") +
                 kSunsOfLightFiles,
             "auto", &a.rays);
    command->get_option("--suns")->needs("--lights");
    add_lamps(command, a.lamps);
    choice(command, "--colors", a.colors, kColors, "values of the vertex colors, COLOR_0", "radiance");
    add_exposure(command, a.exposure);
    add_light_options(command, a.light_options);
    add_reading(command, a.reading);
    add_threads(command, a.threads);
    add_json(command, a.json);
}

} // namespace prt::cli
