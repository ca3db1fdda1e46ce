// Tests ambient occlusion through the program: written data and rejected input.

#include "demanding_file.h"
#include "pipeline.h"
#include "prt/gltf/gltf.h"
#include "prt/image/image_file.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace prt::test {
namespace {

class Occlusion : public Pipeline {
protected:
    void SetUp() override {
        demanding_file().write(folder / "d.glb");
        write_png(folder / "a picture.png", 2, 2, std::vector<glm::u8vec3>(4, glm::u8vec3(200)));
    }
    Outcome ao(const std::vector<std::string>& options, const char* scene = "d.glb") {
        std::vector<std::string> arguments = {"ao",     at(scene),    "-o",     at("o.glb"),
                                              "--json", at("o.json"), "--rays", "64"};
        arguments.insert(arguments.end(), options.begin(), options.end());
        return prt(arguments);
    }
    /// Returns the written scene. All other content of the file is preserved.
    Scene written() const {
        GltfDocument document = load_gltf(folder / "o.glb");
        EXPECT_NE(validator_errors(folder / "o.glb"), 1);
        return extract_scene(document);
    }
};

/// The first image of that name.
Image8 image_named(const std::filesystem::path& path, const std::string& name) {
    const GlbFile file = read_glb(path);
    for (const auto& image : file.json["images"])
        if (image.value("name", "") == name) {
            const auto& view = file.json["bufferViews"][image["bufferView"].get<std::size_t>()];
            return decode_image(std::span(file.binary)
                                    .subspan(view.value("byteOffset", std::size_t{0}),
                                             view["byteLength"].get<std::size_t>()));
        }
    return {};
}

TEST_F(Occlusion, VerticesBecomeVertexColors) {
    ASSERT_EQ(ao({}).status, 0);
    const Scene scene = written();
    for (const VertexArray& vertices : scene.vertex_arrays) {
        ASSERT_FALSE(vertices.colors.empty());
        for (const glm::vec4& color : vertices.colors)
            EXPECT_EQ(color.r, color.g);
    }
    EXPECT_GT(read_json(folder / "o.json")["mean_ambient"], 0.5);
}

/// A closed room of four triangles that look inwards is black: the notice names the option that helps.
TEST_F(Occlusion, ClosedRoomsAreBlackWithARemedy) {
    GlbFile room = triangle_file();
    const auto position =
        room.accessor(std::vector<float>{0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1}, kFloat, "VEC3", 3);
    room.json["accessors"][position]["min"] = {0, 0, 0};
    room.json["accessors"][position]["max"] = {1, 1, 1};
    const auto indices = room.accessor(std::vector<std::uint8_t>{0, 1, 2, 0, 3, 1, 0, 2, 3, 1, 3, 2},
                                       kUnsignedByte, "SCALAR", 1);
    room.json["meshes"][0]["primitives"] = {{{"attributes", {{"POSITION", position}}}, {"indices", indices}}};
    room.write(folder / "room.glb");
    ASSERT_EQ(ao({}, "room.glb").status, 0);
    const nlohmann::json black = read_json(folder / "o.json");
    EXPECT_EQ(black["mean_ambient"], 0);
    ASSERT_EQ(black["notices"].size(), 1u);
    EXPECT_NE(black["notices"][0].get<std::string>().find("--falloff"), std::string::npos);
    ASSERT_EQ(ao({"--falloff", "1"}, "room.glb").status, 0);
    EXPECT_GT(read_json(folder / "o.json")["mean_ambient"], 0.1);
    EXPECT_TRUE(read_json(folder / "o.json")["notices"].empty());
}

TEST_F(Occlusion, UsesCustomAttributes) {
    const Outcome outcome = ao({"--attribute", "_AO", "--bent-normals", "--fit", "vertex"});
    ASSERT_EQ(outcome.status, 0) << outcome.err;
    written();
    const GlbFile file = read_glb(folder / "o.glb");
    for (const auto& mesh : file.json["meshes"])
        for (const auto& primitive : mesh["primitives"]) {
            const auto& attributes = primitive["attributes"];
            EXPECT_FALSE(attributes.contains("COLOR_0"));
            EXPECT_EQ(file.json["accessors"][attributes["_AO"].get<std::size_t>()]["type"], "SCALAR");
            EXPECT_EQ(file.json["accessors"][attributes["_BENT_NORMAL"].get<std::size_t>()]["type"], "VEC3");
        }
}

TEST_F(Occlusion, TexelsBecomeOcclusionTextures) {
    const Outcome outcome = ao({"--texels", "48", "--texels", "unwrap", "--bent-normals"});
    ASSERT_EQ(outcome.status, 0) << outcome.err;
    EXPECT_NE(outcome.err.find("TEXCOORD_1 has"), std::string::npos) << outcome.err;
    EXPECT_GT(read_json(folder / "o.json")["charts"], 1);
    const Scene scene = written();
    for (const VertexArray& vertices : scene.vertex_arrays)
        EXPECT_EQ(vertices.texcoords.size(), 2u);
    const GlbFile file = read_glb(folder / "o.glb");
    for (const auto& mesh : file.json["meshes"])
        for (const auto& primitive : mesh["primitives"]) {
            const auto& material = file.json["materials"][primitive["material"].get<std::size_t>()];
            EXPECT_EQ(material["occlusionTexture"]["texCoord"], 1);
            EXPECT_EQ(material["extras"]["prtkit"]["bentNormalTexture"]["texCoord"], 1);
        }
    EXPECT_EQ(file.json["materials"][0]["pbrMetallicRoughness"]["baseColorTexture"]["index"], 0);
    const Image8 occlusion = image_named(folder / "o.glb", "ambient occlusion"),
                 bent = image_named(folder / "o.glb", "bent normals");
    EXPECT_EQ(occlusion.width, 48);
    EXPECT_EQ(bent.height, 48);
    EXPECT_GT(std::ranges::max_element(occlusion.pixels, {}, [](const auto& p) { return p.r; })->r, 250);
    for (const glm::u8vec4& p : bent.pixels)
        EXPECT_NEAR(glm::length(glm::vec3(p) / 127.5f - 1.0f), 1, 0.02f);
    // Once more: coordinates are there now.
    ASSERT_EQ(prt({"ao", at("o.glb"), "-o", at("again.glb"), "--texels", "48", "--rays", "16"}).status, 0);
    const Outcome again = prt(
        {"ao", at("o.glb"), "-o", at("again.glb"), "--texels", "4/m", "--texels", "unwrap", "--rays", "16"});
    EXPECT_EQ(again.status, 0);
    EXPECT_NE(again.err.find("has TEXCOORD_1 already"), std::string::npos) << again.err;
}

TEST_F(Occlusion, EachObjectHasItsMaterial) {
    ASSERT_EQ(ao({"--texels", "32", "--texels", "unwrap", "--texels", "atlas=each"}).status, 0);
    written();
    EXPECT_EQ(read_json(folder / "o.json")["textures"], 2);
    const GlbFile file = read_glb(folder / "o.glb");
    std::vector<std::size_t> textures;
    for (const auto& mesh : file.json["meshes"]) // the separate image belongs to one primitive of each mesh
        textures.push_back(file.json["materials"][mesh["primitives"][1]["material"].get<std::size_t>()]
                                    ["occlusionTexture"]["index"]
                                        .get<std::size_t>());
    EXPECT_NE(textures.at(0), textures.at(1));
}

TEST_F(Occlusion, DoesNotDependOnThreads) {
    const auto bytes = [&](const char* threads) {
        EXPECT_EQ(
            ao({"--texels", "32", "--texels", "unwrap", "--falloff", "2:97,300:3", "--threads", threads})
                .status,
            0);
        return read_glb(folder / "o.glb").binary;
    };
    EXPECT_EQ(bytes("1"), bytes("3"));
}

TEST_F(Occlusion, UsesAHighPolyModel) {
    for (std::vector<std::string> options :
         {std::vector<std::string>{"--texels", "32", "--texels", "unwrap"}, {}}) {
        options.insert(options.end(), {"--high-poly", at("d.glb"), "--high-poly", "distance=0.1"});
        EXPECT_EQ(ao(options).status, 0) << options.size();
        written();
    }
}

TEST_F(Occlusion, RejectsUnsupportedOptions) {
    triangle_file().write(folder / "t.glb");
    const struct {
        std::vector<std::string> options;
        int status;
        std::string why;
    } cases[] = {
        {{"--texels", "16"}, 1, "has no TEXCOORD_1"},
        {{"--texels", "16", "--texels", "uv=0"}, 1, "has no TEXCOORD_0"},
        {{"--high-poly", at("t.glb"), "--occluders"}, 1, "no object has the name"},
        {{"--texels", "16", "--texels", "unwrap", "--high-poly", at("missing.glb")}, 1, "missing.glb"},
        {{"--high-poly", "distance=1"}, 1, "needs a file"},
        {{"--texels", "unwrap"}, 1, "--texels needs a size"},
        {{"--texels", "uv=0"}, 1, "--texels needs a size"},
        {{"--texels", "atlas=each"}, 1, "--texels needs a size"},
        {{"--attribute", "_BENT_NORMAL", "--bent-normals"}, 1, "--bent-normals"},
        {{"--texels", "3", "--texels", "unwrap"}, 1, "too small"},
        {{"--texels", "1e6/m", "--texels", "unwrap"}, 1, "more than 8192"},
        {{"--attribute", "AO"}, 1, "begin with _"},
        {{"--texels", "0/m"}, 2, "--texels"},
        {{"--texels", "nan"}, 2, "--texels"},
        {{"--falloff", "0"}, 2, "--falloff"},
        {{"--falloff", "2:-1"}, 2, "--falloff"},
        {{"--falloff", "2:0"}, 1, "shares"},
        {{"--max-distance", "0"}, 2, "--max-distance"},
        {{"--device", ""}, 2, "--device"}};
    for (const auto& c : cases) {
        const std::size_t before = folder.files();
        const Outcome outcome = ao(c.options, "t.glb");
        EXPECT_EQ(outcome.status, c.status) << c.options.back() << outcome.err;
        EXPECT_NE(outcome.err.find(c.why), std::string::npos) << outcome.err;
        EXPECT_EQ(folder.files(), before);
    }
}

} // namespace
} // namespace prt::test
