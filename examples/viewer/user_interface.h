#pragma once

#include "viewer.h"

#include <functional>

struct GLFWwindow;

namespace viewer {

/// Dear ImGui in the current context, over a window or over none.
class UserInterface {
public:
    /// `window` null: without input, for pictures of the panels.
    explicit UserInterface(GLFWwindow* window);
    ~UserInterface();
    UserInterface(const UserInterface&) = delete;
    UserInterface& operator=(const UserInterface&) = delete;

    /// Draws the panels over `framebuffer`.
    void draw(Viewer& viewer, std::uint32_t framebuffer, int width, int height);
    bool wants_pointer() const;
    bool wants_keyboard() const;

private:
    GLFWwindow* window_;
};

} // namespace viewer
