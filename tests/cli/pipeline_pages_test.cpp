// Tests the pages of commands in a browser.

#include "pipeline.h"
#include "support/glb_file.h"

#include <set>
#include <string_view>

namespace prt::test {
namespace {

std::size_t count(const std::string& text, std::string_view term) {
    std::size_t found = 0;
    for (std::size_t at = text.find(term); at != std::string::npos; at = text.find(term, at + 1))
        ++found;
    return found;
}

/// Expects that a page loads no other file, local or remote.
void expect_standing_alone(const std::filesystem::path& path) {
    std::ifstream file(path);
    const std::string page{std::istreambuf_iterator<char>(file), {}};
    for (const char* loading :
         {"src=", "href", "@import", "url(", "fetch(", "import(", "XMLHttpRequest", "{{"})
        EXPECT_EQ(page.find(loading), std::string::npos) << loading;
    EXPECT_EQ(count(page, "</script>"), 2u); // the report and the script that draws it
}

/// Returns the elements of a page after its script has run; empty if there is no browser.
std::string drawn_page(const std::filesystem::path& path) {
    if (std::string(PRT_CHROMIUM).empty())
        return {};
    const Outcome outcome = run(PRT_CHROMIUM, {"--headless", "--no-sandbox", "--disable-gpu",
                                               "--user-data-dir=" + path.string() + ".profile", "--dump-dom",
                                               "file://" + path.string()});
    EXPECT_EQ(outcome.status, 0) << outcome.err;
    return outcome.out;
}

TEST_F(Pipeline, SweepsAreSelfContainedPages) {
    triangle_file().write(folder / "t.glb");
    ASSERT_EQ(prt({"bake", at("t.glb"), "-o", at("b.glb"), "--rays", "16", "--order", "2"}).status, 0);
    const Outcome evaluate =
        prt({"evaluate", at("b.glb"), "--sweep", "--json", at("e.json"), "--html", at("e.html")});
    ASSERT_EQ(evaluate.status, 0) << evaluate.err;
    const auto sweep = read_json(folder / "e.json")["sweep"];
    EXPECT_GT(sweep["equal_bytes"].size(), 3u);
    EXPECT_GT(sweep["equal_shader_operations"].size(), 3u);
    EXPECT_TRUE(sweep["equal_bytes"][0]["jumps_percentile_99"].is_number());
    expect_standing_alone(folder / "e.html");
    const std::string drawn = drawn_page(folder / "e.html");
    if (drawn.empty())
        GTEST_SKIP() << "chromium is not installed";
    EXPECT_EQ(count(drawn, "<svg"), 2u);
    std::size_t curves = 0;
    for (const char* points : {"equal_bytes", "equal_shader_operations"}) {
        std::set<std::string> methods = {"prtkit"}; // is listed even without a point
        for (const auto& point : sweep[points])
            methods.insert(point["method"]);
        curves += methods.size();
    }
    EXPECT_EQ(count(drawn, "<polyline"), curves);
    EXPECT_NE(drawn.find("<h2>Error at equal bytes</h2>"), std::string::npos);
}

TEST_F(Pipeline, BenchMeasuresEveryBackendAndMethod) {
    triangle_file().write(folder / "a<b>&.glb");
    const Outcome bench = prt({"bench", at("a<b>&.glb"), "--from", "16", "--to", "64", "--order", "3",
                               "--json", at("bench.json"), "--html", at("bench.html")});
    ASSERT_EQ(bench.status, 0) << bench.err;
    const auto report = read_json(folder / "bench.json");
    EXPECT_EQ(report["reference_rays"], 64 * 64);
    ASSERT_EQ(report["runs"].size(), 12u); // four ways, three numbers of rays
    for (const auto& run : report["runs"]) {
        EXPECT_LT(run["relative_l2"], 1e-5); // a lone triangle is open: no sampling error at all
        EXPECT_LT(run["surface_l2"], 1e-5);
        EXPECT_GT(run["seconds"], 0);
    }
    expect_standing_alone(folder / "bench.html");
    const std::string drawn = drawn_page(folder / "bench.html");
    if (drawn.empty())
        GTEST_SKIP() << "chromium is not installed";
    EXPECT_EQ(count(drawn, "<svg"), 3u); // error at and between vertices over time, speed over rays
    EXPECT_EQ(count(drawn, "<td>cpu trace</td>"), 3u);
    EXPECT_EQ(count(drawn, "<td>cpu trace fitted</td>"), 3u);
    EXPECT_EQ(count(drawn, "<polyline"), 12u); // one way is missing: no ray queries
    EXPECT_EQ(drawn.find("NaN"), std::string::npos);
    // Names are escaped as text, not markup.
    EXPECT_NE(drawn.find("a&lt;b&gt;&amp;.glb"), std::string::npos);
}

} // namespace
} // namespace prt::test
