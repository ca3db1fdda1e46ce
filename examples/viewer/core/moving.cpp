// Moves and animates the figure, and returns the surfaces of the moving objects.

#include "core/moving.h"

#include "pictures/joined_scene.h"

#include "prt/core/error.h"

#include <glm/geometric.hpp>
#include <glm/gtc/matrix_transform.hpp>

#include <algorithm>
#include <cctype>
#include <cmath>

namespace viewer {
namespace {

/// Walking speed for animations without one, metres per second.
constexpr double kUsualSpeed = 1.2;
constexpr float kSphereRadius = 0.35f; ///< metres

std::string small_letters(std::string text) {
    std::ranges::transform(text, text.begin(),
                           [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    return text;
}

/// Bounding box of the figure at rest, in its file's world space.
struct RestBox {
    glm::dvec3 low, high;
};
RestBox rest_box(const prt::AnimatedScene& figure) {
    const prt::Bounds box = prt::bounds(figure.scene());
    return {figure.scene().world(box.low), figure.scene().world(box.high)};
}

/// Returns the transform that moves the figure's feet to its position.
glm::dmat4 placement_of(const prt::AnimatedScene& figure, const FigureWalk& walk, double scale) {
    glm::dmat4 placement = glm::translate(glm::dmat4(1), glm::dvec3(walk.position()));
    placement = glm::rotate(placement, static_cast<double>(walk.heading()), glm::dvec3(0, 1, 0));
    placement = glm::scale(placement, glm::dvec3(scale));
    return glm::translate(placement, {0, -rest_box(figure).low.y, 0});
}

Walker walker_of(const prt::AnimatedScene* figure, double scale) {
    if (!figure)
        return {};
    const RestBox box = rest_box(*figure);
    const auto height = static_cast<float>(scale * (box.high.y - box.low.y));
    return {height, height / 3, 0.2f * height};
}

/// Returns a box around the figure in every pose: a sphere about its middle with the diameter of its rest
/// box.
prt::Bounds box_of(const prt::AnimatedScene& figure, const glm::dmat4& placement) {
    const RestBox rest = rest_box(figure);
    const glm::vec3 middle(placement * glm::dvec4(0.5 * (rest.low + rest.high), 1));
    const auto reach =
        static_cast<float>(0.6 * glm::length(glm::dvec3(placement[1])) * glm::distance(rest.low, rest.high));
    return {middle - reach, middle + reach};
}

} // namespace

void Moving::set_figure(const FigureFile& file) {
    file_ = file;
    occluders_.clear();
    choice_ = {};
    seconds_ = 0;
}

void Moving::choose(const FigureChoice& choice, const std::shared_ptr<const Model>& model) {
    choice_ = choice;
    if (file_.figure && !animation())
        throw prt::Error(file_.path.string() + ": has no animation '" + choice.animation + "'");
    seconds_ = 0;
    place_figures(model);
}

void Moving::enter(const std::shared_ptr<const Model>& model) {
    volume_ = {};
    volume_asked_ = false;
    place_figures(model);
}

void Moving::place_figures(const std::shared_ptr<const Model>& model) {
    std::vector<glm::vec3> path;
    for (const glm::dvec3& point : choice_.path)
        path.emplace_back(point - model->scene.origin);
    walk_ = FigureWalk(model, walker_of(file_.figure.get(), choice_.scale), std::move(path));
    const glm::vec3 side(std::cos(walk_.heading()), 0, -std::sin(walk_.heading()));
    const glm::vec3 middle = walk_.position() + glm::vec3(0, 2.5f * kSphereRadius, 0);
    spheres_ = {{middle - 0.9f * side, middle + 0.9f * side}, kSphereRadius};
    take_pose();
}

const prt::Animation* Moving::animation() const {
    const std::vector<prt::Animation>& all = file_.figure->animations();
    const auto called = [&](auto&& accepts) {
        const auto found = std::ranges::find_if(all, accepts);
        return found == all.end() ? nullptr : &*found;
    };
    if (!choice_.animation.empty())
        return called([&](const prt::Animation& a) { return a.name == choice_.animation; });
    const prt::Animation* walks = called(
        [](const prt::Animation& a) { return small_letters(a.name).find("walk") != std::string::npos; });
    return walks || all.empty() ? walks : &all.front();
}

void Moving::advance(double seconds, double speed) {
    if (!file_.figure || seconds * speed == 0)
        return;
    const prt::Animation* moves = animation();
    seconds_ += speed * seconds;
    const double own = moves && moves->speed > 0 ? moves->speed : kUsualSpeed;
    walk_.advance(speed * seconds * own * choice_.scale);
    take_pose();
}

void Moving::take_pose() {
    const std::uint64_t version = pose_.version + 1;
    if (!file_.figure) {
        pose_ = {};
        pose_.version = version;
        return;
    }
    const prt::AnimatedScene& figure = *file_.figure;
    const prt::Animation* moves = animation();
    pose_.nodes = moves && moves->duration > 0 ? figure.pose(*moves, std::fmod(seconds_, moves->duration))
                                               : figure.rest();
    pose_.placement = placement_of(figure, walk_, choice_.scale);
    pose_.palettes.clear();
    for (std::size_t array = 0; array < figure.vertices().size(); ++array) {
        std::vector<glm::mat4>& palette = pose_.palettes.emplace_back();
        for (const glm::dmat4& matrix : figure.matrices(array, pose_.nodes))
            palette.emplace_back(pose_.placement * matrix);
    }
    pose_.box = box_of(figure, pose_.placement);
    pose_.version = version;
}

std::shared_ptr<const prt::Scene> Moving::surfaces(const MovingSettings& shown) {
    const bool figure = shown.figure && file_.figure && pose_.version > 0;
    if (surfaces_.version == pose_.version && surfaces_.figure == figure &&
        surfaces_.spheres == shown.spheres)
        return surfaces_.scene;
    surfaces_ = {pose_.version, figure, shown.spheres, nullptr};
    if (!figure && !shown.spheres)
        return nullptr;
    prt::Scene scene;
    if (figure)
        scene = file_.figure->posed(pose_.nodes, pose_.placement);
    if (shown.spheres) {
        prt::Scene sphere = unit_sphere(kMattColor).scene;
        for (glm::vec3& position : sphere.vertex_arrays[0].positions)
            position = spheres_.middles[0] + spheres_.radius * position;
        join(scene, sphere);
    }
    surfaces_.scene = std::make_shared<const prt::Scene>(std::move(scene));
    return surfaces_.scene;
}

} // namespace viewer
