// Tests the experience of a first-time user: one helpful line, before any work starts.

#include "program.h"
#include "prt/image/image_file.h"
#include "support/glb_file.h"
#include "support/scene_builder.h"
#include "support/temporary_folder.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <map>
#include <set>

namespace prt::test {
namespace {

/// The rows of CSV (RFC 4180), by the names of the header. A test with a row of another width fails.
std::vector<std::map<std::string, std::string>> rows_of_csv(const std::string& csv) {
    std::vector<std::vector<std::string>> lines(1, std::vector<std::string>(1));
    bool quoted = false;
    for (const char c : csv)
        if (c == '"')
            quoted = !quoted; // a doubled quote is lost: no test has one
        else if (c == ',' && !quoted)
            lines.back().emplace_back();
        else if (c == '\n' && !quoted)
            lines.emplace_back(1);
        else
            lines.back().back() += c;
    lines.pop_back(); // behind the last end of a line
    std::vector<std::map<std::string, std::string>> rows;
    for (std::size_t i = 1; i < lines.size(); ++i) {
        EXPECT_EQ(lines[i].size(), lines[0].size()) << csv;
        std::map<std::string, std::string>& row = rows.emplace_back();
        for (std::size_t c = 0; c < lines[0].size(); ++c)
            row[lines[0][c]] = c < lines[i].size() ? lines[i][c] : "";
    }
    return rows;
}

class FirstHour : public testing::Test {
protected:
    void SetUp() override { triangle_file().write(folder / "t.glb"); }
    std::string at(const std::string& name) const { return (folder / name).string(); }
    std::string text(const char* name) const {
        std::ifstream file(folder / name);
        return {std::istreambuf_iterator<char>(file), {}};
    }
    /// Expects one line with `words`, that status, and no file more.
    void expect_line(const std::vector<std::string>& arguments, int status, const std::string& words) {
        const std::size_t before = folder.files();
        const Outcome outcome = prt(arguments);
        EXPECT_EQ(outcome.status, status) << outcome.err;
        EXPECT_TRUE(outcome.err.starts_with("prt: error: ")) << outcome.err;
        EXPECT_EQ(std::count(outcome.err.begin(), outcome.err.end(), '\n'), 1) << outcome.err;
        EXPECT_NE(outcome.err.find(words), std::string::npos) << outcome.err;
        for (const char* inner : {"json.exception", "_M_range_check", "std::", "tinygltf"})
            EXPECT_EQ(outcome.err.find(inner), std::string::npos) << outcome.err;
        EXPECT_EQ(folder.files(), before);
    }
    void bake_and_compress() {
        prt_once("b.glb", {"bake", at("t.glb"), "--rays", "16", "--order", "3"}, folder / "b.glb");
        prt_once("c.glb", {"compress", at("b.glb")}, folder / "c.glb");
    }

