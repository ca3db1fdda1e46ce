// Measures the errors of a file against its bake under several lights.

#include "cli/pipeline/comparison.h"

#include "bake/pipeline/sun_radiance.h"
#include "bake/reference/ray_renderer.h"
#include "cli/pipeline/cluster_shares.h"
#include "cli/pipeline/evaluation_lights.h"
#include "cli/pipeline/instance_errors.h"
#include "cli/pipeline/solid_materials.h"
#include "cli/report/verdict.h"
#include "compress/study/receiver_colors.h"
#include "prt/core/dering.h"
#include "prt/core/error.h"
#include "prt/core/error_measures.h"
#include "prt/render/lightmap_file.h"
#include "prt/render/tone_map.h"
#include "runtime/core/support/printable.h"
#include "runtime/load/mesh_edges.h"

#include <fmt/core.h>
#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>

namespace prt::pipeline {
namespace {

/// The measured file: compressed, or another bake.
struct Candidate {
    const SceneFile& model;
    Transfer transfer; ///< decoded
    std::optional<std::vector<std::uint16_t>> clusters;

    /// Returns exit radiance, computed as a game does.
    std::vector<glm::vec3> radiance(const Lighting& lighting, int threads) const {
        return model.compressed ? exit_radiance(model.compressed->transfer, lighting, threads)
                                : exit_radiance(transfer, lighting, threads);
    }
};

Candidate candidate(const SceneFile& model, const Path& path) {
    if (model.compressed)
        return {model, decode(model.compressed->transfer),
                model.compressed->transfer.receivers.cluster_indices()};
    if (model.baked)
        return {model, model.baked->transfer, std::nullopt};
    throw Error(path.string() + ": contains no transfer; run prt bake and prt compress first");
}

/// Error under one lighting.
struct NamedError {
    std::string name;
    LitError error;
    std::size_t suns = 0; ///< number of separate suns
    bool judged = false;  ///< counts for the verdict
};

/// Errors under the named lights and under the standard lights.
struct Evaluation {
    std::vector<NamedError> named, standard;
    std::string worst_sun; ///< direction of the worst sun
    std::vector<ClusterShare> clusters;
    double relative_l2 = 0;
};

/// Returns the texel and its map.
std::string position_of(const LightmapOfFile& lightmap, std::uint32_t receiver) {
    const std::vector<std::size_t> first = lightmap.layout.first_texels();
    const std::size_t texel = lightmap.texels[receiver];
    const auto map = static_cast<std::size_t>(std::ranges::upper_bound(first, texel) - first.begin()) - 1;
    const auto width = static_cast<std::size_t>(lightmap.layout.maps[map].width);
    return fmt::format("map {} texel {} {}", map, (texel - first[map]) % width, (texel - first[map]) / width);
}

/// Returns the position of a receiver in the world, metres.
std::string position_of(const SceneFile& baked, std::uint32_t receiver) {
    if (baked.lightmap)
        return position_of(*baked.lightmap, receiver);
    const Scene& scene = baked.scene;
    for (const VertexArray& vertices : scene.vertex_arrays)
        if (receiver >= vertices.first_receiver && receiver < vertices.first_receiver + vertices.size()) {
            const glm::dvec3 p = scene.world(vertices.positions[receiver - vertices.first_receiver]);
            return fmt::format("{:.4g} {:.4g} {:.4g}", p.x, p.y, p.z);
        }
    return {};
}

std::string about_lights(const Evaluation& evaluation) {
    const bool separate = std::any_of(evaluation.named.begin(), evaluation.named.end(),
                                      [](const NamedError& e) { return e.suns > 0; });
    const bool lamps = std::any_of(evaluation.standard.begin(), evaluation.standard.end(),
                                   [](const NamedError& e) { return e.judged; });
    return "lit_rms: relative L2 of exit radiance for albedo 1. lit_max and 99.9 %: maximum and 99.9th "
           "percentile of the errors of receivers. Darker half: relative L2 over the darker half of the "
           "area. Contrast error, 95 %: error relative to the radiance at the point plus a tenth of the "
           "logarithmic mean of all; 95 % of the area have less. Jumps, 99 %: jump of this error along an "
           "edge; 99 % of all edges have less. Largest seam: largest jump of the error along an edge "
           "between two clusters. Seams and inner, 99 %: 99th percentile of the jumps along edges between "
           "clusters and inside clusters. lit_max, 99.9 %, all seams and inner are relative to the mean "
           "radiance. Worst sun: the sun with the largest error among 64 over the whole sphere; its errors "
           "are relative to the radiance of all 64, because a sun may light nothing. Its direction is " +
           evaluation.worst_sun +
           ". Random white: random coefficients of equal variance; errors are relative to the root mean "
           "square of the radiance." +
           (separate
                ? " Separate suns: light without the direct light of suns, which the renderer adds with "
                  "sharp shadows; errors are relative to the radiance under the complete light. The verdict "
                  "uses these rows."
                : "") +
           (lamps ? " Lamps: all lamps at the strengths of the scene, without a sky; then each lamp alone. "
                    "Lamps are off under skies."
                  : "");
}

/// Returns null if the light that an error is relative to is zero.
Json finite(double value) {
    return std::isfinite(value) ? Json(value) : Json();
}

Table lights_table(const Evaluation& evaluation, const SceneFile& baked) {
    Table table{"lights", "Errors by light", about_lights(evaluation), {}, {}};
    const Unit share = Unit::percent;
    table.columns = {{"light", "light"},
                     {"lit_rms", "lit_rms", share},
                     {"lit_max", "lit_max", share, 2},
                     {"percentile_999", "99.9 %", share, 2},
                     {"darker_half_rms", "darker half", share},
                     {"visible_percentile_95", "contrast error, 95 %", share, 2},
                     {"visible_jumps_99", "jumps, 99 %", share, 2},
                     {"seam", "largest seam", share, 2},
                     {"crossing_percentile_99", "seams, 99 %", share, 2},
                     {"inner_percentile_99", "inner, 99 %", share, 2},
                     {"mean_radiance", "mean radiance"}};
    for (const char* key :
         {"crossing_edges", "crossing_rms", "seam_position_metres", "inner_edges", "inner_rms", "inner_max",
          "separate_suns", "in_verdict", "visible_mean", "visible_percentile_99", "visible_above_5_percent"})
        table.columns.push_back({key});
    for (const auto* lights : {&evaluation.named, &evaluation.standard})
        for (const auto& [name, e, suns, judged] : *lights)
            table.rows.push_back(
                {name,
                 e.rms,
                 e.max,
                 e.percentile_999,
                 finite(e.darker_half_rms),
                 finite(e.visible.percentile_95),
                 finite(e.visible.jumps_99),
                 e.crossing.max,
                 e.crossing.percentile_99,
                 e.inner.percentile_99,
                 e.mean,
                 e.crossing.edges,
                 e.crossing.rms,
                 e.crossing.edges > 0 ? Json(position_of(baked, e.crossing.worst.first)) : Json(),
                 e.inner.edges,
                 e.inner.rms,
                 e.inner.max,
                 suns,
                 judged,
                 finite(e.visible.mean),
                 finite(e.visible.percentile_99),
                 e.visible.area_above_5_percent});
    return table;
}

Table clusters_table(const Evaluation& evaluation) {
    Table table{"clusters", "Clusters with the largest errors", "", {}, {}};
    table.columns = {{"cluster", "cluster"},
                     {"receivers", "vertices"},
                     {"components", "components"},
                     {"area_share", "share of the area", Unit::percent, 2},
                     {"squared_error_share", "share of the squared error", Unit::percent, 2},
                     {"lit_rms", "lit_rms", Unit::percent}};
    for (const ClusterShare& c : evaluation.clusters)
        table.rows.push_back({c.cluster, c.receivers, c.components, c.area_share, c.error_share, c.lit_rms});
    table.max_shown = 8;
    return table;
}

/// A shipped file held against its bake.
class Comparison {
public:
    Comparison(const ComparisonOptions& a, SceneFile& baked)
        : a_(a), baked_(baked), model_(load_scene_file(a.shipped, a.reading)),
          shipped_(candidate(matched(model_, baked, a), a.shipped.path)) {
        about(a_.shipped.path, [&] { put_in_order_of(model_.scene, baked); });
        areas_ = baked.lightmap ? baked.lightmap->areas : receiver_areas(baked.scene);
        edges_ = baked.lightmap ? baked.lightmap->edges : mesh_edges(baked.scene);
    }

