#include "commands.h"

#include "evaluation_lights.h"
#include "html_report.h"
#include "inputs.h"
#include "prt/error.h"
#include "prt/error_measures.h"
#include "prt/file.h"
#include "prt/ray_renderer.h"
#include "prt/receiver_colors.h"
#include "report.h"
#include "residual_vq.h"
#include "sweep_report.h"

#include <fmt/core.h>
#include <glm/geometric.hpp>

#include <algorithm>
#include <filesystem>

namespace prt::cli {
namespace {

/// The file that is measured: compressed, or another bake.
struct Candidate {
    const Model& model;
    Transfer transfer; ///< decoded
    std::optional<std::span<const std::uint16_t>> clusters;

    /// Exit radiance by the road that a game takes.
    std::vector<glm::vec3> radiance(const Light& light, int threads) const {
        return model.compressed ? exit_radiance(model.compressed->transfer, light, threads)
                                : exit_radiance(transfer, light, threads);
    }
};

Candidate candidate(const Model& model, const Path& path) {
    if (model.compressed)
        return {model, decode(model.compressed->transfer), model.compressed->transfer.receivers.clusters};
    if (model.baked)
        return {model, model.baked->transfer, std::nullopt};
    throw Error(path.string() + ": holds no transfer; run prt bake and prt compress first");
}

/// Sums what each cluster contributes, light by light.
class ClusterShares {
public:
    explicit ClusterShares(std::size_t clusters) : shares_(clusters), norms_(clusters, 0) {}

    void add(std::span<const std::uint16_t> clusters, std::span<const float> areas,
             std::span<const glm::vec3> reference, std::span<const glm::vec3> shipped) {
        for (std::size_t p = 0; p < clusters.size(); ++p) {
            const double a = static_cast<double>(areas[p]);
            const glm::dvec3 r(reference[p]), d = r - glm::dvec3(shipped[p]);
            shares_[clusters[p]].error_share += a * glm::dot(d, d);
            norms_[clusters[p]] += a * glm::dot(r, r);
        }
    }

