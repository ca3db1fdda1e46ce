#include "commands/commands.h"

#include "inputs.h"
#include "outputs.h"
#include "report/write_report.h"

#include <fmt/core.h>

#include <algorithm>

namespace prt::cli {
namespace {

/// "1 image", "2 images"
std::string counted(std::size_t count, const char* what) {
    return fmt::format("{} {}{}", count, what, count == 1 ? "" : "s");
}

void describe_record(const BakeRecord& record) {
    fmt::print("  baked by {} on the {}, {} per vertex, {}, seed {}\n",
               record.method == BakeMethod::raster ? "depth maps" : "rays",
               record.backend == Backend::cpu ? "CPU" : "GPU",
               counted(static_cast<std::size_t>(record.rays),
                       record.method == BakeMethod::raster ? "direction" : "ray"),
               counted(static_cast<std::size_t>(record.bounces), "bounce"), record.seed);
}

} // namespace

void run(const InfoArguments& a, Interrupt& interrupt) {
    check_outputs({{a.json, "--json", {".json"}}}, {a.file});
    const Model model = load_model(a.file);
    const Scene& scene = model.scene;
    const Bounds box = bounds(scene);
    const glm::dvec3 low = scene.world(box.low), high = scene.world(box.high);
    fmt::print("{}: {}, {}, {}, {}, {}\n", a.file.string(), counted(scene.primitives.size(), "primitive"),
               counted(scene.triangles(), "triangle"),
               scene.receivers() == 1 ? "1 vertex" : fmt::format("{} vertices", scene.receivers()),
               counted(scene.materials.size() - 1, "material"), counted(scene.images.size(), "image"));
    fmt::print("  from {:g} {:g} {:g} to {:g} {:g} {:g} m\n", low.x, low.y, low.z, high.x, high.y, high.z);
    Json report = {{"file", a.file.string()},
                   {"primitives", scene.primitives.size()},
                   {"triangles", scene.triangles()},
                   {"vertices", scene.receivers()},
                   {"materials", scene.materials.size() - 1},
                   {"images", scene.images.size()},
                   {"low_metres", {low.x, low.y, low.z}},
                   {"high_metres", {high.x, high.y, high.z}},
                   {"notices", scene.notices}};
    if (model.baked) {
        const Transfer& t = model.baked->transfer;
        const bool half = model.baked->storage == TransferStorage::float16;
        const std::size_t bytes = t.dimension() * (half ? sizeof(std::uint16_t) : sizeof(float));
        fmt::print("  raw transfer: order {}, {}, {} bytes per vertex as {}\n", t.order,
                   counted(static_cast<std::size_t>(t.channels), "channel"), bytes,
                   half ? "float16" : "float32");
        describe_record(model.baked->record);
        report["transfer"] = {{"order", t.order},
                              {"channels", t.channels},
                              {"bytes_stored_per_vertex", bytes},
                              {"bake", bake_record_json(model.baked->record)}};
    }
    if (model.compressed) {
        const ClusteredTransfer& t = model.compressed->transfer;
        const auto [least, most] = std::minmax_element(t.bases.components.begin(), t.bases.components.end());
        const bool packed = t.receivers.format == WeightFormat::packed;
        const std::size_t bits = packed ? 0 : 8 * bytes_per_weight(t.receivers.format);
        fmt::print("  clustered PCA: order {}, {}, {} x {} to {} components, {}\n", t.bases.order,
                   counted(static_cast<std::size_t>(t.bases.channels), "channel"),
                   counted(t.bases.clusters(), "cluster"), *least, *most,
                   packed ? fmt::format("packed weights") : fmt::format("{}-bit weights", bits));
        fmt::print("  {} bytes per vertex to bind ({} bits in use)\n", bytes_per_receiver(t),
                   bits_per_receiver(t));
        fmt::print("  {} bytes of bases, {} shader constants per frame\n", basis_bytes(t.bases),
                   constant_rows(t.bases));
        describe_record(model.compressed->record);
        report["clustered_pca"] = {{"order", t.bases.order},
                                   {"channels", t.bases.channels},
                                   {"clusters", t.bases.clusters()},
                                   {"components_least", *least},
                                   {"components_most", *most},
                                   {"weights", packed ? "packed" : std::to_string(bits)},
                                   {"bytes_bound_per_vertex", bytes_per_receiver(t)},
                                   {"bits_used_per_vertex", bits_per_receiver(t)},
                                   {"bytes_bases", basis_bytes(t.bases)},
                                   {"bake", bake_record_json(model.compressed->record)}};
    }
    if (!model.baked && !model.compressed)
        fmt::print("  no transfer\n");
    write_json(report, a.json, interrupt);
}

} // namespace prt::cli
