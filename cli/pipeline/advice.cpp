// Tries options against the largest causes of error.

#include "cli/pipeline/advice.h"

#include "bake/trace/trace_receivers.h"
#include "bake/tracers/make_tracer.h"
#include "prt/compress/compress.h"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

namespace prt::pipeline {
namespace {

/// An option, and the squared error of its cause with it.
struct Trial {
    std::string option;
    double squared;
};

class Adviser {
public:
    Adviser(const AdviceSource& source, const ErrorBudget& budget, const Progress& progress)
        : s_(source), budget_(budget), progress_(progress) {}

    std::optional<Trial> try_against(ErrorCause cause) const {
        switch (cause) {
        case ErrorCause::light:
            return more_bands();
        case ErrorCause::bounces:
            return Trial{"prt bake --bounces inf", 0};
        case ErrorCause::vertices:
            return more_vertices();
        case ErrorCause::rays:
            return more_rays();
        default:
            return more_bytes();
        }
    }

private:
    int order() const { return s_.baked.order(); }
    int bounces() const {
        const BakeRecord& record = *s_.baked.record();
        return record.endless ? kEndlessBounces : record.bounces;
    }

    /// Tries the minimum order whose light error is below the sum of the other causes, or the maximum order.
    std::optional<Trial> more_bands() const {
        if (order() == kMaxOrder)
            return std::nullopt;
        const double rest = budget_.sum() - budget_.of(ErrorCause::light).value;
        int chosen = order() + 1;
        double squared = s_.reference.light_error(chosen);
        while (chosen < kMaxOrder && squared > rest)
            squared = s_.reference.light_error(++chosen);
        return Trial{fmt::format("prt bake --order {}", chosen), squared};
    }

    /// All triangles in four, at some of the points.
    std::optional<Trial> more_vertices() const {
        if (s_.baked.lightmap) // a lightmap is not rebaked here, so the effect of more texels is unknown
            return std::nullopt;
        constexpr std::size_t kPoints = 256;
        const SurfacePoints some = some_of(s_.reference.points(), kPoints);
        const QuarterCorners quarters = quarter_corners(s_.reference.scene(), some);
        double split = 0;
        for (std::size_t i = 0; i < s_.reference.lights().size(); ++i) {
            const ReferenceLight& light = s_.reference.lights()[i];
            const auto radiance = [&](const SurfacePoints& points, std::uint64_t seed) {
                return SurfaceRadiance(s_.reference.scene(), points, light,
                                       {.seed = seed, .threads = s_.effort.threads}, {{}, progress_.stop});
            };
            const SurfaceRadiance here = radiance(some, s_.effort.seed + 2),
                                  corners = radiance(quarters.corners, s_.effort.seed + 4);
            split +=
                split_error(some, here, quarters, corners, s_.reference.cut(i, order(), bounces())).value;
        }
        return Trial{"more vertices (prt bake --refine; measured with every triangle split in four)",
                     split / static_cast<double>(s_.reference.lights().size())};
    }

    /// Squared difference of direct light by two seeds, at some of the receivers, under all lights.
    double noise(const Receivers& receivers, std::span<const std::uint32_t> some, int rays) const {
        const auto tracer = make_tracer(s_.reference.scene(), {.backend = Backend::cpu});
        std::array<Transfer, 2> direct;
        for (std::uint64_t seed = 0; seed < 2; ++seed) {
            direct[seed] = zero_transfer(order(), 1, receivers.size());
            trace_receivers(*tracer, receivers, some,
                            {.order = order(), .rays = rays, .seed = s_.effort.seed + seed}, direct[seed],
                            {{}, progress_.stop});
        }
        double sum = 0;
        for (const ReferenceLight& light : s_.reference.lights()) {
            const Light sky = light.lighting(order()).sky;
            for (const std::uint32_t p : some) {
                const glm::vec3 d = exit_radiance(direct[0].vector(p), direct[0].layout, sky.coefficients) -
                                    exit_radiance(direct[1].vector(p), direct[1].layout, sky.coefficients);
                sum += static_cast<double>(receivers.areas[p] * glm::dot(d, d));
            }
        }
        return sum;
    }

