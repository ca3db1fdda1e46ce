// Splits the triangles that have most of the error, and measures the error again, until it is small enough.

#include "prt/bake/refine.h"

#include "bake/plan/plan.h"
#include "bake/refine/surface_error.h"
#include "bake/tracers/make_tracer.h"
#include "prt/core/error.h"
#include "prt/core/sh.h"
#include "runtime/core/support/stopwatch.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <numeric>
#include <optional>
#include <utility>

namespace prt {
namespace {

/// Default limit of the number of vertices.
constexpr std::size_t kTimesVertices = 4, kMinLimit = 20000;
/// Share of the squared error whose triangles are split in one round, largest errors first. The plain room
/// (benchmarks.md) to 2 %: 0.3 took 15 rounds to 6 951 vertices, 0.7 took 8 rounds to 7 487 vertices, with
/// 1.94 % left in both cases.
constexpr double kShareOfRound = 0.5;
/// Share of a triangle's squared error that one bisection removes: half if a step of light crosses it, 3/4 if
/// the curvature is the same along and across the cut.
constexpr double kTakenOff = 0.7;
void check_options(const BakeOptions& options, const RefineOptions& how) {
    check_order(options.order);
    if (!(how.target > 0 && std::isfinite(how.target)))
        throw Error("the error of --refine must be finite and greater than 0");
    if (options.fit == FitMode::vertex)
        throw Error("--refine does not support --fit vertex; use --fit auto or surface");
}

/// Returns [primitives] whether a primitive belongs to one of `nodes`.
std::vector<bool> primitives_of(const Scene& scene, std::vector<int> nodes) {
    std::ranges::sort(nodes);
    std::vector<bool> result;
    for (const Primitive& primitive : scene.primitives)
        result.push_back(std::ranges::binary_search(nodes, primitive.node));
    return result;
}

/// Refines a scene in rounds.
class Refiner {
public:
    Refiner(const Scene& scene, const TraceScene& traced, const DetailedSurface* detail, Tracer& tracer,
            const BakeOptions& options, const RefineOptions& how)
        : options_(options), how_(how), detail_(detail), points_(traced, tracer, options, how.target),
          kept_(primitives_of(scene, how.kept_nodes)), finer_(scene) {
        const Bounds box = bounds(scene);
        const glm::vec3 size = box.high - box.low;
        min_edge_ = kMinEdge * 0.5 * static_cast<double>(std::max({size.x, size.y, size.z}));
        most_ =
            how.max_vertices > 0 ? how.max_vertices : std::max(kTimesVertices * scene.receivers(), kMinLimit);
        result_.refinement = no_refinement(scene);
    }

    RefineResult run(const Progress& progress) {
        RefineStatistics& s = result_.statistics;
        bool limited = false;
        while (true) {
            const SurfaceError error = measure(progress);
            s.after = {finer_.receivers(), finer_.triangles(), error.relative_l2()};
            if (s.rounds == 0)
                s.before = s.after;
            s.end = limited ? RefineEnd::vertices : RefineEnd::target;
            // The points that selected the triangles are biased afterwards; trace fresh ones before stopping.
            if (limited || (s.after.error <= how_.target && (s.rounds == 0 || !points_.look_closer())))
                break;
            if (s.after.error <= how_.target)
                continue;
            const WeldedEdges edges = welded_edges(finer_);
            const EdgeMarks marks = mark(worst_triangles(error, edges), edges, limited);
            if (marks.vertices() == 0) {
                s.end = limited ? RefineEnd::vertices : RefineEnd::edges;
                break;
            }
            split(bisect(finer_, edges, marks));
            ++s.rounds;
        }
        s.points = points_.size();
        s.rays = points_.rays();
        s.rays_per_point = 2 * points_.rays_per_scramble();
        progress.update(1);
        return std::move(result_);
    }

private:
    SurfaceError measure(const Progress& progress) {
        const LitMesh mesh(finer_, kept_, detail_);
        points_.spread(mesh, progress.range(shown_, shown_ + 0.1 * (1 - shown_)));
        shown_ += 0.1 * (1 - shown_);
        SurfaceError error = surface_error(mesh, points_, options_.threads);
        const double now = error.relative_l2();
        if (first_ == 0)
            first_ = now;
        if (first_ > how_.target && now > how_.target) // progress is linear in the logarithm of the error
            shown_ = std::max(shown_, std::log(first_ / now) / std::log(first_ / how_.target));
        progress.update(shown_);
        return error;
    }

