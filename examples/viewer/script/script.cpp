// Executes the steps of a script: a table of functions on a player.

#include "script/script.h"

#include "gpu/offscreen.h"
#include "script/figure_step.h"
#include "script/figures_json.h"
#include "script/lamp_step.h"
#include "ui/commands.h"
#include "ui/controls.h"
#include "ui/user_interface.h"

#include "prt/core/error.h"
#include "prt/gl/gl_context.h"
#include "runtime/core/support/file.h"

#include <epoxy/gl.h>
#include <fmt/core.h>
#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <functional>
#include <thread>

namespace viewer {
namespace {

using Json = nlohmann::json;

constexpr double kPatience = 600; ///< maximum waiting time of a step, seconds

// ---- values of steps

glm::vec3 vec3(const Json& json) {
    return {json.at(0).get<float>(), json.at(1).get<float>(), json.at(2).get<float>()};
}

glm::vec2 vec2(const Json& json, std::size_t first = 0) {
    return {json.at(first).get<float>(), json.at(first + 1).get<float>()};
}

template <class T>
void take(const Json& json, const char* name, T& value) {
    if (json.contains(name))
        value = json.at(name).get<T>();
}

/// Returns the row of `table` with this `id`; `what` names its rows in the error message.
template <class Table>
const auto& named(const Table& table, const std::string& id, const char* what) {
    const auto row = std::ranges::find_if(table, [&](const auto& r) { return r.id == id; });
    if (row == std::end(table))
        throw prt::Error(fmt::format("unknown {} '{}'", what, id));
    return *row;
}

void take_number(const Json& json, const Command& command, float& value) {
    const auto number = json.get<float>();
    if (command.range.strict && !(number >= command.range.low && std::isfinite(number)))
        throw prt::Error(fmt::format("{} must be a finite number of at least {}, not {}", command.id,
                                     command.range.low, json.dump()));
    value = number;
}

/// Changes the setting of `command` to the value in `json`.
void take(const Json& json, const Command& command, Settings& settings) {
    const SettingPointer pointer = command.setting(settings);
    if (PictureKind* const* kind = std::get_if<PictureKind*>(&pointer))
        **kind = named(kPictures, json, "picture").kind;
    else if (bool* const* on = std::get_if<bool*>(&pointer))
        **on = json.get<bool>();
    else if (int* const* number = std::get_if<int*>(&pointer))
        **number = json.get<int>();
    else
        take_number(json, command, *std::get<float*>(pointer));
}

RigLight light_of(const Json& json) {
    RigLight light = make_light(named(kLights, json.at("kind"), "light").kind);
    if (json.contains("direction"))
        light.direction = glm::normalize(vec3(json.at("direction")));
    if (json.contains("color"))
        light.color = vec3(json.at("color"));
    take(json, "size", light.size);
    take(json, "distance", light.distance);
    take(json, "strength", light.strength);
    return light;
}

// ---- the player

/// The viewer, its controls and panels, and an offscreen target for them.
struct Player {
    explicit Player(std::filesystem::path script_folder) : folder(std::move(script_folder)) {
        make_context();
    }
    void make_context();
    void make_interface(float scale) {
        interface.reset(); // Dear ImGui supports one context at a time
        interface = std::make_unique<UserInterface>(nullptr, scale);
    }
    void draw(int frames = 1);
    /// Draws frames until `done`, then one more.
    void wait(const std::function<bool()>& done, const char* what);
    std::filesystem::path path(const Json& json) const { return folder / json.get<std::string>(); }
    void fail_on_message() const {
        if (!viewer->messages().empty())
            throw prt::Error(viewer->messages().back());
    }

