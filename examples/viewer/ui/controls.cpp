#include "ui/controls.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace viewer {
namespace {

constexpr float kGrab = 14; ///< pixels about a handle
constexpr float kSplitGrab = 7;

float handle_radius(const Viewer& viewer, const RigLight& light) {
    const float distance = light.kind == LightKind::sphere ? light.distance : 1.25f;
    return distance * viewer.model()->radius;
}

PictureKind next(PictureKind kind) {
    return kPictures[(static_cast<std::size_t>(kind) + 1) % kPictures.size()].kind;
}

} // namespace

const std::array<KeyHelp, 20> kKeys = {{
    {'1', "left picture: the next"},
    {'2', "right picture: the next"},
    {'X', "swap left and right"},
    {'D', "difference of the two"},
    {'W', "wireframe"},
    {'L', "lobe of the transfer vector under the pointer"},
    {'G', "forward or deferred"},
    {'C', "culling outside the view"},
    {'B', "background"},
    {'T', "base colour"},
    {'N', "day instead of the environment"},
    {' ', "let the day run"},
    {'A', "samples per pixel: 1, 4"},
    {'[', "darker"},
    {']', "brighter"},
    {'R', "reset the camera: the whole model"},
    {'P', "screenshot"},
    {'S', "save the compressed model"},
    {'Q', "quit"},
    {'H', "this help; Tab hides the panels"},
}};

glm::vec3 handle_place(const Viewer& viewer, const RigLight& light) {
    return viewer.model()->centre + handle_radius(viewer, light) * light.direction;
}

int Controls::light_at(const glm::vec2& pixel) const {
    if (!viewer_.has_model())
        return -1;
    for (std::size_t i = 0; i < viewer_.lights.lights.size(); ++i) {
        const auto at = pixel_of(viewer_.screen(), handle_place(viewer_, viewer_.lights.lights[i]));
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
        // A handle behind the centre stays behind it.
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
        light.direction = direction_on_sphere(screen, pixel, viewer_.model()->centre,
                                              handle_radius(viewer_, light), far_side_);
        break;
    }
    }
}

bool Controls::key(char key) {
    Settings& s = viewer_.settings;
    switch (key) {
    case '1':
        s.left = next(s.left);
        return true;
    case '2':
        s.right = next(s.right);
        return true;
    case 'X':
        std::swap(s.left, s.right);
        return true;
    case 'D':
        s.difference = !s.difference;
        return true;
    case 'W':
        s.wireframe = !s.wireframe;
        return true;
    case 'L':
        s.lobe = !s.lobe;
        return true;
    case 'G':
        s.deferred = !s.deferred;
        return true;
    case 'C':
        s.culling = !s.culling;
        return true;
    case 'B':
        s.background = !s.background;
        return true;
    case 'T':
        s.textured = !s.textured;
        return true;
    case 'N':
        viewer_.lights.day = !viewer_.lights.day;
        return true;
    case ' ':
        viewer_.day_runs = !viewer_.day_runs;
        return true;
    case 'A':
        s.samples = s.samples == 1 ? 2 : 1;
        return true;
    case '[':
        s.exposure_stops -= 0.25f;
        return true;
    case ']':
        s.exposure_stops += 0.25f;
        return true;
    case 'R':
        viewer_.reset_camera();
        return true;
    case 'S':
        viewer_.save();
        return true;
    case 'P':
        if (screenshot)
            screenshot();
        return true;
    case 'Q':
        if (quit)
            quit();
        return true;
    case 'H':
        s.help = !s.help;
        return true;
    case '\t':
        s.panels = !s.panels;
        return true;
    default:
        return false;
    }
}

} // namespace viewer
