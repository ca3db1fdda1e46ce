// Tests levels of detail in files: their marks, their positions, and invalid files.

#include "prt/gltf/levels.h"

#include "prt/core/error.h"
#include "support/glb_file.h"
#include "support/temporary_folder.h"

#include <gtest/gtest.h>

#include <cstring>
#include <functional>

namespace prt {
namespace levels_in_files {

using test::GlbFile;
using Json = nlohmann::ordered_json;

/// Returns nodes that all draw the triangle; the first `roots` nodes are in the scene.
GlbFile file_of(const std::vector<Json>& nodes, std::size_t roots) {
    GlbFile file = test::triangle_file();
    file.json["nodes"] = Json::array();
    file.json["scenes"][0]["nodes"] = Json::array();
    for (std::size_t n = 0; n < nodes.size(); ++n) {
        file.json["nodes"].push_back(nodes[n]);
        if (!nodes[n].contains("children") && !nodes[n].contains("mesh"))
            file.json["nodes"].back()["mesh"] = 0;
        if (n < roots)
            file.json["scenes"][0]["nodes"].push_back(n);
    }
    return file;
}

Json with_ids(Json node, const Json& ids) {
    node["extensions"]["MSFT_lod"]["ids"] = ids;
    return node;
}

GltfDocument loaded(const GlbFile& file) {
    const test::TemporaryFolder folder;
    file.write(folder / "scene.glb");
    return load_gltf(folder / "scene.glb");
}

std::string error_of(const GlbFile& file) {
    const GltfDocument document = loaded(file);
    std::string line;
    try {
        extract_scene(document);
    } catch (const Error& error) {
        line = error.what();
    }
    EXPECT_THROW(extract_levels(document), Error);
    return line;
}

glm::vec3 position_of(const LeveledScene& levels, std::size_t primitive) {
    const VertexArray& vertices = levels.scene.vertex_arrays[levels.scene.primitives[primitive].vertices];
    return glm::vec3(levels.scene.world(vertices.positions[0]));
}

void expect_same(const Scene& a, const Scene& b) {
    ASSERT_EQ(a.primitives.size(), b.primitives.size());
    EXPECT_EQ(a.origin, b.origin);
    for (std::size_t p = 0; p < a.primitives.size(); ++p) {
        const auto &x = a.vertex_arrays[a.primitives[p].vertices].positions,
                   &y = b.vertex_arrays[b.primitives[p].vertices].positions;
        ASSERT_EQ(x.size(), y.size());
        EXPECT_EQ(std::memcmp(x.data(), y.data(), x.size() * sizeof x[0]), 0);
    }
}

TEST(LevelsInFiles, OutsideTheSceneUseTheParentOfTheirNode) {
    const GlbFile file = file_of({{{"translation", {10, 0, 0}}, {"children", {1}}},
                                  with_ids({{"translation", {1, 0, 0}}, {"name", "Rock"}}, {2, 3}),
                                  {{"translation", {1, 0, 0}}, {"name", "Rough"}},
                                  {{"children", {4}}, {"translation", {0, 2, 0}}},
                                  {{"scale", {2, 2, 2}}}},
                                 1);
    const GltfDocument document = loaded(file);
    const LeveledScene levels = extract_levels(document);
    ASSERT_EQ(levels.nodes.size(), 1u);
    EXPECT_EQ(levels.nodes[0].name, "node 1 'Rock'");
    EXPECT_FALSE(levels.nodes[0].by_name);
    EXPECT_EQ(levels.nodes[0].finest, std::vector<std::size_t>{0});
    ASSERT_EQ(levels.nodes[0].coarser.size(), 2u);
    EXPECT_EQ(levels.nodes[0].coarser[1].level, 2);
    EXPECT_EQ(levels.deepest(), 2u);
    EXPECT_EQ(position_of(levels, levels.nodes[0].coarser[0].primitives.at(0)), glm::vec3(11, 0, 0));
    EXPECT_EQ(position_of(levels, levels.nodes[0].coarser[1].primitives.at(0)), glm::vec3(10, 2, 0));
    EXPECT_EQ(levels.finest_primitives, 1u);
    EXPECT_EQ(levels.finest_receivers, 3u);
    EXPECT_EQ(levels.scene.receivers(), 9u);
    GlbFile without = file;
    without.json["nodes"][1].erase("extensions");
    expect_same(extract_scene(document), extract_scene(loaded(without)));
    const std::vector<float> areas = areas_of_level(levels, 2);
    EXPECT_EQ(areas[3], 0);
    EXPECT_FLOAT_EQ(areas[6], 4 * receiver_areas(levels.scene)[0]);
}

TEST(LevelsInFiles, InTheSceneAreNotDrawnAndCastNoShadow) {
    const Scene scene = extract_scene(loaded(file_of({with_ids(Json::object(), {1}), {{"name", "far"}}}, 2)));
    EXPECT_EQ(scene.primitives.size(), 1u);
    ASSERT_EQ(scene.notices.size(), 1u);
    EXPECT_NE(scene.notices[0].find("coarser level"), std::string::npos);
}

TEST(LevelsInFiles, AreDetectedFromSiblingNames) {
    for (const auto& names :
         std::vector<std::vector<std::string>>{{"Rock_LOD0", "Rock_LOD1", "Rock_LOD2"},
                                               {"rock lod_0", "Rock LOD_1", "ROCK lod_2"},
                                               {"LOD0", "LOD1", "LOD2"},
                                               {"a_LOD0.001", "a_LOD1.001", "a_LOD2.001"}}) {
        const GltfDocument document =
            loaded(file_of({{{"name", names[2]}}, {{"name", names[0]}}, {{"name", names[1]}}}, 3));
        const LeveledScene levels = extract_levels(document);
        ASSERT_EQ(levels.nodes.size(), 1u) << names[0];
        EXPECT_TRUE(levels.nodes[0].by_name);
        EXPECT_EQ(levels.nodes[0].node, 1);
        ASSERT_EQ(levels.nodes[0].coarser.size(), 2u);
        EXPECT_EQ(levels.nodes[0].coarser[0].node, 2);
        EXPECT_EQ(levels.nodes[0].coarser[1].node, 0);
        EXPECT_EQ(extract_scene(document).primitives.size(), 1u);
    }
}

TEST(LevelsInFiles, OtherNamesAreNotLevels) {
    for (const auto& names : std::vector<std::vector<std::string>>{{"Rock_LOD0", "Tree_LOD1"},
                                                                   {"Rock_LOD1", "Rock_LOD2"},
                                                                   {"explod0", "explod1"},
                                                                   {"Rock0", "Rock1"},
                                                                   {"Rock_LOD0", "Rock_LOD100"}}) {
        const GltfDocument document = loaded(file_of({{{"name", names[0]}}, {{"name", names[1]}}}, 2));
        EXPECT_FALSE(has_levels(document)) << names[0];
        EXPECT_EQ(extract_scene(document).primitives.size(), 2u);
    }
    const GlbFile separate = file_of({{{"name", "a_LOD0"}}, {{"children", {2}}}, {{"name", "a_LOD1"}}}, 2);
    EXPECT_FALSE(has_levels(loaded(separate))); // no siblings
}

TEST(LevelsInFiles, CopiesOfOneNameArePairedInOrderOrNotAtAll) {
    const Json finest = {{"name", "a_LOD0"}}, coarser = {{"name", "a_LOD1"}};
    const LeveledScene pairs = extract_levels(loaded(file_of({finest, coarser, finest, coarser}, 4)));
    ASSERT_EQ(pairs.nodes.size(), 2u);
    EXPECT_EQ(pairs.nodes[1].node, 2);
    EXPECT_EQ(pairs.nodes[1].coarser[0].node, 3);
    const LeveledScene odd = extract_levels(loaded(file_of({finest, coarser, finest}, 3)));
    EXPECT_TRUE(odd.nodes.empty());
    EXPECT_EQ(odd.notices.size(), 1u);
    EXPECT_EQ(odd.scene.primitives.size(), 3u);
}

TEST(LevelsInFiles, ContradictionsAreRejected) {
    const Json plain = Json::object();
    const auto expect = [](const GlbFile& file, const char* words) {
        const std::string line = error_of(file);
        EXPECT_NE(line.find(words), std::string::npos) << line;
        EXPECT_EQ(line.find('\n'), std::string::npos);
    };
    expect(file_of({with_ids(plain, {7}), plain}, 1), "refers to node 7, which does not exist");
    expect(file_of({with_ids(plain, {-1}), plain}, 1), "refers to node -1, which does not exist");
    expect(file_of({with_ids(plain, {1.5}), plain}, 1), "which does not exist");
    expect(file_of({with_ids(plain, "1"), plain}, 1), "no list of ids");
    expect(file_of({with_ids(plain, {0}), plain}, 1), "which is the same node");
    expect(file_of({with_ids(plain, {1, 1}), plain}, 1), "twice");
    expect(file_of({with_ids(plain, {2}), with_ids(plain, {2}), plain}, 2), "and of node 1");
    expect(file_of({with_ids(plain, {1}), with_ids(plain, {2}), plain}, 1),
           "cannot have levels of detail itself");
    expect(file_of({with_ids(plain, {1}), with_ids(plain, {0}), plain}, 1),
           "cannot have levels of detail itself");
    expect(file_of({{{"children", {1}}}, with_ids(plain, {0})}, 1), "which is one of its descendants");
    expect(file_of({with_ids(plain, {1}), {{"children", {1}}}}, 1), "its own ancestor");
    expect(file_of({with_ids(plain, {1}), {{"children", {9}}}}, 1), "node 9 does not exist");
}

TEST(LevelsInFiles, WithoutTrianglesAreOmittedWithANotice) {
    const Json empty = {{"children", Json::array()}};
    const LeveledScene levels =
        extract_levels(loaded(file_of({with_ids(Json::object(), {1, 2}), empty, Json::object()}, 1)));
    ASSERT_EQ(levels.nodes.size(), 1u);
    ASSERT_EQ(levels.nodes[0].coarser.size(), 1u);
    EXPECT_EQ(levels.nodes[0].coarser[0].level, 2); // from its index in the list
    EXPECT_EQ(levels.notices.size(), 1u);
    const LeveledScene group =
        extract_levels(loaded(file_of({with_ids(empty, {1}), empty, Json::object()}, 3)));
    EXPECT_TRUE(group.nodes.empty());
    EXPECT_EQ(group.notices.size(), 1u);
}

TEST(LevelsInFiles, HaveSeparateTransfer) {
    GltfDocument document =
        loaded(file_of({with_ids(Json::object(), {1}), Json::object()}, 1)); // both with one mesh
    const LeveledScene levels = extract_levels(document);
    EXPECT_FALSE(levels_have_transfer(document, levels));
    BakedTransfer baked{zero_transfer(2, 1, 6), {}};
    for (std::size_t i = 0; i < baked.transfer.vectors.size(); ++i)
        baked.transfer.vectors[i] = static_cast<float>(i);
    write_transfer(document, levels.scene, baked);
    const test::TemporaryFolder folder;
    save_glb(document, folder / "baked.glb");
    const GltfDocument again = load_gltf(folder / "baked.glb");
    const LeveledScene read = extract_levels(again);
    EXPECT_TRUE(levels_have_transfer(again, read));
    EXPECT_EQ(read_transfer(again, read.scene)->transfer.vectors, baked.transfer.vectors);
    const std::vector<float> finest = read_transfer(again, extract_scene(again))->transfer.vectors;
    EXPECT_EQ(finest,
              std::vector<float>(baked.transfer.vectors.begin(), baked.transfer.vectors.begin() + 12));
}

} // namespace levels_in_files
} // namespace prt
