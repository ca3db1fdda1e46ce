// Tests transfer of a moving model, in the frames of its vertices, and lobes that rotate with it.

#include "prt/bake/pose_bake.h"

#include "prt/core/error.h"
#include "prt/core/error_measures.h"
#include "prt/core/sh.h"
#include "prt/fit/lobe_fit.h"
#include "support/glb_file.h"
#include "support/scene_builder.h"

#include <glm/geometric.hpp>
#include <glm/gtc/matrix_transform.hpp>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>
#include <numbers>

namespace prt {
namespace poses_of_models { // joined sources share one scope
namespace {

using test::GlbFile;
using Json = nlohmann::ordered_json;

constexpr int kRings = 17, kSides = 16;
constexpr float kRadius = 0.1f, kHeight = 2;

struct Tube {
    std::vector<float> positions, normals, weights;
    std::vector<std::uint8_t> joints;
    std::vector<std::uint16_t> indices;
};

/// Along +Y, its lower half bound to joint 0, its upper to joint 1, by both over a few rings about the
/// middle.
Tube tube() {
    Tube tube;
    for (int ring = 0; ring < kRings; ++ring)
        for (int side = 0; side < kSides; ++side) {
            const float angle = 2 * std::numbers::pi_v<float> * static_cast<float>(side) / kSides;
            const float y = kHeight * static_cast<float>(ring) / (kRings - 1);
            const float upper = std::clamp((y - 0.8f) / 0.4f, 0.0f, 1.0f);
            tube.positions.insert(tube.positions.end(),
                                  {kRadius * std::sin(angle), y, kRadius * std::cos(angle)});
            tube.normals.insert(tube.normals.end(), {std::sin(angle), 0, std::cos(angle)});
            tube.weights.insert(tube.weights.end(), {1 - upper, upper, 0, 0});
            tube.joints.insert(tube.joints.end(), {0, 1, 0, 0});
        }
    for (int ring = 0; ring + 1 < kRings; ++ring)
        for (int side = 0; side < kSides; ++side) {
            const auto at = [&](int r, int s) { return static_cast<std::uint16_t>(r * kSides + s % kSides); };
            for (const std::uint16_t i : {at(ring, side), at(ring, side + 1), at(ring + 1, side + 1),
                                          at(ring, side), at(ring + 1, side + 1), at(ring + 1, side)})
                tube.indices.push_back(i);
        }
    return tube;
}

void add_keys(GlbFile& file, const std::string& name, const std::vector<float>& times,
              const std::vector<float>& rotations) {
    const auto input = file.accessor(times, test::kFloat, "SCALAR", 1),
               output = file.accessor(rotations, test::kFloat, "VEC4", 4);
    file.json["animations"].push_back(
        {{"name", name},
         {"samplers", {{{"input", input}, {"output", output}, {"interpolation", "LINEAR"}}}},
         {"channels", {{{"sampler", 0}, {"target", {{"node", 2}, {"path", "rotation"}}}}}}});
}

/// Returns a tube whose upper half rotates about +Z by `degrees` in two seconds; the transform of node 0,
/// which has the mesh, is ignored.
GlbFile bending(float degrees) {
    GlbFile file = test::triangle_file();
    file.binary.clear();
    for (const char* name : {"accessors", "bufferViews"})
        file.json[name] = Json::array();
    const Tube shape = tube();
    Json primitive = {{"attributes",
                       {{"POSITION", file.accessor(shape.positions, test::kFloat, "VEC3", 3)},
                        {"NORMAL", file.accessor(shape.normals, test::kFloat, "VEC3", 3)},
                        {"JOINTS_0", file.accessor(shape.joints, test::kUnsignedByte, "VEC4", 4)},
                        {"WEIGHTS_0", file.accessor(shape.weights, test::kFloat, "VEC4", 4)}}},
                      {"indices", file.accessor(shape.indices, test::kUnsignedShort, "SCALAR", 1)}};
    file.json["meshes"] = Json::array({{{"primitives", Json::array({primitive})}}});
    const auto bind = file.accessor(std::vector<float>{1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0,  0, 1,
                                                       1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, -1, 0, 1},
                                    test::kFloat, "MAT4", 16);
    file.json["skins"] = {{{"joints", {1, 2}}, {"inverseBindMatrices", bind}}};
    file.json["nodes"] = {{{"mesh", 0}, {"skin", 0}}, {{"children", {2}}}, {{"translation", {0, 1, 0}}}};
    file.json["scenes"] = {{{"nodes", {0, 1}}}};
    file.json["scene"] = 0;
    const float half = degrees * std::numbers::pi_v<float> / 360;
    add_keys(file, "bend", {0, 2}, {0, 0, 0, 1, 0, 0, std::sin(half), std::cos(half)});
    return file;
}

AnimatedScene animated(const GlbFile& file) {
    const std::string bytes = file.bytes();
    return AnimatedScene(parse_gltf(std::as_bytes(std::span(bytes)), "tube.glb"));
}

std::vector<glm::vec3> normals_in(const AnimatedScene& model, const ModelPose& pose) {
    return model.posed(pose.nodes, glm::dmat4(1)).vertex_arrays.at(0).normals;
}

TEST(Poses, AreAtTheMiddlesOfEqualIntervalsPlusThePoseOfTheFile) {
    GlbFile file = bending(90);
    add_keys(file, "again", {0, 1}, {0, 0, 0, 1, 0, 0, 0, 1});
    const AnimatedScene model = animated(file);
    const std::vector<ModelPose> poses = poses_of(model, 6); // in three seconds
    ASSERT_EQ(poses.size(), 7u);
    EXPECT_EQ(poses[0].animation, "");
    EXPECT_DOUBLE_EQ(poses[1].seconds, 0.25);
    EXPECT_DOUBLE_EQ(poses[4].seconds, 1.75);
    EXPECT_EQ(poses[4].animation, "bend");
    EXPECT_EQ(poses[5].animation, "again");
    EXPECT_DOUBLE_EQ(poses[5].seconds, 0.25);
    const std::vector<ModelPose> frames = frames_of(model, 4, "bend");
    ASSERT_EQ(frames.size(), 4u);
    EXPECT_DOUBLE_EQ(frames[0].seconds, 0);
    EXPECT_DOUBLE_EQ(frames[3].seconds, 1.5);
}

TEST(Poses, WithoutAnAnimationAreRejected) {
    GlbFile file = bending(90);
    const AnimatedScene model = animated(file);
    EXPECT_THROW(poses_of(model, 3, "fly"), Error);
    EXPECT_THROW(poses_of(model, 0), Error);
    file.json.erase("animations");
    EXPECT_THROW(poses_of(animated(file), 3), Error);
}

TEST(Poses, StaticAnimationsHaveOnePose) {
    GlbFile file = bending(90);
    file.json["animations"].clear();
    add_keys(file, "one", {0}, {0, 0, 0, 1});
    for (const ModelPose& pose : poses_of(animated(file), 3))
        EXPECT_EQ(pose.seconds, 0);
}

TEST(Poses, WithExtremeVerticesAreRejected) {
    GlbFile file = bending(90);
    const auto input = file.accessor(std::vector<float>{0, 1}, test::kFloat, "SCALAR", 1),
               output = file.accessor(std::vector<float>{1, 1, 1, 1e30f, 1, 1}, test::kFloat, "VEC3", 3);
    file.json["animations"][0]["samplers"].push_back({{"input", input}, {"output", output}});
    file.json["animations"][0]["channels"].push_back(
        {{"sampler", 1}, {"target", {{"node", 2}, {"path", "scale"}}}});
    const AnimatedScene model = animated(file);
    try {
        bake_pose(model, poses_of(model, 1).back(), {.rays = 4});
        FAIL() << "it is baked";
    } catch (const Error& error) {
        EXPECT_NE(std::string(error.what()).find("animation 'bend' moves vertices farther than"),
                  std::string::npos);
    }
}

TEST(VertexFrames, MapCosineLobesToTheUnskinnedNormals) {
    GlbFile file = bending(70);
    file.json["nodes"][1]["scale"] = {-2, 2, 2}; // mirrored, and larger
    const AnimatedScene model = animated(file);
    const ModelPose pose = poses_of(model, 1).back();
    const VertexFrames frames(model, pose);
    const std::vector<glm::vec3> normals = normals_in(model, pose);
    for (std::size_t v = 0; v < frames.vertices(); ++v) {
        const float upper = model.vertices()[0].weights[4 * v + 1];
        if (upper > 0 && upper < 1)
            continue; // the bent part is not a rotation
        std::array<double, 16> world, own, expected;
        clamped_cosine_lobe(4, glm::dvec3(normals[v]), world);
        clamped_cosine_lobe(4, glm::dvec3(model.vertices()[0].normals[v]), expected);
        frames.from_world(4, v, world, own);
        for (std::size_t i = 0; i < 16; ++i)
            EXPECT_NEAR(own[i], expected[i], 1e-5) << v;
        frames.to_world(4, v, own, own);
        for (std::size_t i = 0; i < 16; ++i)
            EXPECT_NEAR(own[i], world[i], 1e-9) << v;
    }
}

TEST(PoseBake, LobesRotateWithTheBend) {
    const AnimatedScene model = animated(bending(60));
    const PoseBakeOptions options{.rays = 4096, .bounces = 0};
    const MeanTransfer mean = mean_of_poses(model, poses_of(model, 1), options); // straight, and half bent
    const std::vector<Lobe> fitted = fit_lobes({4, mean.vectors, mean.areas}, {.lobes = 1});
    ModelPose bent = poses_of(model, 1).front();
    bent.nodes = model.pose(model.animations()[0], 2);
    const PoseTransfer truth = bake_pose(model, bent, options);
    const VertexFrames frames(model, bent);
    const std::vector<glm::vec3> normals = normals_in(model, bent);
    Transfer rotated = zero_transfer(4, 1, frames.vertices()), still = rotated;
    for (std::size_t v = 0; v < frames.vertices(); ++v) {
        Lobe lobe = fitted[v];
        lobe_transfer({&lobe, 1}, 4, still.vector(v));
        lobe.axis = rotated_axis(lobe.axis, axis_rotation(glm::mat3(frames.matrix(v))));
        lobe_transfer({&lobe, 1}, 4, rotated.vector(v));
        // The ends hardly see each other: their lobes are those of their normals.
        if (v < 2 * kSides || v >= (kRings - 2) * kSides) {
            EXPECT_GT(glm::dot(lobe.axis, normals[v]), 0.995f) << v;
        }
    }
    // Noise of 4096 rays, and occlusion inside the bend; without rotation the error is half of all light.
    EXPECT_LT(relative_l2(truth.transfer, rotated, truth.areas), 0.06);
    EXPECT_GT(relative_l2(truth.transfer, still, truth.areas), 0.25);
}

TEST(PoseBake, MeansUseOnlyPosesThatShowAVertex) {
    const AnimatedScene model = animated(bending(60));
    const PoseBakeOptions options{.rays = 64, .bounces = 0};
    const std::vector<ModelPose> poses = poses_of(model, 2);
    const MeanTransfer all = mean_of_poses(model, poses, options);
    std::vector<double> sum(all.vectors.size());
    for (std::size_t p = 0; p < poses.size(); ++p) {
        PoseBakeOptions of_pose = options;
        of_pose.seed = p;
        const MeanTransfer one = mean_of_poses(model, std::span(poses).subspan(p, 1), of_pose);
        EXPECT_EQ(one.vectors, one.rest);
        for (std::size_t i = 0; i < sum.size(); ++i)
            sum[i] += one.vectors[i] / static_cast<double>(poses.size());
    }
    EXPECT_EQ(all.hidden, 0u); // no vertex is inside a tube without ends
    for (std::size_t i = 0; i < sum.size(); ++i)
        EXPECT_NEAR(all.vectors[i], sum[i], 1e-12);
}

/// Returns `file` with a coarser level of its tube, outside the scene: itself, or with every other vertex of
/// each ring only.
enum class Coarse { same, half };
GlbFile with_level(GlbFile file, Coarse coarse) {
    Json mesh = file.json["meshes"][0];
    if (coarse == Coarse::half) {
        std::vector<std::uint16_t> indices;
        for (int ring = 0; ring + 1 < kRings; ++ring)
            for (int side = 0; side < kSides; side += 2) {
                const auto at = [&](int r, int s) {
                    return static_cast<std::uint16_t>(r * kSides + s % kSides);
                };
                for (const std::uint16_t i : {at(ring, side), at(ring, side + 2), at(ring + 1, side + 2),
                                              at(ring, side), at(ring + 1, side + 2), at(ring + 1, side)})
                    indices.push_back(i);
            }
        mesh["primitives"][0]["indices"] = file.accessor(indices, test::kUnsignedShort, "SCALAR", 1);
    }
    file.json["meshes"].push_back(mesh);
    file.json["nodes"].push_back({{"mesh", 1}, {"skin", 0}});
    file.json["nodes"][0]["extensions"]["MSFT_lod"]["ids"] = {3};
    file.json["extensionsUsed"] = {"MSFT_lod"};
    return file;
}

MeanTransfer mean_with_levels(const GlbFile& file, LevelMode mode) {
    const std::string bytes = file.bytes();
    const AnimatedScene model(parse_gltf(std::as_bytes(std::span(bytes)), "tube.glb"), ReadLevels::all);
    const PoseBakeOptions options{.order = 3, .rays = 64, .bounces = 1, .levels = mode};
    return mean_of_poses(model, poses_of(model, 2), options);
}

/// A level baked in place of level 0 has the transfer of a model whose level 0 it is.
TEST(PoseBake, LevelsAreBakedInPlaceOfLevel0) {
    const GlbFile levels = with_level(bending(120), Coarse::half);
    GlbFile alone = levels;
    alone.json["nodes"][0].erase("extensions");
    alone.json["nodes"][0]["mesh"] = 1;
    const MeanTransfer all = mean_with_levels(levels, LevelMode::own),
                       coarse = mean_with_levels(alone, LevelMode::ignore);
    ASSERT_EQ(all.vectors.size(), 2 * coarse.vectors.size());
    EXPECT_EQ(std::vector(all.vectors.begin() + static_cast<std::ptrdiff_t>(coarse.vectors.size()),
                          all.vectors.end()),
              coarse.vectors);
    ASSERT_EQ(all.levels.levels.size(), 1u);
    EXPECT_TRUE(coarse.levels.levels.empty());
}

/// A level that is level 0 copies its transfer, in each pose.
TEST(PoseBake, LevelsCopyTheTransferOfLevel0) {
    const MeanTransfer mean = mean_with_levels(with_level(bending(120), Coarse::same), LevelMode::carry);
    const std::size_t half = mean.vectors.size() / 2;
    ASSERT_EQ(mean.vertices(), 2u * kRings * kSides);
    EXPECT_GT(mean.vectors[0], 0.1);
    for (std::size_t i = 0; i < half; ++i)
        EXPECT_NEAR(mean.vectors[half + i], mean.vectors[i], 1e-4) << i; // positions are floats
    EXPECT_LT(mean.levels.levels.at(0).squares.relative_l2(), 1e-4);
}

/// Returns a box whose corners have separate vertices at each side.
Scene box(float half) {
    test::SceneBuilder builder;
    for (int axis = 0; axis < 3; ++axis)
        for (const float side : {-half, half}) {
            std::array<glm::vec3, 4> corners;
            for (std::size_t i = 0; i < 4; ++i) {
                corners[i][axis] = side;
                corners[i][(axis + 1) % 3] = i == 1 || i == 2 ? side : -side;
                corners[i][(axis + 2) % 3] = i > 1 ? half : -half;
            }
            builder.quad(corners[0], corners[1], corners[2], corners[3]);
        }
    return builder.build();
}

/// Poses in which a level is inside geometry do not count, as for level 0: a small box moves into a large
/// one.
TEST(PoseBake, LevelsIgnorePosesInsideGeometry) {
    GlbFile file = test::scene_file(box(1));
    file.json["nodes"] = {
        {{"mesh", 0}, {"translation", {0, 9, 0}}, {"scale", {4, 4, 4}}}, {{"mesh", 0}}, {{"mesh", 0}}};
    file.json["scenes"] = {{{"nodes", {0, 1}}}};
    file.json["nodes"][1]["extensions"]["MSFT_lod"]["ids"] = {2};
    file.json["extensionsUsed"] = {"MSFT_lod"};
    const auto times = file.accessor(std::vector<float>{0}, test::kFloat, "SCALAR", 1);
    file.json["animations"] =
        Json::array({{{"samplers",
                       {{{"input", times},
                         {"output", file.accessor(std::vector<float>{0, 9, 0}, test::kFloat, "VEC3", 3)}}}},
                      {"channels", Json::array()}}});
    for (const int node : {1, 2})
        file.json["animations"][0]["channels"].push_back(
            {{"sampler", 0}, {"target", {{"node", node}, {"path", "translation"}}}});
    for (const LevelMode mode : {LevelMode::carry, LevelMode::own}) {
        const MeanTransfer mean = mean_with_levels(file, mode);
        const std::size_t half = mean.vectors.size() / 3;
        for (std::size_t i = 0; i < half; ++i)
            EXPECT_NEAR(mean.vectors[2 * half + i], mean.vectors[half + i], 1e-3) << to_string(mode) << i;
        double sum = 0;
        for (std::size_t v = half; v < 2 * half; v += mean.coefficients())
            sum += mean.vectors[v];
        EXPECT_GT(sum, 0);
    }
}

/// The high-poly model is the tube with a card beside its upper half, which moves with it: the tube has the
/// transfer that it has in that model.
TEST(PoseBake, HighPolyModelsMoveWithTheModel) {
    GlbFile plain = bending(90);
    plain.json["nodes"][1]["name"] = "lower";
    plain.json["nodes"][2]["name"] = "upper";
    GlbFile detailed = plain;
    Json card = detailed.json["meshes"][0]["primitives"][0];
    const std::vector<float> corners{0.2f, 1.2f, -1, 0.2f, 1.2f, 1, 0.2f, 2, 1, 0.2f, 2, -1};
    std::vector<float> normals, weights;
    std::vector<std::uint8_t> joints;
    for (int i = 0; i < 4; ++i) {
        normals.insert(normals.end(), {-1, 0, 0});
        joints.insert(joints.end(), {1, 0, 0, 0});
        weights.insert(weights.end(), {1, 0, 0, 0});
    }
    card["attributes"] = {{"POSITION", detailed.accessor(corners, test::kFloat, "VEC3", 3)},
                          {"NORMAL", detailed.accessor(normals, test::kFloat, "VEC3", 3)},
                          {"JOINTS_0", detailed.accessor(joints, test::kUnsignedByte, "VEC4", 4)},
                          {"WEIGHTS_0", detailed.accessor(weights, test::kFloat, "VEC4", 4)}};
    card["indices"] =
        detailed.accessor(std::vector<std::uint16_t>{0, 1, 2, 0, 2, 3}, test::kUnsignedShort, "SCALAR", 1);
    detailed.json["meshes"][0]["primitives"].push_back(card);
    const AnimatedScene truth_model = animated(detailed);
    const PoseBakeOptions options{.order = 3, .rays = 256, .bounces = 0};
    const MeanTransfer truth = mean_of_poses(truth_model, poses_of(truth_model, 2), options);

    // The same nodes in another order, without the animation.
    detailed.json["nodes"] = {{{"name", "upper"}, {"translation", {0, 1, 0}}},
                              {{"mesh", 0}, {"skin", 0}},
                              {{"name", "lower"}, {"children", {0}}}};
    detailed.json["skins"][0]["joints"] = {2, 0};
    detailed.json["scenes"] = {{{"nodes", {1, 2}}}};
    detailed.json.erase("animations");
    const AnimatedScene model = animated(plain), high_poly = animated(detailed);
    PoseBakeOptions with = options;
    with.high_poly = &high_poly;
    with.reach = 0.05;
    const MeanTransfer mean = mean_of_poses(model, poses_of(model, 2), with),
                       without = mean_of_poses(model, poses_of(model, 2), options);
    const auto difference = [&](const MeanTransfer& other) {
        double wrong = 0, all = 0;
        for (std::size_t i = 0; i < other.vectors.size(); ++i) {
            wrong += (other.vectors[i] - truth.vectors[i]) * (other.vectors[i] - truth.vectors[i]);
            all += truth.vectors[i] * truth.vectors[i];
        }
        return std::sqrt(wrong / all);
    };
    EXPECT_LT(difference(mean), 0.03); // rays that graze neighbouring triangles
    EXPECT_GT(difference(without), 0.2);
    detailed.json["nodes"][2]["name"] = "other";
    detailed.json["nodes"][0].erase("name");
    const AnimatedScene stranger = animated(detailed);
    with.high_poly = &stranger;
    EXPECT_THROW(mean_of_poses(model, poses_of(model, 2), with), Error);
}

TEST(PoseBake, NoVertexReflectsMoreThanItReceives) {
    const AnimatedScene model = animated(bending(150)); // white, and folded on itself
    const MeanTransfer mean =
        mean_of_poses(model, poses_of(model, 3), {.rays = 64, .bounces = kEndlessBounces});
    const LobeFitOptions options{.lobes = 2};
    const LobeTargets targets{4, mean.vectors, mean.areas};
    const LobeModel lobes = code_lobes(targets, fit_lobes(targets, options), options);
    for (std::size_t v = 0; v < lobes.vertices(); ++v)
        EXPECT_LE(lobes.decode(lobes.words[2 * v]).profile[0] +
                      lobes.decode(lobes.words[2 * v + 1]).profile[0],
                  1 + 1e-5f);
}

} // namespace
} // namespace poses_of_models
} // namespace prt
