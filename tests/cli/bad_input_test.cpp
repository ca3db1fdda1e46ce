// Bad input: one line on stderr, exit status 1, no output file.

#include "program.h"
#include "prt/image/image_file.h"
#include "support/glb_file.h"
#include "support/temporary_folder.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>

namespace prt::test {
namespace {

/// Expects a rejection with one error line that names `file`, and no new file in the folder.
void expect_refused(const Outcome& outcome, const std::string& file) {
    EXPECT_EQ(outcome.status, 1) << outcome.err;
    EXPECT_TRUE(outcome.err.starts_with("prt: error: ")) << outcome.err;
    EXPECT_EQ(std::count(outcome.err.begin(), outcome.err.end(), '\n'), 1) << outcome.err;
    EXPECT_NE(outcome.err.find(file), std::string::npos) << outcome.err;
}

class BadInput : public testing::Test {
protected:
    void refuse_bake(const std::filesystem::path& scene, const std::vector<std::string>& options = {}) {
        const std::size_t before = folder.files();
        std::vector<std::string> arguments = {"bake", scene.string(), "-o", out};
        arguments.insert(arguments.end(), options.begin(), options.end());
        expect_refused(prt(arguments), options.empty() ? scene.string() : "");
        EXPECT_EQ(folder.files(), before);
    }
    std::filesystem::path good() {
        triangle_file().write(folder / "good.glb");
        return folder / "good.glb";
    }

