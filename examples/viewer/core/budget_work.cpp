// Measures an error budget for the open model and colors its surface by the error.

#include "core/budget_work.h"

#include "bake/studies/repeated_bake.h"
#include "compress/study/receiver_colors.h"
#include "prt/bake/bake.h"
#include "prt/bake/bake_options.h"
#include "prt/core/dering.h"
#include "prt/core/error.h"
#include "prt/core/sh.h"
#include "runtime/core/support/parallel.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>

namespace viewer {
namespace {

using Radiance = std::vector<glm::vec3>;

/// Target noise of squared errors, and number of paths per half. This takes a sixteenth of the default time
/// for files and is enough for errors of a few percent; the interval of the total shows the remaining
/// uncertainty.
constexpr double kNoise = 2e-4;
constexpr int kMaxPaths = 1024;

/// Leaves one thread for drawing.
int threads_beside_drawing() {
    return std::max(1, prt::thread_count(0) - 1);
}

/// Throws `prt::Error` if the scene has a medium, because the path tracer does not enter media.
void check_no_media(const prt::Scene& scene) {
    for (const prt::Material& material : scene.materials)
        if (prt::medium_of(material))
            throw prt::Error("light of the material '" + material.name +
                             "' comes from inside a medium, which the path tracer of the error budget "
                             "does not support");
}

/// Returns the factors by which `windowed` scales the bands.
prt::BandFactors window_factors(const prt::Light& light, prt::Window window) {
    if (window == prt::Window::automatic)
        return prt::dering_factors(light);
    prt::BandFactors factors;
    factors.fill(1);
    for (int l = 0; l < light.order; ++l) {
        double& factor = factors[static_cast<std::size_t>(l)];
        if (window == prt::Window::hann)
            factor = prt::hann_window(l, light.order);
        else if (window == prt::Window::lanczos)
            factor = prt::lanczos_window(l, light.order);
    }
    return factors;
}

/// Returns the exit radiance interpolated at `points`, with all lamps off.
template <class Transfer>
Radiance radiance_at(const prt::SurfacePoints& points, const Transfer& transfer,
                     const prt::TransferLayout& layout, prt::Lighting lighting) {
    lighting.lamps.assign(layout.lamps(), glm::vec3(0));
    return prt::interpolated(points, prt::exit_radiance(transfer, lighting, threads_beside_drawing()));
}

/// Returns the raw transfer baked with another seed; reuses the existing one if the subject has it.
std::shared_ptr<const prt::Transfer> repeated(Channel& channel, const BudgetSubject& subject) {
    if (subject.repeated)
        return subject.repeated;
    channel.enter(Stage::baking, "baking with another seed");
    const LoadedModel& loaded = subject.loaded;
    auto repeated = std::make_shared<const prt::Transfer>(prt::repeated_bake(
        loaded.model->scene, *loaded.raw, loaded.record, threads_beside_drawing(), channel.progress()));
    channel.post(RepeatedBake{loaded.raw, repeated});
    return repeated;
}

/// Returns the colors of the picture of the total error.
std::vector<glm::vec3> total_colors(const Model& model, const prt::SurfacePoints& points,
                                    const prt::SurfaceRadiance& reference, const Radiance& shown) {
    std::vector<double> squared;
    double norm = 0, area = 0;
    for (std::size_t p = 0; p < points.size(); ++p) {
        const glm::dvec3 a(reference.truth(0)[p]), b(reference.truth(1)[p]), sun(reference.suns()[p]),
            at_point(shown[p]);
        squared.push_back(glm::dot(at_point - a, at_point - b)); // unbiased, because the
                                                                 // noise of `a` and `b` is independent
        norm += static_cast<double>(points.receivers.areas[p]) * glm::dot(a + sun, b + sun);
        area += static_cast<double>(points.receivers.areas[p]);
    }
    return surface_error_colors(model, points, squared, norm / area);
}

/// Spreads sums from receivers with a weight to receivers without one, by one edge per iteration.
void spread(const std::vector<prt::Edge>& edges, std::vector<double>& sums, std::vector<double>& weights) {
    for (bool more = true; more;) {
        more = false;
        const std::vector<double> before = weights;
        for (const prt::Edge& edge : edges)
            for (const auto& [from, to] :
                 {std::pair(edge.first, edge.second), std::pair(edge.second, edge.first)})
                if (before[from] > 0 && !(before[to] > 0)) {
                    sums[to] += sums[from] / before[from];
                    weights[to] += 1;
                    more = true;
                }
    }
}

} // namespace

std::vector<glm::vec3> surface_error_colors(const Model& model, const prt::SurfacePoints& points,
                                            std::span<const double> squared, double norm) {
    const glm::vec3 unknown(0.01f, 0.02f, 0.08f);
    std::vector<double> sums(model.areas.size(), 0), weights = sums;
    for (std::size_t p = 0; p < points.size(); ++p) {
        const std::array<float, 3> shares = points.shares(p);
        for (int corner = 0; corner < 3; ++corner) {
            const double weight = static_cast<double>(points.receivers.areas[p]) *
                                  static_cast<double>(shares[static_cast<std::size_t>(corner)]);
            sums[points.corners[p][corner]] += weight * squared[p];
            weights[points.corners[p][corner]] += weight;
        }
    }
    spread(model.edges, sums, weights);
    std::vector<glm::vec3> colors;
    for (std::size_t r = 0; r < sums.size(); ++r) {
        const double mean = weights[r] > 0 ? std::max(0.0, sums[r] / weights[r]) : 0;
        colors.push_back(weights[r] > 0 && norm > 0
                             ? prt::heat_color(std::sqrt(mean / norm) / kWhiteSurfaceError)
                             : unknown);
    }
    return colors;
}

void find_budget(Channel& channel, const BudgetSubject& subject) {
    const LoadedModel& loaded = subject.loaded;
    const Model& model = *loaded.model;
    check_no_media(model.scene);
    const int order = loaded.compressed ? loaded.compressed->bases.layout.order : loaded.raw->layout.order;
    const auto again = repeated(channel, subject);
    channel.enter(Stage::measuring, "tracing paths from the surface");
    const bool separate = subject.version.separate_suns && loaded.raw->layout.has(prt::TermKind::direct);
    const prt::ReferenceLight light =
        separate ? subject.rig.separate_reference_light() : subject.rig.reference_light();
    const int threads = threads_beside_drawing();
    const prt::Progress progress = channel.progress();
    const prt::SurfacePoints points =
        prt::surface_points(*model.trace, {.threads = threads}, {{}, progress.stop});
    if (points.size() == 0)
        throw prt::Error("no light reaches a surface of the model, so no error can be measured");
    const prt::SurfaceRadiance reference(
        *model.trace, points, light, {.max_paths = kMaxPaths, .noise = kNoise, .threads = threads}, progress);

    const prt::Light sky = prt::truncated(light.sky_bands, subject.light_order);
    const prt::BandFactors factors = window_factors(sky, subject.rig.settings().window);
    const prt::Lighting lighting = light.lighting(subject.light_order, factors);
    const auto baked_at = [&](const prt::Transfer& transfer) {
        return radiance_at(points, truncated(transfer, order), transfer.layout, lighting);
    };
    prt::InterpolatedRadiance radiance{baked_at(*loaded.raw), baked_at(*again), {}};
    radiance.shipped =
        loaded.compressed ? radiance_at(points, *loaded.compressed, loaded.compressed->bases.layout, lighting)
                          : radiance.baked;
    const prt::BandTruncation cut{order, loaded.record.endless ? prt::kEndlessBounces : loaded.record.bounces,
                                  factors};
    channel.post(SurfaceBudget{loaded.model, subject.version,
                               prt::error_budget(points, reference, cut, radiance),
                               total_colors(model, points, reference, radiance.shipped)});
}

} // namespace viewer
