// Bakes poses, and averages them in the frames of the vertices.

#include "prt/bake/pose_bake.h"

#include "bake/products/levels/level_surface.h"
#include "prt/bake/bake.h"
#include "prt/core/error.h"
#include "runtime/core/support/parallel.h"

#include <glm/gtc/matrix_transform.hpp>

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

namespace prt {
namespace {

/// Weight of a pose at a vertex that it seals in, where the light is that of neighbours. It is negligible
/// compared to poses that show the vertex, but used if no pose does.
constexpr double kSealedWeight = 1e-6;

constexpr std::size_t kGrain = 512; ///< vertices per task

/// Throws `Error` for vertices that are too far away: animations have finite values, but the resulting
/// positions can be arbitrary.
void check_positions(const Scene& scene, const ModelPose& pose) {
    for (const VertexArray& vertices : scene.vertex_arrays)
        for (const glm::vec3& p : vertices.positions)
            if (!(std::max({std::abs(p.x), std::abs(p.y), std::abs(p.z)}) <=
                  static_cast<float>(kFarthestVertex)))
                throw Error("animation '" + pose.animation + "' moves vertices farther than " +
                            std::to_string(static_cast<long>(kFarthestVertex)) + " m from the origin at " +
                            std::to_string(pose.seconds) + " s");
}

/// Returns the high-poly model in the pose of `model`, in the frame of `scene_in_pose`; empty if there is
/// none.
std::optional<Scene> high_poly_in_pose(const AnimatedScene& model, const ModelPose& pose,
                                       const PoseBakeOptions& options) {
    if (!options.high_poly)
        return std::nullopt;
    const ModelPose following{pose.animation, pose.seconds, options.high_poly->followed(model, pose.nodes)};
    std::optional<Scene> scene =
        options.high_poly->posed(following.nodes, glm::translate(glm::dmat4(1), -model.scene().origin));
    check_positions(*scene, following);
    return scene;
}

/// Bakes level 0 in a pose, and the coarser levels of `nodes`, whose results `levels` takes.
PoseTransfer bake_levels_in(const AnimatedScene& model, const ModelPose& pose,
                            const std::vector<LeveledNode>& nodes, const PoseBakeOptions& options,
                            const Progress& progress, LevelBake& levels) {
    const LeveledScene scene = scene_in_pose(model, pose, nodes);
    const std::optional<Scene> detailed = high_poly_in_pose(model, pose, options);
    const FinerModel finer{detailed ? &*detailed : nullptr, options.reach};
    const BakeOptions how = bake_options_of(options);
    const double share = 1 / (1 + static_cast<double>(scene.deepest()));
    std::optional<Scene> finest;
    if (scene.finest_primitives < scene.scene.primitives.size())
        finest = with_level(scene, 0).scene;
    BakeResult result =
        bake(finest ? *finest : scene.scene, how, progress.range(0, share), MeasureErrors::no, finer);
    Transfer transfer = std::move(result.baked.transfer);
    std::vector<std::uint32_t> sealed = std::move(result.sealed);
    if (!scene.nodes.empty()) {
        levels =
            transfer_of_levels(scene, transfer, options.levels, how, sealed, progress.range(share, 1), finer);
        transfer = std::move(levels.transfer);
        sealed.insert(sealed.end(), levels.sealed.begin(), levels.sealed.end());
    }
    PoseTransfer baked{as_combined(transfer, options.threads),
                       receiver_areas(scene.scene),
                       {},
                       result.statistics.rays,
                       result.baked.record.rays,
                       std::move(result.statistics.notices)};
    baked.transfer.vectors.resize(scene.scene.receivers() * baked.transfer.dimension());
    baked.sealed.resize(baked.areas.size());
    for (const std::uint32_t v : sealed) {
        baked.sealed[v] = true;
        baked.areas[v] = 0;
    }
    return baked;
}

void add_pose(const PoseTransfer& baked, const VertexFrames& frames, int threads,
              std::vector<double>& weights, MeanTransfer& mean) {
    const bool first = mean.rest.empty();
    if (first)
        mean.rest.resize(mean.vectors.size());
    const std::size_t c = mean.coefficients();
    parallel_for(mean.vertices(), kGrain, threads, [&](std::size_t begin, std::size_t end) {
        std::vector<double> vector(c);
        for (std::size_t v = begin; v < end; ++v) {
            grey_vector(baked.transfer, v, vector);
            frames.from_world(mean.order, v, vector, vector);
            const double weight = baked.sealed[v] ? kSealedWeight : 1;
            weights[v] += weight;
            for (std::size_t i = 0; i < c; ++i)
                mean.vectors[v * c + i] += weight * vector[i];
            if (first)
                std::copy(vector.begin(), vector.end(),
                          mean.rest.begin() + static_cast<std::ptrdiff_t>(v * c));
        }
    });
}

} // namespace

BakeOptions bake_options_of(const PoseBakeOptions& options) {
    BakeOptions bake;
    bake.order = options.order;
    bake.rays = options.rays;
    bake.target_error = options.target_error;
    bake.bounces = options.bounces;
    bake.tracer = options.tracer;
    bake.lamps.mode = LampMode::none;
    bake.repairs.bad_textures = options.bad_textures;
    bake.threads = options.threads;
    bake.seed = options.seed;
    return bake;
}

LeveledScene scene_in_pose(const AnimatedScene& model, const ModelPose& pose,
                           std::vector<LeveledNode> nodes) {
    // Relative to the model's origin, floats are precise enough.
    LeveledScene scene = model.posed_levels(pose.nodes, glm::translate(glm::dmat4(1), -model.scene().origin),
                                            std::move(nodes));
    check_positions(scene.scene, pose);
    return scene;
}

void grey_vector(const Transfer& transfer, std::size_t receiver, std::span<double> grey) {
    const std::span<const float> vector = transfer.vector(receiver);
    const auto channels = static_cast<std::size_t>(transfer.layout.channels());
    for (std::size_t i = 0; i < grey.size(); ++i) {
        grey[i] = 0;
        for (std::size_t c = 0; c < channels; ++c)
            grey[i] += static_cast<double>(vector[c * grey.size() + i]) / static_cast<double>(channels);
    }
}

PoseTransfer bake_pose(const AnimatedScene& model, const ModelPose& pose, const PoseBakeOptions& options,
                       const Progress& progress) {
    LevelBake none;
    return bake_levels_in(model, pose, {}, options, progress, none);
}

MeanTransfer mean_of_poses(const AnimatedScene& model, std::span<const ModelPose> poses,
                           const PoseBakeOptions& options, const Progress& progress) {
    const std::size_t vertices = model.scene().receivers();
    MeanTransfer mean;
    mean.order = options.order;
    mean.areas.resize(vertices);
    mean.vectors.resize(vertices * mean.coefficients());
    std::vector<double> weights(vertices);
    const std::vector<LeveledNode> nodes =
        options.levels == LevelMode::ignore ? std::vector<LeveledNode>{} : moving_levels(model, poses);
    double rays = 0, level_seconds = 0;
    const auto share = [&](std::size_t p) {
        return static_cast<double>(p) / static_cast<double>(poses.size());
    };
    for (std::size_t p = 0; p < poses.size(); ++p) {
        PoseBakeOptions of_pose = options;
        of_pose.seed = options.seed + p; // noise of several poses averages out
        LevelBake levels;
        PoseTransfer baked =
            bake_levels_in(model, poses[p], nodes, of_pose, progress.range(share(p), share(p + 1)), levels);
        level_seconds += levels.seconds;
        if (p == 0) {
            mean.levels = std::move(levels);
            mean.notices = std::move(baked.notices);
        }
        add_pose(baked, VertexFrames(model, poses[p]), options.threads, weights, mean);
        for (std::size_t v = 0; v < vertices; ++v)
            mean.areas[v] += baked.areas[v] / static_cast<float>(poses.size());
        mean.rays += baked.rays;
        rays += baked.rays_per_vertex;
    }
    mean.levels.seconds = level_seconds;
    mean.rays_per_vertex = static_cast<int>(std::lround(rays / static_cast<double>(poses.size())));
    const std::vector<float> standing = receiver_areas(model.scene());
    for (std::size_t v = 0; v < vertices; ++v) {
        for (std::size_t i = 0; i < mean.coefficients(); ++i)
            mean.vectors[v * mean.coefficients() + i] /= weights[v];
        if (weights[v] >= 1)
            continue;
        ++mean.hidden;
        mean.areas[v] = 0.01f * standing[v];
    }
    return mean;
}

} // namespace prt