    TemporaryFolder folder;
    std::string out = (folder / "out.glb").string();
};

TEST_F(BadInput, MissingFileDirectoryAndEmptyFile) {
    refuse_bake(folder / "missing.glb");
    refuse_bake(folder.path());
    refuse_bake(folder.file("empty.glb", ""));
}

TEST_F(BadInput, TruncatedGlbAndJsonOtherThanGltf) {
    const std::string whole = triangle_file().bytes();
    refuse_bake(folder.file("cut.glb", whole.substr(0, whole.size() - 10)));
    refuse_bake(folder.file("no.gltf", "{\"hello\": 1}"));
    refuse_bake(folder.file("broken.gltf", "{\"asset\": "));
}

TEST_F(BadInput, DracoData) {
    GlbFile file = triangle_file();
    for (auto& accessor : file.json["accessors"])
        accessor.erase("bufferView");
    file.json["meshes"][0]["primitives"][0]["extensions"]["KHR_draco_mesh_compression"] = {
        {"bufferView", 0}, {"attributes", {{"POSITION", 0}, {"NORMAL", 1}}}};
    file.json["extensionsRequired"] = {"KHR_draco_mesh_compression"};
    file.write(folder / "draco.glb");
    refuse_bake(folder / "draco.glb");
}

TEST_F(BadInput, BuffersAccessorsAndIndices) {
    GlbFile gone = triangle_file();
    gone.json["buffers"] = {{{"uri", "gone.bin"}, {"byteLength", 90}}};
    gone.write(folder / "gone.glb");
    refuse_bake(folder / "gone.glb");
    GlbFile small = triangle_file();
    small.json["buffers"] = {{{"uri", "small.bin"}, {"byteLength", 90}}};
    small.write(folder / "short.glb");
    folder.file("small.bin", "12345678");
    refuse_bake(folder / "short.glb");
    GlbFile outside = triangle_file();
    outside.json["accessors"][0]["count"] = 400;
    outside.write(folder / "outside.glb");
    refuse_bake(folder / "outside.glb");
    GlbFile beyond = triangle_file();
    beyond.json["meshes"][0]["primitives"][0]["indices"] =
        beyond.accessor(std::vector<std::uint16_t>{0, 1, 77}, kUnsignedShort, "SCALAR", 1);
    beyond.write(folder / "beyond.glb");
    refuse_bake(folder / "beyond.glb");
}

TEST_F(BadInput, NonFinitePositionsAndMissingTriangles) {
    for (const float bad : {std::nanf(""), INFINITY}) {
        GlbFile file = triangle_file();
        file.json["meshes"][0]["primitives"][0]["attributes"]["POSITION"] =
            file.accessor(std::vector<float>{0, 0, 0, bad, 0, 0, 0, 1, 0}, kFloat, "VEC3", 3);
        file.write(folder / "bad.glb");
        refuse_bake(folder / "bad.glb");
    }
    GlbFile nothing = triangle_file();
    nothing.json.erase("meshes");
    nothing.json["nodes"][0].erase("mesh");
    nothing.write(folder / "nothing.glb");
    refuse_bake(folder / "nothing.glb");
}

TEST_F(BadInput, LightBeyondTheValidRange) {
    const auto light = folder.file(
        "huge.json",
        R"({"prtkit_light": 1, "order": 1, "coefficients": {"red": [3e38], "green": [0], "blue": [0]}})");
    expect_refused(prt({"project", light.string(), "--order", "1", "-o", (folder / "light.json").string()}),
                   light.string());
}

TEST_F(BadInput, ScenesReadOutsideFilesOnlyIfAllowed) {
    GlbFile file = triangle_file();
    file.json["buffers"] = {{{"uri", "../data.bin"}, {"byteLength", file.binary.size()}}};
    std::filesystem::create_directory(folder / "scene");
    folder.file("data.bin", {reinterpret_cast<const char*>(file.binary.data()), file.binary.size()});
    const std::string scene = (folder / "scene/scene.glb").string();
    file.write(scene);
    expect_refused(prt({"info", scene}), scene);
    EXPECT_EQ(prt({"info", scene, "--allow-outside"}).status, 0);
}

TEST_F(BadInput, UnsupportedExtensionIsReported) {
    GlbFile file = triangle_file();
    file.json["extensionsRequired"] = {"EXT_unheard_of"};
    file.write(folder / "unheard_of.glb");
    EXPECT_NE(prt({"bake", (folder / "unheard_of.glb").string(), "-o", out}).err.find("EXT_unheard_of"),
              std::string::npos);
}

/// Runs bakes in an environment without any GPU driver.
class GpuSelection : public BadInput {
protected:
    Outcome bake(std::vector<std::string> options) {
        std::vector<std::string> arguments{"-u",
                                           "DISPLAY",
                                           "-u",
                                           "WAYLAND_DISPLAY",
                                           "__EGL_VENDOR_LIBRARY_FILENAMES=/dev/null",
                                           "VK_ICD_FILENAMES=/dev/null",
                                           "ASAN_OPTIONS=detect_leaks=0",
                                           PRT_PROGRAM,
                                           "bake",
                                           good().string(),
                                           "-o",
                                           out,
                                           "--rays",
                                           "4"};
        std::ranges::move(options, std::back_inserter(arguments));
        return run("env", arguments);
    }
};

TEST_F(GpuSelection, MissingGpuIsReportedUnlessAutomatic) {
    expect_refused(bake({"--device", "gpu"}), "no driver for Vulkan");
    expect_refused(bake({"--device", "0"}), "no GPU can be used for baking");
    expect_refused(bake({"--device", "gpu", "--method", "raster"}), "OpenGL 4.5");
    EXPECT_EQ(bake({"--device", "auto"}).status, 0);
}

TEST_F(BadInput, MissingOrUnselectedGpus) {
    const auto refuse = [&](std::vector<std::string> options, const std::string& why) {
        std::vector<std::string> arguments{"bake", good().string(), "-o", out};
        std::ranges::move(options, std::back_inserter(arguments));
        expect_refused(prt(arguments), why);
    };
    refuse({"--device", "no such card"}, "no GPU has \"no such card\" as its number or in its name");
    refuse({"--device", "999"}, "no GPU has \"999\"");
    refuse({"--device", "0", "--method", "raster"}, "--method raster");
    EXPECT_EQ(prt({"bench", "--device", "list"}).status, 0);
}

TEST_F(BadInput, RasterOnTheCpuOrWithSharedTransfer) {
    const auto scene = good();
    refuse_bake(scene, {"--method", "raster", "--device", "cpu"});
    refuse_bake(scene, {"--method", "raster", "--instances", "shared"});
}

TEST_F(BadInput, CoefficientsAboveTheRangeOfFloat16) {
    GlbFile file = triangle_file(); // faces +Z; the light shines along -Z
    file.json["extensionsUsed"].push_back("KHR_lights_punctual");
    file.json["extensions"]["KHR_lights_punctual"]["lights"] = {
        {{"type", "directional"}, {"intensity", 1e6}}};
    file.json["nodes"].push_back({{"extensions", {{"KHR_lights_punctual", {{"light", 0}}}}}});
    file.json["scenes"][0]["nodes"].push_back(1);
    file.write(folder / "sun.glb");
    refuse_bake(folder / "sun.glb", {"--rays", "16", "--storage", "float16"});
    EXPECT_EQ(prt({"bake", (folder / "sun.glb").string(), "-o", out, "--rays", "16"}).status, 0);
}

TEST_F(BadInput, SettingsOfSharedTransferWithoutSharing) {
    refuse_bake(good(), {"--instances", "own,error=0.1"});
    refuse_bake(good(), {"--instances", "samples=64"});
}

TEST_F(BadInput, MediaForMissingMaterials) {
    refuse_bake(good(), {"--subsurface", "porcelain=marble"});
}

TEST_F(BadInput, MissingTexturesAreReportedAndMayBeIgnored) {
    GlbFile file = triangle_file();
    file.json["images"] = {{{"uri", "gone.png"}}};
    file.json["textures"] = {{{"source", 0}}};
    file.json["materials"] = {{{"pbrMetallicRoughness", {{"baseColorTexture", {{"index", 0}}}}}}};
    file.json["meshes"][0]["primitives"][0]["material"] = 0;
    file.write(folder / "untextured.glb");
    const std::string scene = (folder / "untextured.glb").string();
    const Outcome refused = prt({"bake", scene, "-o", out, "--bounces", "1"});
    EXPECT_EQ(refused.status, 1);
    EXPECT_NE(refused.err.find("prt: error: " + scene + ": image 0 'gone.png'"), std::string::npos)
        << refused.err;
    const Outcome ignored =
        prt({"bake", scene, "-o", out, "--bad-textures", "ignore", "--rays", "4", "--bounces", "1"});
    EXPECT_EQ(ignored.status, 0) << ignored.err;
    EXPECT_NE(ignored.out.find("missing"), std::string::npos) << ignored.out;
}

TEST_F(BadInput, WrongUsageHasStatusTwo) {
    const std::string scene = good().string();
    for (const std::vector<std::string>& arguments :
         {std::vector<std::string>{},
          {"nonsense"},
          {"bake"},
          {"bake", scene},
          {"bake", scene, "-o", out, "--order", "six"},
          {"bake", scene, "-o", out, "--bounces", "many"},
          {"bake", scene, "-o", out, "--bounces", "-1"},
          {"bake", scene, "-o", out, "--device", ""},
          {"bake", scene, "-o", out, "--method", "guess"},
          {"bake", scene, "-o", out, "--subsurface", "custard"},
          {"bake", scene, "-o", out, "--subsurface", "1,2,3,4,5"},
          {"bake", scene, "-o", out, "--rays", "64", "--target-error", "0.01"},
          {"bake", scene, "-o", out, "--subsurface", "wax=marble", "--subsurface", "wax=skin1"},
          {"bake", scene, "-o", out, "--texels", "64", "--fit", "vertex"},
          {"ao", scene, "-o", out, "--texels", "64", "--fit", "vertex"},
          {"ao", scene, "-o", out, "--falloff", "1,,2"},
          {"bench"},
          {"bench", scene, "--device", "list"},
          {"compress", scene, "-o", out, "--clusters", "auto"},
          {"compress", scene, "-o", out, "--components", "auto"},
          {"compress", scene, "-o", out, "--bits", "241"},
          {"compress", scene, "-o", out, "--preset", "u32", "--clusters", "4"},
          {"compress", scene, "-o", out, "--preset", "u16"},
          {"compress", scene, "-o", out, "--max-error", "0.1", "--bits", "24"},
          {"compress", scene, "-o", out, "--max-error", "small"},
          {"compress", scene, "-o", out, "--lights", "plain", "--lights", scene},
          {"evaluate", scene},
          {"evaluate", scene, "--measure", "sweep", "--rotations", "2"},
          {"evaluate", scene, "--measure", "sweep", "--suns", "2"},
          {"render", scene, "--lights", scene, "-o", "p.exr", "--tone-map", "srgb"},
          {"render", scene, "--lights", scene, "-o", "p.png", "--show", "ao", "--exposure", "1"},
          {"render", scene, "--lights", scene, "-o", "p.png", "--size", "0x5"},
          {"render", scene, "--lights", scene, "-o", "p.png", "--size", "4294967297x1"},
          {"render", scene, "--lights", scene, "-o", "p.png", "--show", "error"},
          {"render", scene, "--lights", scene, "-o", "p.png", "--camera", "1,2"}}) {
        const Outcome outcome = prt(arguments);
        EXPECT_EQ(outcome.status, 2) << (arguments.empty() ? "" : arguments[0]) << outcome.err;
        EXPECT_EQ(std::count(outcome.err.begin(), outcome.err.end(), '\n'), 1) << outcome.err;
    }
}

TEST_F(BadInput, HelpSucceedsAndShowsDefaults) {
    EXPECT_EQ(prt({"--help"}).status, 0);
    for (const char* command : {"bake", "bench", "compress", "evaluate", "project", "render", "info"}) {
        const Outcome outcome = prt({command, "--help"});
        EXPECT_EQ(outcome.status, 0);
        EXPECT_NE(outcome.out.find("--json"), std::string::npos);
    }
    EXPECT_NE(prt({"bake", "--help"}).out.find("1024"), std::string::npos);
}

TEST_F(BadInput, CompressAndEvaluateNeedABake) {
    const std::string scene = good().string();
    expect_refused(prt({"compress", scene, "-o", out}), scene);
    const std::string baked = (folder / "baked.glb").string(), shipped = (folder / "shipped.glb").string();
    ASSERT_EQ(prt({"bake", scene, "-o", baked, "--rays", "4"}).status, 0);
    ASSERT_EQ(prt({"compress", baked, "-o", shipped, "--clusters", "1", "--components", "1"}).status, 0);
    expect_refused(prt({"compress", shipped, "-o", out}), "already compressed");
    expect_refused(prt({"evaluate", scene, shipped}), scene);
    expect_refused(prt({"evaluate", baked, scene}), scene);
    expect_refused(prt({"evaluate", shipped, shipped}), shipped);

    GlbFile other = triangle_file();
    other.json["nodes"][0]["scale"] = {1, 2, 3}; // a rigid motion would keep the scene equal
    other.write(folder / "other.glb");
    const std::string other_baked = (folder / "other_baked.glb").string();
    ASSERT_EQ(prt({"bake", (folder / "other.glb").string(), "-o", other_baked, "--rays", "4"}).status, 0);
    expect_refused(prt({"evaluate", other_baked, shipped}), "was not made from");
    const std::string low = (folder / "low.glb").string();
    ASSERT_EQ(prt({"bake", scene, "-o", low, "--rays", "4", "--order", "3"}).status, 0);
    expect_refused(prt({"evaluate", low, shipped}), "order");
    EXPECT_FALSE(std::filesystem::exists(out));
}

TEST_F(BadInput, TooManyComponentsAreRejected) {
    const std::string baked = (folder / "baked.glb").string();
    ASSERT_EQ(prt({"bake", good().string(), "-o", baked, "--rays", "4", "--order", "2"}).status, 0);
    expect_refused(prt({"compress", baked, "-o", out, "--components", "5"}), "0..4");
    // Four coefficients in less than a byte, exactly: budgets that contradict each other.
    expect_refused(prt({"compress", baked, "-o", out, "--max-error", "1e-9", "--bytes-per-vertex", "0.5"}),
                   "no result meets the goal");
    EXPECT_FALSE(std::filesystem::exists(out));
}

TEST_F(BadInput, InvalidEnvironments) {
    write_exr(folder / "photo.exr", {5, 4, std::vector<glm::vec3>(20, glm::vec3(1))});
    write_exr(folder / "nan.exr", {2, 1, {glm::vec3(1), glm::vec3(std::nanf(""))}});
    const std::string light = (folder / "light.json").string();
    for (const char* name : {"photo.exr", "nan.exr", "missing.hdr"}) {
        expect_refused(prt({"project", (folder / name).string(), "-o", light}), name);
        EXPECT_FALSE(std::filesystem::exists(light));
    }
    EXPECT_EQ(prt({"project", (folder / "nan.exr").string(), "-o", light, "--bad-pixels", "zero"}).status, 0);
    folder.file("bad.json", "{\"prtkit_light\": 1, \"order\": 6}");
    const std::string baked = (folder / "baked.glb").string();
    ASSERT_EQ(prt({"bake", good().string(), "-o", baked, "--rays", "4"}).status, 0);
    expect_refused(
        prt({"render", baked, "--lights", (folder / "bad.json").string(), "-o", (folder / "p.png").string()}),
        "bad.json");
}

class BadLightFile : public BadInput {
protected:
    nlohmann::json light = {
        {"prtkit_light", 1},
        {"order", 1},
        {"coefficients", {{"red", {1}}, {"green", {2}}, {"blue", {3}}}},
        {"suns", {{{"towards", {0, 1, 0}}, {"irradiance", {1, 1, 1}}, {"half_angle_radians", 0}}}}};