    Evaluation measure(const std::vector<LoadedLight>& lights) const {
        Evaluation evaluation;
        evaluation.relative_l2 = relative_l2(reference(), shipped_.transfer, areas_);
        if (!std::isfinite(evaluation.relative_l2))
            throw Error(a_.baked.string() + ": all transfer is zero, but that of " + a_.shipped.string() +
                        " is not; no relative error exists");
        ClusterShares shares(model_.compressed ? model_.compressed->transfer.bases.clusters() : 0);
        for (const LoadedLight& light : lights) {
            add_named(light, evaluation);
            if (shipped_.clusters)
                shares.add(*shipped_.clusters, areas_, wanted_under(judged(light)),
                           shipped_under(judged(light)));
        }
        add_worst_sun(evaluation);
        // Half of the radiance under random light is negative, and its mean is useless as a divisor.
        const Lighting random{random_white_light(reference().layout.order)};
        const double square = lit_scale(wanted_under(random), areas_).mean_square;
        add_lamps(evaluation);
        evaluation.standard.push_back(
            {"random white", error_under(random, LitScale{square, std::sqrt(square / 3)})});
        if (model_.compressed)
            evaluation.clusters = shares.finish(model_.compressed->transfer, areas_);
        return evaluation;
    }

    void add_sizes(Report& report) const {
        add_figure(report, {"bytes_file_shipped", "file size of the shipped file, bytes"},
                   static_cast<std::size_t>(a_.shipped.size()));
        if (!model_.compressed)
            return;
        const ClusteredTransfer& t = model_.compressed->transfer;
        const double with_bases =
            static_cast<double>(bytes_per_receiver(t)) +
            static_cast<double>(basis_bytes(t.bases)) / static_cast<double>(t.receivers.size());
        add_figure(report, {"bytes_bound_per_vertex", "bytes of attributes per vertex"},
                   bytes_per_receiver(t));
        add_figure(report, {"bytes_bound_per_vertex_with_bases", "bytes per vertex, bases included"},
                   with_bases);
        add_figure(report, {"bits_used_per_vertex", "used bits per vertex"}, bits_per_receiver(t));
        add_figure(report, {"bytes_bases", "bytes of bases"}, basis_bytes(t.bases));
        add_figure(report, {"clusters", "clusters"}, t.bases.clusters());
        add_figure(report, {"components_max", "maximum number of components"}, t.bases.max_components());
    }

