// Measures, bakes, refines and compresses a scene under constraints.

#include "cli/pipeline/make_model.h"

#include "bake/gltf/encode_glb.h"
#include "cli/pipeline/budget_report.h"
#include "cli/pipeline/choices.h"
#include "cli/pipeline/compress_metric.h"
#include "cli/pipeline/lamp_strengths.h"
#include "cli/pipeline/measure_budget.h"
#include "cli/pipeline/no_shadow.h"
#include "cli/pipeline/shell_word.h"
#include "cli/pipeline/solid_materials.h"
#include "compress/metric/jumps.h"
#include "prt/bake/refine.h"
#include "prt/compress/search.h"
#include "prt/core/error.h"
#include "prt/gltf/levels.h"
#include "runtime/core/support/counted.h"
#include "runtime/core/support/stopwatch.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <memory>

namespace prt::pipeline {
namespace {

constexpr int kTrialRays = 256;

std::string percent(double squared) {
    return fmt::format("{:.2f} %", 100 * std::sqrt(std::max(squared, 0.0)));
}

std::string bounces_in_words(int bounces) {
    return bounces == kEndlessBounces ? "inf" : fmt::format("{}", bounces);
}

/// A compression that was tried.
struct Compressed {
    ClusteredTransfer transfer;
    CompressStatistics statistics;
    double asked = 0; ///< --max-error, or --bytes-per-vertex
    Budgets budgets;
    double total() const { return mean_budget(budgets.relative).total.value; }
};

/// Chosen options.
struct MakePlan {
    double error = 0; ///< that is aimed at
    TruncationChoice cut{};
    double refine = 0; ///< target of refinement; 0: none
    FitMode fit = FitMode::automatic;
    int rays = 0;
};

/// Errors and time measured by two trial bakes with few rays.
struct TrialBake {
    ErrorBudget budget;
    double seconds_per_ray = 0;
};

/// Reads the scene. Its lobes are removed: all vertices get transfer.
GltfDocument load_without_lobes(const MakeRequest& request, const Host& host) {
    GltfDocument document = load_gltf(request.scene, request.reading);
    if (has_lobes(document)) {
        send(host.notify, request.scene, {"its lobes are removed; run prt lobes on the output"});
        discard_lobes(document);
    }
    return document;
}

class Maker {
public:
    Maker(const MakeRequest& request, const Host& host, std::vector<ReferenceLight> lights)
        : r_(request), host_(host), document_(load_without_lobes(request, host)),
          scene_(extract_scene(document_)), lights_(std::move(lights)) {
        send(host_.notify, r_.scene, scene_.notices);
        check_no_media(scene_, solid_materials(scene_));
        leave_out_shadows(scene_, r_.no_shadow);
        separate();
    }

    void run(Report& report) {
        plan_.error = r_.goal.bytes_per_vertex ? kBesideBytes : r_.goal.max_error.value_or(kUsualError);
        trace_paths();
        choose_bands();
        TrialBake trial = run_trial_bake();
        const bool coarse = trial.budget.of(ErrorCause::vertices).value > kMaxVertexShare * allowed();
        if (coarse && in_time(0.3) && refine_mesh(trial)) {
            trace_paths();
            trial = run_trial_bake();
        }
        choose_effort(trial);
        bake_all();
        Compressed best =
            r_.goal.bytes_per_vertex ? compressed({}, r_.goal.bytes_per_vertex) : within_error();
        write(best, report);
    }

private:
    bool aims_by_itself() const { return !r_.goal.max_error && !r_.goal.bytes_per_vertex; }
    double allowed() const { return plan_.error * plan_.error; }
    bool in_time(double share) const {
        return !r_.goal.seconds || watch_.seconds() < share * *r_.goal.seconds;
    }

    /// Gives both sides of double-sided surfaces separate vertices.
    void separate() {
        BakeOptions options;
        options.repairs.bad_textures = r_.reading.bad_textures;
        options.threads = r_.threads;
        separate_sides({.sides = r_.back_sides,
                        .path = r_.scene,
                        .options = options,
                        .no_shadow = r_.no_shadow,
                        .notify = host_.notify},
                       document_, scene_);
    }

    void trace_paths() {
        const Stage stage = host_.stages("tracing paths");
        reference_ = std::make_unique<BudgetReference>(
            scene_, lights_,
            BudgetEffort{.noise = std::max(kShareOfNoise * allowed(), kMinNoise),
                         .seconds =
                             kShareOfTime * r_.goal.seconds.value_or(0) / static_cast<double>(lights_.size()),
                         .bad_textures = r_.reading.bad_textures,
                         .threads = r_.threads},
            stage.progress);
    }