    Outcome project(const std::string& text, const std::vector<std::string>& options = {"--order", "1"}) {
        std::vector<std::string> arguments = {"project", folder.file("bad.json", text).string(), "-o",
                                              (folder / "out.json").string()};
        arguments.insert(arguments.end(), options.begin(), options.end());
        return prt(arguments);
    }
    void refuse(const std::string& text, const std::string& wrong) {
        const Outcome outcome = project(text);
        expect_refused(outcome, "bad.json: ");
        EXPECT_NE(outcome.err.find(wrong), std::string::npos) << outcome.err;
        EXPECT_EQ(outcome.err.find("json.exception"), std::string::npos) << outcome.err;
    }
    /// Expects an error if `position` in the JSON is replaced by `value`; null removes the member.
    void refuse_at(const std::string& position, const nlohmann::json& value, const std::string& wrong) {
        nlohmann::json changed = light;
        const nlohmann::json::json_pointer at(position);
        if (value.is_null())
            changed[at.parent_pointer()].erase(at.back());
        else
            changed[at] = value;
        SCOPED_TRACE(position);
        refuse(changed.dump(), wrong);
    }
};

TEST_F(BadLightFile, IsRejectedWithAPlainReason) {
    EXPECT_EQ(project(light.dump()).status, 0);
    for (const char* key : {"order", "coefficients"})
        refuse_at(std::string("/") + key, nullptr, std::string("\"") + key + "\" is missing");
    refuse_at("/coefficients/green", nullptr, "\"green\" is missing");
    refuse_at("/coefficients", 3, "\"red\" is missing");
    refuse_at("/coefficients/blue", {1, 2}, "\"blue\" has 2 numbers, but needs 1");
    refuse_at("/coefficients/blue", nlohmann::json::array(), "\"blue\" has 0 numbers, but needs 1");
    refuse_at("/coefficients/blue", "much", "\"blue\" is not a list");
    refuse_at("/coefficients/blue/0", "much", "\"blue\" is not a list");
    refuse_at("/coefficients/blue/0", 1e300, "finite");
    for (const nlohmann::json& order : {nlohmann::json(6.5), nlohmann::json(0), nlohmann::json(1e300)})
        refuse_at("/order", order, "must be an integer in 1..10");
    refuse_at("/order", "six", "\"order\" is not a number");
    refuse_at("/prtkit_light", "one", "not a light file");
    refuse("[1]", "not a light file");
    refuse("{\"prtkit_light\": 1,", "not valid JSON: the error is at byte");
    refuse("{\"prtkit_light\": 1e999}", "double");
}

TEST_F(BadLightFile, ItsSunsAreCheckedOneByOne) {
    refuse_at("/suns", nlohmann::json::object(), "\"suns\" is not a list");
    refuse_at("/lights", nlohmann::json::array(), "older version of prt");
    refuse_at("/suns/0", 3, "sun 0 of \"suns\": \"towards\" is missing");
    for (const char* key : {"towards", "irradiance", "half_angle_radians"})
        refuse_at(std::string("/suns/0/") + key, nullptr, std::string("\"") + key + "\" is missing");
    refuse_at("/suns/0/towards", {0, 1}, "has 2 numbers, but needs 3");
    refuse_at("/suns/0/towards", {0, 0, 0}, "not a direction");
    refuse_at("/suns/0/irradiance/1", -1, "\"irradiance\" is negative");
    refuse_at("/suns/0/half_angle_radians", 2, "0..1.5708");
}

TEST_F(BadLightFile, SunsAreSearchedOnlyInImages) {
    const Outcome outcome = project(light.dump(), {"--order", "1", "--suns", "1"});
    expect_refused(outcome, "bad.json: ");
    EXPECT_NE(outcome.err.find("suns are found in images"), std::string::npos) << outcome.err;
}

TEST_F(BadInput, OutputsThatCannotBeWritten) {
    const std::string scene = good().string();
    for (const std::string& position : {std::string("/no/such/folder/out.glb"), folder.path().string(),
                                        (folder / (std::string(252, 'n') + ".glb")).string()})
        expect_refused(prt({"bake", scene, "-o", position, "--rays", "4"}), position);
    if (std::filesystem::exists("/proc/self"))
        expect_refused(prt({"bake", scene, "-o", "/proc/out.glb", "--rays", "4"}), "/proc/out.glb");
}

TEST_F(BadInput, InputsAreNeverChanged) {
    const auto scene = good();
    const auto time = std::filesystem::last_write_time(scene);
    const auto size = std::filesystem::file_size(scene);
    ASSERT_EQ(prt({"bake", scene.string(), "-o", out, "--rays", "4"}).status, 0);
    EXPECT_EQ(std::filesystem::last_write_time(scene), time);
    EXPECT_EQ(std::filesystem::file_size(scene), size);
    // The input is also protected by an equivalent path, or a link to it.
    std::filesystem::create_symlink("good.glb", folder / "link.glb");
    for (const std::string& same :
         {scene.string(), (folder / "." / "good.glb").string(), (folder / "link.glb").string()})
        expect_refused(prt({"bake", scene.string(), "-o", same, "--rays", "4"}), same);
    EXPECT_EQ(std::filesystem::last_write_time(scene), time);
}

TEST_F(BadInput, ReferencedFilesAreNeverChanged) {
    GlbFile file = triangle_file();
    const std::string buffer(reinterpret_cast<const char*>(file.binary.data()), file.binary.size());
    const std::string report = folder.file("report.json", buffer);
    file.json["buffers"] = {{{"uri", "report.json"}, {"byteLength", buffer.size()}}};
    const std::string scene = (folder / "named.glb").string(), picture = (folder / "p.png").string();
    const std::string light = folder.file(
        "light.json", R"({"prtkit_light":1,"order":1,"coefficients":{"red":[1],"green":[1],"blue":[1]}})");
    file.write(scene);
    for (const std::vector<std::string>& words : std::vector<std::vector<std::string>>{
             {"bake", scene, "-o", out, "--rays", "4", "--json", report},
             {"info", scene, "--json", report},
             {"bench", scene, "--json", report},
             {"render", scene, "--lights", light, "-o", picture, "--device", "cpu", "--json", report}})
        expect_refused(prt(words), scene);
    EXPECT_EQ(std::filesystem::file_size(report), buffer.size());
}

TEST_F(BadInput, DamagedExrs) {
    const auto damaged = shared_file("bad/exr");
    if (damaged.empty())
        GTEST_SKIP() << "the damaged files are not here";
    const std::string light = (folder / "light.json").string();
    for (const auto& entry : std::filesystem::directory_iterator(damaged)) {
        const Outcome outcome = prt({"project", entry.path().string(), "-o", light});
        EXPECT_LE(outcome.status, 1) << entry.path() << outcome.err;
        EXPECT_EQ(std::count(outcome.err.begin(), outcome.err.end(), '\n'), outcome.status) << outcome.err;
    }
}

} // namespace
} // namespace prt::test
