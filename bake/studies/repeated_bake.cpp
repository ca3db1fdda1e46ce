// Repeats a bake from its record, and checks that the result differs only by noise.

#include "bake/studies/repeated_bake.h"

#include "prt/bake/bake.h"
#include "prt/bake/lightmap_bake.h"
#include "prt/core/error.h"

#include <fmt/core.h>

#include <cmath>

namespace prt {
namespace {

/// Relative L2 difference of two bakes with one layout in their first part.
double difference_of_bakes(const Transfer& a, const Transfer& b, std::span<const float> areas) {
    double squared = 0, norm = 0;
    const std::size_t numbers = b.layout.numbers_of(b.layout.terms.front());
    for (std::size_t p = 0; p < b.receivers(); ++p)
        for (std::size_t i = 0; i < numbers; ++i) {
            const double one = static_cast<double>(a.vector(p)[i]),
                         other = static_cast<double>(b.vector(p)[i]);
            squared += static_cast<double>(areas[p]) * (one - other) * (one - other);
            norm += static_cast<double>(areas[p]) * one * one;
        }
    return norm > 0 ? std::sqrt(squared / norm) : 0;
}

/// Options of a bake as far as its record contains them; lamps are omitted.
BakeOptions options_of_record(const BakeRecord& record, int order, int threads) {
    BakeOptions options;
    options.order = order;
    options.rays = record.rays;
    options.fit = record.fitted ? FitMode::surface : FitMode::vertex;
    options.bounces = record.endless ? kEndlessBounces : record.bounces;
    options.tracer.method = record.method;
    options.tracer.backend = record.method == BakeMethod::raster ? Backend::automatic : Backend::cpu;
    options.lamps.mode = LampMode::none;
    options.memory.storage = TransferStorage::float32;
    options.threads = threads;
    options.seed = record.seed;
    return options;
}

/// Options of a repetition, with independent rays.
BakeOptions options_of_repetition(const BakeRecord& record, int order, int threads) {
    BakeOptions options = options_of_record(record, order, threads);
    options.repairs.bad_textures = BadTextures::ignore; // the original bake accepted the textures
    options.seed = ~record.seed;
    return options;
}

/// Throws `Error` unless `repeated` differs from `baked` only by noise.
void check_repeats(const Transfer& baked, const Transfer& repeated, std::span<const float> areas,
                   const BakeRecord& record) {
    // Two bakes with independent rays differ by sqrt(2) times the error of one of them in direct light, which
    // is the first part. In practice the estimate of this error deviates by less than another factor of two,
    // or by four for few rays with a fit. A scene that was baked differently differs by tens of per cent.
    constexpr double kNoise = 6, kRounding = 0.05;
    const std::size_t terms = baked.layout.distant_terms().size();
    if (terms == 0)
        throw Error("the error cannot be broken down: the transfer has no distant light");
    bool same = terms == repeated.layout.terms.size() && baked.receivers() == repeated.receivers();
    for (std::size_t i = 0; same && i < terms; ++i)
        same = baked.layout.terms[i] == repeated.layout.terms[i];
    const double off = same ? difference_of_bakes(baked, repeated, areas) : 1;
    if (!(off <= kNoise * record.sampling_error + kRounding))
        throw Error(
            fmt::format("a repeated bake differs by {:.1f} %, but the noise of the rays is {:.1f} %; the "
                        "breakdown needs a bake of the scene as in the file: repeat --no-shadow, and bake "
                        "without --enclosed, "
                        "--subsurface and --high-poly",
                        100 * off, 100 * record.sampling_error));
}

} // namespace

Transfer repeated_bake(const Scene& scene, const Transfer& baked, const BakeRecord& record, int threads,
                       const Progress& progress) {
    const BakeOptions options = options_of_repetition(record, baked.layout.order, threads);
    Transfer repeated = bake(scene, options, progress).baked.transfer;
    check_repeats(baked, repeated, receiver_areas(scene), record);
    return repeated;
}

Transfer repeated_lightmap(const Scene& scene, const BakedLightmap& lightmap, int threads,
                           const Progress& progress) {
    const BakedTransfer& baked = lightmap.baked;
    BakeOptions options = options_of_repetition(baked.record, baked.transfer.layout.order, threads);
    options.fit = FitMode::automatic; // applies to vertices that light bounces between
    Transfer repeated =
        bake_lightmap(scene, atlases_of(lightmap.layout), options, {}, progress).lightmap.baked.transfer;
    check_repeats(baked.transfer, repeated, lightmap.areas, baked.record);
    return repeated;
}

} // namespace prt
