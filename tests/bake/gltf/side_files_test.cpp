// Which files a scene reaches.
#include "prt/gltf/gltf.h"

#include "prt/core/error.h"
#include "prt/image/image_file.h"
#include "support/glb_file.h"
#include "support/temporary_folder.h"

#include <gtest/gtest.h>

#include <filesystem>

#include <sys/stat.h>

namespace prt {
namespace {

namespace fs = std::filesystem;

/// A scene in a separate folder, with files inside and outside it.
class SideFile : public testing::Test {
protected:
    SideFile() {
        fs::create_directories(folder / "scene/parts");
        const std::string bytes = data();
        folder.file("secret.bin", bytes);
        folder.file("scene/own.bin", bytes);
        folder.file("scene/parts/a b.bin", bytes);
        fs::create_symlink("own.bin", folder / "scene/inward.bin");
        fs::create_symlink("../secret.bin", folder / "scene/outward.bin");
        fs::create_symlink("..", folder / "scene/up");
        mkfifo((folder / "scene/pipe.bin").c_str(), 0600);
    }

    static std::string data() {
        const test::GlbFile file = test::triangle_file();
        return {reinterpret_cast<const char*>(file.binary.data()), file.binary.size()};
    }

    /// Returns the error of a scene whose buffer is `uri`.
    std::string refusal_of_buffer(const std::string& uri, const GltfOptions& options = {}) {
        test::GlbFile file = test::triangle_file();
        file.json["buffers"] = {{{"uri", uri}, {"byteLength", file.binary.size()}}};
        return refusal(file, options);
    }
    std::string refusal_of_image(const std::string& uri, const GltfOptions& options = {}) {
        test::GlbFile file = test::triangle_file();
        file.json["images"] = {{{"uri", uri}}};
        return refusal(file, options);
    }
    std::string refusal(const test::GlbFile& file, const GltfOptions& options) {
        const fs::path path = folder / "scene/scene.glb";
        file.write(path);
        try {
            const Scene scene = extract_scene(load_gltf(path, options));
            for (const EncodedImage& image : scene.images)
                if (!image.trouble.empty())
                    return image.trouble;
        } catch (const Error& error) {
            std::string message = error.what();
            EXPECT_TRUE(message.starts_with(path.string() + ": ")) << message;
            EXPECT_EQ(message.find('\n'), std::string::npos) << message;
            EXPECT_EQ(message.find("std::"), std::string::npos) << message;
            return message;
        }
        return {};
    }

    test::TemporaryFolder folder;
};

TEST_F(SideFile, InTheFolderAndBelowIsRead) {
    for (const char* uri : {"own.bin", "parts/a%20b.bin", "parts/../own.bin", "./own.bin", "inward.bin"}) {
        EXPECT_EQ(refusal_of_buffer(uri), "") << uri;
        EXPECT_EQ(refusal_of_image(uri), "") << uri;
    }
}

TEST_F(SideFile, OutsideTheFolderIsReadIfAllowed) {
    for (const std::string& uri : {std::string("../secret.bin"), std::string("%2e%2e/secret.bin"),
                                   std::string("parts/../../secret.bin"), std::string("outward.bin"),
                                   std::string("up/secret.bin"), (folder / "secret.bin").string()}) {
        EXPECT_NE(refusal_of_buffer(uri).find("outside the folder"), std::string::npos) << uri;
        EXPECT_NE(refusal_of_image(uri).find("outside the folder"), std::string::npos) << uri;
        EXPECT_EQ(refusal_of_buffer(uri, {.allow_outside = true}), "") << uri;
        EXPECT_EQ(refusal_of_image(uri, {.allow_outside = true}), "") << uri;
    }
    EXPECT_NE(refusal_of_buffer("../gone.bin").find("outside the folder"), std::string::npos);
}

TEST_F(SideFile, NonRegularFilesAreRejected) {
    for (const bool outside : {false, true})
        for (const char* uri :
             {"pipe.bin", ".", "parts", "%00", "gone.bin", "", "/dev/zero", "http://a.b/c"}) {
            EXPECT_EQ(refusal_of_buffer(uri, {.allow_outside = outside}).empty(), *uri == 0) << uri;
            EXPECT_NE(refusal_of_image(uri, {.allow_outside = outside}), "") << uri;
        }
}

TEST_F(SideFile, OtherFoldersAreNotSearched) {
    const fs::path before = fs::current_path();
    fs::current_path(folder.path());
    EXPECT_NE(refusal_of_buffer("secret.bin"), "");
    fs::current_path(before);
}

TEST_F(SideFile, ExcessiveReferencesAreRejected) {
    fs::resize_file(folder / "scene/own.bin", 8 << 20);
    test::GlbFile file = test::triangle_file();
    for (int i = 0; i < 120; ++i)
        file.json["images"].push_back({{"uri", "own.bin"}});
    EXPECT_NE(refusal(file, {}).find("too often"), std::string::npos);
}

TEST_F(SideFile, OutputsAsInputsAreRejected) {
    for (const char* uri : {"own.bin", "inward.bin", "parts/../own.bin"}) {
        const GltfOptions options{.outputs = {folder / "gone.glb", folder / "scene/own.bin"}};
        EXPECT_NE(refusal_of_buffer(uri, options).find("which the output would overwrite"),
                  std::string::npos);
        EXPECT_NE(refusal_of_image(uri, options).find("which the output would overwrite"), std::string::npos);
    }
    EXPECT_EQ(refusal_of_buffer("own.bin", {.outputs = {folder / "secret.bin", folder / "gone.glb"}}), "");
}

TEST_F(SideFile, SharedImagesAreOneTexture) {
    test::GlbFile file = test::triangle_file();
    file.json["images"] = {{{"uri", "own.bin"}}, {{"uri", "own.bin"}}, {{"uri", "inward.bin"}}};
    file.json["textures"] = {{{"source", 0}}, {{"source", 1}}, {{"source", 2}}};
    for (int i = 0; i < 3; ++i)
        file.json["materials"].push_back(
            {{"pbrMetallicRoughness",
              {{"baseColorTexture", {{"index", i}}}, {"metallicRoughnessTexture", {{"index", 1}}}}}});
    file.write(folder / "scene/scene.glb");
    const Scene scene = extract_scene(load_gltf(folder / "scene/scene.glb"));
    EXPECT_EQ(scene.materials[0].base_color_texture.image, 0);
    EXPECT_EQ(scene.materials[1].base_color_texture.image, 0);
    EXPECT_EQ(scene.materials[2].base_color_texture.image, 2);
    EXPECT_EQ(scene.materials[0].metal.texture.image, 1); // numbers are decoded otherwise
}

} // namespace
} // namespace prt
