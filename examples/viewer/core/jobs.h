#pragma once

// All that the viewer does in the background.

#include "core/document.h"
#include "pictures/lamps.h"

#include <array>

namespace viewer {

/// One job of a kind at a time: another one stops the first, unless it says otherwise.
class Jobs {
public:
    /// Reads models that hold the same scene, and takes over transfer from `open` where that is of it, too.
    /// Then bakes, compresses and finds the occlusion, what of it is missing.
    void open(const std::vector<std::filesystem::path>& paths, const OpenModels& open);
    /// Bakes `model`, compresses that and finds the occlusion.
    void bake(std::shared_ptr<const Model> model);
    /// Compresses what was baked anew; finds the occlusion where it is missing.
    void compress(const Document& document, const CompressionSettings& how);
    /// Tells figures from scenes and reads the last figure.
    void sort(const std::vector<std::filesystem::path>& paths, bool scene_open);
    void read_figure(const std::filesystem::path& path);
    /// Finds the volume of `model` in its file, or bakes one.
    void find_volume(std::shared_ptr<const Model> model);
    /// Reads environments; those that were still being read are read, too.
    void read_environments(const std::vector<std::filesystem::path>& paths);
    void find_numbers(const Document& document, const prt::Lighting& lighting, const LampSettings& lamps);
    /// Measures where the error over the surface comes from, of a document with raw transfer.
    void find_budget(const Document& document, const LightRig& rig, const RadianceVersion& version);
    /// Writes the model with its compressed transfer.
    void save(const Document& document, const std::filesystem::path& output);

    /// Ends work of that kind.
    void stop(JobKind kind) { works_[static_cast<std::size_t>(kind)].stop(); }

    /// Returns what was found since the last call.
    std::vector<Finding> collect();

    bool busy(JobKind kind) const { return work(kind).busy(); }
    /// Files are read or written, or the model is baked or compressed.
    bool busy() const;
    /// What there is of raw transfer is of few rays.
    bool baking() const { return busy(JobKind::model) && work(JobKind::model).stage() == Stage::baking; }
    /// Nothing would be lost by compressing again.
    bool may_compress() const;
    /// Of work of that kind: what is done, and how far it is.
    std::string label(JobKind kind = JobKind::model) const { return work(kind).label(); }
    double share(JobKind kind = JobKind::model) const { return work(kind).share(); }

private:
    const BackgroundWork<Finding>& work(JobKind kind) const { return works_[static_cast<std::size_t>(kind)]; }
    void start(JobKind kind, std::function<void(Channel&)> work);

    std::array<BackgroundWork<Finding>, 7> works_; ///< [JobKind]
    std::vector<std::filesystem::path> environments_to_read_;
};

} // namespace viewer
