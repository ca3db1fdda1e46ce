// Tests the forest and the street of example_scenes: the requested number of instances, of few meshes, on the
// ground.

#include "prt/gltf/gltf.h"
#include "prt/gltf/transfer_gltf.h"
#include "support/temporary_folder.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <string>

namespace prt {
namespace instanced_scenes {

int make(const test::TemporaryFolder& folder, const std::string& scene) {
    std::string command = PRT_EXAMPLE_SCENES " '";
    command.append(folder.path().string()).append("' ").append(scene).append(" >/dev/null 2>/dev/null");
    return std::system(command.c_str());
}

void expect_shared(const char* scene, std::size_t meshes, std::size_t instances) {
    const test::TemporaryFolder folder;
    ASSERT_EQ(make(folder, std::string(scene) + ":" + std::to_string(instances)), 0);
    const GltfDocument document = load_gltf(folder / (std::string(scene) + ".glb"));
    const SharedMeshes shared = shared_meshes(document, extract_scene(document));
    EXPECT_EQ(shared.meshes.size(), meshes);
    EXPECT_EQ(shared.placements(), instances);
    EXPECT_EQ(shared.mirrored + shared.uneven + shared.bent, 0u);
}

TEST(InstancedScenes, AForestHasTreesOfThreeKinds) {
    expect_shared("forest", 3, 40);
}

TEST(InstancedScenes, AStreetHasHousesOfFiveKinds) {
    expect_shared("street", 5, 40);
}

TEST(InstancedScenes, ATreeHasSomeSixHundredVertices) {
    const test::TemporaryFolder folder;
    ASSERT_EQ(make(folder, "forest:60"), 0);
    const GltfDocument document = load_gltf(folder / "forest.glb");
    const Scene scene = extract_scene(document);
    std::size_t of_trees = 0;
    for (const Primitive& primitive : scene.primitives)
        if (primitive.mesh > 0) // mesh 0 is the meadow
            of_trees += scene.vertex_arrays[primitive.vertices].size();
    EXPECT_GT(of_trees, 60 * 400u);
    EXPECT_LT(of_trees, 60 * 900u);
}

TEST(InstancedScenes, InvalidCountsAreRejected) {
    const test::TemporaryFolder folder;
    for (const char* count : {"forest:0", "forest:-3", "forest:many", "forest:", "street:1e9", "oak:3"})
        EXPECT_NE(make(folder, count), 0) << count;
}

} // namespace instanced_scenes
} // namespace prt
