#include "commands.h"

#include "html_report.h"
#include "inputs.h"
#include "prt/error.h"
#include "prt/error_measures.h"
#include "prt/file.h"
#include "report.h"

#include <fmt/core.h>

#include <filesystem>

namespace prt::cli {
namespace {

/// The file that is measured: compressed, or another bake.
struct Candidate {
    Transfer transfer; ///< decoded
    std::optional<std::span<const std::uint16_t>> clusters;
};

Candidate candidate(const Model& model, const Path& path) {
    if (model.compressed)
        return {decode(model.compressed->transfer), model.compressed->transfer.receivers.clusters};
    if (model.baked)
        return {model.baked->transfer, std::nullopt};
    throw Error(path.string() + ": holds no transfer; run prt bake and prt compress first");
}

/// Exit radiance of the measured file, by the road that a game takes.
std::vector<glm::vec3> shipped_radiance(const Model& model, const Candidate& shipped, const Light& light,
                                        int threads) {
    return model.compressed ? exit_radiance(model.compressed->transfer, light, threads)
                            : exit_radiance(shipped.transfer, light, threads);
}

} // namespace

void run(const EvaluateArguments& a, Interrupt& interrupt) {
    const Model baked = load_model(a.baked);
    if (!baked.baked)
        throw Error(a.baked.string() + ": holds no raw transfer; the first file is the output of prt bake");
    const Model model = load_model(a.shipped);
    const Candidate shipped = candidate(model, a.shipped);
    check_belong_together(baked, a.baked, model, a.shipped);

    const Transfer& reference = baked.baked->transfer;
    std::vector<LoadedLight> lights;
    for (const Path& path : a.lights)
        lights.push_back(load_light(path, reference.order, a.light_options, a.threads));
    if (lights.empty())
        lights = default_lights(reference.order);

    const std::vector<float> areas = receiver_areas(baked.scene);
    Evaluation evaluation{
        a.baked.string(), a.shipped.string(), relative_l2(reference, shipped.transfer, areas), {}, {}};
    for (const LoadedLight& light : lights)
        evaluation.lights.push_back(
            {light.name, lit_error(exit_radiance(reference, light.light, a.threads),
                                   shipped_radiance(model, shipped, light.light, a.threads), areas,
                                   baked.scene, shipped.clusters)});
    evaluation.facts = {
        {"receivers", fmt::format("{}", reference.receivers())},
        {"order", fmt::format("{}", reference.order)},
        {"channels", fmt::format("{}", reference.channels)},
        {"bytes per vertex, bake", fmt::format("{}", reference.dimension() * sizeof(float))},
        {"bytes of the file, bake", fmt::format("{}", std::filesystem::file_size(a.baked))},
        {"bytes of the file, shipped", fmt::format("{}", std::filesystem::file_size(a.shipped))}};
    if (model.compressed) {
        const ClusteredTransfer& t = model.compressed->transfer;
        evaluation.facts.insert(evaluation.facts.end(),
                                {{"bytes per vertex, shipped", fmt::format("{}", bytes_per_receiver(t))},
                                 {"bytes of bases", fmt::format("{}", basis_bytes(t.bases))},
                                 {"clusters", fmt::format("{}", t.bases.clusters())},
                                 {"components", fmt::format("{}", t.bases.max_components())}});
    }

    fmt::print("{} against {}: relative L2 {:.4f} %\n", a.shipped.string(), a.baked.string(),
               100 * evaluation.relative_l2);
    fmt::print("  {:<28} {:>10} {:>10} {:>10}\n", "light", "lit_rms", "lit_max", "seam");
    Json light_reports = Json::array();
    for (const auto& [name, error] : evaluation.lights) {
        fmt::print("  {:<28} {:>8.4f} % {:>8.3f} % {:>8.3f} %\n", name, 100 * error.rms, 100 * error.max,
                   100 * error.seam);
        light_reports.push_back({{"light", name},
                                 {"lit_rms", error.rms},
                                 {"lit_max", error.max},
                                 {"seam", error.seam},
                                 {"mean_radiance", error.mean}});
    }
    write_json({{"baked", a.baked.string()},
                {"shipped", a.shipped.string()},
                {"receivers", reference.receivers()},
                {"order", reference.order},
                {"relative_l2", evaluation.relative_l2},
                {"lights", light_reports}},
               a.json, interrupt);
    if (!a.html.empty()) {
        const Interrupt::WritingScope writing(interrupt);
        OutputFile page(a.html);
        page.write(html_report(evaluation));
        page.commit();
    }
}

} // namespace prt::cli
