#pragma once

// The objects that move through the open scene, and the volume that lights them.

#include "core/figure_walk.h"
#include "core/findings.h"
#include "pictures/figure_pose.h"
#include "pictures/moving_stage.h"

#include "prt/gltf/animation.h"

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace viewer {

/// Figure options of a script.
struct FigureChoice {
    std::string animation = {};        ///< empty: the animation named like a walk, otherwise the first
    double scale = 1;                  ///< scale factor on the file's units
    std::vector<glm::dvec3> path = {}; ///< path in the world space of the model's file; empty: walk freely
                                       ///< where there is room
};

/// State of the moving figure, its pose and position.
class Moving {
public:
    void set_figure(const FigureFile& file);
    /// Sets the occluders if they belong to the current figure; ignores them otherwise.
    void set_occluders(const FoundOccluders& found) {
        if (found.figure == file_.figure)
            occluders_ = found.occluders;
    }
    void set_volume(const FoundVolume& found) { volume_ = found; }
    /// Throws `prt::Error` if the figure does not have this animation.
    void choose(const FigureChoice& choice, const std::shared_ptr<const Model>& model);
    /// Adapts to another open scene: restarts the figure there and removes the volume.
    void enter(const std::shared_ptr<const Model>& model);
    void advance(double seconds, double speed);

    const std::shared_ptr<const prt::AnimatedScene>& figure() const { return file_.figure; }
    const std::shared_ptr<const prt::LobeModel>& lobes() const { return file_.lobes; }
    const std::filesystem::path& path() const { return file_.path; }
    const std::vector<prt::NodeOccluder>& occluders() const { return occluders_; }
    const FoundVolume& volume() const { return volume_; }
    /// Pose of the frame. All code that lights or shades objects by the figure uses these matrices.
    const FigurePose& pose() const { return pose_; }
    /// Returns the surfaces of the shown objects in their current pose, in scene space; null if nothing is
    /// shown. Mirrored surfaces are omitted. Returns the same object until something changes.
    std::shared_ptr<const prt::Scene> surfaces(const MovingSettings& shown);
    /// Returns true once per opened scene: a volume was not requested yet, and is requested now.
    bool ask_for_volume() { return !std::exchange(volume_asked_, true); }
    /// Spheres next to the starting position of the figure.
    const TwoSpheres& spheres() const { return spheres_; }

private:
    const prt::Animation* animation() const;
    void place_figures(const std::shared_ptr<const Model>& model);
    void take_pose();

    FigureFile file_;
    std::vector<prt::NodeOccluder> occluders_;
    FoundVolume volume_;
    FigureChoice choice_;
    FigureWalk walk_;
    double seconds_ = 0; ///< time in the animation
    FigurePose pose_;
    TwoSpheres spheres_;
    bool volume_asked_ = false;
    struct Surfaces {
        std::uint64_t version = 0; ///< version of the pose
        bool figure = false, spheres = false;
        std::shared_ptr<const prt::Scene> scene;
    };
    Surfaces surfaces_;
};

} // namespace viewer