    std::vector<bool> kept_triangles() const {
        std::vector<bool> result;
        for (std::size_t p = 0; p < kept_.size(); ++p)
            result.insert(result.end(), finer_.primitives[p].triangles.size(), kept_[p]);
        return result;
    }

    double allowed(const SurfaceError& error) const { return how_.target * how_.target * error.norm; }

    /// Returns triangles that can be split, largest errors first: enough to remove the excess error, or the
    /// share of a round.
    std::vector<std::uint32_t> worst_triangles(const SurfaceError& error, const WeldedEdges& edges) const {
        const std::vector<double>& e = error.of_triangles;
        const std::vector<bool> fixed = fixed_edges(edges, kept_triangles());
        std::vector<std::uint32_t> worst;
        for (std::uint32_t t = 0; t < e.size(); ++t) {
            const std::uint32_t longest = edges.of_triangle[t][edges.longest[t]];
            if (e[t] > 0 && longest != kNoEdge && !fixed[longest] && edges.lengths[longest] >= 2 * min_edge_)
                worst.push_back(t);
        }
        std::stable_sort(worst.begin(), worst.end(),
                         [&](std::uint32_t a, std::uint32_t b) { return e[a] > e[b]; });
        const double all = std::accumulate(e.begin(), e.end(), 0.0);
        double left = std::min(kShareOfRound * all, (all - allowed(error)) / kTakenOff);
        std::size_t count = 0;
        for (; count < worst.size() && left > 0; ++count)
            left -= e[worst[count]];
        worst.resize(count);
        return worst;
    }

    /// Marks triangles up to the limit. Sets `limited` if the limit did not allow all.
    EdgeMarks mark(const std::vector<std::uint32_t>& worst, const WeldedEdges& edges, bool& limited) const {
        const auto mark_first = [&](std::size_t count) {
            EdgeMarks marks(edges);
            std::size_t marked = 0;
            while (marked < count && finer_.receivers() + marks.vertices() <= most_) {
                const std::uint32_t t = worst[marked++];
                marks.mark(edges.of_triangle[t][edges.longest[t]]);
            }
            return std::pair(std::move(marks), marked);
        };
        auto [marks, marked] = mark_first(worst.size());
        limited = finer_.receivers() + marks.vertices() > most_;
        if (!limited)
            return std::move(marks);
        return mark_first(std::max<std::size_t>(marked, 1) - 1).first; // the last one exceeded the limit
    }

    void split(Bisection bisection) {
        finer_ = refined(finer_, bisection.refinement);
        points_.move(bisection.parts);
        append(result_.refinement, std::move(bisection.refinement));
    }

    const BakeOptions& options_;
    const RefineOptions& how_;
    const DetailedSurface* detail_; ///< may be null
    LightPoints points_;
    std::vector<bool> kept_; ///< [primitives] true: triangles are not split
    Scene finer_;
    double min_edge_ = 0;  ///< metres
    std::size_t most_ = 0; ///< vertices
    double first_ = 0, shown_ = 0;
    RefineResult result_;
};

} // namespace

RefineResult refine(const Scene& scene, const BakeOptions& options, const RefineOptions& how,
                    const Progress& progress, const FinerModel& finer) {
    check_options(options, how);
    check_finer(finer);
    const Stopwatch all;
    BakeOptions direct = options; // nothing bounces here
    direct.bounces = 0;
    const Scene &shown = finer.scene ? *finer.scene : scene, *other = finer.scene ? &scene : nullptr;
    const TraceScene traced = trace_scene(shown, choose_media(shown, options, other), direct);
    std::optional<DetailedSurface> detail;
    if (finer.scene)
        detail.emplace(traced, finer.reach, scene.origin);
    const std::unique_ptr<Tracer> tracer = make_tracer(traced, options.tracer);
    RefineResult result =
        Refiner(scene, traced, detail ? &*detail : nullptr, tracer->rays(), options, how).run(progress);
    result.statistics.seconds = all.seconds();
    return result;
}

} // namespace prt