    /// Chooses order and number of bounces by the path-traced error of each.
    void choose_bands() {
        const TruncationErrors errors{[&](int order) { return reference_->light_error(order); },
                                      [&](int bounces) { return reference_->bounces_error(bounces); }};
        if (aims_by_itself())
            plan_.error =
                std::max(kUsualError, std::sqrt(kAboveRest * std::max(errors.light(kMaxOrder), 0.0)));
        for (const int order : {2, 4, 6, 8, 10})
            tried_.push_back(fmt::format("order {}: error of light {}", order, percent(errors.light(order))));
        for (const int bounces : {0, 1, 2, 4})
            tried_.push_back(fmt::format("{}: error of bounces {}", counted(bounces, "bounce"),
                                         percent(errors.bounces(bounces))));
        plan_.cut = choose_truncation(errors, allowed());
        check_lamps_end();
        check_possible(plan_.cut.squared, fmt::format("the truncation to order {} and {}", plan_.cut.order,
                                                      plan_.cut.bounces == kEndlessBounces
                                                          ? "all bounces"
                                                          : counted(plan_.cut.bounces, "bounce")));
    }

    /// Limits the bounces where light of lamps would grow without end.
    void check_lamps_end() {
        if (plan_.cut.bounces != kEndlessBounces)
            return;
        constexpr int kRays = 64, kManyBounces = 8; // the walls decide, not the noise
        BakeOptions options = bake_options(kRays);
        options.order = 1;
        try {
            baked(options, "checking lamps");
        } catch (const EndlessLampLight&) {
            plan_.cut.bounces = kManyBounces;
            notices_.push_back(
                fmt::format("infinite bounces do not converge, because a closed room reflects all light of "
                            "lamps; the bake has {} bounces",
                            kManyBounces));
        }
    }

    /// Throws `Error` if the allowed error is used up before compression.
    void check_possible(double squared, const std::string& cause) const {
        if (r_.goal.max_error && squared > kMaxUncompressedShare * allowed() && !r_.goal.best_effort)
            throw Error(fmt::format(
                "an error of {} cannot be reached under these lights: the error of {} is {} already; raise "
                "--max-error, or get the closest result with --best-effort",
                percent(allowed()), cause, percent(squared)));
    }

    BakeOptions bake_options(int rays) const {
        BakeOptions options;
        options.order = plan_.cut.order;
        options.bounces = plan_.cut.bounces;
        options.rays = rays;
        options.fit = plan_.fit;
        options.repairs.bad_textures = r_.reading.bad_textures;
        options.threads = r_.threads;
        return options;
    }

    BakeResult baked(const BakeOptions& options, const std::string& title,
                     MeasureErrors errors = MeasureErrors::no) {
        const Stage stage = host_.stages(title);
        return bake(scene_, options, stage.progress, errors);
    }

    /// Measures the error of vertices and rays, and whether vertices are fitted.
    TrialBake run_trial_bake() {
        const Stopwatch stopwatch;
        BakeOptions options = bake_options(kTrialRays);
        options.lamps.mode = LampMode::none;
        const BakeResult first = baked(options, "trial bake 1 of 2");
        plan_.fit = options.fit = first.baked.record.fitted ? FitMode::surface : FitMode::vertex;
        options.seed = 1;
        trial_ = baked(options, "trial bake 2 of 2").baked.transfer;
        TrialBake trial{mean_budget(budgets(*reference_,
                                            {.baked = first.baked.transfer,
                                             .repeated = trial_,
                                             .shipped = nullptr,
                                             .bounces = plan_.cut.bounces},
                                            r_.threads)
                                        .relative),
                        stopwatch.seconds() / (2 * kTrialRays)};
        tried_.push_back(fmt::format("trial bake, {}, {} rays each, {}: error of vertices {}, of rays {}",
                                     counted(scene_.receivers(), "vertex", "vertices"), kTrialRays,
                                     plan_.fit == FitMode::surface ? "fitted" : "not fitted",
                                     percent(trial.budget.of(ErrorCause::vertices).value),
                                     percent(trial.budget.of(ErrorCause::rays).value)));
        return trial;
    }

