// Sorts vertices by cluster, in memory and in files, and measures the reuse of a vertex order on GPUs.
#include "bake/gltf/reorder.h"

#include "bake/gltf/contents.h"
#include "bake/gltf/gathered_accessor.h"
#include "bake/gltf/make_meshes_unique.h"
#include "bake/gltf/write_set.h"
#include "prt/core/error.h"
#include "runtime/load/accessor.h"

#include <meshoptimizer.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cstring>
#include <map>
#include <numeric>

namespace prt {
namespace {

/// Returns whether the receivers are bitwise equal, in the same order.
bool same_receivers(const Scene& scene, const Scene& other) {
    const auto same = [](const std::vector<glm::vec3>& a, const std::vector<glm::vec3>& b) {
        return a.size() == b.size() &&
               (a.empty() || std::memcmp(a.data(), b.data(), a.size() * sizeof a[0]) == 0);
    };
    return std::ranges::equal(scene.vertex_arrays, other.vertex_arrays,
                              [&](const VertexArray& a, const VertexArray& b) {
                                  return same(a.positions, b.positions) && same(a.normals, b.normals);
                              });
}

/// Vertex array, position and normal, compared bitwise.
using Key = std::array<std::uint32_t, 7>;

/// Returns the keys of all receivers. Vertex arrays are numbered by content: scenes with the same nodes in
/// another order have equal keys.
std::vector<Key> keys_of(const Scene& scene) {
    std::vector<Key> keys;
    std::vector<std::pair<std::vector<Key>, std::size_t>> held; // contents of each vertex array, sorted
    for (std::size_t a = 0; a < scene.vertex_arrays.size(); ++a) {
        const VertexArray& vertices = scene.vertex_arrays[a];
        const auto begin = static_cast<std::ptrdiff_t>(keys.size());
        for (std::size_t v = 0; v < vertices.size(); ++v) {
            const glm::vec3 &p = vertices.positions[v], &n = vertices.normals[v];
            keys.push_back({0, std::bit_cast<std::uint32_t>(p.x), std::bit_cast<std::uint32_t>(p.y),
                            std::bit_cast<std::uint32_t>(p.z), std::bit_cast<std::uint32_t>(n.x),
                            std::bit_cast<std::uint32_t>(n.y), std::bit_cast<std::uint32_t>(n.z)});
        }
        held.emplace_back(std::vector<Key>(keys.begin() + begin, keys.end()), a);
        std::ranges::sort(held.back().first);
    }
    std::ranges::sort(held);
    for (std::uint32_t number = 0; number < held.size(); ++number) {
        const VertexArray& vertices = scene.vertex_arrays[held[number].second];
        for (std::size_t v = 0; v < vertices.size(); ++v)
            keys[vertices.first_receiver + v][0] = number;
    }
    return keys;
}

/// Returns the sorted order of the keys; stable.
std::vector<std::uint32_t> sorted(const std::vector<Key>& keys) {
    std::vector<std::uint32_t> order(keys.size());
    std::iota(order.begin(), order.end(), 0u);
    std::stable_sort(order.begin(), order.end(),
                     [&](std::uint32_t a, std::uint32_t b) { return keys[a] < keys[b]; });
    return order;
}

void reorder(GltfContents& contents, const Scene& scene, std::span<const std::uint32_t> order) {
    const std::vector<Json*> primitives = make_meshes_unique(contents, scene);
    std::set<std::size_t> replaced;
    std::map<std::pair<std::size_t, std::size_t>, std::size_t>
        moved; // accessor and vertex array: its new accessor
    for (std::size_t i = 0; i < primitives.size(); ++i) {
        Json& primitive = *primitives[i];
        const std::size_t array = scene.primitives[i].vertices;
        const VertexArray& vertices = scene.vertex_arrays[array];
        std::vector<std::uint32_t> source(vertices.size()), position(vertices.size());
        for (std::uint32_t v = 0; v < source.size(); ++v) {
            source[v] =
                order[vertices.first_receiver + v] - static_cast<std::uint32_t>(vertices.first_receiver);
            position[source[v]] = v;
        }
        const auto move_all = [&](Json& attributes) {
            for (Json& accessor : attributes) {
                const auto old = accessor.get<std::size_t>();
                const auto [entry, is_new] = moved.try_emplace({old, array}, 0);
                if (is_new)
                    entry->second = add_gathered_accessor(contents, accessor, source);
                replaced.insert(old);
                accessor = entry->second;
            }
        };
        move_all(primitive["attributes"]);
        if (primitive.contains("targets"))
            for (Json& target : primitive["targets"])
                move_all(target);
        std::vector<std::uint32_t> indices(vertices.size());
        std::iota(indices.begin(), indices.end(), 0u);
        if (primitive.contains("indices")) {
            indices = read_unsigned(contents.model, primitive["indices"].get<int>(), 1);
            replaced.insert(primitive["indices"].get<std::size_t>());
        }
        for (std::uint32_t& index : indices)
            index = position.at(index);
        primitive["indices"] = add_index_accessor(contents, indices);
    }
    contents.remove_unused(std::move(replaced));
}

} // namespace

std::vector<std::uint32_t> order_by_cluster(const Scene& scene, const ClusteredReceivers& receivers) {
    std::vector<std::uint32_t> order(receivers.size());
    std::iota(order.begin(), order.end(), 0u);
    for (const VertexArray& vertices : scene.vertex_arrays) {
        const auto begin = order.begin() + static_cast<std::ptrdiff_t>(vertices.first_receiver);
        std::stable_sort(
            begin, begin + static_cast<std::ptrdiff_t>(vertices.size()),
            [&](std::uint32_t a, std::uint32_t b) { return receivers.cluster(a) < receivers.cluster(b); });
    }
    return order;
}

ClusteredReceivers reordered(const ClusteredReceivers& receivers, std::span<const std::uint32_t> order) {
    ClusteredReceivers result = receivers;
    const std::size_t stride = receivers.stride(),
                      predictors = receivers.size() > 0 ? receivers.predictors.size() / receivers.size() : 0;
    for (std::size_t i = 0; i < order.size(); ++i) {
        if (!receivers.clusters.empty())
            result.clusters[i] = receivers.clusters[order[i]];
        if (stride > 0)
            std::memcpy(&result.weights[i * stride], &receivers.weights[order[i] * stride], stride);
        std::copy_n(receivers.predictors.begin() + static_cast<std::ptrdiff_t>(order[i] * predictors),
                    predictors, result.predictors.begin() + static_cast<std::ptrdiff_t>(i * predictors));
    }
    return result;
}

void reorder_vertices(GltfDocument& document, const Scene& scene, std::span<const std::uint32_t> order) {
    named(document, [&](GltfContents& contents) { reorder(contents, scene, order); });
}

std::vector<std::uint32_t> matching_receivers(const Scene& scene, const Scene& other) {
    std::vector<std::uint32_t> match(scene.receivers());
    std::iota(match.begin(), match.end(), 0u);
    if (same_receivers(scene, other))
        return match;
    const std::vector<Key> keys = keys_of(scene), other_keys = keys_of(other);
    const std::vector<std::uint32_t> order = sorted(keys), other_order = sorted(other_keys);
    for (std::size_t i = 0; i < order.size(); ++i) {
        if (order.size() != other_order.size() || keys[order[i]] != other_keys[other_order[i]])
            throw Error("its vertices differ from those of the bake");
        match[order[i]] = other_order[i];
    }
    return match;
}

Transfer in_order_of(const Scene& scene, const Scene& other, const Transfer& transfer) {
    const std::vector<std::uint32_t> match = matching_receivers(scene, other);
    Transfer ordered = zero_transfer(transfer.layout, transfer.receivers());
    for (std::size_t p = 0; p < match.size(); ++p)
        std::copy_n(transfer.vector(match[p]).begin(), transfer.dimension(), ordered.vector(p).begin());
    return ordered;
}

VertexReuse vertex_reuse(const Scene& scene) {
    std::vector<unsigned> indices;
    for (const Primitive& primitive : scene.primitives) {
        const auto first = static_cast<unsigned>(scene.vertex_arrays[primitive.vertices].first_receiver);
        for (const glm::uvec3& t : primitive.triangles)
            indices.insert(indices.end(), {first + t.x, first + t.y, first + t.z});
    }
    constexpr unsigned kCache = 16;
    const auto cache =
        meshopt_analyzeVertexCache(indices.data(), indices.size(), scene.receivers(), kCache, 0, 0);
    const auto fetch =
        meshopt_analyzeVertexFetch(indices.data(), indices.size(), scene.receivers(), sizeof(glm::vec3));
    return {static_cast<double>(cache.acmr), static_cast<double>(fetch.overfetch)};
}

} // namespace prt
