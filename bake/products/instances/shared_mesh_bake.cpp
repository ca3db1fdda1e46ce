// Bakes a separate mesh on both sides of its surfaces.

#include "bake/products/instances/shared_mesh_bake.h"

#include "bake/pipeline/direct_transfer.h"
#include "bake/pipeline/light_transport.h"
#include "bake/plan/transfer_terms.h"
#include "bake/tracers/make_tracer.h"
#include "prt/core/sh_basis.h"

#include <algorithm>

namespace prt {
namespace {

Scene scene_of(const Scene& stored, int node) {
    Scene scene;
    scene.origin = stored.origin;
    scene.materials = stored.materials;
    scene.images = stored.images;
    std::size_t first = 0;
    std::vector<std::size_t> array_of(stored.vertex_arrays.size(), ~std::size_t{0});
    for (const Primitive& from : stored.primitives) {
        if (from.node != node)
            continue;
        std::size_t& array = array_of[from.vertices];
        if (array == ~std::size_t{0}) {
            array = scene.vertex_arrays.size();
            scene.vertex_arrays.push_back(stored.vertex_arrays[from.vertices]);
            scene.vertex_arrays.back().first_receiver = first;
            first += scene.vertex_arrays.back().size();
        }
        scene.primitives.push_back(from);
        scene.primitives.back().vertices = array;
    }
    return scene;
}

/// Joins `direct` of one channel and the difference of `all` from it, which has the channels of bounced
/// light.
Transfer optional_work(const Transfer& direct, const Transfer& all) {
    const int order = direct.layout.order, channels = all.layout.channels();
    Transfer both =
        zero_transfer({order, {{TermKind::direct, 1}, {TermKind::indirect, channels}}}, direct.receivers());
    const std::size_t count = direct.dimension();
    for (std::size_t r = 0; r < both.receivers(); ++r) {
        const std::span<float> to = both.vector(r);
        std::ranges::copy(direct.vector(r), to.begin());
        for (std::size_t i = 0; i < all.dimension(); ++i)
            to[count + i] = all.vector(r)[i] - direct.vector(r)[i % count];
    }
    return both;
}

} // namespace

glm::vec3 SharedMeshBake::position_of(std::size_t receiver) const {
    return box.position_of(glm::vec3(scene->world(receivers().positions[receiver])));
}

SharedMeshBake bake_shared_mesh(const Scene& stored, int node, int channels, const BakeOptions& options,
                                const Progress& progress) {
    SharedMeshBake mesh;
    mesh.scene = std::make_unique<const Scene>(scene_of(stored, node));
    const Media media = choose_media(*mesh.scene, options);
    mesh.traced = std::make_unique<const TraceScene>(
        *mesh.scene, load_textures(*mesh.scene, options.repairs.bad_textures, TextureNeeds::all),
        TraceSceneOptions{.solid = {}, .threads = options.threads});
    mesh.plan = std::make_unique<const BakePlan>(plan_bake(*mesh.traced, media, options));
    std::vector<glm::vec3> positions;
    for (const VertexArray& vertices : mesh.scene->vertex_arrays)
        for (const glm::vec3& position : vertices.positions)
            positions.emplace_back(mesh.scene->world(position));
    mesh.box = bounding_box(positions);

    const std::unique_ptr<Tracer> tracer = make_tracer(*mesh.traced, options.tracer);
    BakeStatistics asked;
    Measured measured = measure(*mesh.plan, *tracer, LastOfLamps::as_others, asked, progress);
    mesh.rays = measured.direct.rays + measured.sealed.rays;
    mesh.sampling_error = measured.direct.sampling_error;
    const Transfer direct =
        exit_without_bounces(*mesh.plan, measured.direct.transfer, measured.sealed.refill);
    if (options.bounces == 0) {
        mesh.after.push_back(direct);
        return mesh;
    }
    const TransportOperators operators{.refill = measured.sealed.refill,
                                       .diffusion = {},
                                       .gather = measured.direct.gather ? &*measured.direct.gather : nullptr};
    const std::vector<int> wanted =
        options.bounces == kEndlessBounces ? std::vector<int>{0, kEndlessBounces} : std::vector<int>{};
    const int steps = wanted.empty() ? options.bounces + 1 : 2;
    for (int step = 0; step < steps; ++step) {
        const int bounces = wanted.empty() ? step : wanted[static_cast<std::size_t>(step)];
        Transfer light = mesh.plan->channels == 3 ? in_color(direct) : direct;
        Transfer all =
            propagate(std::move(light), operators, bounces, options.threads, {{}, progress.stop}).transfer;
        if (channels == 3 && all.layout.channels() == 1)
            all = in_color(all);
        mesh.after.push_back(optional_work(direct, all));
    }
    return mesh;
}

Transfer of_fronts(const BakePlan& plan, const Transfer& both_sides, int direct_channels) {
    const std::size_t count = static_cast<std::size_t>(coefficient_count(both_sides.layout.order));
    const auto term = [&](std::size_t first, TermKind kind, int stored, int channels) {
        Transfer one =
            zero_transfer(layout_of_one(both_sides.layout.order, channels, kind), both_sides.receivers());
        for (std::size_t r = 0; r < one.receivers(); ++r)
            for (std::size_t c = 0; c < static_cast<std::size_t>(channels); ++c)
                std::copy_n(&both_sides.vector(r)[first + (stored == 1 ? 0 : c) * count], count,
                            &one.vector(r)[c * count]);
        if (plan.scene.surfaces().traits().transmission)
            add_transmission(one, plan.scene.surfaces(), *plan.transport);
        one.vectors.resize(plan.transport->fronts * one.dimension());
        return one;
    };
    Transfer direct = term(0, TermKind::direct, 1, direct_channels);
    if (both_sides.layout.terms.size() == 1)
        return direct;
    const int channels = both_sides.layout.terms[1].channels;
    const Transfer rest = term(count, TermKind::indirect, channels, channels);
    Transfer all = zero_transfer({direct.layout.order, {direct.layout.terms[0], rest.layout.terms[0]}},
                                 direct.receivers());
    for (std::size_t r = 0; r < all.receivers(); ++r)
        std::ranges::copy(rest.vector(r), std::ranges::copy(direct.vector(r), all.vector(r).begin()).out);
    return all;
}

Transfer stored_transfer(const SharedMeshBake& mesh, int direct_channels) {
    return of_fronts(*mesh.plan, mesh.after.back(), direct_channels);
}

} // namespace prt