    /// Splits triangles until the error between vertices is within its fraction; false if no triangle is
    /// split.
    bool refine_mesh(const TrialBake& trial) {
        constexpr double kLook = 1e3; // a target that is met at once
        BakeOptions options = bake_options(kTrialRays);
        options.fit = FitMode::surface;
        const Stage stage = host_.stages("refining");
        const Progress progress = stage.progress;
        // Assumes that the error under these lights and the error of direct transfer between vertices
        // decrease in proportion.
        const double now = refine(scene_, options, {.target = kLook}, progress.range(0, 0.1))
                               .statistics.before.error,
                     vertices = trial.budget.of(ErrorCause::vertices).value;
        const double target = now * std::sqrt(kShareOfVertices * allowed() / vertices);
        if (!(target > 0))
            return false;
        const RefineResult result = refine(scene_, options, {.target = target}, progress.range(0.1, 1));
        tried_.push_back(fmt::format("prt bake --refine {:.3g}: {}", target,
                                     counted(result.statistics.after.vertices, "vertex", "vertices")));
        if (result.statistics.rounds == 0)
            return false;
        plan_.refine = target;
        plan_.fit = FitMode::surface;
        document_ = refined(std::move(document_), scene_, result.refinement);
        scene_ = extract_scene(document_);
        leave_out_shadows(scene_, r_.no_shadow);
        return true;
    }

    /// Chooses rays by their noise, within the allowed time.
    void choose_effort(const TrialBake& trial) {
        plan_.rays = choose_rays(trial.budget.of(ErrorCause::rays).value, kTrialRays, allowed());
        if (r_.goal.seconds) { // half of the remaining time, because compression takes as long as the bake
            const double left = 0.5 * (*r_.goal.seconds - watch_.seconds());
            while (plan_.rays > kFewestRays && plan_.rays * trial.seconds_per_ray > left)
                plan_.rays /= 2;
        }
        double before_bytes = kShareOfRays * allowed();
        for (const ErrorCause cause : {ErrorCause::light, ErrorCause::bounces, ErrorCause::vertices})
            before_bytes += trial.budget.of(cause).value;
        if (aims_by_itself())
            plan_.error = std::max(kUsualError, std::sqrt(kAboveRest * before_bytes));
        check_possible(before_bytes, fmt::format("light and bounces ({}), vertices ({}) and rays",
                                                 percent(plan_.cut.squared),
                                                 percent(trial.budget.of(ErrorCause::vertices).value)));
    }

    /// Bakes the transfer, writes the file and reads it back, as separate commands do.
    void bake_all() {
        const BakeResult result =
            // measures errors, as prt bake does
            baked(bake_options(plan_.rays), "baking", MeasureErrors::yes);
        for (const std::string& notice : result.statistics.notices)
            notices_.push_back(notice);
        note_lights(result.baked.transfer);
        if (has_levels(document_))
            notices_.emplace_back(
                "coarser levels of detail have no transfer; to bake them, use prt bake and prt compress");
        write_transfer(document_, scene_, result.baked);
        const std::vector<std::byte> file = encode_glb(document_);
        host_.write(r_.baked, file);
        model_.emplace(scene_file_of(parse_gltf(file, r_.output, {.scene_limit = r_.reading.scene_limit}),
                                     r_.output, host_.notify));
        discard_transfer(model_->document);
    }

    /// Adds a notice if the lights of the scene are far brighter than the first of the skies.
    void note_lights(const Transfer& transfer) {
        Lighting lighting = lights_.front().lighting(transfer.layout.order);
        lighting.lamps.assign(transfer.layout.lamps(), glm::vec3(1));
        const std::vector<float> areas = receiver_areas(scene_);
        if (auto notice = photometric_notice(scene_, relit_by(transfer, areas, r_.threads), lighting))
            notices_.push_back(std::move(*notice));
    }

    const Transfer& transfer() const { return model_->baked->transfer; }

    /// --max-error or --bytes-per-vertex, as `prt compress` does it with --lights.
    Compressed compressed(std::optional<double> max_error, std::optional<double> bytes) {
        const MetricArguments metric{
            .metric = MetricChoice::outdoor, .lights = r_.lights, .light_options = r_.reading_lights};
        const SceneSurface surface(model_->scene);
        ErrorTerms terms = error_terms(metric, given_lights(metric, transfer().layout, r_.threads),
                                       transfer(), surface.areas, r_.threads);
        SearchOptions options;
        options.compress.metric = std::move(terms.metric);
        options.compress.threads = r_.threads;
        options.budget.max_error = max_error;
        options.budget.bytes_per_vertex = bytes;
        if (max_error)
            options.budget.max_jump = kUnseenJump;
        promise(terms, options.budget);
        const Stage stage = host_.stages("compressing");
        SearchResult found = compress_within(transfer(), surface.view(), options, stage.progress);
        if (!found.kept && bytes)
            throw Error(fmt::format("--bytes-per-vertex {} cannot be reached; the minimum is {:.2f}", *bytes,
                                    found.result.statistics.bytes_with_bases(transfer().receivers())));
        Compressed one{std::move(found.result.transfer),
                       found.result.statistics,
                       max_error.value_or(bytes.value_or(0)),
                       {}};
        const Transfer coded = decode(one.transfer, r_.threads);
        one.budgets = budgets(*reference_,
                              {.baked = transfer(),
                               .repeated = trial_,
                               .shipped = &coded,
                               .bounces = plan_.cut.bounces,
                               .alike = plan_.rays == kTrialRays},
                              r_.threads);
        tried_.push_back(fmt::format(
            "prt compress {} {:.4g}: {:.2f} bytes per vertex, error of bytes {}, total {}",
            max_error ? "--max-error" : "--bytes-per-vertex", one.asked,
            one.statistics.bytes_with_bases(transfer().receivers()),
            percent(mean_budget(one.budgets.relative).of(ErrorCause::bytes).value), percent(one.total())));
        return one;
    }

