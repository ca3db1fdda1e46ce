// Tests a model with predictors through the C interface.

#include "prt/prt.h"

#include "prt/core/light.h"
#include "prt/gltf/gltf.h"
#include "runtime/load/predictors.h"
#include "support/glb_file.h"
#include "support/predicted.h"
#include "support/temporary_folder.h"

#include <gtest/gtest.h>

#include <string>

namespace prt {
namespace {

/// A triangle far away, of clusters without weights.
class CPredictors : public testing::Test {
protected:
    void make(const std::vector<PredictorKind>& kinds) {
        test::GlbFile file = test::triangle_file();
        file.json["nodes"][0]["translation"] = {1e6, 20, 3};
        file.write(folder / "t.glb");
        GltfDocument document = load_gltf(folder / "t.glb");
        scene = extract_scene(document);
        transfer.bases.layout = layout_of_one(2, 3);
        transfer.bases.components = {0, 0};
        transfer.bases.rows.assign(2 * transfer.bases.dimension(), 1);
        std::mt19937 random(3);
        test::add_predictors(transfer.bases, kinds, random);
        transfer.receivers.clusters = {0, 1, 1};
        transfer.receivers.predictors = predictor_coordinates(scene, transfer.bases.predictors);
        write_clustered(document, scene, {transfer, {}});
        save_glb(document, folder / "g.glb");
        ASSERT_EQ(prt_model_load((folder / "g.glb").string().c_str(), &model, nullptr), PRT_OK);
        ASSERT_EQ(prt_model_get_info(model, &info, nullptr), PRT_OK);
        ASSERT_EQ(prt_model_get_vertex_inputs(model, &inputs, nullptr), PRT_OK);
    }
    void TearDown() override { prt_model_destroy(model); }

    test::TemporaryFolder folder;
    Scene scene;
    ClusteredTransfer transfer;
    prt_model* model = nullptr;
    prt_model_info info = {};
    prt_vertex_inputs inputs = {};
};

TEST_F(CPredictors, EvaluateLikeCpp) {
    make({PredictorKind::normal, PredictorKind::position});
    EXPECT_EQ(info.rows, 14u);
    EXPECT_EQ(inputs.normals, 1);
    EXPECT_EQ(inputs.positions, 1);
    const Light light = directional_light(2, {0.6f, 0.8f, 0}, {1, 2, 3});
    std::vector<float> constants(4 * info.rows), radiance(3 * info.receivers);
    ASSERT_EQ(prt_model_update_constants(model, 2, &light.coefficients[0].x, constants.data(), nullptr),
              PRT_OK);
    ASSERT_EQ(prt_model_evaluate(model, constants.data(), radiance.data(), nullptr), PRT_OK);
    const std::vector<glm::vec3> expected = exit_radiance(decode(transfer), light);
    for (std::size_t p = 0; p < 3; ++p)
        for (int c = 0; c < 3; ++c)
            EXPECT_NEAR(radiance[3 * p + static_cast<std::size_t>(c)], expected[p][c], 1e-5f);
}

TEST_F(CPredictors, ShadersUseMeshPositions) {
    make({PredictorKind::position});
    EXPECT_EQ(inputs.normals, 0);
    EXPECT_EQ(inputs.positions, 1);
    EXPECT_EQ(inputs.predictor_origin[1], -2);
    EXPECT_EQ(prt_model_get_vertex_inputs(model, nullptr, nullptr), PRT_BAD_ARGUMENT);
    EXPECT_EQ(inputs.origin[0], 1e6 + 0.5);
    EXPECT_EQ(inputs.origin[1], 20.5);
    EXPECT_EQ(inputs.origin[2], 3);
    prt_mesh mesh;
    ASSERT_EQ(prt_model_get_mesh(model, 0, &mesh, nullptr), PRT_OK);
    EXPECT_EQ(mesh.positions[0], -0.5f); // seen from the origin
    std::size_t size = 0;
    prt_model_shader(model, PRT_GLSL450, PRT_CONSTANTS_IN_BUFFER, nullptr, &size, nullptr);
    std::string source(size, ' ');
    ASSERT_EQ(prt_model_shader(model, PRT_GLSL450, PRT_CONSTANTS_IN_BUFFER, source.data(), &size, nullptr),
              PRT_OK);
    // Also contains the origin of the predictor, which test::add_predictors sets.
    EXPECT_NE(source.find("PRT_PREDICTOR_ORIGIN vec3(2.50000000e-01, -2.00000000e+00, 1.29999995e+00)"),
              std::string::npos);
}

} // namespace
} // namespace prt
