#include "commands.h"

#include "prt/gltf.h"
#include "report.h"

#include <fmt/core.h>

#include <filesystem>

namespace prt::cli {

void run(const BakeArguments& a, Interrupt& interrupt) {
    GltfDocument document = load_gltf(a.scene);
    const Scene scene = extract_scene(document);
    print_notices(a.scene.string(), scene.notices);
    std::size_t not_opaque = 0;
    for (const Primitive& primitive : scene.primitives)
        not_opaque += scene.materials[primitive.material].alpha_mode != AlphaMode::opaque;
    if (not_opaque > 0)
        print_notices(
            a.scene.string(),
            {fmt::format("{} primitives with alpha cast shadows as if they were opaque", not_opaque)});

    BakeResult result;
    {
        ProgressBar bar("baking", interrupt.token());
        result = bake(scene, a.options, bar.progress());
    }
    write_transfer(document, scene, result.baked);
    {
        const Interrupt::WritingScope writing(interrupt);
        save_glb(document, a.output);
    }
    const BakeStatistics& s = result.statistics;
    const std::size_t unused = s.receivers - s.traced;
    fmt::print("{}: {} receivers, {} triangles, order {}, {} rays each\n", a.output.string(), s.receivers,
               s.triangles, a.options.order, a.options.rays);
    if (unused > 0)
        fmt::print("  {} receivers are on no surface and have zero transfer\n", unused);
    fmt::print("  {:.3f} s build, {:.3f} s trace, {:.2f} million rays/s\n", s.seconds_build, s.seconds_trace,
               s.rays_per_second * 1e-6);
    fmt::print("  mean visibility {:.4f}\n", s.mean_visibility);
    write_json({{"output", a.output.string()},
                {"order", a.options.order},
                {"channels", result.baked.transfer.channels},
                {"bake", bake_record_json(result.baked.record)},
                {"receivers", s.receivers},
                {"receivers_traced", s.traced},
                {"triangles", s.triangles},
                {"seconds_build", s.seconds_build},
                {"seconds_trace", s.seconds_trace},
                {"rays_per_second", s.rays_per_second},
                {"mean_visibility", s.mean_visibility},
                {"bytes_output", std::filesystem::file_size(a.output)}},
               a.json, interrupt);
}

} // namespace prt::cli
