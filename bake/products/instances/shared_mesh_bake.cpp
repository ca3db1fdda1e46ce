// Bakes a separate mesh on both sides of its surfaces.

#include "bake/products/instances/shared_mesh_bake.h"

#include "bake/pipeline/direct_transfer.h"
#include "bake/pipeline/light_transport.h"
#include "bake/plan/transfer_terms.h"
#include "bake/products/instances/own_fit.h"
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

/// Options for a mesh, at its vertices. Media have lengths in metres.
BakeOptions options_of_mesh(const BakePlan& whole, double scale) {
    BakeOptions options = whole.options;
    options.bounces = whole.bounces;
    options.fit = FitMode::vertex;
    options.subsurface.metres_per_unit *= scale;
    return options;
}

SharedMeshBake planned(const Scene& stored, const MeshToBake& to_bake, const BakePlan& whole) {
    SharedMeshBake mesh;
    mesh.scene = std::make_unique<const Scene>(scene_of(stored, to_bake.node));
    mesh.options = std::make_unique<const BakeOptions>(options_of_mesh(whole, to_bake.scale));
    const Media media = choose_media(*mesh.scene, *mesh.options);
    std::vector<bool> solid;
    for (const auto& medium : media)
        solid.push_back(medium.has_value());
    mesh.traced = std::make_unique<const TraceScene>(
        *mesh.scene, load_textures(*mesh.scene, mesh.options->repairs.bad_textures, TextureNeeds::all),
        TraceSceneOptions{.solid = std::move(solid), .threads = mesh.options->threads});
    mesh.plan = std::make_unique<const BakePlan>(plan_bake(*mesh.traced, media, *mesh.options));
    std::vector<glm::vec3> positions;
    for (const VertexArray& vertices : mesh.scene->vertex_arrays)
        for (const glm::vec3& position : vertices.positions)
            positions.emplace_back(mesh.scene->world(position));
    mesh.box = bounding_box(positions);
    return mesh;
}

/// The mesh's light transport.
struct MeshOperators {
    const BakePlan& plan;
    const Measured& measured;

    TransportOperators operators() const {
        return {.refill = measured.sealed.refill,
                .diffusion = plan.diffusion,
                .gather = measured.direct.gather ? &*measured.direct.gather : nullptr};
    }
    /// Direct light that arrives at all receivers.
    Transfer incident() const {
        Transfer light = measured.direct.transfer;
        light.layout.terms.front().kind = TermKind::direct;
        return plan.channels == 3 ? in_color(light) : light;
    }
    Transfer exit(int bounces, const Progress& progress) const {
        return propagate(incident(), operators(), bounces, plan.options.threads, progress).transfer;
    }
    /// Light that arrives from surfaces with `exit` transfer, and direct light.
    Transfer arriving(Transfer exit) const {
        Transfer light = incident();
        if (measured.direct.gather) {
            const int order = plan.options.order, threads = plan.options.threads;
            std::vector<float> bounced(light.vectors.size());
            measured.direct.gather->reflect(order, exit.vectors, threads);
            measured.direct.gather->apply(order, exit.vectors, 0, bounced, threads);
            for (std::size_t i = 0; i < bounced.size(); ++i)
                light.vectors[i] += bounced[i];
        }
        measured.sealed.refill.apply(std::span(light.vectors), light.dimension());
        return light;
    }
};

/// Adds transfer after `bounces` bounces to `mesh`. `direct`: exit transfer without a bounce.
void add_step(const MeshOperators& mesh, const Transfer& direct, int channels, int bounces,
              const Progress& progress, SharedMeshBake& to) {
    const auto wide = [&](Transfer light) {
        return channels == 3 && light.layout.channels() == 1 ? in_color(light) : light;
    };
    Transfer exit = mesh.exit(bounces, progress);
    to.after.push_back(optional_work(direct, wide(exit)));
    if (mesh.plan.diffusion.empty())
        return;
    Transfer incident = mesh.measured.direct.transfer, all = mesh.incident();
    mesh.measured.sealed.refill.apply(std::span(incident.vectors), incident.dimension());
    if (bounces == 0)
        mesh.measured.sealed.refill.apply(std::span(all.vectors), all.dimension());
    else
        all = mesh.arriving(bounces == kEndlessBounces ? std::move(exit) : mesh.exit(bounces - 1, progress));
    const Transfer arriving = optional_work(incident, wide(std::move(all)));
    to.arriving.push_back(to.after.back());
    for (const DiffusionOperator& body : mesh.plan.diffusion)
        for (const std::uint32_t r : body.members())
            std::ranges::copy(arriving.vector(r), to.arriving.back().vector(r).begin());
}

/// Fits light to samples between the vertices, for the written transfer.
void fit_surface(const BakePlan& whole, Tracer& tracer, const Progress& progress, SharedMeshBake& mesh) {
    BakeOptions options = *mesh.options;
    options.fit = FitMode::surface;
    const BakePlan plan = plan_bake(*mesh.traced, choose_media(*mesh.scene, options), options);
    BakeStatistics asked;
    const Measured measured = measure(plan, tracer, LastOfLamps::as_others, asked, progress);
    FittedTransfer light = fitted_transfer(plan, measured, {{}, progress.stop});
    if (whole.channels == 3 && light.all.layout.channels() == 1)
        light.all = in_color(light.all);
    mesh.fitted = has_rest(whole) ? optional_work(light.direct, light.all) : std::move(light.direct);
    mesh.rays += asked.rays + measured.direct.rays + measured.sealed.rays;
    mesh.sampling_error = measured.direct.sampling_error;
}

} // namespace

bool has_rest(const BakePlan& plan) {
    return plan.bounces != 0 || !plan.diffusion.empty();
}

glm::vec3 SharedMeshBake::position_of(std::size_t receiver) const {
    return box.position_of(glm::vec3(scene->world(receivers().positions[receiver])));
}

SharedMeshBake bake_shared_mesh(const Scene& stored, const MeshToBake& to_bake, const BakePlan& whole,
                                const Progress& progress) {
    SharedMeshBake mesh = planned(stored, to_bake, whole);
    const BakeOptions& options = *mesh.options;
    const std::unique_ptr<Tracer> tracer = make_tracer(*mesh.traced, options.tracer);
    BakeStatistics asked;
    Measured measured = measure(*mesh.plan, *tracer, LastOfLamps::as_others, asked, progress);
    mesh.rays = measured.direct.rays + measured.sealed.rays;
    mesh.mean_rays = measured.direct.mean_rays;
    mesh.sampling_error = measured.direct.sampling_error;
    const MeshOperators operators{*mesh.plan, measured};
    const Transfer direct =
        exit_without_bounces(*mesh.plan, measured.direct.transfer, measured.sealed.refill);
    if (!has_rest(whole)) {
        mesh.after.push_back(direct);
    } else {
        const bool endless = options.bounces == kEndlessBounces;
        const int steps = endless ? 2 : options.bounces + 1;
        for (int step = 0; step < steps; ++step)
            add_step(operators, direct, whole.channels, endless && step > 0 ? kEndlessBounces : step,
                     {{}, progress.stop}, mesh);
    }
    for (std::vector<Transfer>* const transfer : {&mesh.after, &mesh.arriving})
        for (Transfer& light : *transfer)
            measured.shared->average(light);
    if (whole.options.fit == FitMode::surface)
        fit_surface(whole, *tracer, {{}, progress.stop}, mesh);
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
    return of_fronts(*mesh.plan, mesh.stored(), direct_channels);
}

} // namespace prt
