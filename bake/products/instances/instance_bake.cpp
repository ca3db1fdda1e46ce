// Bakes a scene of instances: separate meshes first, then everything that is drawn once and samples of the
// instances in the whole scene. Light bounces between all of them; the light of an instance is its mesh's
// light under its factors.

#include "prt/bake/instance_bake.h"

#include "bake/pipeline/equal_rays.h"
#include "bake/pipeline/record.h"
#include "bake/plan/check_options.h"
#include "bake/plan/memory.h"
#include "bake/products/instances/instance_lamps.h"
#include "bake/products/instances/instance_light.h"
#include "bake/products/instances/instance_scales.h"
#include "bake/tracers/make_tracer.h"
#include "prt/core/error.h"
#include "runtime/core/support/stopwatch.h"

#include <algorithm>
#include <map>

namespace prt {
namespace {

void check_instance_options(const BakeOptions& options, const InstanceBakeOptions& instances) {
    check_options(options);
    if (instances.samples < 8 || !(instances.rays > 0 && instances.rays <= 1))
        throw Error("the number of samples per instance must be at least 8, and their share of rays in 0..1");
}

/// Returns `options` with a decision about the fit, and without lamps.
BakeOptions of_sky(BakeOptions options) {
    if (options.fit == FitMode::automatic)
        options.fit = FitMode::vertex;
    options.lamps.mode = LampMode::none;
    return options;
}

/// Returns for each vertex array of the stored scene its vertex array in the flat scene, if it belongs to no
/// instance.
std::vector<std::size_t> flat_arrays(const InstanceScene& scene) {
    std::map<std::pair<int, int>, std::size_t> of; // (node of `stored`, primitive)
    for (const Primitive& primitive : scene.scene.primitives)
        of[{scene.node_of[static_cast<std::size_t>(primitive.node)], primitive.primitive}] =
            primitive.vertices;
    std::vector<std::size_t> result(scene.stored.vertex_arrays.size(), ~std::size_t{0});
    for (const Primitive& primitive : scene.stored.primitives)
        if (const auto found = of.find({primitive.node, primitive.primitive}); found != of.end())
            result[primitive.vertices] = found->second;
    return result;
}

class InstanceBaker {
public:
    InstanceBaker(const InstanceScene& scene, const BakeOptions& options,
                  const InstanceBakeOptions& instances)
        : scene_(scene), with_lamps_(options), options_(of_sky(options)), instances_(instances),
          traced_(trace_scene(scene.scene, choose_media(scene.scene, options_), options_)),
          plan_(plan_bake(traced_, choose_media(scene.scene, options_), options_)) {
        check_memory(plan_);
    }

    InstanceBake run(const Progress& progress) {
        const Stopwatch watch;
        bake_meshes(progress.range(0, 0.3));
        InstanceReceivers receivers = choose_receivers(scene_, plan_, meshes_, instances_.samples);
        const std::unique_ptr<Tracer> tracer = make_tracer(traced_, options_.tracer);
        InstanceLight light(plan_, {*tracer, tracer->rays()}, meshes_, std::move(receivers), instances_);
        const bool lamps = has_lamps();
        light.trace(progress.range(0.3, lamps ? 0.5 : 0.9));
        light.bounce(progress.range(lamps ? 0.5 : 0.9, lamps ? 0.6 : 1));
        if (options_.fit == FitMode::surface)
            light.fit_own({{}, progress.stop});
        result_.baked.transfer = assembled(light);
        record(*tracer, light);
        result_.instances.factors = light.factors();
        for (const SharedMeshBake& mesh : meshes_)
            result_.instances.boxes.push_back(mesh.box);
        result_.errors = light.errors();
        if (lamps) {
            result_.flat_lamps = scene_.flat_lamps
                                     ? scene_.flat_lamps
                                     : bake_lamps(scene_.scene, with_lamps_, progress.range(0.6, 1));
            add_lamps(fit_instance_lamps(result_.flat_lamps, meshes_, light.receivers(), options_.threads));
        }
        result_.statistics.seconds = watch.seconds();
        progress.update(1);
        return std::move(result_);
    }

private:
    /// Calls `take(stored, flat)` with the receivers, in both scenes, of each vertex that is drawn once.
    template <class Take>
    void for_each_own_vertex(const Take& take) const {
        const std::vector<std::size_t> flat = flat_arrays(scene_);
        for (std::size_t a = 0; a < flat.size(); ++a) {
            if (flat[a] == ~std::size_t{0})
                continue;
            const std::size_t first = scene_.scene.vertex_arrays[flat[a]].first_receiver;
            const VertexArray& vertices = scene_.stored.vertex_arrays[a];
            for (std::size_t v = 0; v < vertices.size(); ++v)
                take(vertices.first_receiver + v, first + v);
        }
    }

    bool has_lamps() const {
        return with_lamps_.lamps.mode != LampMode::none &&
               !choose_lamps(traced_.surfaces(), with_lamps_.lamps).empty();
    }

