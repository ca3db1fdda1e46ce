// Walks a figure along a path or around obstacles.

#include "core/figure_walk.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace viewer {
namespace {

constexpr float kTurnAround = std::numbers::pi_v<float>;
/// Distance between two checks for obstacles ahead, metres.
constexpr float kLook = 0.1f;
/// Maximum distance per call, because a file may contain any speed.
constexpr double kMaxMetres = 1e4;
/// Rotation per metre walked, radians.
constexpr float kTurn = 1.6f;
constexpr float kLookAhead = 1.5f; ///< metres

glm::vec3 ahead(float heading) {
    return {std::sin(heading), 0, std::cos(heading)};
}

glm::vec3 level(const glm::vec3& v) {
    return {v.x, 0, v.z};
}

/// Returns the heading with free room ahead that needs the smallest rotation; the opposite heading if there
/// is none.
float free_heading(const Ground& ground, const glm::vec3& position, float heading) {
    constexpr int kRotations = 12;
    for (int i = 1; i <= kRotations; ++i)
        for (const float side : {1.0f, -1.0f}) {
            const float tried = heading + side * kTurnAround * static_cast<float>(i) / kRotations;
            if (ground.free_way(position, ahead(tried), kLookAhead) >= kLookAhead)
                return tried;
        }
    return heading + kTurnAround;
}

} // namespace

FigureWalk::FigureWalk(std::shared_ptr<const Model> model, const Walker& walker, std::vector<glm::vec3> path)
    : model_(std::move(model)), walker_(walker), path_(std::move(path)) {
    if (!path_.empty()) {
        follow_path();
        return;
    }
    const Ground ground(*model_, walker_);
    position_ = ground.widest().value_or(glm::vec3(model_->center.x, model_->box.low.y, model_->center.z));
    if (ground.free_way(position_, ahead(heading_), kLookAhead) < kLookAhead)
        heading_ = free_heading(ground, position_, heading_);
}

void FigureWalk::advance(double metres) {
    if (!model_)
        return;
    if (!path_.empty()) {
        walked_ += metres;
        follow_path();
        return;
    }
    for (double left = std::min(metres, kMaxMetres); left > 0; left -= kLook)
        wander(static_cast<float>(std::min<double>(left, kLook)));
}

void FigureWalk::follow_path() {
    double length = 0;
    for (std::size_t i = 0; i < path_.size(); ++i)
        length += glm::distance(level(path_[i]), level(path_[(i + 1) % path_.size()]));
    double at = length > 0 ? std::fmod(walked_, length) : 0;
    std::size_t i = 0;
    const auto next = [&] { return path_[(i + 1) % path_.size()]; };
    for (; i + 1 < path_.size() && at >= glm::distance(level(path_[i]), level(next())); ++i)
        at -= glm::distance(level(path_[i]), level(next()));
    const glm::vec3 way = level(next() - path_[i]);
    const float share = glm::length(way) > 0 ? static_cast<float>(at) / glm::length(way) : 0;
    const glm::vec3 point = glm::mix(path_[i], next(), std::min(share, 1.0f));
    position_ =
        Ground(*model_, walker_).below(point + glm::vec3(0, 0.5f * walker_.height, 0)).value_or(point);
    if (glm::length(way) > 0)
        heading_ = std::atan2(way.x, way.z);
}

void FigureWalk::wander(float metres) {
    const Ground ground(*model_, walker_);
    const float way = ground.free_way(position_, ahead(heading_), kLookAhead);
    if (way < kLookAhead) { // rotate more slowly if there is more room
        const float wanted = free_heading(ground, position_, heading_);
        const float most = kTurn * metres * (1 + 2 * (kLookAhead - way) / kLookAhead);
        heading_ += std::clamp(wanted - heading_, -most, most);
    }
    const float walked = std::min(metres, std::max(0.0f, way - 0.5f * walker_.width));
    const glm::vec3 point = position_ + walked * ahead(heading_);
    if (const auto floor = ground.below(point + glm::vec3(0, 2 * walker_.step, 0));
        floor && std::abs(floor->y - position_.y) <= 2 * walker_.step)
        position_ = *floor;
}

} // namespace viewer
