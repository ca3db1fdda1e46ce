// Dragging, and the geometry behind it.

#include "ui/commands.h"
#include "ui/controls.h"

#include "prt/core/error.h"
#include "prt/gl/gl_context.h"

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include <fstream>
#include <set>
#include <sstream>

namespace viewer {
namespace {

const Screen kScreen{{{1, 2, 5}, {0, 0.5f, 0}, {0, 1, 0}, 0.7f}, {640, 360}};

TEST(Screen, PixelsAndDirectionsAreInverse) {
    for (const glm::vec2 pixel : {glm::vec2(0, 0), {320, 180}, {77, 300}, {639, 12}}) {
        const glm::vec3 point = kScreen.camera.position + 3.0f * direction_through(kScreen, pixel);
        const auto back = pixel_of(kScreen, point);
        ASSERT_TRUE(back);
        EXPECT_NEAR(back->x, pixel.x, 0.01f);
        EXPECT_NEAR(back->y, pixel.y, 0.01f);
    }
    EXPECT_FALSE(pixel_of(kScreen, kScreen.camera.position + glm::vec3(0, 0, 1)));
}

TEST(Screen, DirectionsOnASphereMeetThePixel) {
    const glm::vec3 center(0.2f, 0.4f, 0);
    for (const bool far_side : {false, true})
        for (const glm::vec2 pixel : {glm::vec2(300, 170), {350, 200}, {320, 150}}) {
            const glm::vec3 d = direction_on_sphere(kScreen, pixel, center, 0.8f, far_side);
            EXPECT_NEAR(glm::length(d), 1, 1e-5f);
            const auto back = pixel_of(kScreen, center + 0.8f * d);
            ASSERT_TRUE(back);
            EXPECT_LT(glm::distance(*back, pixel), 0.05f);
            EXPECT_EQ(glm::dot(d, kScreen.camera.position - center) > 0, !far_side);
        }
    // Outside the sphere: its outline.
    const glm::vec3 d = direction_on_sphere(kScreen, {0, 180}, center, 0.8f, false);
    EXPECT_NEAR(glm::length(d), 1, 1e-5f);
}

TEST(OrbitCamera, RotatesAboutItsTarget) {
    const prt::Camera before{{3, 2, 4}, {1, 1, 1}, {0, 1, 0}, 0.6f};
    OrbitCamera orbit(before);
    EXPECT_LT(glm::distance(orbit.camera().position, before.position), 1e-5f);
    orbit.orbit({0.5f, 0}); // half a height: a quarter rotation
    const glm::vec3 a = before.position - before.target, b = orbit.camera().position - before.target;
    EXPECT_NEAR(glm::length(b), glm::length(a), 1e-5f);
    EXPECT_NEAR(b.x * a.x + b.z * a.z, 0, 1e-4f);
    EXPECT_EQ(orbit.camera().target, before.target);
    orbit.orbit({0, 10}); // never over the top
    EXPECT_NO_THROW(prt::camera_frame(orbit.camera()));
    orbit.zoom(5);
    EXPECT_NEAR(glm::distance(orbit.camera().position, before.target), glm::length(a) / 2, 1e-4f);
}

TEST(OrbitCamera, PanMovesTheTargetWithThePointer) {
    OrbitCamera orbit(kScreen.camera);
    const auto before = pixel_of({orbit.camera(), kScreen.size}, {0, 0.5f, 0});
    orbit.pan({36.0f / 360, -18.0f / 360});
    const auto after = pixel_of({orbit.camera(), kScreen.size}, {0, 0.5f, 0});
    EXPECT_NEAR(after->x - before->x, 36, 0.5f);
    EXPECT_NEAR(after->y - before->y, -18, 0.5f);
}

TEST(Controls, EveryKeyOfTheTableDoesSomething) {
    const auto context = prt::GlContext::create(prt::GlDevice::any);
    ASSERT_TRUE(context);
    Viewer viewer;
    Controls controls(viewer);
    int calls = 0;
    controls.screenshot = controls.quit = [&] { ++calls; };
    for (const Command& command : commands()) {
        if (command.key == 0 || command.key == 'R') // without a model there is nothing to see
            continue;
        viewer.dismiss_messages();
        const Settings settings = viewer.settings;
        const LightSettings lights = viewer.lights;
        const int calls_before = calls;
        EXPECT_TRUE(controls.key(command.key)) << command.key;
        EXPECT_TRUE(!(viewer.settings == settings) || !(viewer.lights == lights) || calls > calls_before ||
                    !viewer.messages().empty())
            << command.key;
    }
    EXPECT_EQ(calls, 2);
    EXPECT_FALSE(controls.key('\1'));
    EXPECT_FALSE(controls.key(0));
}

TEST(Commands, HaveEachKeyAndEachNameOnce) {
    std::set<std::string> ids;
    std::set<char> keys;
    for (const Command& command : commands()) {
        EXPECT_TRUE(*command.id == 0 || ids.insert(command.id).second) << command.id;
        EXPECT_TRUE(command.key == 0 || keys.insert(command.key).second) << command.key;
        EXPECT_TRUE(command.setting || command.press);
        if (*command.id != 0) {
            EXPECT_EQ(&setting(command.id), &command);
        }
    }
    EXPECT_THROW(setting("nothing"), prt::Error);
}

/// Returns the words between backticks in `text`.
std::set<std::string> quoted(const std::string& text) {
    std::set<std::string> words;
    for (std::size_t at = text.find('`'); at != std::string::npos; at = text.find('`', at + 1)) {
        const std::size_t end = text.find('`', at + 1);
        words.insert(text.substr(at + 1, end - at - 1));
        at = end;
    }
    return words;
}

TEST(Commands, MatchTheDocumentation) {
    std::ifstream page(PRT_DOCS "/viewer.md");
    std::set<std::string> documented_keys, documented_ids;
    for (std::string line; std::getline(page, line);) {
        const std::string first = line.substr(0, line.find('|', 1));
        if (line.starts_with("| `{\"set\""))
            documented_ids = quoted(line.substr(first.size()));
        if (!line.starts_with("| ") || first.find('`') != std::string::npos)
            continue;
        std::istringstream words(first.substr(2));
        for (std::string word; words >> word;) {
            if (word.size() > 1 && word.ends_with(','))
                word.pop_back();
            if (word.size() == 1 || word == "Space" || word == "Tab")
                documented_keys.insert(word);
        }
    }
    std::set<std::string> keys, ids;
    for (const Command& command : commands()) {
        if (command.key != 0)
            keys.insert(command.key == ' '    ? "Space"
                        : command.key == '\t' ? "Tab"
                                              : std::string(1, command.key));
        if (*command.id != 0)
            ids.insert(command.id);
    }
    for (const PictureName& name : kPictures)
        ids.insert(name.id);
    EXPECT_EQ(documented_keys, keys);
    EXPECT_EQ(documented_ids, ids);
}

} // namespace
} // namespace viewer
