#pragma once

// What moves through the scene that is open, and the volume that lights it.

#include "core/figure_walk.h"
#include "core/findings.h"
#include "pictures/figure_pose.h"
#include "pictures/moving_stage.h"

#include "prt/animation.h"

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace viewer {

/// What a script may say of the figure.
struct FigureChoice {
    std::string animation = {};        ///< empty: the one called like a walk, else the first
    double scale = 1;                  ///< of the file
    std::vector<glm::dvec3> path = {}; ///< in the world of the model's file; empty: wherever there is room
};

/// The figure, how it stands, and where.
class Moving {
public:
    void set_figure(const FigureFile& file);
    /// What it blocks, of the figure that is there; of another one it is left out.
    void set_occluders(const FoundOccluders& found) {
        if (found.figure == file_.figure)
            occluders_ = found.occluders;
    }
    void set_volume(const FoundVolume& found) { volume_ = found; }
    /// Throws `prt::Error` where the figure has no such animation.
    void choose(const FigureChoice& choice, const std::shared_ptr<const Model>& model);
    /// Another scene is open: the figure starts anew there, and there is no volume.
    void enter(const std::shared_ptr<const Model>& model);
    void advance(double seconds, double speed);

    const std::shared_ptr<const prt::AnimatedScene>& figure() const { return file_.figure; }
    const std::shared_ptr<const prt::LobeModel>& lobes() const { return file_.lobes; }
    const std::filesystem::path& path() const { return file_.path; }
    const std::vector<prt::NodeOccluder>& occluders() const { return occluders_; }
    const FoundVolume& volume() const { return volume_; }
    /// For the frame: what lights or shades others by the figure takes its matrices from here.
    const FigurePose& pose() const { return pose_; }
    /// The surfaces of what is shown, as they stand, seen from the origin of the scene; what mirrors is left
    /// out. Null: nothing is. The same until something changes.
    std::shared_ptr<const prt::Scene> surfaces(const MovingSettings& shown);
    /// Whether a volume was not yet asked for since the scene was opened; it is now.
    bool ask_for_volume() { return !std::exchange(volume_asked_, true); }
    /// Beside where the figure began.
    const TwoSpheres& spheres() const { return spheres_; }

private:
    const prt::Animation* animation() const;
    void place(const std::shared_ptr<const Model>& model);
    void take_pose();

    FigureFile file_;
    std::vector<prt::NodeOccluder> occluders_;
    FoundVolume volume_;
    FigureChoice choice_;
    FigureWalk walk_;
    double seconds_ = 0; ///< of the animation
    FigurePose pose_;
    TwoSpheres spheres_;
    bool volume_asked_ = false;
    struct Surfaces {
        std::uint64_t version = 0; ///< of the pose
        bool figure = false, spheres = false;
        std::shared_ptr<const prt::Scene> scene;
    };
    Surfaces surfaces_;
};

} // namespace viewer
