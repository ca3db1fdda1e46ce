#pragma once

// Handles the pointer and the keyboard, from a window or a script.

#include "core/viewer.h"

#include <functional>

namespace viewer {

enum class Button { left, middle, right };

/// Drags the camera (left button), its target (middle) or the environment (right); a light or the split if it
/// is pressed on one. Pixels are counted from the top left.
class Controls {
public:
    explicit Controls(Viewer& viewer) : viewer_(viewer) {}
    Viewer& viewer() { return viewer_; }
    void press(Button button, const glm::vec2& pixel);
    void move(const glm::vec2& pixel);
    void release() { drag_ = Drag::nothing; }
    void scroll(float notches) { viewer_.camera.zoom(notches); }
    /// Returns false for a key without a function.
    bool key(char key);
    std::function<void()> screenshot = [] {}, quit = [] {}; ///< called by their keys

    /// Returns the light under the pointer or being dragged; -1: none.
    int light_at(const glm::vec2& pixel) const;

private:
    enum class Drag { nothing, camera, pan, environment, split, light };
    Viewer& viewer_;
    Drag drag_ = Drag::nothing;
    glm::vec2 last_{0};
    int light_ = -1;
    bool far_side_ = false;
};

/// Returns the position of a light's handle in the scene.
glm::vec3 handle_position(const Viewer& viewer, const RigLight& light);

} // namespace viewer
