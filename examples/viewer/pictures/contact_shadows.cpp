// Places the occluders of a frame and binds them for the shaders.

#include "pictures/contact_shadows.h"

#include <epoxy/gl.h>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/gtc/matrix_transform.hpp>
#include <glm/gtc/type_ptr.hpp>

#include <algorithm>
#include <cmath>

namespace viewer {
namespace {

/// Returns the occlusion volume of a sphere of radius 1 about the origin, in closed form.
prt::OcclusionVolume unit_ball() {
    prt::OcclusionVolume volume{glm::vec3(-3), glm::vec3(3), 10, {}};
    constexpr float kCells = prt::kOccluderSide - 1;
    for (std::size_t i = 0; i < volume.texels.size(); ++i) {
        const auto n = static_cast<int>(i);
        const glm::vec3 corner(n % prt::kOccluderSide, n / prt::kOccluderSide % prt::kOccluderSide,
                               n / (prt::kOccluderSide * prt::kOccluderSide));
        const glm::vec3 at = glm::mix(volume.low, volume.high, corner / kCells);
        const float sine = std::min(1 / glm::length(at), 1.0f);
        volume.texels[i] = prt::occluder_texel(0.5f * (1 - std::sqrt(1 - sine * sine)), -glm::normalize(at));
    }
    return volume;
}

} // namespace

void ContactShadows::set_figure(std::vector<prt::NodeOccluder> occluders) {
    nodes_ = std::move(occluders);
    gpu_.reset();
    placed_.clear();
}

void ContactShadows::place(const FigurePose* pose, std::span<const Ball> balls) {
    placed_.clear();
    std::vector<prt::PlacedOccluder> all;
    if (pose)
        for (std::size_t i = 0; i < nodes_.size(); ++i)
            if (const auto node = static_cast<std::size_t>(nodes_[i].node); node < pose->nodes.size())
                all.push_back(prt::placed(nodes_[i].volume, glm::mat4(pose->node(node)), i));
    const prt::OcclusionVolume ball = unit_ball();
    for (const Ball& b : balls)
        all.push_back(prt::placed(
            ball, glm::scale(glm::translate(glm::mat4(1), b.middle), glm::vec3(b.radius)), nodes_.size()));
    if (all.empty())
        return;
    if (!gpu_) {
        std::vector<prt::OcclusionVolume> volumes;
        for (const prt::NodeOccluder& node : nodes_)
            volumes.push_back(node.volume);
        volumes.push_back(ball);
        gpu_.emplace(volumes);
    }
    box_ = {all.front().center(), all.front().center()};
    for (const prt::PlacedOccluder& one : all) {
        box_.low = glm::min(box_.low, one.center() - one.reach());
        box_.high = glm::max(box_.high, one.center() + one.reach());
    }
    for (const std::uint32_t i : prt::occluders_near(all, box_.low, box_.high, prt::kMaxOccluders))
        placed_.push_back(all[i]);
}

void ContactShadows::use(const prt::GlObject& program) {
    gpu_->use(placed_);
    glUniform3fv(prt::uniform(program, "occluders_low"), 1, glm::value_ptr(box_.low));
    glUniform3fv(prt::uniform(program, "occluders_high"), 1, glm::value_ptr(box_.high));
}

} // namespace viewer
