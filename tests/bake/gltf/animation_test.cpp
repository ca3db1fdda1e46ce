// Nodes, skins and animations of glTF files.

#include "prt/gltf/animation.h"

#include "prt/core/error.h"
#include "support/glb_file.h"
#include "support/temporary_folder.h"

#include <glm/geometric.hpp>
#include <glm/gtc/matrix_transform.hpp>
#include <glm/gtc/quaternion.hpp>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>

namespace prt {
namespace {

using test::GlbFile;

constexpr double kPi = std::numbers::pi;
constexpr float kNan = std::numeric_limits<float>::quiet_NaN();

AnimatedScene animated(const GlbFile& file) {
    const test::TemporaryFolder folder;
    file.write(folder / "moving.glb");
    return AnimatedScene(load_gltf(folder / "moving.glb"));
}

/// Returns the error of a rejected file; empty if it is accepted.
std::string refusal(const GlbFile& file) {
    try {
        animated(file);
        return "";
    } catch (const Error& error) {
        return error.what();
    }
}

/// Adds one animation of one channel of node 0.
struct Keys {
    std::string path, interpolation;
    std::vector<float> times, values;
};
void animate(GlbFile& file, const Keys& keys, int node = 0) {
    const bool rotation = keys.path == "rotation";
    const auto input = file.accessor(keys.times, test::kFloat, "SCALAR", 1),
               output =
                   file.accessor(keys.values, test::kFloat, rotation ? "VEC4" : "VEC3", rotation ? 4 : 3);
    file.json["animations"].push_back(
        {{"samplers", {{{"input", input}, {"output", output}, {"interpolation", keys.interpolation}}}},
         {"channels", {{{"sampler", 0}, {"target", {{"node", node}, {"path", keys.path}}}}}}});
}

/// Returns a rotation about +Z as a glTF quaternion.
std::vector<float> rotation(double degrees) {
    const double half = degrees * kPi / 360;
    return {0, 0, static_cast<float>(std::sin(half)), static_cast<float>(std::cos(half))};
}

std::vector<float> joined(const std::vector<std::vector<float>>& parts) {
    std::vector<float> all;
    for (const std::vector<float>& part : parts)
        all.insert(all.end(), part.begin(), part.end());
    return all;
}

/// Returns the triangle with two joints, one above the other: vertex 0 follows the lower, vertex 1 the upper,
/// vertex 2 both equally. The upper joint is at (0, 1, 0).
GlbFile skinned_file() {
    GlbFile file = test::triangle_file();
    auto& attributes = file.json["meshes"][0]["primitives"][0]["attributes"];
    attributes["JOINTS_0"] = file.accessor(std::vector<std::uint8_t>{0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0},
                                           test::kUnsignedByte, "VEC4", 4);
    attributes["WEIGHTS_0"] =
        file.accessor(std::vector<float>{1, 0, 0, 0, 1, 0, 0, 0, 0.5f, 0.5f, 0, 0}, test::kFloat, "VEC4", 4);
    // Column by column: the identity, and down by one metre.
    const auto bind = file.accessor(std::vector<float>{1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0,  0, 1,
                                                       1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, -1, 0, 1},
                                    test::kFloat, "MAT4", 16);
    file.json["skins"] = {{{"joints", {1, 2}}, {"inverseBindMatrices", bind}}};
    file.json["nodes"] = {{{"mesh", 0}, {"skin", 0}}, {{"children", {2}}}, {{"translation", {0, 1, 0}}}};
    file.json["scenes"] = {{{"nodes", {0, 1}}}};
    file.json["scene"] = 0;
    return file;
}

glm::dvec3 position(const glm::dmat4& matrix) {
    return glm::dvec3(matrix[3]);
}

/// Differs from `wanted` by rounding to floats of positions of a few metres.
void expect_near(const glm::dvec3& found, const glm::dvec3& wanted) {
    EXPECT_LT(glm::distance(found, wanted), 1e-6) << found.x << " " << found.y << " " << found.z;
}

TEST(Animation, HalfOfTheTimeIsHalfOfTheAngle) {
    GlbFile file = test::triangle_file();
    animate(file, {"rotation", "LINEAR", {1, 3}, joined({rotation(0), rotation(120)})});
    const AnimatedScene scene = animated(file);
    EXPECT_EQ(scene.animations().at(0).duration, 3);
    for (const double seconds :
         {0.0, 1.0, 1.5, 2.0, 2.75, 3.0, 9.0}) { // before the first key and after the last
        const double angle = std::clamp((seconds - 1) / 2, 0.0, 1.0) * 120 * kPi / 180;
        const auto nodes = scene.pose(scene.animations()[0], seconds);
        expect_near(glm::dvec3(nodes[0] * glm::dvec4(1, 0, 0, 0)), {std::cos(angle), std::sin(angle), 0});
    }
}

TEST(Animation, RotationsTakeTheShortestPath) {
    GlbFile file = test::triangle_file();
    std::vector<float> far = rotation(90);
    for (float& number : far)
        number = -number; // an equal rotation
    animate(file, {"rotation", "LINEAR", {0, 1}, joined({rotation(0), far})});
    const AnimatedScene scene = animated(file);
    const auto nodes = scene.pose(scene.animations()[0], 0.5);
    expect_near(glm::dvec3(nodes[0] * glm::dvec4(1, 0, 0, 0)), {std::sqrt(0.5), std::sqrt(0.5), 0});
}

TEST(Animation, StepAndLinearInterpolationFollowGltf) {
    GlbFile file = test::triangle_file();
    animate(file, {"translation", "STEP", {0, 1, 2}, {0, 0, 0, 4, 0, 0, 0, 8, 0}});
    animate(file, {"scale", "LINEAR", {0, 2}, {1, 1, 1, 3, 5, 1}});
    const AnimatedScene scene = animated(file);
    expect_near(position(scene.pose(scene.animations()[0], 0.999)[0]), {0, 0, 0});
    expect_near(position(scene.pose(scene.animations()[0], 1)[0]), {4, 0, 0});
    expect_near(position(scene.pose(scene.animations()[0], 1.7)[0]), {4, 0, 0});
    expect_near(position(scene.pose(scene.animations()[0], 2)[0]), {0, 8, 0});
    const glm::dmat4 scaled = scene.pose(scene.animations()[1], 0.5)[0];
    expect_near({scaled[0][0], scaled[1][1], scaled[2][2]}, {1.5, 2, 1});
}

// A cubic equals the Hermite interpolation of its ends and slopes, for any length of the interval.
TEST(Animation, SplinesAreTheCubicsOfTheirTangents) {
    const auto x = [](double t) { return 2 * t * t * t - 3 * t * t + 0.5 * t + 1; };
    const auto slope = [](double t) { return 6 * t * t - 6 * t + 0.5; };
    const std::vector<float> times = {0.5f, 1.25f, 4};
    std::vector<float> values;
    for (const float t : times)
        for (const double number : {slope(t), x(t), slope(t)})
            values.insert(values.end(), {static_cast<float>(number), 0, 7 * static_cast<float>(number)});
    GlbFile file = test::triangle_file();
    animate(file, {"translation", "CUBICSPLINE", times, values});
    const AnimatedScene scene = animated(file);
    for (double t = 0.5; t <= 4; t += 0.25) {
        const glm::dvec3 found = position(scene.pose(scene.animations()[0], t)[0]);
        EXPECT_NEAR(found.x, x(t), 1e-5 * (1 + std::abs(x(t)))) << t; // keys are floats of up to 80
        EXPECT_NEAR(found.z, 7 * x(t), 7e-5 * (1 + std::abs(x(t)))) << t;
    }
}

TEST(Animation, SplinesOfRotationsAreUnit) {
    GlbFile file = test::triangle_file();
    const std::vector<float> still(4, 0);
    animate(
        file,
        {"rotation", "CUBICSPLINE", {0, 1}, joined({still, rotation(0), still, still, rotation(90), still})});
    const AnimatedScene scene = animated(file);
    const auto nodes = scene.pose(scene.animations()[0], 0.5);
    EXPECT_NEAR(glm::determinant(nodes[0]), 1, 1e-12);
    // By symmetry the middle of two keys without tangents is half of the rotation.
    expect_near(glm::dvec3(nodes[0] * glm::dvec4(1, 0, 0, 0)), {std::sqrt(0.5), std::sqrt(0.5), 0});
}

TEST(Animation, ChildrenMoveWithTheirParents) {
    GlbFile file = test::triangle_file();
    file.json["nodes"] = {
        {{"mesh", 0}, {"children", {1}}}, {{"translation", {0, 2, 0}}}, {{"translation", {3, 0, 0}}}};
    file.json["scenes"] = {{{"nodes", {0, 2}}}};
    animate(file, {"rotation", "LINEAR", {0, 1}, joined({rotation(0), rotation(90)})});
    const AnimatedScene scene = animated(file);
    const auto nodes = scene.pose(scene.animations()[0], 1);
    expect_near(position(nodes[1]), {-2, 0, 0});
    expect_near(position(nodes[2]), {3, 0, 0});
}

TEST(Skins, VerticesRotateWithTheirJoint) {
    GlbFile file = skinned_file();
    animate(file, {"rotation", "LINEAR", {0, 1}, joined({rotation(0), rotation(90)})}, 2);
    const AnimatedScene scene = animated(file);
    const auto nodes = scene.pose(scene.animations()[0], 1);
    const Scene posed = scene.posed(nodes, glm::dmat4(1));
    const auto& positions = posed.vertex_arrays[0].positions;
    // Relative to (0, 1, 0), (1, 0, 0) is at (1, -1, 0), which is rotated to (1, 1, 0).
    expect_near(positions[0], {0, 0, 0});
    expect_near(positions[1], {1, 2, 0});
    expect_near(positions[2], {0, 1, 0}); // at the joint itself
    // The palette is the shader's input: joint world times inverse bind, then the identity.
    const auto palette = scene.matrices(0, nodes);
    ASSERT_EQ(palette.size(), 3u);
    EXPECT_EQ(palette[2], glm::dmat4(1));
    expect_near(glm::dvec3(palette[1] * glm::dvec4(1, 0, 0, 1)), {1, 2, 0});
}

TEST(Skins, NormalsFollowJointsAndInverseScales) {
    GlbFile file = skinned_file();
    const float s = std::sqrt(0.5f);
    file.json["meshes"][0]["primitives"][0]["attributes"]["NORMAL"] =
        file.accessor(std::vector<float>{0, 0, 1, 1, 0, 0, s, s, 0}, test::kFloat, "VEC3", 3);
    animate(file, {"rotation", "LINEAR", {0, 1}, joined({rotation(0), rotation(90)})}, 2);
    animate(file, {"scale", "STEP", {0}, {2, 1, 1}}, 1);
    const AnimatedScene scene = animated(file);
    const Scene rotated = scene.posed(scene.pose(scene.animations()[0], 1), glm::dmat4(1));
    expect_near(rotated.vertex_arrays[0].normals[0], {0, 0, 1});
    expect_near(rotated.vertex_arrays[0].normals[1], {0, 1, 0});
    const Scene wide = scene.posed(scene.pose(scene.animations()[1], 0), glm::dmat4(1));
    const glm::dvec3 leaning =
        glm::normalize(glm::dvec3(0.5, 1, 0)); // the plane x + y = c becomes x / 2 + y = c
    expect_near(wide.vertex_arrays[0].normals[2], leaning);
}

/// Expects that the rest pose equals the extracted scene at its original position.
void expect_rest_is_scene(const AnimatedScene& animated, const Scene& scene) {
    const Scene posed = animated.posed(animated.rest(), glm::translate(glm::dmat4(1), -scene.origin));
    ASSERT_EQ(posed.vertex_arrays.size(), scene.vertex_arrays.size());
    const Bounds box = bounds(scene);
    const float rounding = 4e-7f * glm::distance(box.low, box.high);
    for (std::size_t a = 0; a < scene.vertex_arrays.size(); ++a) {
        ASSERT_EQ(posed.vertex_arrays[a].size(), scene.vertex_arrays[a].size());
        for (std::size_t i = 0; i < scene.vertex_arrays[a].size(); ++i) {
            ASSERT_LT(glm::distance(posed.vertex_arrays[a].positions[i], scene.vertex_arrays[a].positions[i]),
                      rounding);
            ASSERT_LT(glm::distance(posed.vertex_arrays[a].normals[i], scene.vertex_arrays[a].normals[i]),
                      1e-6f);
        }
    }
}

TEST(Skins, RestPoseMatchesTheExtractedScene) {
    GlbFile rotated = skinned_file();
    rotated.json["nodes"][2]["rotation"] = rotation(37);
    GlbFile flat = rotated;
    flat.json["meshes"][0]["primitives"][0]["attributes"].erase("NORMAL");
    GlbFile rigid = test::triangle_file();
    rigid.json["nodes"][0]["scale"] = {2, -1, 0.5};
    GlbFile loose = skinned_file(); // vertex 0 has no joint
    loose.json["meshes"][0]["primitives"][0]["attributes"]["WEIGHTS_0"] =
        loose.accessor(std::vector<float>{0, 0, 0, 0, 1, 0, 0, 0, 0.5f, 0.5f, 0, 0}, test::kFloat, "VEC4", 4);
    for (const GlbFile& file : {rotated, flat, rigid, loose}) {
        const test::TemporaryFolder folder;
        file.write(folder / "rest.glb");
        const GltfDocument document = load_gltf(folder / "rest.glb");
        expect_rest_is_scene(AnimatedScene(document), extract_scene(document));
    }
}

/// A level outside the scene moves with the parent of its level 0, as one in the scene.
TEST(AnimatedLevels, MoveWithTheParentOfLevel0) {
    for (const bool outside : {false, true}) {
        GlbFile file = test::triangle_file();
        file.json["nodes"] = {{{"children", {1}}, {"translation", {0, 1, 0}}},
                              {{"mesh", 0}, {"translation", {1, 0, 0}}},
                              {{"children", {3}}, {"translation", {2, 0, 0}}},
                              {{"mesh", 0}, {"scale", {2, 2, 2}}}};
        file.json["nodes"][1]["extensions"]["MSFT_lod"]["ids"] = {2};
        file.json["extensionsUsed"] = {"MSFT_lod"};
        if (!outside)
            file.json["nodes"][0]["children"].push_back(2);
        animate(file, {"translation", "LINEAR", {0}, {0, 5, 0}});
        const std::string bytes = file.bytes();
        const GltfDocument document = parse_gltf(std::as_bytes(std::span(bytes)), "levels.glb");
        const AnimatedScene model(document, ReadLevels::all);
        expect_rest_is_scene(model, extract_levels(document).scene);
        EXPECT_EQ(model.leveled().nodes.size(), 1u);
        const Scene posed = model.posed(model.pose(model.animations()[0], 0), glm::dmat4(1));
        EXPECT_EQ(posed.vertex_arrays.at(0).positions[1], glm::vec3(2, 5, 0)) << outside;
        EXPECT_EQ(posed.vertex_arrays.at(1).positions[1], glm::vec3(4, 5, 0)) << outside;
        EXPECT_TRUE(AnimatedScene(document).leveled().nodes.empty());
        EXPECT_EQ(AnimatedScene(document).scene().receivers(), 3u);
    }
}

TEST(Skins, RealCharactersMatchTheRestPoseAndStayFinite) {
    const std::filesystem::path path = test::shared_file("mesh/RobotExpressive.glb");
    if (path.empty())
        GTEST_SKIP() << "no mesh/RobotExpressive.glb";
    const GltfDocument document = load_gltf(path);
    const AnimatedScene robot(document);
    expect_rest_is_scene(robot, extract_scene(document));
    EXPECT_GT(robot.animations().size(), 10u);
    for (const Animation& animation : robot.animations()) {
        const Scene posed = robot.posed(robot.pose(animation, 0.4 * animation.duration), glm::dmat4(1));
        const Bounds box = bounds(posed);
        EXPECT_TRUE(glm::length(box.high - box.low) > 1 && glm::length(box.high - box.low) < 20)
            << animation.name;
    }
}

TEST(Animation, ChannelsWithoutNodesAreIgnored) {
    GlbFile file = test::triangle_file();
    animate(file, {"translation", "LINEAR", {0, 1}, {0, 0, 0, 1, 0, 0}});
    file.json["animations"][0]["channels"][0]["target"] = {{"path", "pointer"}};
    file.json["animations"][0]["extras"] = {{"speed", 1.25}};
    const AnimatedScene scene = animated(file);
    EXPECT_TRUE(scene.animations().at(0).channels.empty());
    EXPECT_EQ(scene.animations().at(0).speed, 1.25);
    EXPECT_EQ(scene.pose(scene.animations()[0], 1), scene.rest());
}

TEST(BadAnimation, IsRejectedWithItsPosition) {
    const auto refused = [](const Keys& keys, int node = 0) {
        GlbFile file = test::triangle_file();
        animate(file, keys, node);
        return refusal(file);
    };
    const std::vector<float> two = {0, 0, 0, 1, 0, 0};
    const auto has = [](const std::string& text, const char* part) {
        EXPECT_NE(text.find(part), std::string::npos) << text;
        EXPECT_NE(text.find("moving.glb: animation 0 channel 0: "), std::string::npos) << text;
        EXPECT_EQ(text.find('\n'), std::string::npos);
    };
    has(refused({"translation", "LINEAR", {0, kNan}, two}), "time of keyframe 1 is not finite");
    has(refused({"translation", "LINEAR", {1, 0.5f}, two}), "keyframe 1 is earlier than the previous one");
    has(refused({"translation", "LINEAR", {0, 1}, {0, 0, 0, 1, kNan, 0}}), "value 1 is not finite");
    has(refused({"translation", "LINEAR", {0, 1, 2}, two}), "2 values, but its 3 keyframes need 3");
    has(refused({"translation", "CUBICSPLINE", {0, 1}, two}), "2 values, but its 2 keyframes need 6");
    has(refused({"translation", "LINEAR", {}, {}}), "it has no keyframes");
    has(refused({"translation", "LINEAR", {0, 1}, two}, 7), "moves node 7, which does not exist");
    has(refused({"rotation", "LINEAR", {0}, {0, 0, 0, 0}}), "rotation of keyframe 0 is not a rotation");
    has(refused({"translation", "WOBBLE", {0, 1}, two}), "interpolation 'WOBBLE' is not LINEAR");
}

TEST(BadAnimation, WithMissingTargetsIsRejected) {
    GlbFile file = test::triangle_file();
    animate(file, {"translation", "LINEAR", {0, 1}, {0, 0, 0, 1, 0, 0}});
    GlbFile output = file, input = file, sampler = file, matrix = file;
    output.json["animations"][0]["samplers"][0]["output"] = 99;
    EXPECT_NE(refusal(output).find("accessor 99 does not exist"), std::string::npos) << refusal(output);
    input.json["animations"][0]["samplers"][0]["input"] = 98;
    EXPECT_NE(refusal(input).find("accessor 98 does not exist"), std::string::npos) << refusal(input);
    sampler.json["animations"][0]["channels"][0]["sampler"] = 5;
    EXPECT_NE(refusal(sampler).find("sampler 5 does not exist"), std::string::npos) << refusal(sampler);
    matrix.json["nodes"][0]["matrix"] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
    EXPECT_NE(refusal(matrix).find("node 0, which has a matrix"), std::string::npos) << refusal(matrix);
}

TEST(BadSkin, IsRejectedWithItsPosition) {
    GlbFile joint = skinned_file(), index = skinned_file(), skin = skinned_file(), bind = skinned_file();
    joint.json["skins"][0]["joints"] = {1, 44};
    EXPECT_NE(refusal(joint).find("joint 1 of skin 0 is node 44, which does not exist"), std::string::npos)
        << refusal(joint);
    index.json["skins"][0]["joints"] = {1};
    EXPECT_NE(refusal(index).find("joint 1 does not exist: the skin has 1 joint"), std::string::npos)
        << refusal(index);
    skin.json["nodes"][0]["skin"] = 3;
    EXPECT_NE(refusal(skin).find("skin 3 does not exist"), std::string::npos) << refusal(skin);
    bind.json["skins"][0]["inverseBindMatrices"] = 77;
    EXPECT_NE(refusal(bind).find("accessor 77 does not exist"), std::string::npos) << refusal(bind);
    GlbFile few = skinned_file();
    few.json["skins"][0]["inverseBindMatrices"] = few.accessor(
        std::vector<float>{1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1}, test::kFloat, "MAT4", 16);
    EXPECT_NE(refusal(few).find("2 joints, but 1 inverse bind"), std::string::npos) << refusal(few);
    for (const float weight : {std::nanf(""), -1.0f}) {
        GlbFile file = skinned_file();
        file.json["meshes"][0]["primitives"][0]["attributes"]["WEIGHTS_0"] = file.accessor(
            std::vector<float>{1, 0, 0, 0, weight, 0, 0, 0, 1, 0, 0, 0}, test::kFloat, "VEC4", 4);
        EXPECT_NE(refusal(file).find("a joint weight of vertex 1"), std::string::npos) << refusal(file);
    }
}

} // namespace
} // namespace prt
