#pragma once

#include "core/viewer.h"

#include <functional>

struct GLFWwindow;

namespace viewer {

/// Dear ImGui in the current OpenGL context, with or without a window.
class UserInterface {
public:
    /// `window` null: a script controls the pointer. `scale` is the size of letters and panels, 1 at 96 dpi.
    explicit UserInterface(GLFWwindow* window, float scale = 1);
    ~UserInterface();
    UserInterface(const UserInterface&) = delete;
    UserInterface& operator=(const UserInterface&) = delete;

    /// Draws the panels over `framebuffer`.
    void draw(Viewer& viewer, std::uint32_t framebuffer, int width, int height);
    /// Move the pointer (pixels from the top left) and its left button; only without a window.
    void point(const glm::vec2& pixel);
    void press(bool down);
    /// Closes the open drop-down, otherwise messages, otherwise the help, in the next frame.
    void close() { close_ = true; }
    bool wants_pointer() const;
    bool wants_keyboard() const;

private:
    GLFWwindow* window_;
    bool close_ = false;
};

} // namespace viewer
