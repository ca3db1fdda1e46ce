#include "script/script.h"

#include "gpu/offscreen.h"
#include "ui/controls.h"
#include "ui/user_interface.h"

#include "prt/gl_context.h"
#include "prt/support/error.h"
#include "prt/support/file.h"

#include <epoxy/gl.h>
#include <fmt/core.h>
#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>
#include <nlohmann/json.hpp>

#include <chrono>
#include <functional>
#include <map>
#include <thread>

namespace viewer {
namespace {

using Json = nlohmann::json;

constexpr double kPatience = 600; ///< seconds that a step waits at most

PictureKind picture_kind(const std::string& id) {
    for (const PictureName& name : kPictures)
        if (id == name.id)
            return name.kind;
    throw prt::Error("there is no picture called '" + id + "'");
}

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

void apply(const Json& json, Settings& s) {
    if (json.contains("left"))
        s.left = picture_kind(json.at("left"));
    if (json.contains("right"))
        s.right = picture_kind(json.at("right"));
    take(json, "split", s.split);
    take(json, "difference", s.difference);
    take(json, "white", s.white);
    take(json, "wireframe", s.wireframe);
    take(json, "lobe", s.lobe);
    take(json, "deferred", s.deferred);
    take(json, "dithered", s.dithered);
    take(json, "culling", s.culling);
    take(json, "background", s.background);
    take(json, "textured", s.textured);
    take(json, "samples", s.samples);
    take(json, "exposure_stops", s.exposure_stops);
    take(json, "panels", s.panels);
    take(json, "help", s.help);
    take(json, "ssao_radius", s.ssao.radius);
    take(json, "ssao_bias", s.ssao.bias);
    take(json, "ssao_intensity", s.ssao.intensity);
    take(json, "ssao_samples", s.ssao.samples);
}

prt::Window window_of(const std::string& name) {
    static const std::map<std::string, prt::Window> windows = {{"auto", prt::Window::automatic},
                                                               {"none", prt::Window::none},
                                                               {"hann", prt::Window::hann},
                                                               {"lanczos", prt::Window::lanczos}};
    const auto window = windows.find(name);
    if (window == windows.end())
        throw prt::Error("there is no window called '" + name + "'");
    return window->second;
}

RigLight light_of(const Json& json) {
    static const std::map<std::string, LightKind> kinds = {{"sun", LightKind::sun},
                                                           {"cone", LightKind::cone},
                                                           {"sphere", LightKind::sphere},
                                                           {"hemisphere", LightKind::hemisphere}};
    const auto kind = kinds.find(json.at("kind").get<std::string>());
    if (kind == kinds.end())
        throw prt::Error("there is no light called '" + json.at("kind").get<std::string>() + "'");
    RigLight light = make_light(kind->second);
    if (json.contains("direction"))
        light.direction = glm::normalize(vec3(json.at("direction")));
    if (json.contains("color"))
        light.color = vec3(json.at("color"));
    take(json, "size", light.size);
    take(json, "distance", light.distance);
    take(json, "strength", light.strength);
    return light;
}

Json figures_json(const Figures& f) {
    return {{"frame_milliseconds", f.frame_milliseconds},
            {"longest_frame_milliseconds", f.longest_milliseconds},
            {"gpu_milliseconds", f.gpu_milliseconds},
            {"vertex_milliseconds", f.vertex_milliseconds},
            {"constants_milliseconds", f.constants_milliseconds},
            {"open_milliseconds", f.open_milliseconds},
            {"receivers", f.receivers},
            {"triangles", f.triangles},
            {"triangles_drawn", f.triangles_drawn},
            {"raw_bytes", f.raw_bytes},
            {"bytes_per_vertex", f.bytes_per_vertex},
            {"bytes_per_vertex_with_bases", f.bytes_with_bases},
            {"clusters", f.clusters},
            {"order", f.order},
            {"channels", f.channels},
            {"reference_passes", f.reference_passes},
            {"difference_relative_l2", f.difference.relative_l2},
            {"difference_mean_radiance", f.difference.mean},
            {"difference_pixels", f.difference.pixels}};
}

class Player {
public:
    explicit Player(std::filesystem::path folder) : folder_(std::move(folder)) { make_context(); }

    void open(const std::vector<std::filesystem::path>& files) { viewer_->open(files); }

    void run(const Json& step) {
        if (!step.is_object() || step.size() != 1)
            throw prt::Error("a step is an object with one member, not " + step.dump());
        const std::string name = step.begin().key();
        const auto found = steps_.find(name);
        if (found == steps_.end())
            throw prt::Error("there is no step called '" + name + "'");
        found->second(step.begin().value());
        if (name != "expect_message" && !expects_message_)
            fail_on_message();
        expects_message_ = false;
    }

