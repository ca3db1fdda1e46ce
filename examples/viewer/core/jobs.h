#pragma once

// All background jobs of the viewer.

#include "core/document.h"
#include "pictures/lamps.h"

#include <array>

namespace viewer {

/// Runs one job per kind. A new job stops the running one of its kind; `read_environments` continues with its
/// unread files.
class Jobs {
public:
    /// Reads models that hold one scene, and takes over the transfer in `open` that fits it. Then bakes,
    /// compresses and computes the occlusion where these are missing.
    void open(const std::vector<std::filesystem::path>& paths, const OpenModels& open);
    /// Bakes `model`, compresses the result and computes the occlusion.
    void bake(std::shared_ptr<const Model> model);
    /// Compresses the raw transfer again; computes the occlusion if it is missing.
    void compress(const Document& document, const CompressionSettings& how);
    /// Separates figures from scenes and reads the last figure.
    void sort(const std::vector<std::filesystem::path>& paths, bool scene_open);
    void read_figure(const std::filesystem::path& path);
    /// Reads the volume of `model` from its file, or bakes one.
    void find_volume(std::shared_ptr<const Model> model);
    /// Reads environments, and those of the previous call that are not read yet.
    void read_environments(const std::vector<std::filesystem::path>& paths);
    void find_numbers(const Document& document, const prt::Lighting& lighting, const LampSettings& lamps);
    /// Measures the sources of the error over the surface. The document must have raw transfer.
    void find_budget(const Document& document, const LightRig& rig, const RadianceVersion& version);
    /// Writes the model with its compressed transfer.
    void save(const Document& document, const std::filesystem::path& output);

    /// Stops the job of this kind.
    void stop(JobKind kind) { works_[static_cast<std::size_t>(kind)].stop(); }

    /// Returns the findings since the last call.
    std::vector<Finding> collect();

    bool busy(JobKind kind) const { return work(kind).busy(); }
    /// True while files are read or written, or the model is baked or compressed.
    bool busy() const;
    /// True while the bake runs: the raw transfer has few rays so far.
    bool baking() const { return busy(JobKind::model) && work(JobKind::model).stage() == Stage::baking; }
    /// True if a new compression would not stop other results.
    bool may_compress() const;
    /// Label and progress (0..1) of the job of this kind.
    std::string label(JobKind kind = JobKind::model) const { return work(kind).label(); }
    double share(JobKind kind = JobKind::model) const { return work(kind).share(); }

private:
    const BackgroundWork<Finding>& work(JobKind kind) const { return works_[static_cast<std::size_t>(kind)]; }
    void start(JobKind kind, std::function<void(Channel&)> work);

    std::array<BackgroundWork<Finding>, 7> works_; ///< [JobKind]
    std::vector<std::filesystem::path> environments_to_read_;
};

} // namespace viewer