    /// Adds the light of lamps to the transfer of everything that is drawn once, and to the instances.
    void add_lamps(InstanceLamps lamps) {
        Transfer& transfer = result_.baked.transfer;
        TransferLayout layout = transfer.layout;
        layout.terms.insert(layout.terms.end(), lamps.terms().begin(), lamps.terms().end());
        Transfer all = zero_transfer(layout, transfer.receivers());
        for (std::size_t r = 0; r < all.receivers(); ++r)
            std::ranges::copy(transfer.vector(r), all.vector(r).begin());
        for_each_own_vertex([&](std::size_t stored, std::size_t flat) {
            std::ranges::copy(lamps.numbers(flat), all.vector(stored).subspan(transfer.dimension()).begin());
        });
        transfer = std::move(all);
        result_.lamp_errors = std::move(lamps.errors);
        result_.instances.lamps = std::move(lamps.lights);
        const BakeStatistics& statistics = lamps.flat->statistics;
        result_.statistics.rays += scene_.flat_lamps ? 0 : statistics.rays;
        for (const std::string& notice : statistics.notices)
            if (std::ranges::find(result_.statistics.notices, notice) == result_.statistics.notices.end())
                result_.statistics.notices.push_back(notice);
    }

    void bake_meshes(const Progress& progress) {
        const auto count = static_cast<double>(scene_.meshes.size());
        for (std::size_t m = 0; m < scene_.meshes.size(); ++m) {
            meshes_.push_back(bake_shared_mesh(
                scene_.stored,
                {scene_.mesh_nodes[m], scale_to_bake(scene_.scene, scene_.meshes[m].placements, options_)},
                plan_, progress.range(static_cast<double>(m) / count, static_cast<double>(m + 1) / count)));
            result_.statistics.receivers += receivers_on_surfaces(meshes_.back().receivers()).size();
            result_.statistics.rays += meshes_.back().rays;
        }
    }

    /// Joins the transfer of the stored scene.
    Transfer assembled(const InstanceLight& light) const {
        const int direct_channels = plan_.direct_channels();
        const Transfer own = light.own_fronts(direct_channels);
        Transfer all = zero_transfer(own.layout, scene_.stored.receivers());
        const std::size_t dimension = all.dimension();
        const auto to = [&](const VertexArray& vertices) {
            return all.vectors.begin() + static_cast<std::ptrdiff_t>(vertices.first_receiver * dimension);
        };
        for_each_own_vertex([&](std::size_t stored, std::size_t flat) {
            if (const std::uint32_t r = light.receivers().own_of[flat]; r != kNoReceiver)
                std::ranges::copy(own.vector(r), all.vector(stored).begin());
        });
        for (std::size_t m = 0; m < meshes_.size(); ++m) {
            const Transfer mesh = stored_transfer(meshes_[m], direct_channels);
            std::size_t next = 0;
            std::vector<bool> seen(scene_.stored.vertex_arrays.size());
            for (const Primitive& primitive : scene_.stored.primitives) {
                if (primitive.node != scene_.mesh_nodes[m] || seen[primitive.vertices])
                    continue;
                seen[primitive.vertices] = true;
                const VertexArray& vertices = scene_.stored.vertex_arrays[primitive.vertices];
                std::copy_n(mesh.vectors.begin() + static_cast<std::ptrdiff_t>(next * dimension),
                            vertices.size() * dimension, to(vertices));
                next += vertices.size();
            }
        }
        return all;
    }

    void record(const Tracer& tracer, const InstanceLight& light) {
        BakedTransfer& baked = result_.baked;
        InstanceStatistics& statistics = result_.statistics;
        statistics.receivers += light.receivers().own.size();
        statistics.samples = light.receivers().sampled.size();
        statistics.rays += light.rays();
        statistics.lights = instances_.lights.size();
        statistics.alone = light.alone();
        statistics.bounces = light.bounces();
        statistics.notices = plan_.notices;
        double sampling = light.sampling_error();
        for (const SharedMeshBake& mesh : meshes_)
            sampling = std::max(sampling, mesh.sampling_error);
        if (options_.target_error && sampling > *options_.target_error)
            statistics.notices.push_back(missed_target());
        const double rounding = float16_rounding_error(baked.transfer, receiver_areas(scene_.stored));
        baked.storage = storage_for(options_.memory.storage, {.rounding = rounding, .sampling = sampling},
                                    statistics.notices);
        baked.record = {.bounces = statistics.bounces,
                        .endless = options_.bounces == kEndlessBounces,
                        .rays = light.rays_per_receiver(),
                        .seed = options_.seed,
                        .method = tracer.method(),
                        .backend = tracer.backend(),
                        .receivers = receivers_id(scene_.scene),
                        .sampling_error = sampling,
                        .media = added_media(scene_.scene, choose_media(scene_.scene, options_)),
                        .fitted = options_.fit == FitMode::surface};
    }

    const InstanceScene& scene_;
    BakeOptions with_lamps_, options_;
    InstanceBakeOptions instances_;
    TraceScene traced_;
    BakePlan plan_;
    std::vector<SharedMeshBake> meshes_;
    InstanceBake result_;
};

} // namespace

InstanceBake bake_instances(const InstanceScene& scene, const BakeOptions& options,
                            const InstanceBakeOptions& instances, const Progress& progress) {
    check_instance_options(options, instances);
    return InstanceBaker(scene, options, instances).run(progress);
}

} // namespace prt