    void fail_on_message() {
        if (!viewer_->messages().empty())
            throw prt::Error(viewer_->messages().back());
    }
    void expect_message_next() { expects_message_ = true; }

private:
    void make_context() {
        std::string why;
        context_ = prt::GlContext::create(prt::GlDevice::any, &why);
        if (!context_)
            throw prt::Error("there is no OpenGL 4.5 (" + why + ")");
        screen_ = std::make_unique<Offscreen>(size_.x, size_.y);
        if (!viewer_) {
            viewer_ = std::make_unique<Viewer>();
            controls_ = std::make_unique<Controls>(*viewer_);
        } else {
            viewer_->restore_gpu();
        }
        make_interface(1);
    }

    void make_interface(float scale) {
        interface_.reset(); // Dear ImGui has one context at a time
        interface_ = std::make_unique<UserInterface>(nullptr, scale);
    }

    /// The pointer rests there; on a panel long enough for what it says of the control.
    void hover(const glm::vec2& pixel) {
        constexpr int kRest = 30; // frames
        interface_->point(pixel);
        draw(); // a panel says in the next frame that it is under the pointer
        draw();
        for (int frame = 0; frame < kRest && interface_->wants_pointer(); ++frame)
            draw();
        viewer_->hover(interface_->wants_pointer() ? std::nullopt : std::optional(pixel));
    }

    void press(Button button, const glm::vec2& pixel) {
        interface_->point(pixel);
        draw(); // a panel says in the next frame that it is under the pointer
        interface_->press(button == Button::left);
        draw();
        if (!interface_->wants_pointer())
            controls_->press(button, pixel);
    }

    void release() {
        interface_->press(false);
        draw();
        controls_->release();
    }

    void press_keys(const std::string& keys) {
        for (const char key : keys)
            if (key == '\x1b')
                interface_->close();
            else if (!controls_->key(key))
                throw prt::Error(fmt::format("there is no key '{}'", key));
    }

    /// Waits until it is written; the message that says so is expected.
    void save(const std::filesystem::path& file) {
        viewer_->save(file);
        wait([&] { return !viewer_->busy(); }, "the file");
        if (!viewer_->messages().empty() && viewer_->messages().back().starts_with("saved "))
            viewer_->messages().pop_back();
    }

    void lose_context() {
        interface_.reset();
        viewer_->release_gpu();
        screen_.reset();
        context_.reset();
        make_context();
    }

    void draw() {
        viewer_->update(1.0 / 60);
        viewer_->draw(screen_->framebuffer(), size_.x, size_.y);
        interface_->draw(*viewer_, screen_->framebuffer(), size_.x, size_.y);
    }

    void wait(const std::function<bool()>& done, const char* what) {
        const prt::Stopwatch stopwatch;
        while (!done()) {
            if (stopwatch.seconds() > kPatience)
                throw prt::Error(fmt::format("waited {} s for {}", kPatience, what));
            draw();
            std::this_thread::sleep_for(std::chrono::milliseconds(5));
        }
        draw();
    }

    std::filesystem::path path(const Json& json) const { return folder_ / json.get<std::string>(); }

    void write_figures(const std::filesystem::path& file) {
        glFinish();
        draw();
        prt::OutputFile output(file);
        output.write(figures_json(viewer_->figures()).dump(2) + "\n");
        output.commit();
    }

    std::filesystem::path folder_;
    glm::ivec2 size_{640, 360};
    std::unique_ptr<prt::GlContext> context_;
    std::unique_ptr<Offscreen> screen_;
    std::unique_ptr<Viewer> viewer_;
    std::unique_ptr<Controls> controls_;
    std::unique_ptr<UserInterface> interface_;
    bool expects_message_ = false;

