// Runs the viewer in a GLFW window.

#include "ui/window.h"

#include "gpu/offscreen.h"
#include "ui/controls.h"
#include "ui/user_interface.h"

#include "prt/core/error.h"

#include <epoxy/gl.h>
#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>
#include <backends/imgui_impl_glfw.h>
#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <memory>

namespace viewer {
namespace {

/// Initialises GLFW; terminates it in the destructor.
struct Glfw {
    Glfw() {
        if (!glfwInit())
            throw prt::Error("no display is available; use --headless SCRIPT");
    }
    ~Glfw() { glfwTerminate(); }
    Glfw(const Glfw&) = delete;
    Glfw& operator=(const Glfw&) = delete;
};

struct CloseWindow {
    void operator()(GLFWwindow* window) const { glfwDestroyWindow(window); }
};
using Window = std::unique_ptr<GLFWwindow, CloseWindow>;

Window create_window(int width, int height) {
    glfwWindowHint(GLFW_CONTEXT_VERSION_MAJOR, 4);
    glfwWindowHint(GLFW_CONTEXT_VERSION_MINOR, 5);
    glfwWindowHint(GLFW_OPENGL_PROFILE, GLFW_OPENGL_CORE_PROFILE);
    glfwWindowHint(GLFW_CONTEXT_ROBUSTNESS, GLFW_LOSE_CONTEXT_ON_RESET);
    Window window(glfwCreateWindow(width, height, "prtkit", nullptr, nullptr));
    if (!window) { // some drivers do not support robust contexts
        glfwWindowHint(GLFW_CONTEXT_ROBUSTNESS, GLFW_NO_ROBUSTNESS);
        window.reset(glfwCreateWindow(width, height, "prtkit", nullptr, nullptr));
    }
    if (!window)
        throw prt::Error("the display does not support OpenGL 4.5");
    return window;
}

class Application {
public:
    Application(const std::vector<std::filesystem::path>& files, int width, int height)
        : width_(width), height_(height) {
        make_window();
        viewer_ = std::make_unique<Viewer>();
        controls_ = std::make_unique<Controls>(*viewer_);
        controls_->screenshot = [this] { wants_screenshot_ = true; };
        controls_->quit = [this] { glfwSetWindowShouldClose(window_.get(), GLFW_TRUE); };
        make_interface();
        viewer_->open(files);
    }

    void run() {
        double last = glfwGetTime();
        while (!glfwWindowShouldClose(window_.get())) {
            glfwPollEvents();
            if (std::exchange(rescale_, false))
                make_interface();
            const double now = glfwGetTime();
            viewer_->update(now - std::exchange(last, now));
            int width = 0, height = 0;
            glfwGetFramebufferSize(window_.get(), &width, &height);
            if (width == 0 || height == 0) { // minimised
                glfwWaitEventsTimeout(0.1);
                continue;
            }
            draw(width, height);
            glfwSwapBuffers(window_.get());
            if (glGetGraphicsResetStatus() != GL_NO_ERROR)
                recover();
        }
    }

private:
    void make_window() {
        window_ = create_window(width_, height_);
        glfwMakeContextCurrent(window_.get());
        glfwSwapInterval(1);
        glfwSetWindowUserPointer(window_.get(), this);
        set_pointer_callbacks(window_.get());
        set_other_callbacks(window_.get());
    }

    static void set_pointer_callbacks(GLFWwindow* window) {
        glfwSetMouseButtonCallback(window, [](GLFWwindow* w, int button, int action, int mods) {
            ImGui_ImplGlfw_MouseButtonCallback(w, button, action, mods);
            self(w).pointer_button(button, action);
        });
        glfwSetCursorPosCallback(window, [](GLFWwindow* w, double, double) { self(w).pointer_moved(); });
        glfwSetCursorEnterCallback(window, [](GLFWwindow* w, int entered) {
            ImGui_ImplGlfw_CursorEnterCallback(w, entered);
            if (!entered)
                self(w).viewer_->hover(std::nullopt);
        });
        glfwSetScrollCallback(window, [](GLFWwindow* w, double x, double y) {
            ImGui_ImplGlfw_ScrollCallback(w, x, y);
            if (!self(w).interface_->wants_pointer())
                self(w).controls_->scroll(static_cast<float>(y));
        });
    }

