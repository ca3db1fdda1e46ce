// Tests instances that share transfer through the program: baked, compressed, reported, evaluated and drawn;
// and rejected input.

#include "pipeline.h"
#include "prt/core/error.h"
#include "prt/core/light.h"
#include "prt/gltf/levels.h"
#include "prt/gltf/transfer_gltf.h"
#include "prt/load/model.h"
#include "runtime/core/support/file.h"
#include "support/glb_file.h"
#include "support/scene_builder.h"

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <numeric>
#include <set>

namespace prt::test {
namespace shared_transfer {

class SharedInstances : public Pipeline {
protected:
    void make(const char* scene) {
        ASSERT_EQ(run(PRT_EXAMPLE_SCENES, {folder.path().string(), scene, "sky"}).status, 0);
    }
    Outcome bake(const char* scene, const char* output, const char* mode,
                 const std::vector<std::string>& options = {}) {
        std::vector<std::string> arguments = {"bake", at(scene), "-o",     at(output),    "--order",
                                              "3",    "--fit",   "vertex", "--instances", mode};
        arguments.insert(arguments.end(), options.begin(), options.end());
        if (std::ranges::find(options, "--rays") == options.end())
            arguments.insert(arguments.end(), {"--rays", "32"});
        return prt(arguments);
    }
    /// Returns boxes without ground, with middles at `points`. Sides are a metre long.
    GlbFile boxes(const std::vector<float>& points) const {
        GlbFile file;
        std::vector<float> positions, normals;
        std::vector<unsigned> indices;
        for (int axis = 0; axis < 3; ++axis)
            for (const float side : {-0.5f, 0.5f}) {
                const auto first = static_cast<unsigned>(positions.size() / 3);
                for (int corner = 0; corner < 4; ++corner) {
                    float p[3];
                    p[axis] = side;
                    p[(axis + 1) % 3] = corner % 2 == 0 ? -0.5f : 0.5f;
                    p[(axis + 2) % 3] = corner / 2 == 0 ? -0.5f : 0.5f;
                    positions.insert(positions.end(), p, p + 3);
                    for (int i = 0; i < 3; ++i)
                        normals.push_back(i == axis ? 2 * side : 0);
                }
                const bool rotated = side < 0;
                for (const unsigned i : {0u, 1u, 3u, 0u, 3u, 2u})
                    indices.push_back(first + i);
                if (rotated)
                    std::reverse(indices.end() - 6, indices.end());
            }
        const std::size_t position = file.accessor(positions, kFloat, "VEC3", 3),
                          normal = file.accessor(normals, kFloat, "VEC3", 3),
                          index = file.accessor(indices, kUnsignedInt, "SCALAR", 1),
                          translation = file.accessor(points, kFloat, "VEC3", 3);
        file.json["accessors"][position]["min"] = {-0.5, -0.5, -0.5};
        file.json["accessors"][position]["max"] = {0.5, 0.5, 0.5};
        file.json["meshes"] = {
            {{"primitives",
              {{{"attributes", {{"POSITION", position}, {"NORMAL", normal}}}, {"indices", index}}}}}};
        file.json["nodes"] = {
            {{"mesh", 0},
             {"extensions",
              {{"EXT_mesh_gpu_instancing", {{"attributes", {{"TRANSLATION", translation}}}}}}}}};
        file.json["scenes"] = {{{"nodes", {0}}}};
        file.json["scene"] = 0;
        file.json["extensionsUsed"] = {"EXT_mesh_gpu_instancing"};
        return file;
    }
    /// Writes three boxes on a ground that is drawn once.
    void write_boxes_on_ground() const {
        GlbFile file = boxes({0, 0, 0, 1.7f, 0, 0.3f, 0.4f, 0, -1.8f});
        constexpr unsigned kSteps = 8;
        std::vector<float> positions, normals;
        std::vector<unsigned> indices;
        for (unsigned row = 0; row <= kSteps; ++row)
            for (unsigned column = 0; column <= kSteps; ++column) {
                positions.insert(positions.end(), {static_cast<float>(column) - 3.625f, -0.5f,
                                                   static_cast<float>(row) - 4.25f});
                normals.insert(normals.end(), {0, 1, 0});
                const unsigned at = row * (kSteps + 1) + column;
                if (row < kSteps && column < kSteps)
                    for (const unsigned i : {0u, kSteps + 1, 1u, 1u, kSteps + 1, kSteps + 2})
                        indices.push_back(at + i);
            }
        const std::size_t position = file.accessor(positions, kFloat, "VEC3", 3),
                          normal = file.accessor(normals, kFloat, "VEC3", 3),
                          index = file.accessor(indices, kUnsignedInt, "SCALAR", 1);
        file.json["accessors"][position]["min"] = {-3.625f, -0.5f, -4.25f};
        file.json["accessors"][position]["max"] = {4.375f, -0.5f, 3.75f};
        file.json["meshes"].push_back(
            {{"primitives",
              {{{"attributes", {{"POSITION", position}, {"NORMAL", normal}}}, {"indices", index}}}}});
        file.json["nodes"].push_back({{"mesh", 1}});
        file.json["scenes"] = {{{"nodes", {0, 1}}}};
        file.write(folder / "ground.glb");
    }
    /// Returns the relative L2 difference of two bakes over surfaces that are no instances of `shared`.
    double ground_error(const char* own, const char* shared) const {
        const SceneTransfer a = transfer_of(own), b = transfer_of(shared);
        std::set<std::size_t> instances;
        for (const FileInstance& instance : instances_of(shared))
            instances.insert(instance.arrays.begin(), instance.arrays.end());
        const std::vector<float> areas = receiver_areas(a.scene);
        double wrong = 0, all = 0;
        for (std::size_t array = 0; array < a.scene.vertex_arrays.size(); ++array) {
            const VertexArray& vertices = a.scene.vertex_arrays[array];
            for (std::size_t r = vertices.first_receiver; r < vertices.first_receiver + vertices.size(); ++r)
                for (std::size_t i = 0; !instances.contains(array) && i < a.transfer.dimension(); ++i) {
                    wrong +=
                        static_cast<double>(areas[r]) *
                        std::pow(static_cast<double>(a.transfer.vector(r)[i] - b.transfer.vector(r)[i]), 2);
                    all += static_cast<double>(areas[r]) *
                           std::pow(static_cast<double>(a.transfer.vector(r)[i]), 2);
                }
        }
        return std::sqrt(wrong / all);
    }
    struct SceneTransfer {
        Scene scene;
        Transfer transfer; ///< of all vertices
    };
    SceneTransfer transfer_of(const char* name) const {
        const GltfDocument document = load_gltf(folder / name);
        SceneTransfer result{extract_scene(document), {}};
        if (holds_instances(document)) {
            const GltfDocument separate = load_gltf(folder / name, {.instancing = Instancing::separate});
            const Scene stored = extract_scene(separate);
            result.transfer =
                expanded(document, result.scene, stored, read_transfer(separate, stored)->transfer);
        } else {
            result.transfer = read_transfer(document, result.scene)->transfer;
        }
        return result;
    }
    std::vector<FileInstance> instances_of(const char* name) const {
        const GltfDocument document = load_gltf(folder / name),
                           separate = load_gltf(folder / name, {.instancing = Instancing::separate});
        return read_instances(document, extract_scene(document), extract_scene(separate));
    }
};

TEST_F(SharedInstances, WorkInAllCommands) {
    make("forest:12");
    ASSERT_EQ(bake("forest.glb", "own.glb", "own", {"--bounces", "1"}).status, 0);
    ASSERT_EQ(bake("forest.glb", "shared.glb", "shared",
                   {"--bounces", "1", "--instances", "error=1", "--json", at("bake.json")})
                  .status,
              0);
    const nlohmann::json baked = read_json(folder / "bake.json");
    EXPECT_EQ(baked["instances"]["shared"], 12);
    EXPECT_EQ(baked["instances"]["baked_separately"], 0);
    EXPECT_LT(baked["receivers_stored"], baked["receivers"]);
    EXPECT_EQ(validator_errors(folder / "shared.glb"), 0);

    ASSERT_EQ(prt({"compress", at("shared.glb"), "-o", at("shipped.glb")}).status, 0);
    EXPECT_EQ(validator_errors(folder / "shipped.glb"), 0);
    for (const char* name : {"shared.glb", "shipped.glb"}) {
        ASSERT_EQ(
            prt({"evaluate", at("own.glb"), at(name), "--lights", at("sky.exr"), "--json", at("errors.json")})
                .status,
            0);
        const nlohmann::json errors = read_json(folder / "errors.json");
        EXPECT_LT(errors["lights"][0]["lit_rms"], 0.15) << name;
        EXPECT_EQ(errors["instances"][0]["count"], 12);
        EXPECT_GE(errors["instances"][0]["percentile_99"], errors["instances"][0]["median"]);
        const Outcome info = prt({"info", at(name), "--json", at("info.json")});
        EXPECT_EQ(info.status, 0);
        EXPECT_EQ(read_json(folder / "info.json")["instances"]["count"], 12);
    }
    EXPECT_LT(std::filesystem::file_size(folder / "shipped.glb"),
              std::filesystem::file_size(folder / "own.glb") / 3);
    EXPECT_EQ(prt({"render", at("shipped.glb"), "--lights", at("sky.exr"), "-o", at("a.png"), "--size",
                   "64x48", "--device", "cpu"})
                  .status,
              0);
}

TEST_F(SharedInstances, LargeErrorsCauseSeparateBakes) {
    make("forest:6");
    ASSERT_EQ(bake("forest.glb", "shared.glb", "shared", {"--instances", "error=0", "--bounces", "1"}).status,
              0);
    EXPECT_FALSE(holds_instances(load_gltf(folder / "shared.glb")));
    ASSERT_EQ(bake("forest.glb", "all.glb", "shared",
                   {"--instances", "error=1", "--bounces", "1", "--json", at("all.json")})
                  .status,
              0);
    std::vector<double> errors = read_json(folder / "all.json")["instances"]["errors_relative_l2"];
    std::ranges::sort(errors);
    ASSERT_EQ(bake("forest.glb", "some.glb", "shared",
                   {"--instances", std::string("error=") + std::to_string(0.5 * (errors[4] + errors[5])),
                    "--bounces", "1", "--json", at("some.json")})
                  .status,
              0);
    const nlohmann::json some = read_json(folder / "some.json");
    EXPECT_GE(some["instances"]["baked_separately"], 1);
    EXPECT_EQ(validator_errors(folder / "some.glb"), 0);
    ASSERT_EQ(bake("forest.glb", "own.glb", "own", {"--bounces", "1"}).status, 0);
    ASSERT_EQ(prt({"evaluate", at("own.glb"), at("some.glb"), "--json", at("errors.json")}).status, 0);
    EXPECT_LT(read_json(folder / "errors.json")["relative_l2"], 0.5);
}

TEST_F(SharedInstances, UnoccludedInstancesHaveFactorOne) {
    boxes({0, 0, 0, 0, 1000, 0}).write(folder / "boxes.glb"); // with few rays none of them hits the other box
    ASSERT_EQ(bake("boxes.glb", "shared.glb", "shared", {"--bounces", "2", "--json", at("bake.json")}).status,
              0);
    EXPECT_EQ(read_json(folder / "bake.json")["instances"]["unoccluded"], 2);
    const std::vector<FileInstance> instances = instances_of("shared.glb");
    ASSERT_EQ(instances.size(), 2u);
    for (const FileInstance& instance : instances)
        EXPECT_EQ(instance.placed.factors, open_factors());
}

TEST_F(SharedInstances, NeighborsShadowEachOther) {
    boxes({0, 0, 0, 0, 1.2f, 0}).write(folder / "boxes.glb");
    ASSERT_EQ(bake("boxes.glb", "shared.glb", "shared", {"--instances", "error=9", "--rays", "256"}).status,
              0);
    const std::vector<FileInstance> instances = instances_of("shared.glb");
    ASSERT_EQ(instances.size(), 2u);
    const auto above = [](const FileInstance& instance) {
        // The mean over the upper half, in the middle: √4π Y_1-1 contributes -√3 / 2, band 2 nothing.
        const auto& passing = instance.placed.factors.passing;
        return passing[0].w - 0.5f * std::sqrt(3.0f) * passing[1].w;
    };
    // From its middle the box below sees the other over a fifth of its upper half.
    EXPECT_NEAR(above(instances[0]), 0.8f, 0.1f);
    EXPECT_NEAR(above(instances[1]), 1.0f, 0.05f);
}

/// The furnace: white boxes that light each other without end.
TEST_F(SharedInstances, WhiteNeighborsConserveEnergy) {
    boxes({0, 0, 0, 0, 1.5f, 0, 1.3f, 0, 0.2f}).write(folder / "boxes.glb");
    ASSERT_EQ(bake("boxes.glb", "shared.glb", "shared",
                   {"--instances", "error=9", "--rays", "512", "--bounces", "inf"})
                  .status,
              0);
    const GltfDocument document = load_gltf(folder / "shared.glb"),
                       separate = load_gltf(folder / "shared.glb", {.instancing = Instancing::separate});
    const Scene scene = extract_scene(document), stored = extract_scene(separate);
    EXPECT_EQ(stored.receivers(), 24u);
    const Transfer transfer = expanded(document, scene, stored, read_transfer(separate, stored)->transfer);
    double sum = 0;
    for (const glm::vec3& radiance : exit_radiance(transfer, constant_light(3, glm::vec3(1)))) {
        EXPECT_LT(radiance.x, 1.001f); // rounding of a mesh's transfer to float16
        sum += static_cast<double>(radiance.x);
    }
    // Least squares results in more than 1 at some vertices, up to 1.08 here; the limit of 1 for the
    // brightest reduces others, and infinite bounces in white boxes apply it repeatedly.
    EXPECT_GT(sum / static_cast<double>(scene.receivers()), 0.92);
}

/// Reported errors are those of factors, not of rays; samples have 16 and 128 rays.
/// Spheres under a lamp: I cos / (pi d^2) on the lit half. Five bands of the clamped cosine leave 4.4 %
/// (math.md, section 22); the rest is left for bytes, and for the change of the light over a sphere.
TEST_F(SharedInstances, LampsLightSpheresAsInClosedForm) {
    GlbFile file = scene_file(SceneBuilder().sphere(glm::vec3(0), 1, 12).build());
    const std::vector<float> points = {-4, 0, 0, 0, 0, 0, 4, 1, 2};
    file.json["nodes"] = {
        {{"mesh", 0},
         {"extensions",
          {{"EXT_mesh_gpu_instancing",
            {{"attributes", {{"TRANSLATION", file.accessor(points, kFloat, "VEC3", 3)}}}}}}}},
        {{"translation", {0, 30, 0}}, {"extensions", {{"KHR_lights_punctual", {{"light", 0}}}}}}};
    file.json["scenes"] = {{{"nodes", {0, 1}}}};
    file.json["extensionsUsed"] = {"EXT_mesh_gpu_instancing", "KHR_lights_punctual"};
    file.json["extensions"]["KHR_lights_punctual"]["lights"] = {
        {{"type", "point"}, {"intensity", 1000}, {"color", {1, 0.5, 0}}}};
    file.write(folder / "spheres.glb");
    const Outcome baked = prt({"bake", at("spheres.glb"), "-o", at("shared.glb"), "--order", "5", "--rays",
                               "256", "--instances", "shared", "--json", at("bake.json")});
    ASSERT_EQ(baked.status, 0) << baked.err;
    EXPECT_EQ(read_json(folder / "bake.json")["instances"]["shared"], 3);
    const GltfDocument document = load_gltf(folder / "shared.glb");
    const Scene scene = extract_scene(document);
    const InstancedModel model = read_instanced(document, scene, folder / "shared.glb");
    const Transfer all = expanded(document, scene, model.stored, model.baked->transfer);
    ASSERT_EQ(all.layout.lamps(), 1u);
    const std::vector<float> areas = receiver_areas(scene);
    double wrong = 0, light = 0;
    for (const VertexArray& vertices : scene.vertex_arrays)
        for (std::size_t v = 0; v < vertices.size(); ++v) {
            const glm::dvec3 way = glm::dvec3(0, 30, 0) - scene.world(vertices.positions[v]);
            const double cosine = glm::dot(glm::dvec3(vertices.normals[v]), glm::normalize(way)),
                         exact = 1000 * std::max(cosine, 0.0) / (M_PI * glm::dot(way, way));
            const std::span<const float> lamp = all.vector(vertices.first_receiver + v).last(3);
            const auto area = static_cast<double>(areas[vertices.first_receiver + v]);
            wrong += area * std::pow(static_cast<double>(lamp[0]) - exact, 2);
            light += area * exact * exact;
            EXPECT_NEAR(lamp[1], 0.5f * lamp[0], 0.02f);
            EXPECT_NEAR(lamp[2], 0, 0.02f);
        }
    EXPECT_LT(std::sqrt(wrong / light), 0.055);
    EXPECT_GT(std::sqrt(wrong / light), 0.03); // fewer bands, or another model, would give another error
    for (const char* image : {"a.png", "b.png"})
        EXPECT_EQ(prt({"render", at("shared.glb"), "-o", at(image), "--size", "32x24", "--exposure", "0",
                       "--lamp-strengths", image[0] == 'a' ? "on" : "off"})
                      .status,
                  0);
    EXPECT_NE(read_file(folder / "a.png"), read_file(folder / "b.png"));
}

TEST_F(SharedInstances, ErrorsDoNotDependOnTheNumberOfRays) {
    make("forest:24");
    double median[2];
    for (const int i : {0, 1}) {
        ASSERT_EQ(
            bake("forest.glb", "shared.glb", "shared",
                 {"--rays", i == 0 ? "256" : "2048", "--instances", "error=9", "--json", at("bake.json")})
                .status,
            0);
        median[i] = read_json(folder / "bake.json")["instances"]["error_relative_l2"]["median"];
    }
    EXPECT_GT(median[1], 0.01);
    EXPECT_NEAR(median[0] / median[1], 1, 0.2);
}

TEST_F(SharedInstances, KeepTheirLimitUnderGivenSkies) {
    make("forest:12");
    const auto errors = [&](const std::vector<std::string>& more) {
        std::vector<std::string> all = {"--json", at("bake.json")};
        all.insert(all.end(), more.begin(), more.end());
        EXPECT_EQ(bake("forest.glb", "shared.glb", "shared", all).status, 0);
        return read_json(folder / "bake.json")["instances"];
    };
    const std::vector<double> soft = errors({"--instances", "error=9"})["errors_relative_l2"],
                              lit = errors({"--instances", "error=9", "--lights",
                                            at("sky.exr")})["errors_relative_l2"];
    ASSERT_EQ(lit.size(), soft.size());
    std::size_t more = 0;
    for (std::size_t i = 0; i < lit.size(); ++i) {
        EXPECT_GE(lit[i], soft[i]);
        more += lit[i] > 1.05 * soft[i] ? 1 : 0;
    }
    EXPECT_GE(more, 3u); // the sun casts shadows that factors cannot represent
    std::vector<double> sorted = lit;
    std::ranges::sort(sorted);
    const nlohmann::json kept =
        errors({"--instances", std::string("error=") + std::to_string(sorted[8]), "--lights", at("sky.exr")});
    EXPECT_GE(kept["baked_separately"], 3);
    EXPECT_LE(kept["error_relative_l2"]["max"], sorted[8] + 1e-6);
    EXPECT_NE(bake("forest.glb", "shared.glb", "shared", {"--suns", "auto"}).status, 0);
}

/// A mesh of instances that plain nodes also draw, as siblings and as children.
TEST_F(SharedInstances, SupportPlainNodesAndInstances) {
    for (const bool below : {false, true}) {
        GlbFile file = boxes({0, 0, 0, 3, 0, 0});
        file.json["nodes"].push_back({{"mesh", 0}, {"translation", {6, 0, 0}}});
        file.json["nodes"].push_back({{"mesh", 0}, {"translation", {9, 0, 0}}});
        if (below)
            file.json["nodes"][0]["children"] = {1, 2};
        else
            file.json["scenes"] = {{{"nodes", {1, 0, 2}}}};
        file.write(folder / "boxes.glb");
        ASSERT_EQ(bake("boxes.glb", "own.glb", "own", {"--rays", "256"}).status, 0);
        ASSERT_EQ(
            bake("boxes.glb", "shared.glb", "shared", {"--instances", "error=9", "--rays", "256"}).status, 0);
        EXPECT_EQ(validator_errors(folder / "shared.glb"), 0);
        const std::vector<FileInstance> instances = instances_of("shared.glb");
        ASSERT_EQ(instances.size(), 4u);
        ASSERT_EQ(prt({"evaluate", at("own.glb"), at("shared.glb"), "--json", at("errors.json")}).status, 0);
        EXPECT_LT(read_json(folder / "errors.json")["relative_l2"], 0.1) << below;
    }
}

/// Instances that are baked separately may be at another position in the file, and are still compared.
TEST_F(SharedInstances, MixedWithSeparateInstancesAreCompared) {
    boxes({0, 0, 0, 0, 1.2f, 0, 40, 0, 0, 80, 0, 0}).write(folder / "boxes.glb");
    ASSERT_EQ(bake("boxes.glb", "own.glb", "own", {"--rays", "256"}).status, 0);
    ASSERT_EQ(bake("boxes.glb", "shared.glb", "shared",
                   {"--rays", "256", "--instances", "error=0.01", "--json", at("bake.json")})
                  .status,
              0);
    const nlohmann::json told = read_json(folder / "bake.json")["instances"];
    ASSERT_GE(told["baked_separately"], 1);
    ASSERT_GE(told["shared"], 2);
    const Outcome outcome = prt({"evaluate", at("own.glb"), at("shared.glb"), "--json", at("errors.json")});
    ASSERT_EQ(outcome.status, 0) << outcome.err;
    EXPECT_LT(read_json(folder / "errors.json")["relative_l2"], 0.05);
}

/// Probes see the flat scene, so that they do not depend on how surfaces store their transfer.
TEST_F(SharedInstances, HaveTheVolumeOfSeparateInstances) {
    boxes({0, 0, 0, 0, 1.2f, 0, 900, 5, 3}).write(folder / "boxes.glb");
    const std::vector<std::string> options = {"--volume", "probes=300,bounds=-2,-2,-2,2,4,2", "--bounces",
                                              "1"};
    ASSERT_EQ(bake("boxes.glb", "own.glb", "own", options).status, 0);
    std::vector<std::string> shared = options;
    shared.insert(shared.end(), {"--instances", "error=9", "--json", at("bake.json")});
    ASSERT_EQ(bake("boxes.glb", "shared.glb", "shared", shared).status, 0);
    EXPECT_EQ(read_json(folder / "bake.json")["instances"]["shared"], 3);
    EXPECT_GT(read_json(folder / "bake.json")["volume"]["probes"], 0);
    EXPECT_EQ(validator_errors(folder / "shared.glb"), 0);
    const auto volume_of = [&](const char* name) {
        const GltfDocument document = load_gltf(folder / name);
        const Scene scene = extract_scene(document);
        std::optional<BakedVolume> volume = read_volume(document, scene);
        if (volume) // the grid in the world: the scene of instances may have another origin
            volume->grid.origin = glm::vec3(scene.world(volume->grid.origin));
        return volume;
    };
    const std::optional<BakedVolume> own = volume_of("own.glb"), with = volume_of("shared.glb");
    ASSERT_TRUE(own && with);
    EXPECT_EQ(with->grid.origin, own->grid.origin);
    EXPECT_EQ(with->baked.transfer.vectors, own->baked.transfer.vectors);

    for (const char* name : {"own.glb", "shared.glb"})
        ASSERT_EQ(prt({"compress", at(name), "-o", at((std::string("shipped_") + name).c_str())}).status, 0);
    EXPECT_EQ(validator_errors(folder / "shipped_shared.glb"), 0);
    const Model reference = load_model(folder / "shipped_own.glb"),
                shipped = load_model(folder / "shipped_shared.glb");
    ASSERT_TRUE(reference.volume && shipped.volume);
    EXPECT_EQ(shipped.instances.size(), 3u);
    const glm::dvec3 origin = shipped.scene.world(shipped.volume->grid.origin),
                     wanted = reference.scene.world(reference.volume->grid.origin);
    EXPECT_LT(glm::distance(origin, wanted), 1e-4); // rounding of floats at 900 m
    EXPECT_EQ(shipped.volume->visibility.size(), reference.volume->visibility.size());
}

/// Options of an ordinary bake apply to meshes and to surfaces that are drawn once.
TEST_F(SharedInstances, ReachTheTargetError) {
    write_boxes_on_ground();
    ASSERT_EQ(bake("ground.glb", "own.glb", "own", {"--rays", "16384"}).status, 0);
    double rays[2], errors[2];
    for (const int i : {0, 1}) {
        const double target = i == 0 ? 0.1 : 0.01;
        ASSERT_EQ(prt({"bake", at("ground.glb"), "-o", at("shared.glb"), "--order", "3", "--instances",
                       "shared,error=9", "--target-error", std::to_string(target), "--json", at("bake.json")})
                      .status,
                  0);
        const nlohmann::json record = read_json(folder / "bake.json")["bake"];
        EXPECT_LE(record["sampling_error_relative_l2"], target);
        rays[i] = read_json(folder / "bake.json")["rays"];
        errors[i] = ground_error("own.glb", "shared.glb");
        EXPECT_LT(errors[i], 1.5 * target); // estimated from few receivers, and from 16384 rays
    }
    EXPECT_GT(rays[1], 2 * rays[0]);
    EXPECT_GT(errors[0], 2 * errors[1]);
}

TEST_F(SharedInstances, AreRasterized) {
    write_boxes_on_ground();
    const std::vector<std::string> raster = {"--rays",   "128", "--method", "raster,resolution=128",
                                             "--device", "gpu"};
    const std::vector<std::string> rays = {"--rays", "128"};
    double errors[2];
    for (const int i : {0, 1}) {
        std::vector<std::string> options = i == 0 ? raster : rays;
        ASSERT_EQ(bake("ground.glb", "own.glb", "own", options).status, 0);
        options.insert(options.end(), {"--instances", "error=9", "--json", at("bake.json")});
        ASSERT_EQ(bake("ground.glb", "shared.glb", "shared", options).status, 0);
        EXPECT_EQ(read_json(folder / "bake.json")["bake"]["method"], i == 0 ? "raster" : "trace");
        EXPECT_EQ(read_json(folder / "bake.json")["instances"]["shared"], 3);
        if (i == 0) {
            EXPECT_LT(ground_error("own.glb", "shared.glb"), 1e-3); // the same maps, stored in 16 bits
        }
        ASSERT_EQ(prt({"evaluate", at("own.glb"), at("shared.glb"), "--json", at("errors.json")}).status, 0);
        errors[i] = read_json(folder / "errors.json")["relative_l2"];
    }
    EXPECT_LT(errors[0], 1.3 * errors[1]); // depth maps are coarser than rays
}

/// The written transfer is fitted: without neighbours it is that of a fitted bake of each instance, and the
/// ground has the light of a fitted bake of the scene.
TEST_F(SharedInstances, AreFittedToSurfaces) {
    const auto run_bake = [&](const char* scene, std::vector<std::string> options) {
        options.insert(options.begin(), {"bake", at(scene), "--order", "3", "--rays", "1024"});
        return prt(options).status;
    };
    write_boxes_on_ground();
    for (const char* bounces : {"0", "1", "inf"}) {
        for (const char* fit : {"vertex", "surface"}) {
            const std::string own = std::string("own_") + fit + ".glb",
                              shared = std::string("shared_") + fit + ".glb";
            const std::vector<std::string> options = {"--denoise", "off", "--fit", fit, "--bounces", bounces};
            std::vector<std::string> of_own = options, of_shared = options;
            of_own.insert(of_own.end(), {"-o", at(own.c_str())});
            of_shared.insert(of_shared.end(), {"-o", at(shared.c_str()), "--instances", "shared,error=9"});
            ASSERT_EQ(run_bake("ground.glb", of_own), 0);
            ASSERT_EQ(run_bake("ground.glb", of_shared), 0);
        }
        const double at_vertices = ground_error("own_vertex.glb", "shared_vertex.glb"),
                     fitted = ground_error("own_surface.glb", "shared_surface.glb"),
                     confused = ground_error("own_surface.glb", "shared_vertex.glb");
        // Light of instances after bounces has the error of factors in both.
        EXPECT_LT(fitted, at_vertices + 0.02) << bounces;
        EXPECT_GT(confused, 1.5 * fitted) << bounces;
    }
    boxes({0, 0, 0, 0, 1000, 0}).write(folder / "boxes.glb");
    ASSERT_EQ(run_bake("boxes.glb", {"-o", at("own.glb"), "--fit", "surface"}), 0);
    ASSERT_EQ(
        run_bake("boxes.glb", {"-o", at("shared.glb"), "--fit", "surface", "--instances", "shared,error=9"}),
        0);
    ASSERT_EQ(prt({"evaluate", at("own.glb"), at("shared.glb"), "--json", at("errors.json")}).status, 0);
    EXPECT_LT(read_json(folder / "errors.json")["relative_l2"], 0.01);
}

/// A light box of marble: without neighbours, instances have the light of their own bake. Lengths of the
/// medium are metres, so that a box of another scale has another transfer.
TEST_F(SharedInstances, ScatterLightInMedia) {
    GlbFile file = boxes({0, 0, 0});
    file.json["nodes"] = nlohmann::ordered_json::array();
    for (const int scale : {2, 2, 2, 1}) {
        const auto nodes = static_cast<int>(file.json["nodes"].size());
        file.json["nodes"].push_back(
            {{"mesh", 0}, {"translation", {1000 * nodes, 0, 0}}, {"scale", {scale, scale, scale}}});
    }
    file.json["scenes"] = {{{"nodes", {0, 1, 2, 3}}}};
    file.json.erase("extensionsUsed");
    file.write(folder / "boxes.glb");
    const auto error_of = [&](const std::vector<std::string>& medium, const std::string& bounces) {
        std::vector<std::string> options = medium;
        options.insert(options.end(), {"--rays", "256", "--bounces", bounces, "--json", at("bake.json")});
        EXPECT_EQ(bake("boxes.glb", "shared.glb", "shared", options).status, 0);
        EXPECT_EQ(prt({"evaluate", at("own.glb"), at("shared.glb"), "--json", at("errors.json")}).status, 0);
        return read_json(folder / "errors.json")["relative_l2"].get<double>();
    };
    // A box of 10 mm: light leaves marble a few millimetres from where it entered.
    const std::vector<std::string> marble = {"--subsurface", "marble", "--metres-per-unit", "0.005"};
    for (const char* bounces : {"0", "1", "inf"}) {
        std::vector<std::string> options = marble;
        options.insert(options.end(), {"--rays", "256", "--bounces", bounces});
        ASSERT_EQ(bake("boxes.glb", "own.glb", "own", options).status, 0);
        EXPECT_LT(error_of(marble, bounces), 1e-4) << bounces; // the same rays
        EXPECT_EQ(read_json(folder / "bake.json")["instances"]["shared"], 3);
        EXPECT_GT(error_of({"--subsurface", "marble", "--metres-per-unit", "0.0025"}, bounces), 0.04);
    }
    const auto media_of = [&](const char* name) {
        return set_of(read_glb(folder / name).json, "vertices").at("bake").at("media");
    };
    EXPECT_EQ(media_of("own.glb").size(), 1u);
    EXPECT_EQ(media_of("shared.glb"), media_of("own.glb")); // so that renderers add no suns to them
}

/// Neighbours shadow and light a medium as they do other surfaces.
TEST_F(SharedInstances, ShadowNeighborsOfMarble) {
    boxes({0, 0, 0, 0, 2, 0, 1.8f, 0, 0.3f}).write(folder / "boxes.glb");
    const auto all = [](std::vector<std::string> options) {
        options.insert(options.end(), {"--rays", "256", "--bounces", "2"});
        return options;
    };
    const auto error_of = [&](std::vector<std::string> options) {
        options.insert(options.end(), {"--instances", "error=9"});
        EXPECT_EQ(bake("boxes.glb", "shared.glb", "shared", all(options)).status, 0);
        EXPECT_EQ(prt({"evaluate", at("own.glb"), at("shared.glb"), "--json", at("errors.json")}).status, 0);
        return read_json(folder / "errors.json")["relative_l2"].get<double>();
    };
    const std::vector<std::string> marble = {"--subsurface", "marble", "--metres-per-unit", "0.02"};
    ASSERT_EQ(bake("boxes.glb", "own.glb", "own", all({})).status, 0);
    const double opaque = error_of({});
    ASSERT_EQ(bake("boxes.glb", "own.glb", "own", all(marble)).status, 0);
    const double scattering = error_of(marble), confused = error_of({});
    EXPECT_LT(opaque, 0.15);
    EXPECT_LT(scattering, 1.1 * opaque);
    EXPECT_GT(confused, 1.5 * scattering);
}

/// Nodes with levels are drawn once. Instances around them share transfer.
TEST_F(SharedInstances, ExistNextToCoarserLevels) {
    write_boxes_on_ground();
    GlbFile file = read_glb(folder / "ground.glb");
    for (int copy = 0; copy < 2; ++copy)
        file.json["meshes"].push_back(file.json["meshes"][0]);
    file.json["nodes"].push_back({{"mesh", 2}, {"translation", {-1.6, 0, 0}}}); // node 2: a statue
    file.json["nodes"].push_back({{"mesh", 3}, {"translation", {-1.6, 0, 0}}});
    file.json["nodes"].push_back({{"mesh", 0}, {"translation", {0, 0, 2.2}}}); // node 4: of the shared mesh
    file.json["nodes"].push_back({{"mesh", 3}, {"translation", {0, 0, 2.2}}});
    for (const int node : {2, 4})
        file.json["nodes"][static_cast<std::size_t>(node)]["extensions"]["MSFT_lod"]["ids"] = {node + 1};
    file.json["extensionsUsed"].push_back("MSFT_lod");
    file.json["scenes"] = {{{"nodes", {0, 1, 2, 4}}}};
    file.write(folder / "levels.glb");
    const auto coarser_levels = [&](const char* name) {
        const GltfDocument document = load_gltf(folder / name, {.instancing = Instancing::separate});
        const LeveledScene levels = extract_levels(document);
        EXPECT_EQ(levels.nodes.size(), 2u);
        const Transfer all = read_transfer(document, levels.scene)->transfer;
        const std::size_t first = levels.finest_receivers * all.dimension();
        return std::vector<float>(all.vectors.begin() + static_cast<std::ptrdiff_t>(first),
                                  all.vectors.end());
    };
    for (const char* mode : {"carry", "own"}) {
        const std::vector<std::string> options = {"--levels", mode,     "--denoise",
                                                  "off",      "--json", at("bake.json")};
        ASSERT_EQ(bake("levels.glb", "own.glb", "own", options).status, 0);
        std::vector<std::string> shared = options;
        shared.insert(shared.end(), {"--instances", "error=9"});
        ASSERT_EQ(bake("levels.glb", "shared.glb", "shared", shared).status, 0);
        EXPECT_EQ(read_json(folder / "bake.json")["instances"]["shared"], 3);
        EXPECT_EQ(read_json(folder / "bake.json")["levels"]["nodes"], 2);
        EXPECT_EQ(validator_errors(folder / "shared.glb"), 0);
        const std::vector<float> wanted = coarser_levels("own.glb"), found = coarser_levels("shared.glb");
        ASSERT_EQ(found.size(), wanted.size());
        ASSERT_EQ(found.size(), 2 * 24 * 9u);
        double wrong = 0, norm = 0;
        for (std::size_t i = 0; i < found.size(); ++i) {
            wrong += std::pow(static_cast<double>(found[i] - wanted[i]), 2);
            norm += std::pow(static_cast<double>(wanted[i]), 2);
        }
        EXPECT_LT(std::sqrt(wrong / norm), 2e-3) << mode; // the same rays, stored in 16 bits
    }
    ASSERT_EQ(prt({"compress", at("shared.glb"), "-o", at("shipped.glb")}).status, 0);
    EXPECT_EQ(validator_errors(folder / "shipped.glb"), 0);
    ASSERT_EQ(prt({"evaluate", at("shared.glb"), at("shipped.glb"), "--json", at("errors.json")}).status, 0);
    EXPECT_LT(read_json(folder / "errors.json")["levels"][0]["shipped_relative_l2"], 0.1);
    EXPECT_EQ(read_json(folder / "errors.json")["instances"][0]["count"], 3);
    EXPECT_EQ(load_model(folder / "shipped.glb").instances.size(), 3u);
}

TEST_F(SharedInstances, SurfacesDrawnOnceAreRefined) {
    write_boxes_on_ground();
    const auto refined_bake = [&](const char* input, const char* output, std::vector<std::string> options) {
        options.insert(options.begin(), {"bake", at(input), "-o", at(output), "--order", "3", "--rays", "64",
                                         "--fit", "surface", "--json", at("bake.json")});
        return prt(options).status;
    };
    ASSERT_EQ(refined_bake("ground.glb", "shared.glb",
                           {"--instances", "shared,error=9", "--refine", "0.05,vertices=2000"}),
              0);
    const nlohmann::json report = read_json(folder / "bake.json");
    EXPECT_EQ(report["instances"]["shared"], 3);
    EXPECT_LE(report["refine_error_relative_l2"], 0.05);
    EXPECT_GT(report["refine_error_before_relative_l2"], 0.05);
    EXPECT_EQ(validator_errors(folder / "shared.glb"), 0);
    // The ground has more vertices, the boxes have not.
    const Scene stored =
        extract_scene(load_gltf(folder / "shared.glb", {.instancing = Instancing::separate}));
    ASSERT_EQ(stored.vertex_arrays.size(), 2u);
    EXPECT_EQ(std::ranges::min(stored.vertex_arrays[0].size(), stored.vertex_arrays[1].size()), 24u);
    EXPECT_GT(stored.receivers(), 24 + 81u);
    // The same mesh with separate instances has the same light on the ground, up to the noise of both: 0.04.
    ASSERT_EQ(refined_bake("shared.glb", "own.glb", {"--instances", "own"}), 0);
    EXPECT_LT(ground_error("own.glb", "shared.glb"), 0.08);
}

TEST_F(SharedInstances, UnsupportedMatricesGetSeparateTransfer) {
    GlbFile file = boxes({0, 0, 0});
    file.json["nodes"] = nlohmann::ordered_json::array();
    for (const auto& node : std::vector<nlohmann::ordered_json>{
             {{"translation", {0, 0, 0}}, {"rotation", {0, 0.6, 0, 0.8}}, {"scale", {2, 2, 2}}},
             {{"translation", {5, 0, 0}}},
             {{"translation", {10, 0, 0}}, {"scale", {-1, 1, 1}}},
             {{"translation", {15, 0, 0}}, {"scale", {1, 2, 1}}},
             {{"translation", {20, 0, 0}}, {"scale", {1, 0, 1}}}}) {
        file.json["nodes"].push_back(node);
        file.json["nodes"].back()["mesh"] = 0;
    }
    file.json["scenes"] = {{{"nodes", {0, 1, 2, 3, 4}}}};
    file.json.erase("extensionsUsed");
    file.write(folder / "boxes.glb");
    ASSERT_EQ(bake("boxes.glb", "shared.glb", "shared", {"--json", at("bake.json"), "--instances", "error=9"})
                  .status,
              0);
    const nlohmann::json told = read_json(folder / "bake.json")["instances"];
    EXPECT_EQ(told["shared"], 2);
    EXPECT_EQ(told["mirrored"], 1);
    EXPECT_EQ(told["nonuniform_scale"], 2);
    EXPECT_EQ(validator_errors(folder / "shared.glb"), 0);
    EXPECT_EQ(prt({"info", at("shared.glb")}).status, 0);
}

TEST_F(SharedInstances, UnsupportedMeshesAreRejected) {
    GlbFile alone = boxes({0, 0, 0});
    alone.write(folder / "boxes.glb");
    const Outcome one = bake("boxes.glb", "shared.glb", "shared");
    EXPECT_EQ(one.status, 1);
    EXPECT_NE(one.err.find("no transfer can be shared"), std::string::npos) << one.err;
    EXPECT_EQ(bake("boxes.glb", "auto.glb", "auto").status, 0);
    boxes({0, 0, 0, 3, 0, 0}).write(folder / "two.glb");
    EXPECT_EQ(bake("two.glb", "shared.glb", "shared", {"--high-poly", at("two.glb")}).status, 1);
    EXPECT_EQ(prt({"bake", at("two.glb"), "-o", at("shared.glb"), "--instances", "shared", "--texels", "4/m"})
                  .status,
              1);
    EXPECT_FALSE(std::filesystem::exists(folder / "shared.glb"));
    ASSERT_EQ(bake("two.glb", "shared.glb", "shared", {"--bounces", "1"}).status, 0);
    const Outcome fallback =
        prt({"compress", at("shared.glb"), "-o", at("shipped.glb"), "--fallback", at("sky.exr")});
    EXPECT_EQ(fallback.status, 1);
}

TEST_F(SharedInstances, WrongAttributesAreRejectedByName) {
    const auto refused = [&](const char* attribute, auto&& accessor_in, const char* why) {
        GlbFile file = boxes({0, 0, 0, 3, 0, 0});
        const std::size_t accessor = accessor_in(file);
        file.json["nodes"][0]["extensions"]["EXT_mesh_gpu_instancing"]["attributes"][attribute] = accessor;
        file.write(folder / "wrong.glb");
        const Outcome outcome = bake("wrong.glb", "shared.glb", "shared");
        EXPECT_EQ(outcome.status, 1);
        EXPECT_NE(outcome.err.find(why), std::string::npos) << outcome.err;
        EXPECT_FALSE(std::filesystem::exists(folder / "shared.glb"));
    };
    const auto floats = [](const std::vector<float>& values, const char* type, std::size_t components) {
        return [=](GlbFile& file) { return file.accessor(values, kFloat, type, components); };
    };
    refused("ROTATION", floats({0, 0, 0, 1, 0, 0, 0, 0}, "VEC4", 4),
            "ROTATION of instance 1 is not a rotation");
    refused("TRANSLATION", floats({0, 0, 0, 1, std::nanf(""), 0}, "VEC3", 3),
            "TRANSLATION of instance 1 is not finite");
    refused(
        "SCALE",
        [](GlbFile& file) {
            return file.accessor(std::vector<std::uint16_t>{1, 1, 1, 1, 1, 1}, kUnsignedShort, "VEC3", 3);
        },
        "SCALE of its instances must contain floats");
}

TEST_F(SharedInstances, ZeroAndMillionsOfInstancesAreReportedFirst) {
    GlbFile none = boxes({0, 0, 0});
    none.json["accessors"][3]["count"] = 0;
    none.write(folder / "none.glb");
    EXPECT_EQ(bake("none.glb", "shared.glb", "shared").status, 1);
    GlbFile many = boxes({0, 0, 0});
    many.json["accessors"][3]["count"] = 1'000'000;
    many.json["accessors"][3].erase("bufferView"); // zeros
    many.write(folder / "many.glb");
    const Outcome outcome = bake("many.glb", "shared.glb", "shared");
    EXPECT_EQ(outcome.status, 1);
    EXPECT_NE(outcome.err.find(" MB"), std::string::npos) << outcome.err;
}

TEST_F(SharedInstances, DamagedFactorsAreRejected) {
    boxes({0, 0, 0, 0, 1.2f, 0}).write(folder / "boxes.glb");
    ASSERT_EQ(bake("boxes.glb", "shared.glb", "shared", {"--instances", "error=9"}).status, 0);
    const auto damaged = [&](auto&& change) {
        GlbFile file = read_glb(folder / "shared.glb");
        change(file.json);
        file.write(folder / "damaged.glb");
        const Outcome outcome = prt({"info", at("damaged.glb")});
        EXPECT_NE(outcome.err.find("damaged.glb: "), std::string::npos) << outcome.err;
        // Compression does not copy the damage to its output.
        EXPECT_EQ(prt({"compress", at("damaged.glb"), "-o", at("passed_on.glb")}).status, 1);
        EXPECT_FALSE(std::filesystem::exists(folder / "passed_on.glb"));
        return outcome.status;
    };
    const char* const name = "PRTKIT_instances";
    EXPECT_EQ(damaged([&](auto& json) { json["extensions"][name]["version"] = 1; }), 1);
    EXPECT_EQ(damaged([&](auto& json) { json["extensions"][name]["factors"]["scales"].erase(3); }), 1);
    EXPECT_EQ(damaged([&](auto& json) { json["extensions"][name]["factors"]["scales"][3] = -1; }), 1);
    EXPECT_EQ(damaged([&](auto& json) { json["extensions"][name]["factors"]["scales"][3] = "1"; }), 1);
    EXPECT_EQ(
        damaged([&](auto& json) { json["extensions"][name]["boxes"] = nlohmann::ordered_json::array(); }), 1);
    EXPECT_EQ(damaged([&](auto& json) { json["extensions"][name]["count"] = 3; }), 1);
    EXPECT_EQ(damaged([&](auto& json) { json["extensions"][name]["count"] = 0; }), 1);
    EXPECT_EQ(damaged([&](auto& json) { json["extensions"][name].erase("factors"); }), 1);
    EXPECT_EQ(damaged([&](auto& json) { json["extensions"][name]["boxes"][0]["half"][1] = 0; }), 1);
    EXPECT_EQ(damaged([&](auto& json) { json["nodes"][0]["extensions"][name]["first"] = 1; }), 1);
    EXPECT_EQ(damaged([&](auto& json) { json["nodes"][0]["extensions"][name]["box"] = 7; }), 1);
    EXPECT_EQ(damaged([&](auto& json) { json["nodes"][0].erase("mesh"); }), 1);
    EXPECT_EQ(damaged([&](auto& json) { json["nodes"][0]["scale"] = {1, 2, 1}; }), 1);
    EXPECT_EQ(damaged([&](auto& json) { json["extensions"].erase(name); }), 1);
}

} // namespace shared_transfer
} // namespace prt::test
