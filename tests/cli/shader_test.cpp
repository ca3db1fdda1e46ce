// prt shader: every language, compiled and validated by the tools of Khronos.

#include "program.h"
#include "support/glb_file.h"
#include "support/random_volume.h"
#include "support/temporary_folder.h"
#include "support/volume_model.h"

#include <gtest/gtest.h>

#include <fstream>

namespace prt::test {
namespace {

std::string text_of(const std::filesystem::path& path) {
    std::ifstream file(path);
    return {std::istreambuf_iterator<char>(file), {}};
}

class Tools : public testing::Test {
protected:
    void SetUp() override {
        if (std::string(PRT_GLSLANG).empty() || std::string(PRT_SPIRV_CROSS).empty())
            GTEST_SKIP() << "glslangValidator or spirv-cross is not installed";
    }
    std::string at(const std::string& name) const { return (folder / name).string(); }
    void succeeds(const std::string& program, const std::vector<std::string>& arguments) {
        const Outcome outcome = run(program, arguments);
        EXPECT_EQ(outcome.status, 0) << program << ": " << outcome.out << outcome.err;
    }
    /// SPIR-V, valid, and HLSL from it that compiles.
    void compiles_for_vulkan(const std::string& source, const std::string& stage) {
        succeeds(PRT_GLSLANG,
                 {"-V", "--target-env", "vulkan1.0", "-S", stage, at(source), "-o", at("s.spv")});
        succeeds(PRT_SPIRV_VAL, {"--target-env", "vulkan1.0", at("s.spv")});
        succeeds(PRT_SPIRV_CROSS, {at("s.spv"), "--hlsl", "--shader-model", "50", "--output", at("s.hlsl")});
        succeeds(PRT_GLSLANG, {"-D", "-V", "-S", stage, "-e", "main", at("s.hlsl"), "-o", at("h.spv")});
    }

