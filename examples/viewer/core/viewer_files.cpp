// What the viewer reads and writes.

#include "core/viewer.h"

#include "prt/support/error.h"

#include <fmt/core.h>

namespace viewer {
namespace {

bool is_environment(const std::filesystem::path& path) {
    return path.extension() == ".hdr" || path.extension() == ".exr" || path.extension() == ".pic";
}

bool is_model(const std::filesystem::path& path) {
    return path.extension() == ".glb" || path.extension() == ".gltf";
}

} // namespace

void Viewer::open(const std::vector<std::filesystem::path>& paths) {
    std::vector<std::filesystem::path> models, environments;
    for (const std::filesystem::path& path : paths) {
        if (is_model(path))
            models.push_back(path);
        else if (is_environment(path))
            environments.push_back(path);
        else
            message(path.string() + ": is neither a model (.glb, .gltf) nor an environment map (.hdr, .exr)");
    }
    if (!environments.empty())
        open_environments(environments);
    if (!models.empty())
        open_models(models);
}

void Viewer::open_models(const std::vector<std::filesystem::path>& paths) {
    opening_.emplace();
    work_.start(
        [this, paths,
         open = LoadedModel{model_, raw_, compressed_, record_}](BackgroundWork::Channel& channel) {
            channel.stage("reading " + paths.front().filename().string());
            const LoadedModel loaded = load_together(paths, open);
            channel.post([this, loaded] { take(loaded); });
            complete(channel, loaded);
        },
        [this](const std::string& why) {
            opening_.reset();
            message(why);
        });
}

void Viewer::open_environments(const std::vector<std::filesystem::path>& paths) {
    // Those that were still being read are read again.
    environments_to_read_.insert(environments_to_read_.end(), paths.begin(), paths.end());
    environment_work_.start(
        [this, all = environments_to_read_](BackgroundWork::Channel& channel) {
            for (const std::filesystem::path& path : all) {
                std::shared_ptr<const LoadedEnvironment> environment;
                std::string why;
                try {
                    environment = std::make_shared<const LoadedEnvironment>(load_environment(path.string()));
                } catch (const prt::Error& error) {
                    why = error.what(); // the others are read all the same
                }
                channel.post([this, path, environment, why] {
                    std::erase(environments_to_read_, path);
                    if (!environment)
                        return message(why);
                    environments_.push_back(environment);
                    use_environment(environments_.size() - 1);
                });
            }
        },
        [this](const std::string& why) { message(why); });
}

void Viewer::use_environment(std::size_t index) {
    rig_.set_environment(environments_[index]);
    lights.day = false;
    lights.environment_on = true;
}

void Viewer::save(std::filesystem::path output) {
    if (!can_save())
        return message("there is nothing compressed yet to save");
    for (int i = 1; output.empty(); ++i) {
        const std::string number = i == 1 ? "" : fmt::format("-{}", i);
        const std::filesystem::path name =
            fmt::format("{}.shipped{}.glb", model_->path.stem().string(), number);
        if (!std::filesystem::exists(model_->path.parent_path() / name))
            output = model_->path.parent_path() / name;
    }
    save_work_.start(
        [this, output, model = model_,
         compressed = prt::CompressedTransfer{*compressed_, record_}](BackgroundWork::Channel& channel) {
            channel.stage("saving " + output.filename().string());
            save_compressed(*model, compressed, output);
            channel.post([this, output] { message("saved " + std::filesystem::absolute(output).string()); });
        },
        [this](const std::string& why) { message(why); });
}

} // namespace viewer
