// Tests the defines of the vertex shader for a model.

#include "prt/shader/shader_source.h"

#include "prt/core/error.h"
#include "support/predicted.h"

#include <glm/gtc/constants.hpp>
#include <gtest/gtest.h>

#include <cstdlib>
#include <string>

namespace prt {
namespace {

ClusteredTransfer transfer_of(int components, const std::vector<PredictorKind>& predictors) {
    ClusteredTransfer t;
    t.bases.layout = layout_of_one(1, 1);
    t.bases.components = {components};
    t.bases.rows.resize(1 + static_cast<std::size_t>(components));
    t.receivers.components = (components + 3) / 4 * 4;
    std::mt19937 random(1);
    test::add_predictors(t, predictors, random);
    return t;
}

/// The three numbers of PRT_PREDICTOR_ORIGIN.
glm::vec3 origin_in(const std::string& defines) {
    const std::string begin = "#define PRT_PREDICTOR_ORIGIN vec3(";
    const char* at = defines.c_str() + defines.find(begin) + begin.size();
    glm::vec3 origin(0);
    for (int i = 0; i < 3; ++i) {
        char* end = nullptr;
        origin[i] = std::strtof(at, &end);
        at = end + 2;
    }
    return origin;
}

TEST(RelightDefines, NameThePredictorsOfAModel) {
    const auto defines = [](const std::vector<PredictorKind>& predictors) {
        return relight_defines(transfer_of(4, predictors));
    };
    EXPECT_EQ(defines({}).find("PREDICTOR"), std::string::npos);
    EXPECT_NE(defines({PredictorKind::normal}).find("#define PRT_PREDICTOR_NORMAL\n"), std::string::npos);
    EXPECT_EQ(defines({PredictorKind::normal}).find("POSITION"), std::string::npos);
    EXPECT_NE(defines({PredictorKind::position}).find("#define PRT_PREDICTOR_POSITION\n"), std::string::npos);
    EXPECT_EQ(defines({PredictorKind::position}).find("NORMAL"), std::string::npos);
}

TEST(RelightDefines, ContainTheOriginInFullPrecision) {
    ClusteredTransfer t = transfer_of(4, {PredictorKind::position});
    for (const glm::vec3 origin : {glm::vec3(0), glm::vec3(1.0f / 3, -glm::pi<float>(), 1e-20f),
                                   glm::vec3(16777217, 0.1f, -123456.789f)}) {
        t.bases.predictors[0].origin = origin;
        EXPECT_EQ(origin_in(relight_defines(t)), origin);
        const glm::dvec3 from(1e6 + 0.25, -3, 1e-3);
        EXPECT_EQ(origin_in(relight_defines(t, ConstantSource::buffer, ShaderLanguage::glsl450, from)),
                  glm::vec3(from + glm::dvec3(origin)));
        // GLSL has no implicit floats in ES: every number has a point.
        const std::string text = relight_shader(t, ConstantSource::texture, ShaderLanguage::essl300, from);
        EXPECT_EQ(origin_in(text), glm::vec3(from + glm::dvec3(origin)));
    }
}

/// Two clusters of packed weights with three bits more than the cluster, 1 and 2.
ClusteredTransfer packed_transfer() {
    ClusteredTransfer t;
    t.bases.layout = layout_of_one(1, 1);
    t.bases.components = {2, 2};
    t.bases.rows.resize(6);
    t.bases.bits = {1, 2, 1, 2};
    t.receivers.format = WeightFormat::packed;
    t.receivers.cluster_bits = 5;
    t.receivers.words = 1;
    return t;
}

TEST(RelightDefines, ContainTheLayoutOfEquallyDividedWeights) {
    const ClusteredTransfer packed = packed_transfer();
    EXPECT_TRUE(clusters_have_equal_layout(packed.bases));
    const std::string text = relight_defines(packed);
    EXPECT_NE(text.find("#define PRT_CLUSTER_ROWS 3\n"), std::string::npos) << text;
    EXPECT_NE(
        text.find("#define PRT_SAME_WEIGHTS PRT_ADD(0u, PRT_BITS(5u, 1u)) PRT_ADD(1u, PRT_BITS(6u, 2u))\n"),
        std::string::npos)
        << text;
    const std::string plain = relight_defines(transfer_of(5, {PredictorKind::normal}));
    EXPECT_NE(plain.find("#define PRT_CLUSTER_ROWS 9\n"), std::string::npos) << plain;
    EXPECT_NE(plain.find(" PRT_ADD(3u, prt_weights_0[3]) PRT_ADD(4u, prt_weights_1[0])\n"), std::string::npos)
        << plain;
}

TEST(RelightDefines, UseALoopForDifferentClusters) {
    for (const int which : {0, 1}) {
        ClusteredTransfer t = packed_transfer();
        if (which == 0)
            t.bases.bits = {1, 2, 2, 1};
        else
            t.bases.components = {1, 3}, t.bases.bits = {1, 1, 1, 1};
        EXPECT_FALSE(clusters_have_equal_layout(t.bases));
        const std::string text = relight_defines(t);
        EXPECT_EQ(text.find("PRT_SAME_WEIGHTS"), std::string::npos) << text;
        EXPECT_EQ(text.find("PRT_CLUSTER_ROWS"), std::string::npos) << text;
    }
    EXPECT_FALSE(clusters_have_equal_layout({}));
}

TEST(RelightDefines, LeaveTheLastAttributeToTheNormal) {
    EXPECT_EQ(max_vertex_components(transfer_of(48, {}).bases), 48);
    EXPECT_NO_THROW(relight_defines(transfer_of(48, {})));
    EXPECT_NO_THROW(relight_defines(transfer_of(44, {PredictorKind::normal})));
    EXPECT_THROW(relight_defines(transfer_of(45, {PredictorKind::normal})), Error);
    EXPECT_THROW(relight_defines(transfer_of(49, {})), Error);
}

} // namespace
} // namespace prt