    TemporaryFolder folder;
};

class Shader : public Tools, public testing::WithParamInterface<std::vector<std::string>> {
protected:
    void SetUp() override {
        Tools::SetUp();
        if (IsSkipped())
            return;
        triangle_file().write(folder / "t.glb");
        prt_once("b.glb", {"bake", at("t.glb"), "--rays", "16", "--order", "3"}, folder / "b.glb");
        std::vector<std::string> compress = {"compress", at("b.glb"), "-o", at("c.glb")};
        compress.insert(compress.end(), GetParam().begin(), GetParam().end());
        const Outcome outcome = prt(compress);
        ASSERT_EQ(outcome.status, 0) << outcome.err;
    }
};
INSTANTIATE_TEST_SUITE_P(
    Weights, Shader,
    testing::Values(std::vector<std::string>{}, std::vector<std::string>{"--preset", "u64"},
                    std::vector<std::string>{"--clusters", "1", "--bits", "200"},
                    std::vector<std::string>{"--bits", "float", "--clusters", "1"},
                    std::vector<std::string>{"--bits", "float", "--clusters", "2", "--components", "0"}));

TEST_P(Shader, CompilesInEveryLanguage) {
    for (const std::string language : {"glsl450", "glsl330", "essl300", "vulkan"})
        for (const std::string constants : {"buffer", "block", "texture"}) {
            const Outcome outcome = prt({"shader", at("c.glb"), "-o", at("s.vert"), "--language", language,
                                         "--constants", constants});
            if (constants == "buffer" && (language == "glsl330" || language == "essl300")) {
                EXPECT_EQ(outcome.status, 1);
                EXPECT_NE(outcome.err.find("storage buffers"), std::string::npos);
                continue;
            }
            ASSERT_EQ(outcome.status, 0) << outcome.err;
            EXPECT_NE(outcome.out.find("no loop"), std::string::npos) << outcome.out; // there is one cluster
            const std::string text = text_of(folder / "s.vert");
            EXPECT_EQ(text.find("#include"), std::string::npos); // self-contained
            for (const char* name : {"attribute", "position", "view_projection", "radiance"})
                EXPECT_NE(outcome.out.find(name), std::string::npos) << outcome.out;
            const std::size_t table = outcome.out.find("  attribute");
            ASSERT_NE(table, std::string::npos) << outcome.out;
            EXPECT_NE(text.find(outcome.out.substr(table + 2, outcome.out.find('\n', table) - table - 2)),
                      std::string::npos); // a comment in the file has the same table
            if (language == "vulkan")
                compiles_for_vulkan("s.vert", "vert");
            else
                succeeds(PRT_GLSLANG, {"-S", "vert", at("s.vert")});
        }
}

TEST_P(Shader, ConstantsAreComputedByComputeShaders) {
    for (const std::string language : {"glsl450", "vulkan"}) {
        const Outcome outcome =
            prt({"shader", at("c.glb"), "-o", at("s.comp"), "--stage", "compute", "--language", language});
        ASSERT_EQ(outcome.status, 0) << outcome.err;
        if (language == "vulkan")
            compiles_for_vulkan("s.comp", "comp");
        else
            succeeds(PRT_GLSLANG, {"-S", "comp", at("s.comp")});
    }
    EXPECT_EQ(prt({"shader", at("c.glb"), "-o", at("s.comp"), "--stage", "compute", "--language", "essl300"})
                  .status,
              1);
    EXPECT_EQ(prt({"shader", at("b.glb"), "-o", at("s.comp")}).status, 1);
}

using VolumeShader = Tools;

TEST_F(VolumeShader, HasOneLookupForEveryLanguage) {
    std::mt19937 random(1);
    for (const int order : {2, 3, 4}) {
        with_volume(triangle_file(), random_volume(order, false, random)).write(folder / "v.glb");
        const Outcome outcome = prt({"shader", at("v.glb"), "-o", at("v.glsl"), "--stage", "volume"});
        ASSERT_EQ(outcome.status, 0) << outcome.err;
        EXPECT_NE(outcome.out.find("RGBA16F"), std::string::npos) << outcome.out;
        // the file contains only a volume
        ASSERT_EQ(prt({"shader", at("v.glb"), "-o", at("again.glsl")}).status, 0);
        EXPECT_EQ(text_of(folder / "v.glsl"), text_of(folder / "again.glsl"));
        for (const char* stage : {"fragment", "instances"})
            EXPECT_EQ(prt({"shader", at("v.glb"), "-o", at("no.glsl"), "--stage", stage}).status, 1);
        const std::string use =
            "layout(location = 0) out vec4 color;\n"
            "void main() {\n"
            "    vec3 n = normalize(normal), light[PRT_VOLUME_COEFFICIENTS];\n"
            "    prt_volume_incident(position, n, light);\n"
            "    color = vec4(prt_volume_irradiance(position, n), 1.0);\n"
            "    color.a = prt_volume_sun_visibility(position, n);\n"
            "    color.rgb += prt_incident_radiance(light, prt_incident_direction(light));\n"
            "}\n";
        const std::string inputs = "in vec3 position;\nin vec3 normal;\n";
        for (const std::string version :
             {"#version 450\n", "#version 330\n",
              "#version 300 es\nprecision highp float;\nprecision highp int;\n"}) {
            std::ofstream(folder / "s.frag") << version << text_of(folder / "v.glsl") << inputs << use;
            succeeds(PRT_GLSLANG, {"-S", "frag", at("s.frag")});
        }
        std::ofstream(folder / "s.frag") << "#version 450\n"
                                         << text_of(folder / "v.glsl")
                                         << "layout(location = 0) in vec3 position;\n"
                                            "layout(location = 1) in vec3 normal;\n"
                                         << use;
        compiles_for_vulkan("s.frag", "frag");
    }
}

TEST_F(VolumeShader, ComputesLightInComputeShaders) {
    std::mt19937 random(2);
    for (const bool alike : {false, true}) {
        with_volume(triangle_file(), random_volume(3, alike, random)).write(folder / "v.glb");
        const std::vector<std::string> command = {"shader",  at("v.glb"),      "-o",        at("v.comp"),
                                                  "--stage", "volume-compute", "--language"};
        const auto in = [&](const std::string& language) {
            std::vector<std::string> arguments = command;
            arguments.push_back(language);
            return prt(arguments);
        };
        ASSERT_EQ(in("glsl450").status, 0);
        succeeds(PRT_GLSLANG, {"-S", "comp", at("v.comp")});
        ASSERT_EQ(in("vulkan").status, 0);
        compiles_for_vulkan("v.comp", "comp");
        EXPECT_EQ(in("essl300").status, 1);
    }
    triangle_file().write(folder / "t.glb");
    const Outcome outcome = prt({"shader", at("t.glb"), "-o", at("v.glsl"), "--stage", "volume"});
    EXPECT_EQ(outcome.status, 1);
    EXPECT_NE(outcome.err.find("no compressed volume"), std::string::npos) << outcome.err;
}

} // namespace
} // namespace prt::test