    TemporaryFolder folder;
};

TEST_F(FirstHour, OutputsAreCheckedBeforeWorkBegins) {
    // A bake with this number of rays would take hours: an immediate end shows that nothing was baked.
    const std::vector<std::string> bake = {"bake", at("t.glb"), "--rays", "16777216"};
    const auto with = [&](std::vector<std::string> more) {
        more.insert(more.begin(), bake.begin(), bake.end());
        return more;
    };
    expect_line(with({"-o", at("b.png")}), 1, ".glb");
    expect_line(with({"-o", at("b.gltf")}), 1, ".glb");
    expect_line(with({"-o", at("no/such/b.glb")}), 1, "No such file or directory");
    expect_line(with({"-o", folder.path().string()}), 1, "is a folder");
    expect_line(with({"-o", at("t.glb")}), 1, "is an input");
    expect_line(with({"-o", at("b.glb"), "--json", at("b.txt")}), 1, ".json");
    expect_line(with({"-o", at("b.glb"), "--json", at("no/b.json")}), 1, "no/b.json");
    expect_line(with({"-o", at("b"), "--json", at("b")}), 1, "would be one file");
}

TEST_F(FirstHour, EveryWritingCommandChecksItsOutputs) {
    bake_and_compress();
    write_exr(folder / "e.exr", {4, 2, std::vector<glm::vec3>(8, glm::vec3(1))});
    expect_line({"compress", at("b.glb"), "-o", at("c.png")}, 1, ".glb");
    expect_line({"compress", at("b.glb"), "-o", at("b.glb")}, 1, "is an input");
    expect_line({"evaluate", at("b.glb"), at("c.glb"), "--report", at("no/r.html")}, 1, "no/r.html");
    expect_line({"evaluate", at("b.glb"), at("c.glb"), "--report", at("r.txt")}, 2, ".csv");
    expect_line({"project", at("e.exr"), "-o", at("light.exr")}, 1, ".json");
    expect_line({"project", at("e.exr"), "-o", at("light")}, 1, ".json");
    expect_line({"render", at("c.glb"), "--lights", at("e.exr"), "-o", at("p.jpg")}, 1, ".png or .exr");
    expect_line({"render", at("c.glb"), "--lights", at("e.exr"), "-o", at("e.exr")}, 1, "is an input");
    expect_line({"shader", at("c.glb"), "-o", at("s.png")}, 1, "s.png");
    expect_line({"bench", at("t.glb"), "--report", at("b.json")}, 2, ".html");
    expect_line({"info", at("c.glb"), "--json", at("no/i.json")}, 1, "no/i.json");
}

TEST_F(FirstHour, OtherFormatsSuggestGltfExport) {
    folder.file("m.dae", "<COLLADA>");
    folder.file("m.stl", "solid\n");
    folder.file("m.fbx", "Kaydara FBX Binary  ");
    folder.file("m.glb", "this is no model");
    for (const char* name : {"m.dae", "m.stl", "m.fbx", "m.glb"})
        expect_line({"bake", at(name), "-o", at("o.glb")}, 1, "export the scene as glTF 2.0 (.glb)");
    folder.file("broken.gltf", "{\n  \"asset\": {\"version\": \"2.0\"},\n  \"nodes\": [,]\n}");
    expect_line({"bake", at("broken.gltf"), "-o", at("o.glb")}, 1, "line 3");
    folder.file("wrong.gltf", "{\"asset\": {\"version\": 2}}");
    expect_line({"bake", at("wrong.gltf"), "-o", at("o.glb")}, 1, "wrong.gltf");
}

TEST_F(FirstHour, MissingAndMisspeltCommandsAreReported) {
    expect_line({"bak", at("t.glb")}, 2, "did you mean bake?");
    expect_line({"evalaute"}, 2, "did you mean evaluate?");
    expect_line({"frobnicate"}, 2, "compress");
    expect_line({"evaluate", at("t.glb")}, 2, "prt evaluate BAKED.glb SHIPPED.glb");
    const Outcome alone = prt({});
    EXPECT_EQ(alone.status, 2);
    for (const char* command : {"bake", "compress", "evaluate", "render"})
        EXPECT_NE(alone.out.find(command), std::string::npos);
}

TEST_F(FirstHour, MisspeltOptionsAreReportedAlone) {
    expect_line({"bake", "--ray", "5", at("t.glb"), "-o", at("o.glb")}, 2, "'--ray'; did you mean --rays?");
    expect_line({"bake", at("t.glb"), "--ordre=5", "-o", at("o.glb")}, 2, "'--ordre'; did you mean --order?");
    expect_line({"--versoin"}, 2, "'--versoin'; did you mean --version?");
    expect_line({"bake", at("t.glb"), "-o", ""}, 2, "--output: the name of the file is empty");
}

TEST_F(FirstHour, NounsAgreeWithTheirNumbers) {
    const Outcome outcome = prt({"bake", at("t.glb"), "-o", at("b.glb"), "--rays", "16", "--bounces", "1"});
    ASSERT_EQ(outcome.status, 0) << outcome.err;
    EXPECT_NE(outcome.out.find(": 3 receivers, 1 triangle, order 6, "), std::string::npos) << outcome.out;
    EXPECT_NE(outcome.out.find(", 16 rays per receiver, 0 bounces\n"), std::string::npos) << outcome.out;
}

TEST_F(FirstHour, OptionsMayPrecedeFiles) {
    bake_and_compress();
    write_png(folder / "sky.png", 4, 2, std::vector<glm::u8vec3>(8, glm::u8vec3(188)));
    ASSERT_EQ(prt({"project", at("sky.png"), "-o", at("l.json")}).status, 0);
    const Outcome evaluated = prt({"evaluate", "--lights", at("l.json"), "--lights", at("sky.png"), "--json",
                                   at("e.json"), at("b.glb"), at("c.glb")});
    EXPECT_EQ(evaluated.status, 0) << evaluated.err;
    EXPECT_EQ(nlohmann::json::parse(text("e.json"))["lights"].size(), 4u); // suns and noise always are
    const Outcome compressed = prt({"compress", "--lights", at("l.json"), at("b.glb"), "-o", at("q.glb")});
    EXPECT_EQ(compressed.status, 0) << compressed.err;
}

TEST_F(FirstHour, ShadersAcceptOnlySupportedFeaturesOfTheirLanguage) {
    bake_and_compress();
    for (const char* language : {"essl300", "glsl330"}) {
        const Outcome outcome = prt({"shader", at("c.glb"), "-o", at("s.vert"), "--language", language});
        EXPECT_EQ(outcome.status, 0) << outcome.err;
        EXPECT_NE(text("s.vert").find("PRT_CONSTANTS_TEXTURE"), std::string::npos);
    }
}

TEST_F(FirstHour, SkiesOfEightBitsAreReadWithANotice) {
    write_png(folder / "sky.png", 4, 2, std::vector<glm::u8vec3>(8, glm::u8vec3(188)));
    const Outcome outcome = prt({"project", at("sky.png"), "-o", at("l.json"), "--json", at("r.json")});
    ASSERT_EQ(outcome.status, 0) << outcome.err;
    EXPECT_NE(outcome.err.find("clipped"), std::string::npos) << outcome.err;
    const auto report = nlohmann::json::parse(text("r.json"));
    EXPECT_NEAR(report["mean_radiance"][0].get<double>(), std::pow((188 / 255.0 + 0.055) / 1.055, 2.4), 1e-4);
}

TEST_F(FirstHour, TheVerdictFallsWithTheErrorAndItsFiguresAreExplained) {
    test::scene_file(test::SceneBuilder().floor({0, -0.5f, 0}, 1.5f, 10).sphere({0, 0, 0}, 0.5f, 12).build())
        .write(folder / "ball.glb");
    ASSERT_EQ(prt({"bake", at("ball.glb"), "-o", at("b.glb"), "--rays", "64", "--order", "3"}).status, 0);
    const auto verdict_of = [&](const char* clusters, const char* components) {
        const Outcome made = prt({"compress", at("b.glb"), "-o", at("c.glb"), "--bits", "float", "--clusters",
                                  clusters, "--components", components});
        EXPECT_EQ(made.status, 0) << made.err;
        return prt({"evaluate", at("b.glb"), at("c.glb")}).out;
    };
    const std::string mean = verdict_of("1", "0"), all = verdict_of("1", "9");
    EXPECT_NE(mean.find("clearly visible difference"), std::string::npos)
        << mean; // every vertex has the mean's light
    EXPECT_NE(all.find("no visible difference from the bake"), std::string::npos)
        << all;                                                            // all data are included
    EXPECT_NE(all.find("lit_rms: relative L2"), std::string::npos) << all; // the meaning of the columns
}

TEST_F(FirstHour, SmallMeshesReportFittedSizes) {
    test::scene_file(test::SceneBuilder().floor({0, -0.5f, 0}, 1.5f, 10).sphere({0, 0, 0}, 0.5f, 12).build())
        .write(folder / "small.glb");
    ASSERT_EQ(prt({"bake", at("small.glb"), "-o", at("b.glb"), "--rays", "64"}).status, 0);
    const Outcome outcome = prt({"compress", at("b.glb"), "-o", at("c.glb"), "--json", at("c.json")});
    ASSERT_EQ(outcome.status, 0) << outcome.err;
    EXPECT_NE(outcome.out.find("fitted"), std::string::npos) << outcome.out;
    const auto json = nlohmann::json::parse(text("c.json"));
    EXPECT_LE(json["bytes_bases"], 4096u + 12u * json["receivers"].get<unsigned>());
    const Outcome floats =
        prt({"compress", at("b.glb"), "-o", at("c.glb"), "--bits", "float", "--json", at("c.json")});
    EXPECT_NE(floats.out.find("clusters are fitted"), std::string::npos) << floats.out;
    EXPECT_GT(nlohmann::json::parse(text("c.json"))["components_mean"], 1);
}

TEST_F(FirstHour, EvaluationsBeginWithAVerdictAndAllReportsContainTheFigures) {
    bake_and_compress();
    const Outcome outcome = prt({"evaluate", at("b.glb"), at("c.glb"), "--json", at("e.json"), "--report",
                                 at("e.html"), "--report", at("e.csv")});
    ASSERT_EQ(outcome.status, 0) << outcome.err;
    const std::string verdict = outcome.out.substr(0, outcome.out.find('\n'));
    EXPECT_TRUE(verdict.starts_with("4 bytes per vertex, ")) << verdict; // a lone triangle is exact
    EXPECT_NE(verdict.find("no visible difference from the bake"), std::string::npos) << verdict;
    const auto json = nlohmann::json::parse(text("e.json"));
    EXPECT_EQ(json["verdict"], verdict);
    EXPECT_EQ(json["bytes_bound_per_vertex"], 4);
    const std::string page = text("e.html"), csv = text("e.csv");
    for (const char* term :
         {"b.glb", "c.glb", "prt evaluate", "prefers-color-scheme", "UTC", "Bake, under", "Shipped file"})
        EXPECT_NE(page.find(term), std::string::npos) << term;
    EXPECT_NE(page.find(verdict), std::string::npos);
    EXPECT_EQ(page.find("{{"), std::string::npos);
    const std::vector<std::map<std::string, std::string>> rows = rows_of_csv(csv);
    const auto row_of = [&](const std::string& table, const std::string& light) {
        const auto found = std::ranges::find_if(
            rows, [&](const auto& row) { return row.at("table") == table && row.at("light") == light; });
        EXPECT_NE(found, rows.end()) << table << " " << light << "\n" << csv;
        return found == rows.end() ? rows.front() : *found;
    };
    EXPECT_EQ(row_of("lights", "uniform").at("lit_rms [1]"), json["lights"][0]["lit_rms"].dump());
    EXPECT_EQ(row_of("lights", "uniform").at("bytes_bound_per_vertex [B]"), "");
    EXPECT_EQ(row_of("summary", "").at("bytes_bound_per_vertex [B]"), "4");
}

TEST_F(FirstHour, TheCsvOfASweepHasOneRowForEachMethodAndBudget) {
    prt_once("b.glb", {"bake", at("t.glb"), "--rays", "16", "--order", "3"}, folder / "b.glb");
    const Outcome outcome =
        prt({"evaluate", at("b.glb"), "--measure", "sweep", "--report", at("e.csv"), "--json", at("e.json")});
    ASSERT_EQ(outcome.status, 0) << outcome.err;
    const auto json = nlohmann::json::parse(text("e.json"));
    std::set<std::vector<std::string>> seen;
    for (const auto& row : rows_of_csv(text("e.csv")))
        if (row.at("table").starts_with("sweep/")) {
            EXPECT_TRUE(seen.insert({row.at("table"), row.at("method"), row.at("setting")}).second);
            for (const char* name :
                 {"bytes_per_vertex [B]", "shader_operations", "lit_rms [1]", "seconds [s]"})
                EXPECT_NE(row.at(name), "") << name;
        }
    EXPECT_EQ(seen.size(),
              json["sweep"]["equal_bytes"].size() + json["sweep"]["equal_shader_operations"].size());
}

TEST_F(FirstHour, AMeshWithoutNormalsReportsHowItsVerticesGrow) {
    GlbFile file = triangle_file();
    file.json["meshes"][0]["primitives"][0]["attributes"].erase("NORMAL");
    file.write(folder / "t.glb");
    for (const auto& [option, words] :
         {std::pair("--fit=auto", "flat shading is used: 3 vertices become 3"),
          std::pair("--smooth-normals=30", "normals are created, smooth across edges")}) {
        const Outcome outcome =
            prt({"bake", at("t.glb"), "-o", at("n.glb"), "--rays", "16", "--order", "2", option});
        EXPECT_EQ(outcome.status, 0);
        EXPECT_NE(outcome.err.find(words), std::string::npos) << outcome.err;
    }
    expect_line({"bake", at("t.glb"), "-o", at("m.glb"), "--smooth-normals", "181"}, 2, "--smooth-normals");
}

TEST_F(FirstHour, LargeUniformBlocksAreReported) {
    const std::string baked = fixture("knot.baked.glb");
    for (const auto& [clusters, large] : {std::pair("20", false), std::pair("1100", true)}) {
        ASSERT_EQ(
            prt({"compress", baked, "-o", at("c.glb"), "--clusters", clusters, "--components", "1"}).status,
            0);
        const Outcome outcome = prt({"shader", at("c.glb"), "-o", at("s.vert"), "--constants", "block"});
        EXPECT_EQ(outcome.status, 0);
        EXPECT_EQ(outcome.err.find("16384 are guaranteed") != std::string::npos, large) << outcome.err;
    }
}

} // namespace
} // namespace prt::test
