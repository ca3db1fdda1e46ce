// Measures the number of vertices that a scene needs for an error over its surface: triangles split where
// light requires it, against repeated splits of all triangles into four. Evaluated at independent points.
//   refinement_benchmark SCENE [TARGET [RAYS [LEVELS]]]

#include "bake/reference/surface_reference.h"
#include "prt/bake/bake.h"
#include "prt/bake/refine.h"

#include <glm/vec3.hpp>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <map>
#include <utility>

namespace {

/// Splits every triangle into four at the midpoints of its edges.
prt::Scene split_evenly(const prt::Scene& scene) {
    prt::Refinement even = prt::no_refinement(scene);
    std::vector<std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t>> middles(
        scene.vertex_arrays.size());
    for (std::size_t p = 0; p < scene.primitives.size(); ++p) {
        const std::size_t array = scene.primitives[p].vertices;
        const auto middle = [&](std::uint32_t a, std::uint32_t b) {
            const auto next =
                static_cast<std::uint32_t>(scene.vertex_arrays[array].size() + even.midpoints[array].size());
            const auto [found, is_new] = middles[array].try_emplace(std::minmax(a, b), next);
            if (is_new)
                even.midpoints[array].push_back({a, b});
            return found->second;
        };
        even.triangles[p].clear();
        for (const glm::uvec3& t : scene.primitives[p].triangles) {
            const std::uint32_t xy = middle(t.x, t.y), yz = middle(t.y, t.z), zx = middle(t.z, t.x);
            for (const glm::uvec3& part : {glm::uvec3(t.x, xy, zx), glm::uvec3(xy, t.y, yz),
                                           glm::uvec3(zx, yz, t.z), glm::uvec3(xy, yz, zx)})
                even.triangles[p].push_back(part);
        }
    }
    return prt::refined(scene, even);
}

double surface_error(const prt::Scene& scene, const prt::BakeOptions& options) {
    const prt::TraceScene traced(scene);
    const prt::SurfaceReference reference(traced, {.order = options.order, .points = 6000});
    return reference.relative_l2(prt::bake(scene, options).baked.transfer);
}

void run(int argc, char** argv) {
    const auto number = [&](int i, double otherwise) { return argc > i ? std::atof(argv[i]) : otherwise; };
    const prt::Scene scene = prt::extract_scene(prt::load_gltf(argv[1]));
    prt::BakeOptions options;
    options.rays = static_cast<int>(number(3, 4096));
    options.fit = prt::FitMode::surface;
    options.lamps.mode = prt::LampMode::none;
    const prt::RefineResult result =
        prt::refine(scene, options, {.target = number(2, 0.02), .max_vertices = 1'000'000});
    const prt::RefineStatistics& s = result.statistics;
    const double reached = surface_error(prt::refined(scene, result.refinement), options);
    std::printf(
        "refined: %zu vertices (of %zu), %d rounds, estimate %.3f %% (before %.3f %%), error %.3f %%, "
        "%.2f s, %zu points of %d rays\n",
        s.after.vertices, s.before.vertices, s.rounds, 100 * s.after.error, 100 * s.before.error,
        100 * reached, s.seconds, s.points, s.rays_per_point);
    std::fflush(stdout);
    prt::Scene even = scene;
    double last_error = 0, last_vertices = 0;
    for (int level = 0; level <= static_cast<int>(number(4, 4)); ++level) {
        const double error = surface_error(even, options), vertices = static_cast<double>(even.receivers());
        std::printf("even, level %d: %.0f vertices, error %.3f %%\n", level, vertices, 100 * error);
        std::fflush(stdout);
        if (error <= reached && level > 0) { // a straight line in logarithms between two levels
            const double at = std::log(last_error / reached) / std::log(last_error / error),
                         needed = last_vertices * std::pow(vertices / last_vertices, at);
            std::printf("even splitting needs %.0f vertices: %.2f times as many\n", needed,
                        needed / static_cast<double>(s.after.vertices));
            return;
        }
        last_error = error;
        last_vertices = vertices;
        even = split_evenly(even);
    }
}

} // namespace

int main(int argc, char** argv) {
    if (argc < 2) {
        std::fprintf(stderr, "refinement_benchmark SCENE [TARGET [RAYS [LEVELS]]]\n");
        return 2;
    }
    try {
        run(argc, argv);
    } catch (const std::exception& error) {
        std::fprintf(stderr, "%s\n", error.what());
        return 1;
    }
    return 0;
}
