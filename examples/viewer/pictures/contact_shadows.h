#pragma once

// What moves takes from the light of what it comes near to (prt/occlusion_volume.h).

#include "pictures/figure_pose.h"

#include "prt/gl_occluders.h"
#include "prt/occluder_gltf.h"

#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace viewer {

/// A ball in the scene.
struct Ball {
    glm::vec3 middle;
    float radius;
};

class ContactShadows {
public:
    /// Of a figure's file, by its nodes.
    void set_figure(std::vector<prt::NodeOccluder> occluders);
    bool has_figure() const { return !nodes_.empty(); }

    /// The list of a frame: the figure as it stands, unless it is not shown, and balls.
    void place(const FigurePose* pose, std::span<const Ball> balls);
    /// Nothing is near to anything.
    bool empty() const { return placed_.empty(); }
    /// Binds the list and sets the uniforms of `program`, in use (viewer_occluders.glsl).
    void use(const prt::GlObject& program);

private:
    std::vector<prt::NodeOccluder> nodes_;
    std::optional<prt::GlOccluders> gpu_; ///< once something is placed
    std::vector<prt::PlacedOccluder> placed_;
    prt::Bounds box_{}; ///< that their reaches lie in
};

/// What one drawing of a scene's surfaces needs of them.
struct OccluderPass {
    ContactShadows* shadows = nullptr;
    std::string defines; ///< of the volume that knows the light; empty: none does
};

} // namespace viewer