    static void set_other_callbacks(GLFWwindow* window) {
        glfwSetKeyCallback(window, [](GLFWwindow* w, int key, int scancode, int action, int mods) {
            ImGui_ImplGlfw_KeyCallback(w, key, scancode, action, mods);
            if (action == GLFW_PRESS && key == GLFW_KEY_ESCAPE)
                self(w).interface_->close();
            else if (action == GLFW_PRESS && !self(w).interface_->wants_keyboard())
                self(w).controls_->key(key == GLFW_KEY_TAB ? '\t'
                                       : key < 128         ? static_cast<char>(key)
                                                           : '\0');
        });
        glfwSetCharCallback(window, ImGui_ImplGlfw_CharCallback);
        glfwSetWindowFocusCallback(window, ImGui_ImplGlfw_WindowFocusCallback);
        glfwSetWindowContentScaleCallback(window,
                                          [](GLFWwindow* w, float, float) { self(w).rescale_ = true; });
        glfwSetDropCallback(window, [](GLFWwindow* w, int count, const char** paths) {
            self(w).viewer_->open({paths, paths + count});
        });
    }

    /// Sets the size of letters to that of other programs on the display. If the framebuffer is finer than
    /// the window, the system already scales by that ratio.
    void make_interface() {
        float scale = 1, ignored = 1;
        int width = 1, window_width = 1, height = 1;
        glfwGetWindowContentScale(window_.get(), &scale, &ignored);
        glfwGetFramebufferSize(window_.get(), &width, &height);
        glfwGetWindowSize(window_.get(), &window_width, &height);
        if (width > 0)
            scale *= static_cast<float>(window_width) / static_cast<float>(width);
        interface_.reset(); // Dear ImGui supports one context at a time
        interface_ =
            std::make_unique<UserInterface>(window_.get(), std::clamp(std::round(4 * scale) / 4, 1.0f, 4.0f));
    }

    static Application& self(GLFWwindow* window) {
        return *static_cast<Application*>(glfwGetWindowUserPointer(window));
    }

    /// Returns the pointer in framebuffer pixels, which may be finer than window coordinates.
    glm::vec2 pointer() const {
        double x = 0, y = 0;
        int width = 0, height = 0, window_width = 1, window_height = 1;
        glfwGetCursorPos(window_.get(), &x, &y);
        glfwGetFramebufferSize(window_.get(), &width, &height);
        glfwGetWindowSize(window_.get(), &window_width, &window_height);
        return {static_cast<float>(x * width / std::max(1, window_width)),
                static_cast<float>(y * height / std::max(1, window_height))};
    }

    void pointer_button(int button, int action) {
        if (action == GLFW_RELEASE)
            controls_->release();
        else if (!interface_->wants_pointer())
            controls_->press(button == GLFW_MOUSE_BUTTON_RIGHT    ? Button::right
                             : button == GLFW_MOUSE_BUTTON_MIDDLE ? Button::middle
                                                                  : Button::left,
                             pointer());
    }

    void pointer_moved() {
        controls_->move(pointer());
        viewer_->hover(interface_->wants_pointer() ? std::nullopt : std::optional(pointer()));
    }

    void draw(int width, int height) {
        try {
            viewer_->draw(0, width, height);
        } catch (const prt::Error& error) { // out of memory, or the context is lost
            viewer_->message(error.what());
        }
        if (wants_screenshot_) {
            wants_screenshot_ = false;
            take_screenshot(width, height);
        }
        interface_->draw(*viewer_, 0, width, height);
    }

    void take_screenshot(int width, int height) {
        std::filesystem::path path;
        for (int i = 1; path.empty() || std::filesystem::exists(path); ++i)
            path = fmt::format("prtkit-{}.png", i);
        try {
            save_screenshot(0, width, height, path);
            viewer_->message("saved " + std::filesystem::absolute(path).string());
        } catch (const prt::Error& error) {
            viewer_->message(error.what());
        }
    }

    /// Recovers from a driver reset: all GPU objects are lost, other state remains.
    void recover() {
        interface_.reset();
        viewer_->release_gpu();
        window_.reset();
        make_window();
        viewer_->restore_gpu();
        make_interface();
        viewer_->message("the graphics driver was reset; all data was uploaded again");
    }

    int width_, height_;
    Glfw glfw_;
    Window window_;
    std::unique_ptr<Viewer> viewer_;
    std::unique_ptr<Controls> controls_;
    std::unique_ptr<UserInterface> interface_;
    bool wants_screenshot_ = false, rescale_ = false;
};

} // namespace

void run_window(const std::vector<std::filesystem::path>& files, int width, int height) {
    Application(files, width, height).run();
}

} // namespace viewer
