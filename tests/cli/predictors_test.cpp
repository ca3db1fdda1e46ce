// Tests models with predictors through the program, and by decoders in other languages.

#include "program.h"
#include "prt/gltf/gltf.h"
#include "runtime/load/predictors.h"
#include "support/glb_file.h"
#include "support/predicted.h"
#include "support/scene_builder.h"
#include "support/temporary_folder.h"

#include <gtest/gtest.h>

#include <cstdio>
#include <cstring>
#include <fstream>
#include <sstream>

namespace prt::test {
namespace {

/// Returns coded bases of three clusters with rows for both predictors.
ClusteredBases coded_bases(std::mt19937& random) {
    ClusteredBases bases;
    bases.layout = {3, {{TermKind::direct, 1}, {TermKind::indirect, 3}}};
    bases.components = {2, 0, 3};
    bases.bits = {9, 16, 11, 8, 7};
    bases.rows.resize(8 * bases.dimension());
    add_predictors(bases, {PredictorKind::normal, PredictorKind::position}, random);
    code_bases(bases, {0.02f, 0.016f, 0.012f, 0.008f, 0.004f}, random);
    return bases;
}

ClusteredTransfer predicted_transfer(const Scene& scene) {
    std::mt19937 random(7);
    ClusteredTransfer t{coded_bases(random), {}};
    ClusteredReceivers& r = t.receivers;
    r.format = WeightFormat::packed;
    r.cluster_bits = 2;
    r.words = 1;
    r.weights.resize(4 * scene.receivers());
    const std::vector<ClusterLayout> layouts = cluster_layouts(t.bases);
    for (std::size_t p = 0; p < scene.receivers(); ++p) {
        const auto k = static_cast<std::uint16_t>(random() % 3);
        const std::vector<std::uint32_t> values = {static_cast<std::uint32_t>(random() % 256),
                                                   static_cast<std::uint32_t>(random() % 256),
                                                   static_cast<std::uint32_t>(random() % 128)};
        std::vector<std::uint32_t> words(1);
        pack_words(k, 2, layouts[k], values, words);
        r.clusters.push_back(k);
        std::memcpy(&r.weights[4 * p], words.data(), 4);
    }
    r.predictors = predictor_coordinates(scene, t.bases.predictors);
    return t;
}

/// b.glb contains the vectors decoded from the clusters of c.glb.
class Predicted : public testing::Test {
protected:
    void SetUp() override {
        const Scene ball = SceneBuilder().sphere({2, -1, 0.5f}, 1.5f, 9).floor({3, 0, 0}, 4, 3).build();
        scene_file(ball).write(folder / "t.glb");
        GltfDocument document = load_gltf(folder / "t.glb");
        const Scene scene = extract_scene(document);
        const ClusteredTransfer transfer = predicted_transfer(scene);
        origin = scene.world(transfer.bases.predictors[1].origin);
        const BakeRecord record{.receivers = receivers_id(scene)};
        write_transfer(document, scene, {decode(transfer), record});
        save_glb(document, folder / "b.glb");
        write_clustered(document, scene, {transfer, record});
        save_glb(document, folder / "c.glb");
    }
    std::string at(const std::string& name) const { return (folder / name).string(); }
    double first_number(const std::string& text) {
        std::istringstream stream(text);
        double number = 1e9;
        stream >> number;
        return number;
    }

