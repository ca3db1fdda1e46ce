// Tests predictors in files: the reader returns the data of the writer.

#include "bake/gltf/reorder.h"
#include "prt/core/clustered_bases.h"
#include "prt/core/error.h"
#include "prt/gltf/gltf.h"
#include "runtime/load/predictors.h"
#include "support/glb_file.h"
#include "support/predicted.h"
#include "support/temporary_folder.h"

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include <cstring>
#include <functional>
#include <utility>

namespace prt {
namespace {

using test::GlbFile;

const std::vector<PredictorKind> kBoth = {PredictorKind::normal, PredictorKind::position};

/// Returns quantised normals, a folded primitive without normals, and nodes that mirror, scale and rotate the
/// mesh.
GlbFile hard_file(const glm::dvec3& point) {
    GlbFile file = test::triangle_file();
    file.json["extensionsUsed"] = {"KHR_mesh_quantization"};
    file.json["extensionsRequired"] = {"KHR_mesh_quantization"};
    const std::vector<std::int8_t> normals = {12, 45, 117, 99, -73, 30, 99, 99, 0, 0, 0, 99};
    auto& primitives = file.json["meshes"][0]["primitives"];
    primitives[0]["attributes"]["NORMAL"] =
        file.accessor(std::as_bytes(std::span(normals)), 3, test::kByte, "VEC3", true, 4);
    const auto position =
        file.accessor(std::vector<float>{0, 0, 0, 1, 0, 0.1f, 1, 1, 0, 0, 0.2f, 1}, test::kFloat, "VEC3", 3);
    file.json["accessors"][position]["min"] = {0, 0, 0};
    file.json["accessors"][position]["max"] = {1, 1, 1};
    const auto indices =
        file.accessor(std::vector<std::uint8_t>{0, 1, 2, 0, 2, 3}, test::kUnsignedByte, "SCALAR", 1);
    primitives.push_back({{"attributes", {{"POSITION", position}}}, {"indices", indices}});
    file.json["nodes"] = {
        {{"children", {1, 2, 3}}, {"translation", {point.x, point.y, point.z}}},
        {{"mesh", 0}},
        {{"mesh", 0}, {"scale", {-1, 1, 1}}},
        {{"mesh", 0}, {"scale", {3, 0.5, 1.25}}, {"rotation", {0, 0.6, 0, 0.8}}, {"translation", {4, 1, 2}}}};
    return file;
}

/// Compressed transfer of random numbers for a scene.
CompressedTransfer predicted_transfer(const Scene& scene, const std::vector<PredictorKind>& kinds,
                                      WeightFormat format) {
    CompressedTransfer c;
    ClusteredTransfer& t = c.transfer;
    t.bases.layout = layout_of_one(2, 3);
    t.bases.components = {2, 0, 3};
    std::mt19937 random(7);
    std::normal_distribution<float> normal;
    for (std::size_t i = 0; i < 8 * t.bases.dimension(); ++i)
        t.bases.rows.push_back(normal(random));
    test::add_predictors(t.bases, kinds, random);
    ClusteredReceivers& r = t.receivers;
    r.format = format;
    const bool packed = format == WeightFormat::packed;
    r.components = packed ? 0 : 4;
    r.words = packed ? 1 : 0;
    r.cluster_bits = packed ? 2 : 0;
    if (packed)
        t.bases.bits = {9, 16, 11, 8, 7};
    for (std::size_t p = 0; p < scene.receivers(); ++p)
        r.clusters.push_back(static_cast<std::uint16_t>(random() % 3));
    r.weights.resize(scene.receivers() * r.stride());
    const std::vector<ClusterLayout> layouts = cluster_layouts(t.bases);
    for (std::size_t p = 0; p < scene.receivers(); ++p) {
        std::vector<std::uint32_t> words(1), values = {100, 101, 17};
        if (packed) {
            pack_words(r.clusters[p], 2, layouts[r.clusters[p]], values, words);
            std::memcpy(&r.weights[4 * p], words.data(), 4);
        } else {
            const float weights[4] = {normal(random), normal(random), normal(random), 0};
            std::memcpy(&r.weights[16 * p], weights, sizeof weights);
        }
    }
    r.predictors = predictor_coordinates(scene, t.bases.predictors);
    return c;
}

struct Model {
    GltfDocument document;
    Scene scene;
};

Model read(const std::filesystem::path& path) {
    GltfDocument document = load_gltf(path);
    Scene scene = extract_scene(document);
    return {std::move(document), std::move(scene)};
}

TEST(PredictorCoordinates, AreNormalsAndPositionsSeenFromTheOrigin) {
    const test::TemporaryFolder folder;
    test::triangle_file().write(folder / "t.glb");
    const Scene scene = read(folder / "t.glb").scene; // seen from the middle of the box
    const std::vector<Predictor> predictors = {{PredictorKind::normal},
                                               {PredictorKind::position, {0.5f, 0, -1}}};
    EXPECT_EQ(predictor_coordinates(scene, predictors),
              (std::vector<float>{0, 0, 1, -1, -0.5f, 1, 0, 0, 1, 0, -0.5f, 1, 0, 0, 1, -1, 0.5f, 1}));
    EXPECT_EQ(predictor_coordinates(scene, std::vector<Predictor>(1, predictors[1])),
              (std::vector<float>{-1, -0.5f, 1, 0, -0.5f, 1, -1, 0.5f, 1}));
    EXPECT_TRUE(predictor_coordinates(scene, {}).empty());
}

class PredictorsInFiles : public testing::TestWithParam<WeightFormat> {};
INSTANTIATE_TEST_SUITE_P(Formats, PredictorsInFiles,
                         testing::Values(WeightFormat::float32, WeightFormat::packed));

TEST_P(PredictorsInFiles, RoundTrip) {
    for (const glm::dvec3 point : {glm::dvec3(0), glm::dvec3(1e6, -2e6, 123456.75)})
        for (const std::vector<PredictorKind>& kinds : test::sets_of_predictors()) {
            const test::TemporaryFolder folder;
            hard_file(point).write(folder / "hard.glb");
            Model model = read(folder / "hard.glb");
            const CompressedTransfer c = predicted_transfer(model.scene, kinds, GetParam());
            write_clustered(model.document, model.scene, c);
            save_glb(model.document, folder / "written.glb", BufferCompression::meshopt);
            const Model again = read(folder / "written.glb");
            const auto read_back = read_clustered(again.document, again.scene);
            ASSERT_TRUE(read_back);
            const ClusteredTransfer& t = read_back->transfer;
            EXPECT_EQ(t.bases.predictors, c.transfer.bases.predictors);
            EXPECT_EQ(t.bases.centers, c.transfer.bases.centers);
            EXPECT_EQ(t.bases.rows, c.transfer.bases.rows);
            EXPECT_EQ(t.bases.bits, c.transfer.bases.bits);
            EXPECT_EQ(t.receivers.weights, c.transfer.receivers.weights);
            // Predictors of flat normals are rounded a second time.
            ASSERT_EQ(t.receivers.predictors.size(), c.transfer.receivers.predictors.size());
            for (std::size_t i = 0; i < t.receivers.predictors.size(); ++i)
                EXPECT_NEAR(t.receivers.predictors[i], c.transfer.receivers.predictors[i], 1e-6f) << i;
            const Transfer before = decode(c.transfer), after = decode(t);
            for (std::size_t i = 0; i < before.vectors.size(); ++i)
                EXPECT_NEAR(before.vectors[i], after.vectors[i], 1e-5f);
        }
}

TEST(PredictorsInFile, OriginsArePositionsInItsWorld) {
    const test::TemporaryFolder folder;
    hard_file(glm::dvec3(1e6, 0, -3)).write(folder / "hard.glb");
    Model model = read(folder / "hard.glb");
    const CompressedTransfer c = predicted_transfer(model.scene, kBoth, WeightFormat::packed);
    write_clustered(model.document, model.scene, c);
    save_glb(model.document, folder / "written.glb");
    const GlbFile written = test::read_glb(folder / "written.glb");
    EXPECT_EQ(written.json["extensions"]["PRTKIT_transfer"]["version"], 6);
    const auto& json = test::set_of(written.json, "vertices");
    EXPECT_FALSE(json["predictors"][0].contains("origin"));
    for (std::size_t i = 0; i < 3; ++i) {
        const int axis = static_cast<int>(i);
        EXPECT_EQ(json["predictors"][1]["origin"][i].get<double>(),
                  model.scene.origin[axis] +
                      static_cast<double>(c.transfer.bases.predictors[1].origin[axis]));
        EXPECT_EQ(json["predictors"][0]["scale"][i].get<float>(), c.transfer.bases.predictors[0].scale[axis]);
    }
}

TEST(PredictorsInFile, FollowMovingVertices) {
    const test::TemporaryFolder folder;
    test::triangle_file().write(folder / "t.glb");
    Model model = read(folder / "t.glb");
    CompressedTransfer c = predicted_transfer(model.scene, kBoth, WeightFormat::float32);
    const std::vector<std::uint32_t> order = {2, 0, 1};
    const Transfer before = decode(c.transfer);
    c.transfer.receivers = reordered(c.transfer.receivers, order);
    reorder_vertices(model.document, model.scene, order);
    save_glb(model.document, folder / "moved.glb");
    Model moved = read(folder / "moved.glb");
    EXPECT_EQ(c.transfer.receivers.predictors,
              predictor_coordinates(moved.scene, c.transfer.bases.predictors));
    write_clustered(moved.document, moved.scene, c);
    save_glb(moved.document, folder / "written.glb");
    const Model again = read(folder / "written.glb");
    const Transfer after = decode(read_clustered(again.document, again.scene)->transfer);
    for (std::size_t p = 0; p < 3; ++p)
        for (std::size_t i = 0; i < before.dimension(); ++i)
            EXPECT_EQ(after.vector(p)[i], before.vector(order[p])[i]);
}

TEST(PredictorsInFile, AreRemovedCompletely) {
    const test::TemporaryFolder folder;
    test::triangle_file().write(folder / "t.glb");
    Model model = read(folder / "t.glb");
    discard_transfer(model.document);
    save_glb(model.document, folder / "before.glb");
    write_clustered(model.document, model.scene,
                    predicted_transfer(model.scene, kBoth, WeightFormat::packed));
    save_glb(model.document, folder / "written.glb");
    Model again = read(folder / "written.glb");
    discard_transfer(again.document);
    save_glb(again.document, folder / "after.glb");
    EXPECT_EQ(std::filesystem::file_size(folder / "before.glb"),
              std::filesystem::file_size(folder / "after.glb"));
}

/// The error of a file with predictors after `change` of its extension.
class PredictedFile {
public:
    explicit PredictedFile(WeightFormat format) {
        test::triangle_file().write(folder_ / "t.glb");
        Model model = read(folder_ / "t.glb");
        write_clustered(model.document, model.scene, predicted_transfer(model.scene, kBoth, format));
        save_glb(model.document, folder_ / "good.glb");
        good_ = test::read_glb(folder_ / "good.glb");
        good_.json.erase("buffers");
    }
    std::string refusal(const std::function<void(nlohmann::ordered_json&, GlbFile&)>& change) const {
        GlbFile changed = good_;
        change(test::set_of(changed.json, "vertices"), changed);
        changed.write(folder_ / "changed.glb");
        try {
            const Model model = read(folder_ / "changed.glb");
            read_clustered(model.document, model.scene);
        } catch (const Error& error) {
            return error.what();
        }
        return "was read";
    }

private:
    test::TemporaryFolder folder_;
    GlbFile good_;
};

TEST(PredictorsInFile, InvalidPredictorsAreRejectedInOneLine) {
    using Json = nlohmann::ordered_json;
    const PredictedFile predicted_file(WeightFormat::packed);
    EXPECT_EQ(predicted_file.refusal([](Json&, GlbFile&) {}), "was read");
    const std::pair<const char*, std::function<void(Json&)>> changes[] = {
        {"predictors are not a list", [](Json& e) { e["predictors"] = "normal"; }},
        {"predictors are not a list", [](Json& e) { e["predictors"] = Json::array(); }},
        {"predictors are not a list", [](Json& e) { e["predictors"].push_back(e["predictors"][0]); }},
        {"kind of a predictor is unknown", [](Json& e) { e["predictors"][0]["kind"] = "tangent"; }},
        {"kind of a predictor is unknown", [](Json& e) { e["predictors"][0]["kind"] = 1; }},
        {"two predictors must be", [](Json& e) { e["predictors"][1] = e["predictors"][0]; }},
        {"two predictors must be", [](Json& e) { e["predictors"][0] = e["predictors"][1]; }},
        {"two predictors must be", [](Json& e) { std::swap(e["predictors"][0], e["predictors"][1]); }},
        {"is damaged glTF", [](Json& e) { e["predictors"][0].erase("kind"); }},
        {"is damaged glTF", [](Json& e) { e["predictors"][0].erase("scale"); }},
        {"is damaged glTF", [](Json& e) { e["predictors"][1].erase("origin"); }},
        {"is damaged glTF", [](Json& e) { e.erase("centers"); }},
        {"scale of a predictor must be three", [](Json& e) { e["predictors"][0]["scale"] = 2; }},
        {"scale of a predictor must be three",
         [](Json& e) {
             e["predictors"][0]["scale"] = {1, 2};
         }},
        {"scale of a predictor must be three",
         [](Json& e) {
             e["predictors"][0]["scale"] = {1, 2, 3, 4};
         }},
        {"scale of a predictor must be three", [](Json& e) { e["predictors"][0]["scale"][1] = "2"; }},
        {"scale of a predictor must be three", [](Json& e) { e["predictors"][0]["scale"][1] = nullptr; }},
        {"scale of a predictor must be three", [](Json& e) { e["predictors"][0]["scale"][1] = 1e300; }},
        {"scale of a predictor is 0", [](Json& e) { e["predictors"][0]["scale"][2] = 0; }},
        {"scale of a predictor is 0", [](Json& e) { e["predictors"][1]["scale"][2] = 1e-60; }},
        {"origin of a predictor must be three", [](Json& e) { e["predictors"][1]["origin"][0] = 1e12; }},
        {"origin of a predictor must be three", [](Json& e) { e["predictors"][1]["origin"].erase(0); }},
        {"farther from the origin",
         [](Json& e) {
             e["predictors"][1]["origin"][0] = 1e9;
             e["predictors"][1]["scale"][0] = 1e3;
         }},
        {"5 columns, but the predictors have 6", [](Json& e) { e["centers"]["drops"].erase(0); }},
        {"an element of \"drops\" is 16", [](Json& e) { e["centers"]["drops"][0] = 16; }},
        {"buffer view 999 does not exist", [](Json& e) { e["centers"]["bufferView"] = 999; }},
    };
    for (std::size_t i = 0; i < std::size(changes); ++i) {
        const std::string said = predicted_file.refusal([&](Json& e, GlbFile&) { changes[i].second(e); });
        EXPECT_NE(said.find(changes[i].first), std::string::npos) << i << ": " << said;
        EXPECT_EQ(said.find('\n'), std::string::npos);
    }
    const auto ends_early = [](Json& e, GlbFile& file) {
        e["centers"]["bufferView"] = file.view(std::vector<std::byte>(1, std::byte{0xff}));
    };
    EXPECT_NE(predicted_file.refusal(ends_early).find("the centers: "), std::string::npos);
    // The bases have rows for predictors, and the widths of weights have none.
    EXPECT_NE(predicted_file.refusal([](Json& e, GlbFile&) {
        e["predictors"].erase(1);
        e["centers"]["drops"] = {0, 0, 0};
    }),
              "was read");
    EXPECT_NE(predicted_file.refusal([](Json& e, GlbFile&) { e.erase("predictors"); }), "was read");
}

TEST(PredictorsInFile, RowsOfZerosAreNotAllocated) {
    const PredictedFile predicted_file(WeightFormat::float32);
    const auto many = [](nlohmann::ordered_json& e, GlbFile& file) {
        constexpr std::size_t kClusters = 65536, kDimension = 12, kAxes = 200;
        e["components"] = std::vector<int>(kClusters, 0);
        const auto zero_rows = [&](std::size_t rows, std::size_t columns) {
            // Rows of zeros consist of their levels, for any number of columns.
            const RowCode code = encode_rows(std::vector<std::int32_t>(rows, 0), 1);
            return nlohmann::ordered_json{{"bufferView", file.view(code.bits)},
                                          {"drops", std::vector<int>(columns, 0)}};
        };
        const auto zeros = [&](std::size_t bytes) {
            return nlohmann::ordered_json{{"bufferView", file.view(std::vector<std::byte>(bytes))}};
        };
        e["centers"] = zero_rows(kClusters, 6);
        e["bases"] = {{"origin", zeros(4 * kDimension)}, {"scales", zeros(4 * kAxes)}, {"step", 1}};
        e["bases"]["axes"] = zero_rows(kAxes, kDimension);
        e["bases"]["values"] = zero_rows(7 * kClusters, kAxes);
    };
    // Seven rows per cluster need 433 MB for 0.3 + 0.02 MB of file, one row needs 62 MB.
    EXPECT_NE(predicted_file.refusal(many).find("its bases would need"), std::string::npos)
        << predicted_file.refusal(many);
}

} // namespace
} // namespace prt