    /// Adds errors of instances that share transfer, each over its vertices, under the lighting of the
    /// verdict.
    void add_instances(const std::vector<LoadedLight>& lights, Report& report) const {
        if (!model_.instanced)
            return;
        std::vector<std::vector<double>> errors;
        for (const LoadedLight& light : lights)
            errors.push_back(instance_errors(*model_.instanced, model_.scene, areas_,
                                             wanted_under(judged(light)), shipped_under(judged(light)),
                                             wanted_under({light.combined})));
        report.tables.push_back(instances_table(lights, errors));
    }

    Verdict verdict(const Evaluation& evaluation) const {
        Verdict v;
        std::size_t lights = 0;
        bool separate = false;
        for (const auto* rows : {&evaluation.named, &evaluation.standard})
            for (const auto& [name, error, suns, judged] : *rows) {
                if (!judged)
                    continue;
                ++lights;
                separate = separate || suns > 0;
                v.under = name;
                v.lit_rms = std::max(v.lit_rms, error.rms);
                if (v.visible_under.empty() || error.visible.percentile_95 > v.visible) {
                    v.visible = error.visible.percentile_95;
                    v.visible_under = name;
                }
                if (v.jumps_under.empty() || error.visible.jumps_99 > v.jumps) {
                    v.jumps = error.visible.jumps_99;
                    v.jumps_under = name;
                }
                const EdgeJumps& seams = error.visible.seams;
                v.seam_99 = std::max(v.seam_99, seams.percentile_99);
                if (seams.edges > 0 && seams.max > v.seam.value_or(-1)) {
                    v.seam = seams.max;
                    v.seam_at = position_of(baked_, seams.worst.first);
                }
            }
        if (lights > 1)
            v.under = fmt::format("these {} lights{}", lights, separate ? ", separate suns" : "");
        if (model_.compressed)
            v.bytes_per_vertex = bytes_per_receiver(model_.compressed->transfer);
        return v;
    }