    TemporaryFolder folder;
    glm::dvec3 origin{0}; ///< origin of the position predictor
};

TEST_F(Predicted, ModelsAreDecodedFromTheFormatPage) {
    if (std::string(PRT_NODE).empty())
        GTEST_SKIP() << "node is not installed";
    const Outcome decoder = run(PRT_NODE, {PRT_DECODE, at("b.glb"), at("c.glb")});
    ASSERT_EQ(decoder.status, 0) << decoder.err;
    EXPECT_LT(first_number(decoder.out), 1e-6);
}

TEST_F(Predicted, ModelsAreLitByTheWebsDecoder) {
    if (std::string(PRT_NODE).empty())
        GTEST_SKIP() << "node is not installed";
    const std::string script = (std::filesystem::path(PRT_DECODE).parent_path() / "decode_web.mjs").string();
    const Outcome decoder = run(PRT_NODE, {script, at("b.glb"), at("c.glb")});
    ASSERT_EQ(decoder.status, 0) << decoder.err;
    EXPECT_LT(first_number(decoder.out), 1e-5);
}

TEST_F(Predicted, ModelsReportTheCostOfPredictors) {
    const Outcome info = prt({"info", at("c.glb"), "--json", at("i.json")});
    ASSERT_EQ(info.status, 0) << info.err;
    EXPECT_NE(info.out.find("predictors: normal and position: 6 rows in each cluster"), std::string::npos)
        << info.out;
    const auto figures = nlohmann::json::parse(std::ifstream(folder / "i.json"))["clustered_pca"];
    EXPECT_EQ(figures["predictors"], (nlohmann::json{"normal", "position"}));
    EXPECT_EQ(figures["predictor_rows"], 6);
    EXPECT_EQ(figures["bytes_bound_per_vertex"], 4);
}

TEST_F(Predicted, ModelsAreTheirVectorsToEveryCommand) {
    const Outcome evaluate = prt({"evaluate", at("b.glb"), at("c.glb"), "--json", at("e.json")});
    ASSERT_EQ(evaluate.status, 0) << evaluate.err;
    EXPECT_LT(nlohmann::json::parse(std::ifstream(folder / "e.json"))["relative_l2"], 1e-6);
}

TEST_F(Predicted, ShadersOfModelsCompileInEveryLanguage) {
    if (std::string(PRT_GLSLANG).empty() || std::string(PRT_SPIRV_CROSS).empty())
        GTEST_SKIP() << "glslangValidator or spirv-cross is not installed";
    for (const std::string language : {"glsl450", "glsl330", "essl300", "vulkan"}) {
        const Outcome shader = prt({"shader", at("c.glb"), "-o", at("s.vert"), "--language", language});
        ASSERT_EQ(shader.status, 0) << shader.err;
        EXPECT_EQ(shader.out.find("no loop"), std::string::npos) << shader.out; // clusters differ
        std::ifstream file(folder / "s.vert");
        const std::string text{std::istreambuf_iterator<char>(file), {}};
        float x = 0, y = 0, z = 0; // in the file's world
        const std::size_t point = text.find("#define PRT_PREDICTOR_ORIGIN");
        ASSERT_NE(point, std::string::npos);
        EXPECT_EQ(std::sscanf(&text[point], "#define PRT_PREDICTOR_ORIGIN vec3(%f, %f, %f)", &x, &y, &z), 3);
        EXPECT_EQ(glm::vec3(x, y, z), glm::vec3(origin));
        const bool vulkan = language == "vulkan";
        std::vector<std::string> arguments = {"-S", "vert", at("s.vert")};
        if (vulkan)
            arguments.insert(arguments.end(), {"-V", "--target-env", "vulkan1.0", "-o", at("s.spv")});
        const Outcome outcome = run(PRT_GLSLANG, arguments);
        EXPECT_EQ(outcome.status, 0) << outcome.out;
        if (!vulkan)
            continue;
        EXPECT_EQ(run(PRT_SPIRV_VAL, {"--target-env", "vulkan1.0", at("s.spv")}).status, 0);
        EXPECT_EQ(
            run(PRT_SPIRV_CROSS, {at("s.spv"), "--hlsl", "--shader-model", "50", "--output", at("s.hlsl")})
                .status,
            0);
        EXPECT_EQ(run(PRT_GLSLANG, {"-D", "-V", "-S", "vert", "-e", "main", at("s.hlsl"), "-o", at("h.spv")})
                      .status,
                  0);
    }
}

} // namespace
} // namespace prt::test