    std::vector<ClusterShare> finish(const ClusteredTransfer& transfer, std::span<const float> areas) {
        double area = 0, error = 0;
        for (std::size_t p = 0; p < areas.size(); ++p) {
            ClusterShare& share = shares_[transfer.receivers.clusters[p]];
            ++share.receivers;
            share.area_share += static_cast<double>(areas[p]);
            area += static_cast<double>(areas[p]);
        }
        for (const ClusterShare& share : shares_)
            error += share.error_share;
        for (std::size_t k = 0; k < shares_.size(); ++k) {
            ClusterShare& share = shares_[k];
            share.cluster = k;
            share.components = transfer.bases.components[k];
            share.lit_rms = norms_[k] > 0 ? std::sqrt(share.error_share / norms_[k]) : 0;
            share.area_share /= area > 0 ? area : 1;
            share.error_share /= error > 0 ? error : 1;
        }
        std::stable_sort(shares_.begin(), shares_.end(), [](const ClusterShare& a, const ClusterShare& b) {
            return a.error_share > b.error_share;
        });
        return std::move(shares_);
    }

private:
    std::vector<ClusterShare> shares_;
    std::vector<double> norms_;
};

void print_lights(const Evaluation& evaluation) {
    fmt::print("  {:<28} {:>9} {:>9} {:>9} {:>9} {:>9} {:>9} {:>9}\n", "light", "lit_rms", "lit_max",
               "99.9 %", "darker", "seam", "seam99", "inner99");
    for (const auto& [name, e] : evaluation.lights)
        fmt::print("  {:<28} {:>7.4f} % {:>7.3f} % {:>7.3f} % {:>7.3f} % {:>7.3f} % {:>7.3f} % {:>7.3f} %\n",
                   name, 100 * e.rms, 100 * e.max, 100 * e.percentile_999, 100 * e.darker_half_rms,
                   100 * e.crossing.max, 100 * e.crossing.percentile_99, 100 * e.inner.percentile_99);
}

Json jumps_json(const EdgeJumps& jumps, const Scene& scene) {
    const auto position = [&](std::uint32_t receiver) {
        for (const VertexArray& vertices : scene.vertex_arrays)
            if (receiver >= vertices.first_receiver && receiver < vertices.first_receiver + vertices.size())
                return scene.world(vertices.positions[receiver - vertices.first_receiver]);
        return scene.origin;
    };
    Json json = {{"edges", jumps.edges},
                 {"rms", jumps.rms},
                 {"percentile_99", jumps.percentile_99},
                 {"max", jumps.max}};
    if (jumps.edges > 0) {
        const glm::dvec3 place = position(jumps.worst.first);
        json["worst_receivers"] = {jumps.worst.first, jumps.worst.second};
        json["worst_place_metres"] = {place.x, place.y, place.z};
    }
    return json;
}

Json evaluation_json(const Evaluation& evaluation, const Scene& scene) {
    Json lights = Json::array(), clusters = Json::array();
    for (const auto& [name, error] : evaluation.lights)
        lights.push_back({{"light", name},
                          {"lit_rms", error.rms},
                          {"lit_max", error.max},
                          {"percentile_999", error.percentile_999},
                          {"darker_half_rms", error.darker_half_rms},
                          {"seam", error.crossing.max},
                          {"crossing_edges", jumps_json(error.crossing, scene)},
                          {"inner_edges", jumps_json(error.inner, scene)},
                          {"mean_radiance", error.mean}});
    for (const ClusterShare& c : evaluation.clusters)
        clusters.push_back({{"cluster", c.cluster},
                            {"receivers", c.receivers},
                            {"components", c.components},
                            {"area_share", c.area_share},
                            {"squared_error_share", c.error_share},
                            {"lit_rms", c.lit_rms}});
    Json json = {{"baked", evaluation.baked}, {"shipped", evaluation.shipped}};
    json["relative_l2"] = evaluation.relative_l2;
    json["lights"] = lights;
    json["worst_directional_light"] = evaluation.worst_light;
    json["clusters"] = clusters;
    return json;
}

std::vector<std::byte> picture_png(const Model& model, std::span<const glm::vec3> colors, int threads) {
    constexpr int kWidth = 800, kHeight = 500, kSamples = 2;
    Picture picture;
    picture.scene = &model.scene;
    picture.radiance = colors;
    picture.textured = false;
    picture.camera = automatic_camera(model.scene, static_cast<float>(kWidth) / kHeight, 0.6f);
    picture.width = kWidth;
    picture.height = kHeight;
    picture.samples = kSamples;
    const Image image = render_rays(picture, RayScene(model.scene, threads), threads);
    return encode_png(kWidth, kHeight, tone_mapped(image, kSamples, 1.0f, ToneMap::srgb));
}

/// Measures the shipped file under all lights.
void measure(const EvaluateArguments& a, Model& baked, const std::vector<LoadedLight>& lights,
             Evaluation& evaluation) {
    const Model model = load_model(a.shipped);
    const Candidate shipped = candidate(model, a.shipped);
    check_belong_together(baked, a.baked, model, a.shipped);
    put_in_order_of(model.scene, baked);
    const Transfer& reference = baked.baked->transfer;
    const std::vector<float> areas = receiver_areas(baked.scene);
    const std::vector<Edge> edges = mesh_edges(baked.scene);
    evaluation.relative_l2 = relative_l2(reference, shipped.transfer, areas);

    ClusterShares shares(model.compressed ? model.compressed->transfer.bases.clusters() : 0);
    const auto error_under = [&](const Light& light, bool shared) {
        const auto wanted = exit_radiance(reference, light, a.threads),
                   lit = shipped.radiance(light, a.threads);
        if (shared && shipped.clusters)
            shares.add(*shipped.clusters, areas, wanted, lit);
        return lit_error(wanted, lit, areas, edges, shipped.clusters);
    };
    for (const LoadedLight& light : lights)
        evaluation.lights.emplace_back(light.name, error_under(light.light, true));
    const DirectionalLights suns = directional_lights(reference.order);
    LitError worst;
    for (std::size_t i = 0; i < suns.lights.size(); ++i) {
        const LitError error = error_under(suns.lights[i], false);
        if (error.rms < worst.rms)
            continue;
        worst = error;
        const glm::vec3& d = suns.directions[i];
        evaluation.worst_light = fmt::format("from ({:.2f}, {:.2f}, {:.2f})", d.x, d.y, d.z);
    }
    evaluation.lights.emplace_back(fmt::format("worst of {} suns", suns.lights.size()), worst);
    evaluation.lights.emplace_back("random white", error_under(random_white_light(reference.order), false));

    if (model.compressed) {
        const ClusteredTransfer& t = model.compressed->transfer;
        evaluation.clusters = shares.finish(t, areas);
        evaluation.facts.insert(
            evaluation.facts.end(),
            {{"bytes of the file, shipped", fmt::format("{}", std::filesystem::file_size(a.shipped))},
             {"bytes per vertex, shipped", fmt::format("{}", bytes_per_receiver(t))},
             {"bytes of bases", fmt::format("{}", basis_bytes(t.bases))},
             {"clusters", fmt::format("{}", t.bases.clusters())},
             {"components, at most", fmt::format("{}", t.bases.max_components())}});
    }
    if (!a.html.empty()) {
        if (model.compressed)
            evaluation.pictures.emplace_back(
                "Clusters", picture_png(model, cluster_colors(model.compressed->transfer), a.threads));
        const Light& light = lights.front().light;
        const auto errors = error_colors(exit_radiance(baked.baked->transfer, light, a.threads),
                                         shipped.radiance(light, a.threads), receiver_areas(model.scene));
        evaluation.pictures.emplace_back(fmt::format("Error under {} (white: {:.0f} % of the mean radiance)",
                                                     lights.front().name, 100 * kWhiteError),
                                         picture_png(model, errors, a.threads));
    }
}

Sweep run_sweep(const EvaluateArguments& a, const Model& baked, const std::vector<LoadedLight>& lights,
                Interrupt& interrupt) {
    std::vector<Light> all;
    for (const LoadedLight& light : lights)
        all.push_back(light.light);
    CompressOptions options;
    options.threads = a.threads;
    ProgressBar bar("sweeping", interrupt.token());
    const Transfer& transfer = baked.baked->transfer;
    return sweep(transfer, receiver_areas(baked.scene), mesh_edges(baked.scene), all, options,
                 residual_vq_candidates(transfer, options.seed), bar.progress());
}

} // namespace

void run(const EvaluateArguments& a, Interrupt& interrupt) {
    Model baked = load_model(a.baked);
    if (!baked.baked)
        throw Error(a.baked.string() + ": holds no raw transfer; the first file is the output of prt bake");
    const Transfer& reference = baked.baked->transfer;
    std::vector<LoadedLight> lights;
    for (const Path& path : a.lights)
        for (LoadedLight& light :
             rotations(load_light(path, reference.order, a.light_options, a.threads), a.rotations))
            lights.push_back(std::move(light));
    if (lights.empty())
        lights = default_lights(reference.order);

    Evaluation evaluation;
    evaluation.baked = a.baked.string();
    evaluation.shipped = a.shipped.string();
    evaluation.facts = {{"receivers", fmt::format("{}", reference.receivers())},
                        {"order", fmt::format("{}", reference.order)},
                        {"channels", fmt::format("{}", reference.channels)},
                        {"bytes per vertex, bake", fmt::format("{}", reference.dimension() * sizeof(float))},
                        {"bytes of the file, bake", fmt::format("{}", std::filesystem::file_size(a.baked))}};
    if (!a.shipped.empty()) {
        measure(a, baked, lights, evaluation);
        fmt::print("{} against {}: relative L2 {:.4f} %\n", evaluation.shipped, evaluation.baked,
                   100 * evaluation.relative_l2);
        print_lights(evaluation);
    }
    if (a.sweep) {
        evaluation.sweep = run_sweep(a, baked, lights, interrupt);
        print_sweep(*evaluation.sweep);
    }
    Json json = evaluation_json(evaluation, baked.scene);
    json["receivers"] = reference.receivers();
    json["order"] = reference.order;
    if (evaluation.sweep)
        json["sweep"] = sweep_json(*evaluation.sweep);
    write_json(json, a.json, interrupt);
    if (!a.html.empty()) {
        const Interrupt::WritingScope writing(interrupt);
        OutputFile page(a.html);
        page.write(html_report(evaluation));
        page.commit();
    }
}

} // namespace prt::cli
