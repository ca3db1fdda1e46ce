#pragma once

#include "core/viewer.h"

#include <functional>

struct GLFWwindow;

namespace viewer {

/// Dear ImGui in the current context, over a window or over none.
class UserInterface {
public:
    /// `window` null: a script is the pointer. `scale`: of letters and panels, 1 for 96 dots an inch.
    explicit UserInterface(GLFWwindow* window, float scale = 1);
    ~UserInterface();
    UserInterface(const UserInterface&) = delete;
    UserInterface& operator=(const UserInterface&) = delete;

    /// Draws the panels over `framebuffer`.
    void draw(Viewer& viewer, std::uint32_t framebuffer, int width, int height);
    /// Where there is no window: the pointer, pixels from the top left, and its left button.
    void point(const glm::vec2& pixel);
    void press(bool down);
    /// Closes the drop-down that is open, else messages, else the help, in the next frame.
    void close() { close_ = true; }
    bool wants_pointer() const;
    bool wants_keyboard() const;

private:
    GLFWwindow* window_;
    bool close_ = false;
};

} // namespace viewer
