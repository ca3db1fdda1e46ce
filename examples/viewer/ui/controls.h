#pragma once

// The pointer and the keyboard, from a window or a script.

#include "core/viewer.h"

#include <functional>

namespace viewer {

enum class Button { left, middle, right };

/// What the pointer drags: the camera (left), what it looks at (middle), the environment (right); a light or
/// the split where it is pressed on one. Pixels from the top left.
class Controls {
public:
    explicit Controls(Viewer& viewer) : viewer_(viewer) {}
    Viewer& viewer() { return viewer_; }
    void press(Button button, const glm::vec2& pixel);
    void move(const glm::vec2& pixel);
    void release() { drag_ = Drag::nothing; }
    void scroll(float notches) { viewer_.camera.zoom(notches); }
    /// False for a key that means nothing.
    bool key(char key);
    std::function<void()> screenshot = [] {}, quit = [] {}; ///< called by their keys

    /// The light under the pointer or being dragged, -1: none.
    int light_at(const glm::vec2& pixel) const;

private:
    enum class Drag { nothing, camera, pan, environment, split, light };
    Viewer& viewer_;
    Drag drag_ = Drag::nothing;
    glm::vec2 last_{0};
    int light_ = -1;
    bool far_side_ = false;
};

/// Where the handle of a light is in the scene.
glm::vec3 handle_place(const Viewer& viewer, const RigLight& light);

} // namespace viewer
