#pragma once

// Shadows of moving objects on surfaces near them (prt/core/occlusion_volume.h).

#include "pictures/figure_pose.h"

#include "prt/gltf/transfer_gltf.h"
#include "runtime/render/gl/gl_occluders.h"

#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace viewer {

/// A sphere in the scene.
struct Ball {
    glm::vec3 middle;
    float radius;
};

class ContactShadows {
public:
    /// Sets the occluders of the nodes of a figure's file.
    void set_figure(std::vector<prt::NodeOccluder> occluders);
    bool has_figure() const { return !nodes_.empty(); }

    /// Sets the occluders of a frame: the figure in its pose (null: hidden) and spheres.
    void place(const FigurePose* pose, std::span<const Ball> balls);
    /// True if there are no occluders in the frame.
    bool empty() const { return placed_.empty(); }
    /// Binds the list and sets the uniforms of `program`, which must be in use (viewer_occluders.glsl).
    void use(const prt::GlObject& program);

private:
    std::vector<prt::NodeOccluder> nodes_;
    std::optional<prt::GlOccluders> gpu_; ///< created with the first occluder
    std::vector<prt::PlacedOccluder> placed_;
    prt::Bounds box_{}; ///< encloses the reaches of all occluders
};

/// Occluders for drawing the surfaces of a scene.
struct OccluderPass {
    ContactShadows* shadows = nullptr;
    std::string defines; ///< shader defines of the volume that provides the light; empty: there is no volume
};

} // namespace viewer
