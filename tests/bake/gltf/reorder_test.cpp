// Tests the reordering of vertices in files.

#include "bake/gltf/reorder.h"

#include "prt/core/error.h"
#include "support/glb_file.h"
#include "support/temporary_folder.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>

namespace prt {
namespace {

using test::GlbFile;

/// Returns two nodes with one mesh, whose two primitives share vertices, with colors and a morph target; and
/// an animation.
GlbFile instanced_file() {
    GlbFile file = test::triangle_file();
    const auto position = file.accessor(std::vector<float>{0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 1, 1, 2, 0, 1},
                                        test::kFloat, "VEC3", 3);
    file.json["accessors"][position]["min"] = {0, 0, 0};
    file.json["accessors"][position]["max"] = {2, 1, 1};
    const auto normal = file.accessor(std::vector<float>{0, 0, 1, 0, 1, 0, 1, 0, 0, 0, 0, -1, 0, -1, 0},
                                      test::kFloat, "VEC3", 3);
    const auto target = file.accessor(std::vector<float>{0, 0, 0, 0, 0, 1, 0, 0, 2, 0, 0, 3, 0, 0, 4},
                                      test::kFloat, "VEC3", 3);
    const auto time = file.accessor(std::vector<float>{0, 1}, test::kFloat, "SCALAR", 1);
    const auto moves = file.accessor(std::vector<float>{0, 0, 0, 1, 0, 0}, test::kFloat, "VEC3", 3);
    const nlohmann::ordered_json attributes = {{"POSITION", position}, {"NORMAL", normal}};
    const nlohmann::ordered_json targets = nlohmann::ordered_json::array({{{"POSITION", target}}});
    const auto primitive = [&](const std::vector<std::uint8_t>& indices, int mode) {
        return nlohmann::ordered_json{{"attributes", attributes},
                                      {"targets", targets},
                                      {"mode", mode},
                                      {"indices", file.accessor(indices, test::kUnsignedByte, "SCALAR", 1)}};
    };
    file.json["meshes"][0]["weights"] = {0.5};
    file.json["meshes"][0]["primitives"] =
        nlohmann::ordered_json::array({primitive({0, 1, 2}, 4), primitive({1, 3, 2, 4}, 5)});
    file.json["nodes"] = {{{"mesh", 0}}, {{"mesh", 0}, {"translation", {5, 0, 0}}}};
    file.json["scenes"][0]["nodes"] = {0, 1};
    file.json["animations"] = {
        {{"channels", {{{"sampler", 0}, {"target", {{"node", 0}, {"path", "translation"}}}}}},
         {"samplers", {{{"input", time}, {"output", moves}}}}}};
    return file;
}

/// Returns the corners of all triangles, in order, independent of the order of the vertices.
std::vector<glm::vec3> corners(const Scene& scene) {
    std::vector<glm::vec3> result;
    for (const Primitive& primitive : scene.primitives)
        for (const glm::uvec3& t : primitive.triangles)
            for (int c = 0; c < 3; ++c) {
                const VertexArray& vertices = scene.vertex_arrays[primitive.vertices];
                result.push_back(vertices.positions[t[c]]);
                result.push_back(vertices.normals[t[c]]);
            }
    return result;
}

TEST(Reorder, MovesVerticesAndDrawsTheSame) {
    const test::TemporaryFolder folder;
    instanced_file().write(folder / "a.glb");
    GltfDocument document = load_gltf(folder / "a.glb");
    const Scene scene = extract_scene(document);
    ASSERT_EQ(scene.vertex_arrays.size(), 2u); // one per node
    const std::vector<std::uint32_t> order = {4, 2, 0, 1, 3, 5, 9, 8, 7, 6};
    reorder_vertices(document, scene, order);
    save_glb(document, folder / "b.glb");
    const GltfDocument again = load_gltf(folder / "b.glb");
    const Scene moved = extract_scene(again);
    EXPECT_EQ(corners(moved), corners(scene));
    EXPECT_EQ(moved.vertex_arrays[0].positions[0], scene.vertex_arrays[0].positions[4]);
    EXPECT_EQ(moved.vertex_arrays[1].positions[1], scene.vertex_arrays[1].positions[4]);
    EXPECT_EQ(receivers_id(moved), receivers_id(scene)); // equal receivers in a different order
    EXPECT_EQ(matching_receivers(moved, scene), order);
    // Replaced data are removed: a second time does not change the size.
    std::vector<std::uint32_t> same(order.size());
    for (std::uint32_t i = 0; i < same.size(); ++i)
        same[i] = i;
    GltfDocument once = load_gltf(folder / "b.glb");
    reorder_vertices(once, extract_scene(once), same);
    save_glb(once, folder / "c.glb");
    EXPECT_EQ(std::filesystem::file_size(folder / "b.glb"), std::filesystem::file_size(folder / "c.glb"));
}

TEST(Reorder, ByClusterPutsClustersSideBySideWithinEachArray) {
    Scene scene;
    scene.vertex_arrays.resize(2);
    scene.vertex_arrays[0].positions.resize(4);
    scene.vertex_arrays[1].positions.resize(3);
    scene.vertex_arrays[1].first_receiver = 4;
    ClusteredReceivers receivers;
    receivers.format = WeightFormat::packed;
    receivers.words = 1;
    receivers.cluster_bits = 8; // the first byte
    for (std::size_t i = 0; i < 28; ++i)
        receivers.weights.push_back(static_cast<std::byte>(i));
    const std::uint8_t clusters[] = {2, 0, 2, 1, 1, 0, 1};
    for (std::size_t p = 0; p < 7; ++p)
        receivers.weights[4 * p] = std::byte{clusters[p]};
    const std::vector<std::uint32_t> order = order_by_cluster(scene, receivers);
    EXPECT_EQ(order, (std::vector<std::uint32_t>{1, 3, 0, 2, 5, 4, 6}));
    const ClusteredReceivers moved = reordered(receivers, order);
    EXPECT_EQ(moved.cluster_indices(), (std::vector<std::uint16_t>{0, 1, 2, 2, 0, 1, 1}));
    EXPECT_EQ(moved.weights[5], std::byte{13}); // receiver 3, second byte
}

TEST(Reorder, OtherScenesDoNotMatch) {
    const test::TemporaryFolder folder;
    instanced_file().write(folder / "a.glb");
    const Scene scene = extract_scene(load_gltf(folder / "a.glb"));
    Scene other = scene;
    other.vertex_arrays[0].positions[2].x += 1;
    EXPECT_THROW(matching_receivers(scene, other), Error);
    EXPECT_NE(receivers_id(scene), receivers_id(other));
}

TEST(Reorder, ScenesOfTheSameNodesInAnotherOrderMatch) {
    const test::TemporaryFolder folder;
    instanced_file().write(folder / "a.glb");
    const Scene scene = extract_scene(load_gltf(folder / "a.glb"));
    ASSERT_GE(scene.vertex_arrays.size(), 2u);
    Scene other = scene;
    std::ranges::reverse(other.vertex_arrays);
    std::size_t first = 0;
    for (VertexArray& vertices : other.vertex_arrays) {
        vertices.first_receiver = first;
        first += vertices.size();
    }
    const std::vector<std::uint32_t> match = matching_receivers(scene, other);
    const auto position_of = [](const Scene& of, std::size_t receiver) {
        for (const VertexArray& vertices : of.vertex_arrays)
            if (receiver < vertices.first_receiver + vertices.size())
                return vertices.positions[receiver - vertices.first_receiver];
        return glm::vec3(0);
    };
    for (std::size_t r = 0; r < scene.receivers(); ++r)
        EXPECT_EQ(position_of(scene, r), position_of(other, match[r])) << r;
}

TEST(VertexReuse, StripsReuseVerticesToOnePerTriangle) {
    Scene scene;
    scene.vertex_arrays.resize(1);
    scene.vertex_arrays[0].positions.resize(1002);
    scene.primitives.resize(1);
    for (std::uint32_t t = 0; t < 1000; ++t)
        scene.primitives[0].triangles.emplace_back(t, t + 1, t + 2);
    EXPECT_NEAR(vertex_reuse(scene).transforms_per_triangle, 1.002, 1e-6);
    EXPECT_NEAR(vertex_reuse(scene).overfetch, 1, 0.01);
}

} // namespace
} // namespace prt
