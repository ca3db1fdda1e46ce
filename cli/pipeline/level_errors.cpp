// Compares coarser levels with level 0 at points of their surfaces.

#include "cli/pipeline/level_errors.h"

#include "bake/gltf/reorder.h"
#include "bake/gltf/reparse.h"
#include "prt/bake/level_bake.h"

#include <algorithm>
#include <map>

namespace prt::pipeline {
namespace {

/// A file with the transfer of all its levels.
struct LeveledModel {
    LeveledScene scene;
    Transfer transfer;
};

std::optional<LeveledModel> leveled_model(const GltfDocument& document) {
    if (!has_levels(document))
        return std::nullopt;
    if (shares_instances(document)) // as the transfer is stored
        return leveled_model(reparse(document, Instancing::separate));
    LeveledModel model{extract_levels(document), {}};
    if (!levels_have_transfer(document, model.scene))
        return std::nullopt;
    if (std::optional<BakedTransfer> baked = read_transfer(document, model.scene.scene))
        model.transfer = std::move(baked->transfer);
    else if (const auto compressed = read_clustered(document, model.scene.scene))
        model.transfer = decode(compressed->transfer);
    else
        return std::nullopt;
    return model;
}

/// One level of all nodes.
struct LevelErrors {
    std::size_t nodes = 0, triangles = 0, vertices = 0;
    LevelSquares baked, shipped;
    std::vector<LevelSquares> lit; ///< [lights]
};

/// Radiance, albedo 1, without lamps: [receivers][3].
std::vector<float> radiance_of(const Transfer& transfer, const Light& light, int threads) {
    Lighting lighting{light};
    lighting.lamps.assign(transfer.layout.lamps(), glm::vec3(0));
    std::vector<float> numbers;
    for (const glm::vec3& r : exit_radiance(transfer, lighting, threads))
        numbers.insert(numbers.end(), {r.x, r.y, r.z});
    return numbers;
}

/// Both by level, under each light.
class LevelMeter {
public:
    LevelMeter(Transfer baked, Transfer shipped, const std::vector<LoadedLight>& lights, int threads)
        : baked_(as_combined(baked, threads)), shipped_(as_combined(shipped, threads)), threads_(threads) {
        for (const LoadedLight& light : lights) {
            lit_baked_.push_back(radiance_of(baked_, light.combined, threads));
            lit_shipped_.push_back(radiance_of(shipped_, light.combined, threads));
        }
    }

    std::map<int, LevelErrors> measure(const LeveledScene& scene) const {
        static constexpr float kColors[] = {1, 1, 1};
        std::map<int, LevelErrors> errors;
        for (const LeveledNode& node : scene.nodes)
            for (const CoarserLevel& level : node.coarser) {
                LevelErrors& sum = errors[level.level];
                sum.lit.resize(lit_baked_.size());
                ++sum.nodes;
                sum.vertices += vertices_of(scene.scene, level.primitives);
                for (const std::size_t p : level.primitives)
                    sum.triangles += scene.scene.primitives[p].triangles.size();
                const LevelSamples samples = sample_level(scene, node, level, {.threads = threads_});
                sum.baked += level_error(samples, baked_, baked_);
                sum.shipped += level_error(samples, baked_, shipped_);
                for (std::size_t l = 0; l < lit_baked_.size(); ++l)
                    sum.lit[l] += level_error(samples, lit_baked_[l], lit_shipped_[l], kColors);
            }
        return errors;
    }

private:
    Transfer baked_, shipped_;
    int threads_;
    std::vector<std::vector<float>> lit_baked_, lit_shipped_;
};

Table levels_table(const std::map<int, LevelErrors>& errors, const std::vector<LoadedLight>& lights) {
    Table table{
        "levels",
        "Coarser levels of detail against level 0",
        "Relative L2 at samples over the surface of the level, against the nearest positions on level 0 of "
        "the bake. Bake: baked transfer of the level. Shipped: transfer in the compressed file. lit_rms: "
        "exit radiance of the compressed file under the worst light.",
        {},
        {}};
    const Unit share = Unit::percent;
    table.columns = {{"level", "level"},
                     {"nodes", "nodes"},
                     {"triangles", "triangles"},
                     {"vertices", "vertices"},
                     {"baked_relative_l2", "bake", share},
                     {"shipped_relative_l2", "shipped", share},
                     {"lit_rms", "lit_rms", share},
                     {"light", "worst light"}};
    for (const auto& [level, e] : errors) {
        const auto worst = std::ranges::max_element(e.lit, {}, &LevelSquares::relative_l2);
        const bool any = worst != e.lit.end();
        table.rows.push_back(
            {level, e.nodes, e.triangles, e.vertices, e.baked.relative_l2(), e.shipped.relative_l2(),
             any ? Json(worst->relative_l2()) : Json(),
             any ? Json(lights[static_cast<std::size_t>(worst - e.lit.begin())].name) : Json()});
    }
    return table;
}

} // namespace

void add_level_errors(const LevelFiles& files, const std::vector<LoadedLight>& lights, Report& report) {
    std::optional<LeveledModel> baked = about(files.baked_path, [&] { return leveled_model(files.baked); });
    if (!baked)
        return;
    const std::optional<LeveledModel> shipped =
        about(files.shipped.path, [&] { return leveled_model(files.shipped.read(files.reading)); });
    if (shipped && shipped->scene.scene.receivers() != baked->scene.scene.receivers()) {
        report.notes.emplace_back(
            "errors of coarser levels of detail: only one of the files shares transfer between instances");
        return;
    }
    if (!shipped) {
        report.notes.emplace_back(
            "errors of coarser levels of detail: the shipped file has no transfer for them");
        return;
    }
    about(files.shipped.path, [&] {
        baked->transfer = in_order_of(shipped->scene.scene, baked->scene.scene, baked->transfer);
        const LevelMeter meter(std::move(baked->transfer), shipped->transfer, lights, files.threads);
        report.tables.push_back(levels_table(meter.measure(shipped->scene), lights));
    });
}

} // namespace prt::pipeline