    /// Adds pictures lit by the bake and by the shipped file, as `prt render` lights them, at one exposure
    /// and without textures, which would hide errors; then the error as in the figures, and clusters.
    void add_pictures(const LoadedLight& light, Report& report) const {
        const TraceScene scene(model_.scene,
                               about(a_.shipped.path,
                                     [&] {
                                         return load_textures(model_.scene, a_.reading.bad_textures,
                                                              TextureNeeds::visibility);
                                     }),
                               {.solid = solid_materials(baked_.scene), .threads = a_.threads});
        const Lighting lighting = judged(light);
        Lighting drawn = lighting;
        drawn.sky = deringed(drawn.sky);
        const std::span<const Sun> suns = separate_suns(light) ? light.split.suns : std::span<const Sun>();
        const auto before = wanted_under(drawn);
        const float exposure =
            exposure_of(before, sun_radiance(scene, suns, {.rays = 16, .threads = a_.threads}));
        const auto add = [&](std::string title, std::span<const glm::vec3> colors, float exposed,
                             std::span<const Sun> by = {}) {
            report.pictures.push_back({std::move(title), picture(scene, colors, by, exposed)});
        };
        add("Bake, under " + light.name, before, exposure, suns);
        add("Shipped file", shipped_under(drawn), exposure, suns);
        const auto wanted = wanted_under(lighting), lit = shipped_under(lighting);
        add(fmt::format("Contrast error (white: {:.0f} %)", 100 * kWhiteError),
            error_colors(wanted, lit, areas_), 1);
        if (model_.compressed)
            add("Clusters", cluster_colors(model_.compressed->transfer), 1);
    }

private:
    /// Reduces `model` to the receivers of `baked`, because compression fills texels outside surfaces.
    static const SceneFile& matched(SceneFile& model, const SceneFile& baked, const ComparisonOptions& a) {
        check_belong_together(baked, a.baked, model, a.shipped.path);
        if (baked.lightmap && model.compressed)
            model.compressed->transfer = gather_texels(model.compressed->transfer, baked.lightmap->texels);
        return model;
    }

    const Transfer& reference() const { return baked_.baked->transfer; }
    /// Whether the renderer can shadow its suns.
    bool separate_suns(const LoadedLight& light) const {
        return !light.split.suns.empty() && reference().layout.has(TermKind::direct) &&
               shipped_.transfer.layout.has(TermKind::direct);
    }
    /// Returns the lighting of the verdict.
    Lighting judged(const LoadedLight& light) const {
        return separate_suns(light) ? lighting_of(light) : Lighting{light.combined};
    }
    /// Turns lamps off, unless the lighting contains their strengths.
    Lighting with_lamps(Lighting lighting) const {
        if (lighting.lamps.empty())
            lighting.lamps.assign(reference().layout.lamps(), glm::vec3(0));
        return lighting;
    }
    std::vector<glm::vec3> wanted_under(const Lighting& lighting) const {
        return exit_radiance(reference(), with_lamps(lighting), a_.threads);
    }
    std::vector<glm::vec3> shipped_under(const Lighting& lighting) const {
        return shipped_.radiance(with_lamps(lighting), a_.threads);
    }
    LitError error_under(const Lighting& lighting, const std::optional<LitScale>& scale = {}) const {
        return lit_error(wanted_under(lighting), shipped_under(lighting), areas_, edges_, shipped_.clusters,
                         scale);
    }

    /// By lamps of these strengths, without a sky.
    LitError error_by_lamps(std::vector<glm::vec3> strengths) const {
        return error_under(
            {.sky = constant_light(reference().layout.order, glm::vec3(0)), .lamps = std::move(strengths)});
    }
    void add_each_lamp(Evaluation& evaluation) const {
        const std::span<const TransferTerm> lamps = reference().layout.lamp_terms();
        for (std::size_t k = 0; k < lamps.size(); ++k) {
            std::vector<glm::vec3> strengths(lamps.size(), glm::vec3(0));
            strengths[k] = glm::vec3(1);
            evaluation.standard.push_back(
                {"lamp " + printable(lamps[k].name), error_by_lamps(std::move(strengths)), 0, true});
        }
    }

    /// All lamps of the scene as bright as they are there, and each alone.
    void add_lamps(Evaluation& evaluation) const {
        const std::size_t lamps = reference().layout.lamps();
        if (lamps > 0)
            evaluation.standard.push_back(
                {"lamps", error_by_lamps(std::vector<glm::vec3>(lamps, glm::vec3(1))), 0, true});
        if (lamps > 1)
            add_each_lamp(evaluation);
    }

    /// Adds errors under a named light. With separate suns, errors are relative to the radiance under the
    /// whole light, because suns are in the picture.
    void add_named(const LoadedLight& light, Evaluation& evaluation) const {
        const bool separate = separate_suns(light);
        const Lighting whole{light.combined};
        evaluation.named.push_back({light.name, error_under(whole), 0, !separate});
        if (separate) {
            std::vector<glm::vec3> shown = wanted_under(whole);
            LitScale scale = lit_scale(shown, areas_);
            scale.shown = std::move(shown);
            evaluation.named.push_back({light.name + ", separate suns",
                                        error_under(lighting_of(light), scale), light.split.suns.size(),
                                        true});
        }
        if (const std::size_t lamps = reference().layout.lamps(); lamps > 0)
            evaluation.named.push_back(
                {light.name + " with lamps",
                 error_under({.sky = light.combined, .lamps = std::vector<glm::vec3>(lamps, glm::vec3(1))}),
                 0, !separate});
    }