    double size(const Compressed& one) const {
        return one.statistics.bytes_with_bases(transfer().receivers());
    }

    /// Finds the allowed compression error by trials. The compressor guarantees the error for the worst
    /// rotation of each sky at vertices, but the constraint is on the surface in its given orientation.
    Compressed within_error() {
        constexpr int kTries = 5;
        const auto rest = [&](const Budgets& all) {
            const ErrorBudget mean = mean_budget(all.relative);
            return mean.total.value - mean.of(ErrorCause::bytes).value;
        };
        const Budgets uncompressed = budgets(
            *reference_,
            {.baked = transfer(), .repeated = trial_, .shipped = nullptr, .bounces = plan_.cut.bounces},
            r_.threads);
        const double left = std::max(allowed() - rest(uncompressed), (1 - kMaxUncompressedShare) * allowed());
        AskedError asked(std::sqrt(left));
        std::optional<Compressed> best;
        for (int i = 0; i < kTries && asked.worth_trying() && (i == 0 || in_time(0.7)); ++i) {
            Compressed one = compressed(asked.next(), {});
            const double bytes = mean_budget(one.budgets.relative).of(ErrorCause::bytes).value,
                         total = one.total();
            asked.came_out(allowed(), total, bytes, size(one));
            const bool keeps = total <= allowed(), kept = best && best->total() <= allowed();
            if (!best || (keeps && (!kept || size(one) < size(*best))) ||
                (!keeps && !kept && total < best->total()))
                best = std::move(one);
        }
        if (r_.goal.max_error && best->total() > allowed() && !r_.goal.best_effort)
            throw Error(fmt::format(
                "an error of {} cannot be reached under these lights; the closest result has {}; raise "
                "--max-error, or get this result with --best-effort",
                percent(allowed()), percent(best->total())));
        return std::move(*best);
    }

    std::vector<std::string> by_hand(const Compressed& best) const {
        const Path kept = r_.baked.empty() ? Path("baked.glb") : r_.baked;
        std::string bake = fmt::format("prt bake {} -o {} --order {} --rays {} --bounces {} --fit {}",
                                       shell_word(r_.scene.string()), shell_word(kept.string()),
                                       plan_.cut.order, plan_.rays, bounces_in_words(plan_.cut.bounces),
                                       plan_.fit == FitMode::surface ? "surface" : "vertex");
        if (plan_.refine > 0)
            bake += fmt::format(" --refine {}", plan_.refine);
        if (r_.reading.smooth_normals_degrees)
            bake += fmt::format(" --smooth-normals {}", *r_.reading.smooth_normals_degrees);
        if (r_.reading.lamp_scale != 1)
            bake += fmt::format(" --lamp-scale {}", r_.reading.lamp_scale);
        if (r_.reading.bad_textures == BadTextures::ignore)
            bake += " --bad-textures ignore";
        std::string reading = r_.reading.allow_outside ? " --allow-outside" : "";
        if (r_.reading.scene_limit > 0)
            reading += fmt::format(" --memory-limit {:.0f}", r_.reading.scene_limit);
        bake += reading;
        if (r_.back_sides == BackSides::shared)
            bake += " --back-sides shared";
        for (const std::string& material : r_.no_shadow)
            bake += " --no-shadow " + shell_word(material);
        std::string compress =
            fmt::format("prt compress {} -o {}", shell_word(kept.string()), shell_word(r_.output.string()));
        for (const Path& light : r_.lights)
            compress += " --lights " + shell_word(light.string());
        compress += r_.light_options;
        compress += fmt::format(" {} {}", r_.goal.bytes_per_vertex ? "--bytes-per-vertex" : "--max-error",
                                best.asked);
        return {bake, compress + reading + (r_.goal.best_effort ? " --best-effort" : "")};
    }