    const std::map<std::string, std::function<void(const Json&)>> steps_ = {
        {"size",
         [this](const Json& json) {
             size_ = {json.at(0).get<int>(), json.at(1).get<int>()};
             if (size_.x < 1 || size_.y < 1)
                 throw prt::Error("a size is above 0");
             screen_ = std::make_unique<Offscreen>(size_.x, size_.y);
         }},
        {"open",
         [this](const Json& json) {
             std::vector<std::filesystem::path> files;
             if (json.is_string())
                 files.push_back(path(json));
             else
                 for (const Json& file : json)
                     files.push_back(path(file));
             viewer_->open(files);
         }},
        {"wait",
         [this](const Json& json) {
             if (json.is_object()) {
                 const int passes = json.at("reference").get<int>();
                 wait([&] { return viewer_->figures().reference_passes >= passes; }, "the reference");
             } else {
                 const bool numbers = json.get<std::string>() == "numbers";
                 if (!numbers && json.get<std::string>() != "work")
                     throw prt::Error("what to wait for is work, numbers or a reference");
                 wait([&] { return !(numbers ? viewer_->finding_numbers() : viewer_->busy()); },
                      "work in the background");
             }
         }},
        {"set", [this](const Json& json) { apply(json, viewer_->settings); }},
        {"camera", // in the world of the model's file
         [this](const Json& json) {
             prt::Camera camera = viewer_->camera.camera();
             const glm::dvec3 origin = viewer_->model() ? viewer_->model()->scene.origin : glm::dvec3(0);
             const auto place = [&](const Json& at) {
                 const auto v = at.get<std::array<double, 3>>();
                 return glm::vec3(glm::dvec3(v[0], v[1], v[2]) - origin);
             };
             if (json.contains("position"))
                 camera.position = place(json.at("position"));
             if (json.contains("target"))
                 camera.target = place(json.at("target"));
             viewer_->camera = OrbitCamera(camera);
         }},
        {"day",
         [this](const Json& json) {
             viewer_->lights.day = true;
             take(json, "hour", viewer_->lights.time.hour);
             take(json, "turbidity", viewer_->lights.time.turbidity);
         }},
        {"no_sky", [this](const Json&) { viewer_->lights.day = viewer_->lights.environment_on = false; }},
        {"rotate", [this](const Json& json) { viewer_->lights.rotation = glm::radians(json.get<float>()); }},
        {"window", [this](const Json& json) { viewer_->lights.window = window_of(json.get<std::string>()); }},
        {"light", [this](const Json& json) { viewer_->lights.lights.push_back(light_of(json)); }},
        {"compress",
         [this](const Json& json) {
             take(json, "order", viewer_->compression.order);
             take(json, "clusters", viewer_->compression.clusters);
             take(json, "components", viewer_->compression.components);
         }},
        {"press",
         [this](const Json& json) {
             const std::string button = json.at(0);
             press(button == "right"    ? Button::right
                   : button == "middle" ? Button::middle
                                        : Button::left,
                   vec2(json, 1));
         }},
        {"move",
         [this](const Json& json) {
             interface_->point(vec2(json));
             controls_->move(vec2(json));
         }},
        {"release", [this](const Json&) { release(); }},
        {"scroll", [this](const Json& json) { controls_->scroll(json.get<float>()); }},
        {"keys", [this](const Json& json) { press_keys(json.get<std::string>()); }},
        {"hover", [this](const Json& json) { hover(vec2(json)); }},
        {"save", [this](const Json& json) { save(path(json)); }},
        {"scale", [this](const Json& json) { make_interface(json.get<float>()); }},
        {"spin",
         [this](const Json& json) {
             // The light turns by a degree a frame.
             viewer_->forget_longest();
             for (int i = 0; i < json.get<int>(); ++i) {
                 viewer_->lights.rotation = glm::radians(static_cast<float>(i % 360));
                 draw();
                 glFinish();
             }
         }},
        {"draw",
         [this](const Json& json) {
             for (int i = 0; i < json.get<int>(); ++i)
                 draw();
         }},
        {"lose_context", [this](const Json&) { lose_context(); }},
        {"expect_message",
         [this](const Json& json) {
             wait([&] { return !viewer_->messages().empty() || !viewer_->busy(); }, "a message");
             for (const std::string& text : viewer_->messages())
                 if (text.find(json.get<std::string>()) != std::string::npos) {
                     viewer_->messages().clear();
                     return;
                 }
             throw prt::Error("no message says '" + json.get<std::string>() + "'" +
                              (viewer_->messages().empty() ? "" : " but: " + viewer_->messages().back()));
         }},
        {"screenshot",
         [this](const Json& json) {
             draw();
             save_screenshot(screen_->framebuffer(), size_.x, size_.y, path(json));
         }},
        {"figures", [this](const Json& json) { write_figures(path(json)); }},
    };
};

} // namespace

void run_script(const std::filesystem::path& script, const std::vector<std::filesystem::path>& files) {
    const std::vector<std::byte> text = prt::read_file(script);
    const auto at = [&](std::size_t i) { return fmt::format("{}: step {}: ", script.string(), i + 1); };
    Json steps;
    try {
        steps = Json::parse(reinterpret_cast<const char*>(text.data()),
                            reinterpret_cast<const char*>(text.data()) + text.size());
    } catch (const Json::exception& error) {
        throw prt::Error(script.string() + ": " + prt::one_line(error.what()));
    }
    if (!steps.is_array())
        throw prt::Error(script.string() + ": is no array of steps");
    Player player(script.parent_path());
    player.open(files);
    for (std::size_t i = 0; i < steps.size(); ++i) {
        if (i + 1 < steps.size() && steps[i + 1].is_object() && steps[i + 1].contains("expect_message"))
            player.expect_message_next();
        try {
            player.run(steps[i]);
        } catch (const Json::exception& error) {
            throw prt::Error(at(i) + prt::one_line(error.what()));
        } catch (const prt::Error& error) {
            throw prt::Error(at(i) + error.what());
        }
    }
}

} // namespace viewer