    /// Adds the worst of suns with one strength: errors are relative to the mean over all suns (docs/math.md,
    /// eq. 35).
    void add_worst_sun(Evaluation& evaluation) const {
        const DirectionalLights suns = directional_lights(reference().layout.order);
        LitScale all;
        for (const Light& sun : suns.lights) {
            const LitScale one = lit_scale(wanted_under({sun}), areas_);
            all.mean_square += one.mean_square / static_cast<double>(suns.lights.size());
            all.mean += one.mean / static_cast<double>(suns.lights.size());
        }
        LitError worst;
        for (std::size_t i = 0; i < suns.lights.size(); ++i) {
            const LitError error = error_under({suns.lights[i]}, all);
            if (error.rms < worst.rms)
                continue;
            worst = error;
            const glm::vec3& d = suns.directions[i];
            evaluation.worst_sun = fmt::format("{:.2f} {:.2f} {:.2f}", d.x, d.y, d.z);
        }
        evaluation.standard.push_back({fmt::format("worst of {} suns", suns.lights.size()), worst});
    }

    /// Maps the 98th percentile of the receivers to 0.8.
    static float exposure_of(std::span<const glm::vec3> radiance, std::span<const glm::vec3> of_suns) {
        std::vector<float> values;
        for (std::size_t p = 0; p < radiance.size(); ++p) {
            const glm::vec3 r = radiance[p] + of_suns[p];
            values.push_back(std::max({r.x, r.y, r.z}));
        }
        const auto at =
            values.begin() + static_cast<std::ptrdiff_t>(0.98 * static_cast<double>(values.size() - 1));
        std::nth_element(values.begin(), at, values.end());
        return *at > 0 ? 0.8f / *at : 1.0f;
    }

    /// A PNG.
    std::vector<std::byte> picture(const TraceScene& scene, std::span<const glm::vec3> colors,
                                   std::span<const Sun> suns, float exposure) const {
        constexpr int kWidth = 720, kHeight = 450, kSamples = 2;
        Picture picture;
        picture.scene = &model_.scene;
        picture.radiance = colors;
        picture.suns = suns;
        picture.textured = false;
        picture.camera = automatic_camera(model_.scene, static_cast<float>(kWidth) / kHeight, 0.6f);
        picture.width = kWidth;
        picture.height = kHeight;
        picture.samples = kSamples;
        const Image image = render_rays(picture, scene, {.threads = a_.threads});
        return encode_png(kWidth, kHeight, tone_mapped(image, kSamples, exposure, ToneMap::srgb));
    }

    const ComparisonOptions& a_;
    SceneFile& baked_;
    SceneFile model_;
    Candidate shipped_;
    std::vector<float> areas_;
    std::vector<Edge> edges_;
};

/// Returns the light with the largest error.
const LoadedLight& worst_of(const Evaluation& evaluation, const std::vector<LoadedLight>& lights) {
    std::size_t light = 0, worst = 0;
    double most = -1;
    for (const NamedError& e : evaluation.named) {
        if (!e.judged) // its row with separate suns follows
            continue;
        if (e.error.rms > most) {
            most = e.error.rms;
            worst = light;
        }
        ++light;
    }
    return lights[worst];
}

} // namespace

void add_comparison(const ComparisonOptions& options, SceneFile& baked,
                    const std::vector<LoadedLight>& lights, Report& report) {
    const Comparison comparison(options, baked);
    const Evaluation evaluation = comparison.measure(lights);
    report.verdict = in_one_line(comparison.verdict(evaluation));
    add_figure(report, {"relative_l2", "relative L2 of the transfer", Unit::percent, 4},
               evaluation.relative_l2);
    add_figure(report, {"worst_directional_light"}, evaluation.worst_sun);
    comparison.add_sizes(report);
    report.tables.push_back(lights_table(evaluation, baked));
    comparison.add_instances(lights, report);
    if (!evaluation.clusters.empty())
        report.tables.push_back(clusters_table(evaluation));
    if (options.pictures && baked.lightmap)
        report.notes.emplace_back("pictures of lightmaps; draw them with prt render");
    else if (options.pictures)
        comparison.add_pictures(worst_of(evaluation, lights), report);
}

} // namespace prt::pipeline