    /// Four times the rays.
    std::optional<Trial> more_rays() const {
        constexpr int kTimes = 4;
        constexpr std::size_t kReceivers = 256;
        const int rays = s_.baked.record()->rays;
        if (s_.baked.record()->method == BakeMethod::raster || rays > kMaxRays / kTimes)
            return std::nullopt;
        const Receivers receivers = vertex_receivers(s_.baked.scene);
        const std::vector<std::uint32_t> all = receivers_on_surfaces(receivers);
        std::vector<std::uint32_t> some;
        const std::size_t step = std::max<std::size_t>(1, all.size() / kReceivers);
        for (std::size_t i = 0; i < all.size(); i += step)
            some.push_back(all[i]);
        const double now = noise(receivers, some, rays);
        if (!(now > 0))
            return std::nullopt;
        return Trial{fmt::format("prt bake --rays {}", kTimes * rays),
                     budget_.of(ErrorCause::rays).value * noise(receivers, some, kTimes * rays) / now};
    }

    ClusteredTransfer compressed(const Transfer& baked, CompressOptions options) const {
        const Progress quiet{{}, progress_.stop};
        if (const std::optional<LightmapOfFile>& lightmap = s_.baked.lightmap) {
            options.predictors = PredictorChoice::none;
            return compress(baked, {.areas = lightmap->areas, .edges = lightmap->edges}, options, quiet)
                .transfer;
        }
        const SceneSurface surface(s_.baked.scene);
        return compress(baked, surface.view(), options, quiet).transfer;
    }

    /// A word more for every receiver.
    std::optional<Trial> more_bytes() const {
        const ClusteredTransfer& shipped = s_.shipped->compressed->transfer;
        if (shipped.receivers.format != WeightFormat::packed)
            return std::nullopt;
        const int words = static_cast<int>(bytes_per_receiver(shipped) / 4) + 1;
        if (words > kMaxPackedWords)
            return std::nullopt;
        CompressOptions options;
        options.coding = preset_u64();
        options.threads = s_.effort.threads;
        if (words != 2)
            options.coding.bits = 32 * words - 8;
        const Transfer& baked = s_.baked.baked->transfer;
        const Transfer coded = decode(compressed(baked, options), s_.effort.threads);
        const BudgetStages stages{.baked = baked,
                                  .repeated = baked,
                                  .shipped = &coded,
                                  .bounces = bounces(),
                                  .lightmap = s_.baked.lightmap ? &*s_.baked.lightmap : nullptr};
        double squared = 0;
        for (const ErrorBudget& one : budgets(s_.reference, stages, s_.effort.threads).relative)
            squared += one.of(ErrorCause::bytes).value;
        return Trial{words == 2 ? "prt compress --preset u64"
                                : fmt::format("prt compress --preset custom --bits {}", options.coding.bits),
                     squared / static_cast<double>(s_.reference.lights().size())};
    }

    const AdviceSource& s_;
    const ErrorBudget& budget_;
    const Progress& progress_;
};

} // namespace

std::optional<Advice> advice(const AdviceSource& source, const ErrorBudget& budget,
                             const Progress& progress) {
    constexpr double kWorthwhile = 0.02; // fraction of the total
    const Adviser adviser(source, budget, progress);
    std::array<std::size_t, kErrorCauses> causes;
    std::iota(causes.begin(), causes.end(), std::size_t{0});
    std::stable_sort(causes.begin(), causes.end(), [&](std::size_t a, std::size_t b) {
        return budget.causes[a].value > budget.causes[b].value;
    });
    for (const std::size_t c : causes) {
        const auto cause = static_cast<ErrorCause>(c);
        const double now = budget.of(cause).value;
        if (!(now > 0))
            break;
        const std::optional<Trial> trial = adviser.try_against(cause);
        if (!trial)
            continue;
        // Computed as fractions of the sum, so that interactions between causes stay in proportion.
        const double after =
            budget.total.root() * std::sqrt(std::max(0.0, 1 - (now - trial->squared) / budget.sum()));
        if (after < (1 - kWorthwhile) * budget.total.root())
            return Advice{cause, trial->option, budget.total.root(), after};
    }
    return std::nullopt;
}

} // namespace prt::pipeline
