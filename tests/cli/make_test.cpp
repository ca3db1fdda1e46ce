// Tests prt make and prt evaluate --measure budget, from the command line to the file.

#include "pipeline.h"
#include "prt/image/image_file.h"
#include "support/glb_file.h"

#include <algorithm>
#include <sstream>

namespace prt::test {
namespace {

std::string bytes_of(const std::filesystem::path& path) {
    std::ifstream file(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(file), {}};
}

/// Returns the arguments of a printed command line; its paths contain no spaces.
std::vector<std::string> arguments_of(const std::string& line) {
    std::istringstream words(line);
    std::vector<std::string> arguments{std::istream_iterator<std::string>(words), {}};
    arguments.erase(arguments.begin()); // prt
    return arguments;
}

class Make : public Pipeline {
protected:
    void SetUp() override { copy_examples(folder.path(), {"knot", "sky"}); }
    Outcome make(std::vector<std::string> options) const {
        options.insert(options.begin(), {"make", at("knot.glb"), "-o", at("s.glb"), "--lights", at("sky.exr"),
                                         "--json", at("m.json")});
        return prt(options);
    }
};

TEST_F(Make, MeetsTheErrorAndReportsEquivalentCommands) {
    const Outcome made = make({"--max-error", "0.1", "--keep-bake", at("b.glb")});
    ASSERT_EQ(made.status, 0) << made.err;
    const auto report = read_json(folder / "m.json");
    EXPECT_LE(report["total_error"], 0.1);
    EXPECT_LE(report["total_error_low"], report["total_error"]);
    EXPECT_GE(report["total_error_high"], report["total_error"]);
    const std::string baked = bytes_of(folder / "b.glb"), shipped = bytes_of(folder / "s.glb");
    for (const std::string line : report["commands"]) {
        const Outcome step = prt(arguments_of(line));
        ASSERT_EQ(step.status, 0) << line << '\n' << step.err;
    }
    EXPECT_TRUE(bytes_of(folder / "b.glb") == baked);
    EXPECT_TRUE(bytes_of(folder / "s.glb") == shipped);

    // Checks the guarantee with the other command: it needs one more bake, while points and paths are equal.
    const Outcome evaluated = prt({"evaluate", at("b.glb"), at("s.glb"), "--measure", "budget", "--lights",
                                   at("sky.exr"), "--json", at("e.json"), "--report", at("e.html")});
    ASSERT_EQ(evaluated.status, 0) << evaluated.err;
    const auto budget = read_json(folder / "e.json")["budget"][0];
    EXPECT_LE(budget["total"], 0.1);
    EXPECT_NEAR(budget["total"], report["total_error"], 0.01);
    EXPECT_NEAR(budget["sum_over_total"], 1, 0.15);
    EXPECT_GT(budget["rays_error"], 0);
    EXPECT_GT(budget["bytes_error"], 0);
    const auto visible = read_json(folder / "e.json")["visible_budget"][0];
    EXPECT_GT(visible["total"], 0);
    EXPECT_NEAR(visible["total"], report["total_contrast_error"], 0.02);
    EXPECT_NE(bytes_of(folder / "e.html").find("\"bars\""), std::string::npos);
}

TEST_F(Make, KeepsTheByteLimit) {
    ASSERT_EQ(make({"--bytes-per-vertex", "4.5", "--max-error", "0.1"}).status, 2);
    const Outcome made = make({"--bytes-per-vertex", "4.5", "--seconds", "5"});
    ASSERT_EQ(made.status, 0) << made.err;
    EXPECT_LE(read_json(folder / "m.json")["bytes_bound_per_vertex_with_bases"], 4.5);
    const Outcome none = make({"--bytes-per-vertex", "1", "--seconds", "5"});
    EXPECT_EQ(none.status, 1);
    EXPECT_NE(none.err.find("--bytes-per-vertex 1 cannot be reached"), std::string::npos) << none.err;
}

TEST_F(Make, ReportsWhyAnErrorIsNotMet) {
    const Outcome none = make({"--max-error", "0.001", "--seconds", "5"});
    EXPECT_EQ(none.status, 1);
    EXPECT_NE(none.err.find("an error of 0.10 % cannot be reached"), std::string::npos) << none.err;
    EXPECT_FALSE(std::filesystem::exists(folder / "s.glb"));
}

TEST_F(Make, ReportsMissingBounces) {
    ASSERT_EQ(prt({"bake", at("knot.glb"), "-o", at("b.glb"), "--order", "4", "--rays", "64"}).status, 0);
    const Outcome evaluated = prt(
        {"evaluate", at("b.glb"), "--measure", "budget", "--lights", at("sky.exr"), "--json", at("e.json")});
    ASSERT_EQ(evaluated.status, 0) << evaluated.err;
    const auto report = read_json(folder / "e.json");
    EXPECT_EQ(report["advice_option"], "prt bake --bounces inf");
    EXPECT_GT(report["budget"][0]["bounces_error"], 0.1);
    EXPECT_LT(report["total_error_with_advice"], 0.1);
}

TEST_F(Pipeline, RejectsBudgetsBeyondPathTracing) {
    triangle_file().write(folder / "t.glb");
    ASSERT_EQ(prt({"bake", at("t.glb"), "-o", at("b.glb"), "--rays", "64", "--subsurface", "marble"}).status,
              0);
    const Outcome medium = prt({"evaluate", at("b.glb"), "--measure", "budget"});
    EXPECT_EQ(medium.status, 1);
    EXPECT_NE(medium.err.find("passes through a medium"), std::string::npos) << medium.err;
    EXPECT_EQ(std::count(medium.err.begin(), medium.err.end(), '\n'), 1) << medium.err;
    EXPECT_EQ(prt({"evaluate", at("b.glb"), "--measure", "budget", "--rotations", "4"}).status, 2);
    EXPECT_EQ(prt({"make", at("t.glb"), "-o", at("s.glb")}).status, 2); // lights are required
    GlbFile wax = triangle_file();
    wax.json["materials"] = {
        {{"name", "wax"},
         {"extensions",
          {{"KHR_materials_diffuse_transmission", {{"diffuseTransmissionFactor", 1}}},
           {"KHR_materials_volume", {{"thicknessFactor", 1}, {"attenuationDistance", 0.01}}}}}}};
    wax.json["meshes"][0]["primitives"][0]["material"] = 0;
    wax.write(folder / "wax.glb");
    write_exr(folder / "sky.exr", {2, 1, std::vector<glm::vec3>(2, glm::vec3(1))});
    const Outcome made = prt({"make", at("wax.glb"), "-o", at("s.glb"), "--lights", at("sky.exr")});
    EXPECT_EQ(made.status, 1);
    EXPECT_NE(made.err.find("'wax'"), std::string::npos) << made.err;
}

} // namespace
} // namespace prt::test
