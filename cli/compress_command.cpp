#include "commands.h"

#include "inputs.h"
#include "prt/compress.h"
#include "prt/error.h"
#include "prt/error_measures.h"
#include "report.h"

#include <fmt/core.h>

#include <filesystem>

namespace prt::cli {

void run(const CompressArguments& a, Interrupt& interrupt) {
    Model model = load_model(a.baked);
    if (!model.baked)
        throw Error(a.baked.string() + (model.compressed
                                            ? ": is compressed already; compress the bake it came from"
                                            : ": holds no transfer; run prt bake first"));
    const Transfer& transfer = model.baked->transfer;
    const std::vector<float> areas = receiver_areas(model.scene);
    CompressResult result;
    {
        ProgressBar bar("compressing", interrupt.token());
        result = compress(transfer, areas, a.options, bar.progress());
    }
    write_clustered(model.document, model.scene, {result.transfer, model.baked->record});
    {
        const Interrupt::WritingScope writing(interrupt);
        save_glb(model.document, a.output);
    }
    // The figure is that of the file, not of what was meant to be written.
    const Model written = load_model(a.output);
    CompressStatistics& s = result.statistics;
    s.relative_l2 = relative_l2(transfer, decode(written.compressed->transfer), areas);

    const auto uncompressed = static_cast<double>(transfer.dimension() * sizeof(float));
    const auto receivers = static_cast<double>(transfer.receivers());
    const double with_bases =
        static_cast<double>(s.bytes_per_receiver) + static_cast<double>(s.basis_bytes) / receivers;
    fmt::print("{}: {} clusters x {} components, relative L2 {:.3f} %\n", a.output.string(), s.clusters,
               written.compressed->transfer.bases.max_components(), 100 * s.relative_l2);
    fmt::print("  {} bytes per vertex of {:g}, {:.2f} with the bases\n", s.bytes_per_receiver, uncompressed,
               with_bases);
    fmt::print("  {:.2f} s, {} rounds\n", s.seconds, s.relative_l2_by_iteration.size());
    write_json({{"output", a.output.string()},
                {"order", transfer.order},
                {"channels", transfer.channels},
                {"receivers", transfer.receivers()},
                {"clusters", s.clusters},
                {"components", written.compressed->transfer.bases.max_components()},
                {"relative_l2", s.relative_l2},
                {"relative_l2_by_iteration", s.relative_l2_by_iteration},
                {"bytes_per_vertex", s.bytes_per_receiver},
                {"bytes_per_vertex_with_bases", with_bases},
                {"bytes_per_vertex_uncompressed", uncompressed},
                {"bytes_bases", s.basis_bytes},
                {"bytes_output", std::filesystem::file_size(a.output)},
                {"seconds", s.seconds}},
               a.json, interrupt);
}

} // namespace prt::cli
