// Chooses the samples of a mesh: each represents an equal share of its area, in the order of the vertices.

#include "bake/products/instances/instance_receivers.h"

#include "prt/core/error.h"

#include <algorithm>
#include <map>

namespace prt {
namespace {

InstanceSamples choose_samples(const SharedMeshBake& mesh, int most) {
    const Receivers& receivers = mesh.receivers();
    std::vector<std::uint32_t> lit; // sealed receivers provide no information
    double area = 0;
    for (const std::uint32_t r : receivers_on_surfaces(receivers))
        if (mesh.at_samples(0).vector(r)[0] > 0) {
            lit.push_back(r);
            area += static_cast<double>(receivers.areas[r]);
        }
    InstanceSamples samples;
    const bool all = lit.size() <= static_cast<std::size_t>(most);
    const double step = area / most;
    double next = 0.5 * step, passed = 0;
    for (const std::uint32_t r : lit) {
        const auto own = static_cast<double>(receivers.areas[r]);
        passed += own;
        if (!all && passed <= next)
            continue;
        double weight = own;
        if (!all)
            for (weight = 0; next < passed; next += step)
                weight += step;
        samples.receivers.push_back(r);
        samples.positions.push_back(mesh.position_of(r));
        samples.areas.push_back(static_cast<float>(weight));
    }
    float sum = 0;
    for (const float weight : samples.areas)
        sum += weight;
    for (float& weight : samples.areas)
        weight *= static_cast<float>(samples.areas.size()) / sum;
    return samples;
}

/// Receivers of each node's vertices, array by array in the order of the node's primitives.
std::map<int, std::vector<std::uint32_t>> receivers_of_nodes(const Scene& scene) {
    std::map<int, std::vector<std::uint32_t>> result;
    std::vector<bool> seen(scene.vertex_arrays.size());
    for (const Primitive& primitive : scene.primitives) {
        if (seen[primitive.vertices])
            continue;
        seen[primitive.vertices] = true;
        const VertexArray& vertices = scene.vertex_arrays[primitive.vertices];
        for (std::size_t v = 0; v < vertices.size(); ++v)
            result[primitive.node].push_back(static_cast<std::uint32_t>(vertices.first_receiver + v));
    }
    return result;
}

/// Receivers of an instance: fronts, then back sides in the order of its mesh.
std::vector<std::uint32_t> both_sides(const BakePlan& plan, const SharedMeshBake& mesh,
                                      const std::vector<std::uint32_t>& fronts) {
    const TransportReceivers& own = *mesh.plan->transport;
    std::vector<std::uint32_t> all = fronts;
    all.resize(own.receivers.size(), kNoReceiver);
    for (std::uint32_t front = 0; front < fronts.size(); ++front)
        if (const std::uint32_t back = own.back_of(front); back != kNoReceiver)
            all[back] = plan.transport->back_of(fronts[front]);
    return all;
}

} // namespace

std::size_t InstanceReceivers::instance_of_sample(std::size_t sample) const {
    const auto after = std::ranges::upper_bound(instances, sample, {}, &Instance::first_sample);
    return static_cast<std::size_t>(after - instances.begin()) - 1;
}

InstanceReceivers choose_receivers(const InstanceScene& scene, const BakePlan& plan,
                                   const std::vector<SharedMeshBake>& meshes, int samples) {
    const std::map<int, std::vector<std::uint32_t>> of_nodes = receivers_of_nodes(scene.scene);
    InstanceReceivers result;
    std::vector<bool> taken(plan.receivers().size());
    result.sample_of.assign(taken.size(), kNoReceiver);
    for (std::size_t m = 0; m < meshes.size(); ++m) {
        result.samples.push_back(choose_samples(meshes[m], samples));
        for (const MeshPlacement& placement : scene.meshes[m].placements) {
            const std::vector<std::uint32_t>& fronts = of_nodes.at(placement.node);
            if (fronts.size() != meshes[m].plan->transport->fronts)
                throw Error("node " + std::to_string(placement.node) +
                            " does not have the same vertices as its mesh");
            InstanceReceivers::Instance instance{m, placement.node, placement.rotation,
                                                 both_sides(plan, meshes[m], fronts), result.sampled.size()};
            for (const std::uint32_t r : instance.receivers)
                if (r != kNoReceiver)
                    taken[r] = true;
            for (const std::uint32_t r : result.samples[m].receivers) {
                result.sample_of[instance.receivers[r]] = static_cast<std::uint32_t>(result.sampled.size());
                result.sampled.push_back(instance.receivers[r]);
            }
            result.instances.push_back(std::move(instance));
        }
    }
    result.own_of.assign(taken.size(), kNoReceiver);
    for (const std::uint32_t r : receivers_on_surfaces(plan.receivers()))
        if (!taken[r]) {
            result.own_of[r] = static_cast<std::uint32_t>(result.own.size());
            result.own.push_back(r);
        }
    return result;
}

} // namespace prt
