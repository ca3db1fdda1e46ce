// prt info --check, and commands that get models that are damaged or incomplete.

#include "program.h"
#include "support/glb_file.h"
#include "support/temporary_folder.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <cstring>
#include <filesystem>
#include <fstream>
#include <utility>

namespace prt::test {
namespace {

using Json = nlohmann::ordered_json;

Json read_json(const std::filesystem::path& path) {
    std::ifstream file(path);
    return Json::parse(file);
}

class Check : public testing::Test {
protected:
    /// The report of --check on `file`, which ends with the status that its findings ask for.
    Json check(const GlbFile& file) {
        file.write(folder / "scene.glb");
        const Outcome outcome = prt({"info", at("scene.glb"), "--check", "--json", at("report.json")});
        const Json report = read_json(folder / "report.json")["check"];
        EXPECT_EQ(outcome.status, report["findings"].empty() ? 0 : 1) << outcome.err;
        for (const Json& finding : report["findings"])
            EXPECT_NE(outcome.out.find("check: " + finding["problem"].get<std::string>() + "; " +
                                       finding["remedy"].get<std::string>()),
                      std::string::npos)
                << outcome.out;
        return report;
    }
    std::string at(const std::string& name) const { return (folder / name).string(); }

    TemporaryFolder folder;
};

/// Expects one finding, which contains `words`.
void expect_one(const Json& report, const std::string& words) {
    ASSERT_EQ(report["findings"].size(), 1u) << report;
    EXPECT_NE(report["findings"][0]["problem"].get<std::string>().find(words), std::string::npos) << report;
    EXPECT_FALSE(report["findings"][0]["remedy"].get<std::string>().empty());
}

GlbFile with_material(const Json& material) {
    GlbFile file = triangle_file();
    file.json["materials"] = Json::array({material});
    file.json["meshes"][0]["primitives"][0]["material"] = 0;
    file.json["textures"] = {{{"source", 0}}};
    return file;
}

const Json kTextured = {{"pbrMetallicRoughness", {{"baseColorTexture", {{"index", 0}}}}}};

TEST_F(Check, AcceptsAPlainModel) {
    const Json report = check(triangle_file());
    EXPECT_TRUE(report["findings"].empty()) << report;
    EXPECT_NE(report["checked"].get<std::string>().find("texture coordinates"), std::string::npos);
}

TEST_F(Check, FindsUnreadableImages) {
    GlbFile missing = with_material(kTextured), damaged = missing;
    missing.json["images"] = {{{"uri", "gone.png"}}};
    expect_one(check(missing), "image 0 'gone.png' cannot be read");
    damaged.json["images"] = {{{"uri", "data:image/png;base64,AAAA"}}};
    expect_one(check(damaged), "is needed, but cannot be decoded");
}

TEST_F(Check, FindsUnsupportedExtensions) {
    GlbFile file = triangle_file();
    file.json["extensionsUsed"] = {"VENDOR_wind", "KHR_materials_unlit"};
    expect_one(check(file), "the extension VENDOR_wind is not read");
}

TEST_F(Check, FindsLampsWithoutEffect) {
    GlbFile file = triangle_file();
    file.json["extensionsUsed"] = {"KHR_lights_punctual"};
    file.json["extensions"]["KHR_lights_punctual"]["lights"] = {
        {{"type", "point"}, {"name", "lost"}},
        {{"type", "point"}, {"name", "black"}, {"intensity", 0}},
        {{"type", "point"}, {"name", "short"}, {"range", 2}}};
    for (const int light : {1, 2}) {
        file.json["scenes"][0]["nodes"].push_back(file.json["nodes"].size());
        file.json["nodes"].push_back(
            {{"translation", {0, 0, 5}}, {"extensions", {{"KHR_lights_punctual", {{"light", light}}}}}});
    }
    const Json report = check(file);
    ASSERT_EQ(report["findings"].size(), 3u) << report;
    EXPECT_EQ(report["findings"][0]["problem"], "light 0 'lost' is not used by any node");
    EXPECT_NE(report["findings"][1]["problem"].get<std::string>().find("is black"), std::string::npos);
    EXPECT_NE(report["findings"][2]["problem"].get<std::string>().find("has a range of 2 m"),
              std::string::npos);
}

TEST_F(Check, FindsCoordinatesUnfitForLightmaps) {
    for (const auto& [uv, words] : {std::pair(std::vector<float>{0, 0, 3.5f, 0, 0, 1}, "crosses the border"),
                                    std::pair(std::vector<float>{0, 0, 0, 0, 0, 0}, "covers no area")}) {
        GlbFile file = triangle_file();
        Json& attributes = file.json["meshes"][0]["primitives"][0]["attributes"];
        for (const char* set : {"TEXCOORD_0", "TEXCOORD_1"})
            attributes[set] = file.accessor(uv, kFloat, "VEC2", 2);
        const Json report = check(file);
        expect_one(report, words);
        EXPECT_NE(report["findings"][0]["remedy"].get<std::string>().find("unwrap"), std::string::npos);
    }
}

/// A tetrahedron, its faces outwards or inwards, and `points` triangles of one point each.
GlbFile tetrahedron(bool inwards, int points) {
    GlbFile file;
    const std::vector<float> positions = {0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1};
    std::vector<std::uint32_t> indices = {0, 2, 1, 0, 1, 3, 0, 3, 2, 1, 2, 3};
    for (std::size_t i = 0; inwards && i < indices.size(); i += 3)
        std::swap(indices[i], indices[i + 1]);
    for (int i = 0; i < points; ++i)
        indices.insert(indices.end(), {3, 3, 3});
    const std::size_t position = file.accessor(positions, kFloat, "VEC3", 3);
    const std::size_t normal =
        file.accessor(std::vector<float>{-1, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1}, kFloat, "VEC3", 3);
    file.json["meshes"] = {{{"primitives",
                             {{{"attributes", {{"POSITION", position}, {"NORMAL", normal}}},
                               {"indices", file.accessor(indices, kUnsignedInt, "SCALAR", 1)}}}}}};
    file.json["nodes"] = {{{"mesh", 0}}};
    file.json["scenes"] = {{{"nodes", {0}}}};
    return file;
}

TEST_F(Check, FindsInvertedClosedSurfacesAndTrianglesWithoutArea) {
    EXPECT_TRUE(check(tetrahedron(false, 0))["findings"].empty());
    expect_one(check(tetrahedron(true, 0)), "is closed and faces inwards");
    expect_one(check(tetrahedron(false, 2)), "2 triangles have no area");
}

/// gltfpack and others move vertices of a shipped file.
TEST_F(Check, FindsVerticesChangedAfterABake) {
    triangle_file().write(folder / "scene.glb");
    ASSERT_EQ(prt({"bake", at("scene.glb"), "-o", at("baked.glb"), "--rays", "4", "--order", "2"}).status, 0);
    GlbFile baked = read_glb(folder / "baked.glb");
    EXPECT_TRUE(check(baked)["findings"].empty());
    const std::size_t accessor =
        baked.json["meshes"][0]["primitives"][0]["attributes"]["POSITION"].get<std::size_t>();
    const std::size_t view = baked.json["accessors"][accessor]["bufferView"].get<std::size_t>();
    const float moved = 1.001f;
    std::memcpy(&baked.binary[baked.json["bufferViews"][view].value("byteOffset", std::size_t{0}) + 12],
                &moved, 4);
    expect_one(check(baked), "differ from those that were baked");
}

TEST_F(Check, MissingImagesFailOnlyUsersOfTheirPixels) {
    GlbFile file = with_material(kTextured);
    file.json["images"] = {{{"uri", "gone.png"}}};
    file.write(folder / "scene.glb");
    const std::string baked = at("baked.glb"), light = at("light.json"), lit = at("lit.glb");
    folder.file("light.json", R"({"prtkit_light": 1, "order": 1,
                                  "coefficients": {"red": [1], "green": [1], "blue": [1]}})");
    EXPECT_EQ(prt({"info", at("scene.glb")}).status, 0);
    EXPECT_EQ(prt({"ao", at("scene.glb"), "-o", at("ao.glb"), "--rays", "4"}).status, 0);
    const std::vector<std::string> bake = {"bake", at("scene.glb"), "-o", baked,      "--rays",
                                           "4",    "--order",       "1",  "--bounces"};
    auto with = [&](const std::vector<std::string>& more) {
        std::vector<std::string> arguments = bake;
        arguments.insert(arguments.end(), more.begin(), more.end());
        return arguments;
    };
    const Outcome refused = prt(with({"1"}));
    EXPECT_EQ(refused.status, 1);
    EXPECT_NE(refused.err.find("scene.glb: image 0 'gone.png' cannot be read: the file does not exist"),
              std::string::npos)
        << refused.err;
    EXPECT_NE(refused.err.find("--bad-textures ignore"), std::string::npos) << refused.err;
    EXPECT_EQ(prt(with({"1", "--bad-textures", "ignore"})).status, 0);
    EXPECT_EQ(prt(with({"0"})).status, 0);
    EXPECT_EQ(prt({"relight", baked, "--lights", light, "-o", lit}).status, 0);
    EXPECT_EQ(prt({"relight", baked, "--lights", light, "-o", lit, "--colors", "albedo"}).status, 1);
}

TEST_F(Check, CommandsThatCopyTransferRejectDamage) {
    triangle_file().write(folder / "scene.glb");
    ASSERT_EQ(prt({"bake", at("scene.glb"), "-o", at("baked.glb"), "--rays", "4", "--order", "2"}).status, 0);
    GlbFile damaged = read_glb(folder / "baked.glb");
    set_of(damaged.json, "vertices")["bake"]["receivers"] = "none";
    damaged.write(folder / "baked.glb");
    for (const char* command : {"ao", "lobes"}) {
        const Outcome outcome = prt({command, at("baked.glb"), "-o", at("out.glb"), "--rays", "4"});
        EXPECT_EQ(outcome.status, 1);
        EXPECT_NE(outcome.err.find("baked.glb: \"receivers\" of the bake is not a hash"), std::string::npos)
            << outcome.err;
        EXPECT_FALSE(std::filesystem::exists(folder / "out.glb"));
    }
}

} // namespace
} // namespace prt::test
