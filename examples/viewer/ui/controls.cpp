// Maps pointer and keys to the viewer.

#include "ui/controls.h"

#include "ui/commands.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace viewer {
namespace {

constexpr float kGrab = 14; ///< pixels around a handle
constexpr float kSplitGrab = 7;

float handle_radius(const Viewer& viewer, const RigLight& light) {
    const float distance = light.kind == LightKind::sphere ? light.distance : 1.25f;
    return distance * viewer.document().model()->radius;
}

} // namespace

glm::vec3 handle_position(const Viewer& viewer, const RigLight& light) {
    return viewer.document().model()->center + handle_radius(viewer, light) * light.direction;
}

int Controls::light_at(const glm::vec2& pixel) const {
    if (!viewer_.document().model())
        return -1;
    for (std::size_t i = 0; i < viewer_.lights.lights.size(); ++i) {
        const auto at = pixel_of(viewer_.screen(), handle_position(viewer_, viewer_.lights.lights[i]));
        if (viewer_.lights.lights[i].on && at && glm::distance(*at, pixel) < kGrab)
            return static_cast<int>(i);
    }
    return -1;
}

void Controls::press(Button button, const glm::vec2& pixel) {
    last_ = pixel;
    if (button == Button::middle) {
        drag_ = Drag::pan;
        return;
    }
    if (button == Button::right) {
        drag_ = Drag::environment;
        return;
    }
    light_ = light_at(pixel);
    if (light_ >= 0) {
        drag_ = Drag::light;
        // A handle behind the center stays behind it.
        const prt::Camera camera = viewer_.camera.camera();
        far_side_ = glm::dot(viewer_.lights.lights[static_cast<std::size_t>(light_)].direction,
                             camera.position - camera.target) < 0;
    } else if (!viewer_.settings.difference &&
               std::abs(pixel.x - viewer_.settings.split * viewer_.screen().size.x) < kSplitGrab) {
        drag_ = Drag::split;
    } else {
        drag_ = Drag::camera;
    }
}

void Controls::move(const glm::vec2& pixel) {
    const Screen screen = viewer_.screen();
    const glm::vec2 way = (pixel - last_) / screen.size.y;
    last_ = pixel;
    switch (drag_) {
    case Drag::nothing:
        break;
    case Drag::camera:
        viewer_.camera.orbit(way);
        break;
    case Drag::pan:
        viewer_.camera.pan(way);
        break;
    case Drag::environment:
        viewer_.lights.rotation = std::remainder(viewer_.lights.rotation + way.x * std::numbers::pi_v<float>,
                                                 2 * std::numbers::pi_v<float>);
        break;
    case Drag::split:
        viewer_.settings.split = std::clamp(pixel.x / screen.size.x, 0.0f, 1.0f);
        break;
    case Drag::light: {
        RigLight& light = viewer_.lights.lights[static_cast<std::size_t>(light_)];
        light.direction = direction_on_sphere(screen, pixel, viewer_.document().model()->center,
                                              handle_radius(viewer_, light), far_side_);
        break;
    }
    }
}

bool Controls::key(char key) {
    const auto found = std::ranges::find(commands(), key, &Command::key);
    if (key == 0 || found == commands().end())
        return false;
    if (found->press)
        found->press(*this);
    else
        switch_setting(found->setting(viewer_.settings));
    return true;
}

} // namespace viewer