    void write(Compressed& best, Report& report) {
        write_clustered(model_->document, model_->scene, {best.transfer, model_->baked->record});
        const std::uintmax_t bytes = host_.write(r_.output, encode_glb(model_->document));
        const ErrorBudget mean = mean_budget(best.budgets.relative),
                          visible = mean_budget(best.budgets.visible);
        add_figures(report, {{"output", r_.output.string()},
                             {"order", plan_.cut.order},
                             {"rays_per_receiver", plan_.rays},
                             {"bounces", bounces_in_words(plan_.cut.bounces)},
                             {"fit", plan_.fit == FitMode::surface ? "surface" : "vertex"},
                             {"refine", plan_.refine > 0 ? Json(plan_.refine) : Json()},
                             {"receivers", transfer().receivers()},
                             {"clusters", best.statistics.clusters},
                             {"bytes_bound_per_vertex", best.statistics.bytes_per_receiver},
                             {"bytes_bound_per_vertex_with_bases", size(best)},
                             {"target_error", plan_.error},
                             {"total_error", mean.total.root()},
                             {"total_error_low", std::sqrt(std::max(mean.total.low, 0.0))},
                             {"total_error_high", std::sqrt(std::max(mean.total.high, 0.0))},
                             {"total_contrast_error", visible.total.root()},
                             {"bytes_file", bytes},
                             {"seconds", watch_.seconds()},
                             {"trials", tried_},
                             {"commands", by_hand(best)},
                             {"notices", notices_}});
        for (Table& table : budget_tables(lights_, best.budgets))
            report.tables.push_back(std::move(table));
        say(mean, visible, report);
    }

    void say(const ErrorBudget& mean, const ErrorBudget& visible, Report& report) const {
        auto& lines = report.sentences;
        lines.push_back(
            fmt::format("{{output}}: {{receivers:#vertex|vertices}}, order {{order}}, "
                        "{{rays_per_receiver:#ray}} per vertex, {{bounces:#bounce}}, {}; "
                        "{{bytes_bound_per_vertex}} bytes of attributes per vertex, "
                        "{{bytes_bound_per_vertex_with_bases:.2f}} with the bases; {{seconds:.1f}} s",
                        plan_.fit == FitMode::surface ? "fitted to the surface" : "sampled at vertices"));
        lines.push_back("over the surface: " + budget_in_words(mean, visible, lights_.size()) +
                        "; 95 % interval of the total {total_error_low:.2f%} to {total_error_high:.2f%}");
        if (!r_.goal.bytes_per_vertex && mean.total.value > allowed())
            lines.emplace_back("this exceeds the target of {target_error:.2f%}");
        for (std::size_t i = 0; i < notices_.size(); ++i)
            lines.push_back(fmt::format("{{notices/{}}}", i));
        for (std::size_t i = 0; i < tried_.size(); ++i)
            lines.push_back(fmt::format("trial: {{trials/{}}}", i));
        lines.emplace_back("equivalent commands: {commands/0}");
        lines.emplace_back("                     {commands/1}");
    }

    const MakeRequest& r_;
    const Host& host_;
    GltfDocument document_;
    Scene scene_;
    std::vector<ReferenceLight> lights_;
    std::unique_ptr<BudgetReference> reference_;
    Stopwatch watch_;
    MakePlan plan_;
    Transfer trial_;
    std::optional<SceneFile> model_;
    std::vector<std::string> tried_, notices_;
};

/// Throws `Error` if no light shines.
void check_shine(const MakeRequest& request, const std::vector<ReferenceLight>& lights) {
    const auto shines = [](const ReferenceLight& light) {
        return light.sky_bands.coefficients[0] + light.sun_bands.coefficients[0] != glm::vec3(0);
    };
    if (std::ranges::none_of(lights, shines))
        throw Error(request.lights.front().string() +
                    ": is black, so no relative error can be measured; use a brighter light");
}

} // namespace

void make_model(const MakeRequest& request, Report& report, const Host& host) {
    std::vector<ReferenceLight> lights = budget_lights({.files = request.lights,
                                                        .suns = {std::nullopt},
                                                        .reading = request.reading_lights,
                                                        .order = 6,
                                                        .separate = true,
                                                        .threads = request.threads});
    check_shine(request, lights);
    about(request.scene, [&] { Maker(request, host, std::move(lights)).run(report); });
}

} // namespace prt::pipeline