    std::filesystem::path folder;
    glm::ivec2 size{640, 360};
    std::unique_ptr<prt::GlContext> context;
    std::unique_ptr<Offscreen> screen;
    std::unique_ptr<Viewer> viewer;
    std::unique_ptr<Controls> controls;
    std::unique_ptr<UserInterface> interface;
};

void Player::make_context() {
    std::string why;
    context = prt::GlContext::create(prt::GlDevice::any, &why);
    if (!context)
        throw prt::Error("OpenGL 4.5 is not available (" + why + ")");
    screen = std::make_unique<Offscreen>(size.x, size.y);
    if (!viewer) {
        viewer = std::make_unique<Viewer>();
        controls = std::make_unique<Controls>(*viewer);
    } else {
        viewer->restore_gpu();
    }
    make_interface(1);
}

void Player::draw(int frames) {
    for (int frame = 0; frame < frames; ++frame) {
        viewer->update(1.0 / 60);
        viewer->draw(screen->framebuffer(), size.x, size.y);
        interface->draw(*viewer, screen->framebuffer(), size.x, size.y);
    }
}

void Player::wait(const std::function<bool()>& done, const char* what) {
    const prt::Stopwatch stopwatch;
    while (!done()) {
        if (stopwatch.seconds() > kPatience)
            throw prt::Error(fmt::format("waited {} s for {}", kPatience, what));
        draw();
        std::this_thread::sleep_for(std::chrono::milliseconds(5));
    }
    draw();
}

// ---- steps, in the order of docs/viewer.md

void set_size(Player& player, const Json& json) {
    player.size = {json.at(0).get<int>(), json.at(1).get<int>()};
    if (player.size.x < 1 || player.size.y < 1)
        throw prt::Error("a size must be above 0");
    player.screen = std::make_unique<Offscreen>(player.size.x, player.size.y);
}

void open(Player& player, const Json& json) {
    std::vector<std::filesystem::path> files;
    for (const Json& file : json.is_string() ? Json::array({json}) : json)
        files.push_back(player.path(file));
    player.viewer->open(files);
}

void wait(Player& player, const Json& json) {
    if (json.is_object()) {
        const int passes = json.at("reference").get<int>();
        return player.wait([&] { return player.viewer->figures().reference_passes >= passes; },
                           "the reference");
    }
    const std::string what = json.get<std::string>();
    if (what != "work" && what != "numbers" && what != "budget")
        throw prt::Error("wait expects work, numbers, a budget or a reference");
    const Jobs& jobs = player.viewer->jobs();
    const auto busy = [&] {
        return what == "work" ? jobs.busy()
                              : jobs.busy(what == "numbers" ? JobKind::numbers : JobKind::budget);
    };
    player.wait([&] { return !busy(); }, "work in the background");
}

void set(Player& player, const Json& json) {
    for (const Command& command : commands())
        if (command.setting && *command.id != 0 && json.contains(command.id))
            take(json.at(command.id), command, player.viewer->settings);
}

/// Sets the camera in the world space of the model's file.
void set_camera(Player& player, const Json& json) {
    prt::Camera camera = player.viewer->camera.camera();
    const Model* model = player.viewer->document().model();
    const glm::dvec3 origin = model ? model->scene.origin : glm::dvec3(0);
    const auto position = [&](const Json& at) {
        const auto v = at.get<std::array<double, 3>>();
        return glm::vec3(glm::dvec3(v[0], v[1], v[2]) - origin);
    };
    if (json.contains("position"))
        camera.position = position(json.at("position"));
    if (json.contains("target"))
        camera.target = position(json.at("target"));
    player.viewer->camera = OrbitCamera(camera);
}

void set_day(Player& player, const Json& json) {
    LightSettings& lights = player.viewer->lights;
    lights.day = true;
    take(json, "hour", lights.time.hour);
    take(json, "turbidity", lights.time.turbidity);
}

void remove_sky(Player& player, const Json&) {
    player.viewer->lights.day = player.viewer->lights.environment_on = false;
}

void rotate(Player& player, const Json& json) {
    player.viewer->lights.rotation = glm::radians(json.get<float>());
}

void set_window(Player& player, const Json& json) {
    player.viewer->lights.window = named(kWindows, json, "window").window;
}

void add_light(Player& player, const Json& json) {
    player.viewer->lights.lights.push_back(light_of(json));
}

void set_lamps(Player& player, const Json& json) {
    set_strengths(player.viewer->settings.lit.lamps.each, json);
}

/// Opens a figure, sets its options, and advances it by some seconds at once.
void set_figure(Player& player, const Json& json) {
    Viewer& viewer = *player.viewer;
    if (json.contains("file")) {
        viewer.open_figure(player.path(json.at("file")));
        player.wait([&] { return !viewer.jobs().busy(JobKind::figure); }, "the figure");
        player.fail_on_message();
    }
    viewer.choose_figure(figure_choice(json));
    const double seconds = json.value("seconds", 0.0);
    if (!(seconds >= 0 && seconds <= 3600))
        throw prt::Error("the seconds of a figure must be 0 to 3600");
    viewer.walk_figure(seconds);
}

void compress(Player& player, const Json& json) {
    take(json, "order", player.viewer->compression.order);
    take(json, "clusters", player.viewer->compression.clusters);
    take(json, "components", player.viewer->compression.components);
}

void press(Player& player, const Json& json) {
    const std::string name = json.at(0);
    const Button button = name == "right" ? Button::right : name == "middle" ? Button::middle : Button::left;
    const glm::vec2 pixel = vec2(json, 1);
    player.interface->point(pixel);
    player.draw(); // a panel detects the pointer one frame later
    player.interface->press(button == Button::left);
    player.draw();
    if (!player.interface->wants_pointer())
        player.controls->press(button, pixel);
}

void move(Player& player, const Json& json) {
    player.interface->point(vec2(json));
    player.controls->move(vec2(json));
}

void release(Player& player, const Json&) {
    player.interface->press(false);
    player.draw();
    player.controls->release();
}

void scroll(Player& player, const Json& json) {
    player.controls->scroll(json.get<float>());
}

void press_keys(Player& player, const Json& json) {
    for (const char key : json.get<std::string>())
        if (key == '\x1b')
            player.interface->close();
        else if (!player.controls->key(key))
            throw prt::Error(fmt::format("unknown key '{}'", key));
}

/// Moves the pointer; over a panel, waits long enough for the tooltip.
void hover(Player& player, const Json& json) {
    constexpr int kRest = 30; // frames
    const glm::vec2 pixel = vec2(json);
    player.interface->point(pixel);
    player.draw(2); // a panel detects the pointer one frame later
    for (int frame = 0; frame < kRest && player.interface->wants_pointer(); ++frame)
        player.draw();
    player.viewer->hover(player.interface->wants_pointer() ? std::nullopt : std::optional(pixel));
}

/// Waits until the file is written; the message about it is expected.
void save(Player& player, const Json& json) {
    Viewer& viewer = *player.viewer;
    viewer.save(player.path(json));
    player.wait([&] { return !viewer.jobs().busy(); }, "the file");
    if (viewer.messages().size() == 1 && viewer.messages().back().starts_with("saved "))
        viewer.dismiss_messages();
}

void set_scale(Player& player, const Json& json) {
    player.make_interface(json.get<float>());
}

/// Rotates the light by one degree per frame.
void spin(Player& player, const Json& json) {
    player.viewer->forget_longest();
    for (int i = 0; i < json.get<int>(); ++i) {
        player.viewer->lights.rotation = glm::radians(static_cast<float>(i % 360));
        player.draw();
        glFinish();
    }
}

void draw(Player& player, const Json& json) {
    player.draw(json.get<int>());
}

void lose_context(Player& player, const Json&) {
    player.interface.reset();
    player.viewer->release_gpu();
    player.screen.reset();
    player.context.reset();
    player.make_context();
}

void expect_message(Player& player, const Json& json) {
    Viewer& viewer = *player.viewer;
    const auto part = json.get<std::string>();
    player.wait([&] { return !viewer.messages().empty() || !viewer.jobs().busy(); }, "a message");
    const std::string last =
        viewer.messages().empty() ? "" : "; the last message is: " + viewer.messages().back();
    if (std::ranges::none_of(viewer.messages(),
                             [&](const std::string& text) { return text.find(part) != std::string::npos; }))
        throw prt::Error("no message contains '" + part + "'" + last);
    viewer.dismiss_messages();
}

void take_screenshot(Player& player, const Json& json) {
    player.draw();
    save_screenshot(player.screen->framebuffer(), player.size.x, player.size.y, player.path(json));
}

void write(const std::filesystem::path& path, const Json& json) {
    prt::OutputFile output(path);
    output.write(json.dump(2) + "\n");
    output.commit();
}

void write_figures(Player& player, const Json& json) {
    glFinish();
    player.draw();
    write(player.path(json), figures_json(player.viewer->figures()));
}

/// Measures the budget if that of the current light is not available.
void write_budget(Player& player, const Json& json) {
    Viewer& viewer = *player.viewer;
    player.draw(); // applies the pending light
    if (!viewer.jobs().busy(JobKind::budget) && !viewer.budget_is_current())
        viewer.measure_budget();
    player.wait([&] { return !viewer.jobs().busy(JobKind::budget); }, "the budget");
    player.fail_on_message();
    if (!viewer.budget_is_current())
        throw prt::Error("the budget was measured with other light");
    write(player.path(json), budget_json(viewer.document().budget->errors));
}

struct Step {
    std::string_view id;
    void (*run)(Player&, const Json&);
};
constexpr Step kSteps[] = {{"size", set_size},
                           {"open", open},
                           {"wait", wait},
                           {"set", set},
                           {"camera", set_camera},
                           {"window", set_window},
                           {"rotate", rotate},
                           {"day", set_day},
                           {"no_sky", remove_sky},
                           {"light", add_light},
                           {"lamps", set_lamps},
                           {"figure", set_figure},
                           {"compress", compress},
                           {"press", press},
                           {"move", move},
                           {"release", release},
                           {"scroll", scroll},
                           {"keys", press_keys},
                           {"hover", hover},
                           {"scale", set_scale},
                           {"save", save},
                           {"draw", draw},
                           {"spin", spin},
                           {"screenshot", take_screenshot},
                           {"figures", write_figures},
                           {"budget", write_budget},
                           {"lose_context", lose_context},
                           {"expect_message", expect_message}};

void run(Player& player, const Json& step) {
    if (!step.is_object() || step.size() != 1)
        throw prt::Error("a step must be an object with one member, not " + step.dump());
    named(kSteps, step.begin().key(), "step").run(player, step.begin().value());
}

Json read_steps(const std::filesystem::path& script) {
    const std::vector<std::byte> bytes = prt::read_file(script);
    const auto* text = reinterpret_cast<const char*>(bytes.data());
    try {
        Json steps = Json::parse(text, text + bytes.size());
        if (!steps.is_array())
            throw prt::Error(script.string() + ": the file must contain an array of steps");
        return steps;
    } catch (const Json::exception& error) {
        throw prt::Error(script.string() + ": " + prt::one_line(error.what()));
    }
}

} // namespace

void run_script(const std::filesystem::path& script, const std::vector<std::filesystem::path>& files) {
    const Json steps = read_steps(script);
    /// Adds the index of the step to an error.
    const auto at_step = [&](std::size_t i, const auto& work) {
        const std::string at = fmt::format("{}: step {}: ", script.string(), i + 1);
        try {
            work();
        } catch (const Json::exception& error) {
            throw prt::Error(at + prt::one_line(error.what()));
        } catch (const prt::Error& error) {
            throw prt::Error(at + error.what());
        }
    };
    Player player(script.parent_path());
    player.viewer->open(files);
    const auto fail_on_message_of = [&](std::size_t i) { at_step(i, [&] { player.fail_on_message(); }); };
    for (std::size_t i = 0; i < steps.size(); ++i) {
        if (i > 0 && !steps[i].contains("expect_message"))
            fail_on_message_of(i - 1);
        at_step(i, [&] { run(player, steps[i]); });
    }
    if (!steps.empty())
        fail_on_message_of(steps.size() - 1);
}

} // namespace viewer
