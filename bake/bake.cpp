#include "prt/bake.h"

#include "adaptive.h"
#include "available_memory.h"
#include "prt/sh.h"
#include "prt/support/error.h"
#include "prt/support/stopwatch.h"
#include "prt/trace_receivers.h"
#include "prt/trace_scene.h"
#include "scene/material_notices.h"
#include "scene/mesh_neighbours.h"
#include "scene/sealed.h"
#include "storage.h"
#include "transport/gather.h"
#include "transport/light_transport.h"

#include <fmt/core.h>

#include <algorithm>
#include <map>
#include <numeric>

namespace prt {
namespace {

void check_options(const BakeOptions& options) {
    check_order(options.order);
    if (options.rays < 1 || options.rays > kMostRays)
        throw Error(fmt::format("rays per receiver must lie in 1..{}, not {}", kMostRays, options.rays));
    if (options.bounces < 0 && options.bounces != kEndlessBounces)
        throw Error(fmt::format("{} bounces cannot be", options.bounces));
    if (options.target_error && !(*options.target_error > 0))
        throw Error("the error to reach must be above 0");
    if (!(options.metres_per_unit > 0))
        throw Error("metres per unit must be above 0");
    if (options.tracer.method == BakeMethod::raster) {
        if (options.tracer.backend == Backend::cpu)
            throw Error("method raster draws on the GPU: it has no CPU backend");
        if (options.bounces != 0)
            throw Error("method raster finds direct light only: use method trace for bounces");
        if (options.target_error)
            throw Error(
                "method raster takes the same directions everywhere: use method trace for an error to "
                "reach");
        if (options.tracer.raster_resolution < 16 || options.tracer.raster_resolution > 16384)
            throw Error("the resolution of depth maps must lie in 16..16384");
    }
}

/// One ray of so many is followed for the bounces. Measured on the room with columns, 3 bounces, 1 024 rays:
/// relative L2 2.32 % in 1.53 s and 190 MB with every ray, 2.86 % in 1.04 s and 59 MB with every fourth (0.74
/// s without bounces); more rays would buy that error back in the time that was saved.
constexpr int kHitStride = 4;

/// A part of the work, as a part of the progress.
Progress part_of(const Progress& whole, double from, double to) {
    return {[&whole, from, to](double fraction) { whole.update(from + (to - from) * fraction); }, whole.stop};
}

/// The media of the scene's materials, in the scene's unit.
std::vector<std::optional<Medium>> choose_media(const Scene& scene, const BakeOptions& options) {
    std::vector<std::optional<Medium>> media;
    for (const Material& material : scene.materials)
        media.push_back(medium_of(material));
    for (const MediumChoice& choice : options.subsurface) {
        bool found = false;
        for (std::size_t m = 0; m < scene.materials.size(); ++m)
            if (choice.material.empty() || scene.materials[m].name == choice.material) {
                media[m] = choice.medium;
                found = true;
            }
        if (!found)
            throw Error("no material is called '" + choice.material + "'");
    }
    for (auto& medium : media)
        if (medium) {
            medium->scattering *= options.metres_per_unit;
            medium->absorption *= options.metres_per_unit;
        }
    return media;
}

class Baker {
public:
    Baker(const Scene& scene, const BakeOptions& options, const Progress& progress)
        : scene_(scene), options_(options), progress_(progress), media_(choose_media(scene, options)),
          traced_(scene, load_textures(scene, options.bad_textures, texture_needs()),
                  {.solid = solid(), .threads = options.threads}) {
        note_materials();
    }

    BakeResult run() {
        const Stopwatch all;
        receivers_ = transport_receivers(vertex_receivers(scene_), surfaces());
        decide_what_is_needed();
        check_memory(memory_needed());
        tracer_ = make_tracer(traced_, options_.tracer);
        statistics().device = tracer_->device();
        statistics().seconds_build = all.seconds();

        Transfer transfer = trace();
        statistics().mean_visibility = mean_visibility(transfer, fronts_areas());
        const Stopwatch transport;
        transfer = propagated(std::move(transfer));
        statistics().seconds_transport = transport.seconds();
        finish(std::move(transfer));
        statistics().seconds = all.seconds();
        statistics().rays_per_second = static_cast<double>(statistics().rays) / statistics().seconds;
        progress_.update(1);
        return std::move(result_);
    }

private:
    const Surfaces& surfaces() const { return traced_.surfaces(); }
    BakeStatistics& statistics() { return result_.statistics; }
    template <class... Args>
    void note(fmt::format_string<Args...> format, Args&&... args) {
        statistics().notices.push_back(fmt::format(format, std::forward<Args>(args)...));
    }

    TextureNeeds texture_needs() const {
        return options_.bounces != 0 ? TextureNeeds::all : TextureNeeds::visibility;
    }

    std::vector<bool> solid() const {
        std::vector<bool> result;
        for (const auto& medium : media_)
            result.push_back(medium.has_value());
        return result;
    }

    void note_materials() {
        for (const auto& [image, encoding] : needed_images(scene_, texture_needs()))
            if (traced_.textures()[static_cast<std::size_t>(image)].levels.empty())
                note("image {} is missing or damaged: the factors of its materials are used alone", image);
        for (std::string& notice : material_notices(scene_, options_.bounces != 0))
            statistics().notices.push_back(std::move(notice));
    }

    /// Only what the scene needs: bounces, back sides and colour.
    void decide_what_is_needed() {
        bounces_ = options_.bounces;
        if (bounces_ != 0 && !surfaces().traits().scattering) {
            bounces_ = 0;
            note("no bounces: every surface is black");
        }
        if (bounces_ == 0 && !surfaces().traits().transmission && !receivers_.back.empty()) {
            Receivers& all = receivers_.receivers;
            all.positions.resize(receivers_.fronts);
            all.normals.resize(receivers_.fronts);
            all.areas.resize(receivers_.fronts);
            all.starts.resize(receivers_.fronts);
            receivers_.back.clear();
        }
        make_diffusion();
        const bool grey_media =
            std::all_of(diffusion_.begin(), diffusion_.end(), [](const auto& d) { return d.is_grey(); });
        const bool colored =
            (surfaces().traits().color && (bounces_ != 0 || surfaces().traits().transmission)) || !grey_media;
        channels_ = colored ? 3 : 1;
        if (!colored)
            note("one channel: {}", bounces_ != 0 ? "every surface is grey" : "direct light is white");
        statistics().receivers = receivers_.fronts;
        statistics().back_sides = receivers_.receivers.size() - receivers_.fronts;
        statistics().triangles = scene_.triangles();
    }

    /// One operator for each medium of each node.
    void make_diffusion() {
        std::map<std::pair<std::size_t, int>, std::vector<glm::uvec3>> bodies;
        for (const Primitive& primitive : scene_.primitives) {
            if (!media_[primitive.material])
                continue;
            auto& triangles = bodies[{primitive.material, primitive.node}];
            const auto first = static_cast<unsigned>(scene_.vertex_arrays[primitive.vertices].first_receiver);
            for (const glm::uvec3& t : primitive.triangles)
                triangles.push_back(t + first);
        }
        for (auto& [key, triangles] : bodies)
            diffusion_.emplace_back(receivers_.receivers, std::move(triangles), *media_[key.first]);
    }

    double memory_there() const {
        return options_.memory_limit > 0 ? options_.memory_limit : available_memory();
    }

    double memory_needed() const {
        return estimate_memory(options_, receivers_.receivers.size(), scene_.triangles(), channels_);
    }

    void check_memory(double needed) const {
        const double there = memory_there();
        if (there > 0 && needed > there)
            throw Error(
                fmt::format("the bake needs about {:.2g} GB of memory ({} receivers, order {}, {} rays{}), "
                            "and {} {:.2g} GB",
                            needed * 1e-9, receivers_.receivers.size(), options_.order, options_.rays,
                            bounces_ != 0 ? ", with bounces" : "",
                            options_.memory_limit > 0 ? "the limit is" : "there are", there * 1e-9));
    }

    /// Asks whether the rows of the gather fit: by what there can be at most, else by what some receivers
    /// see.
    void check_gather_memory(const std::map<std::uint32_t, std::vector<std::uint32_t>>& by_rays,
                             const TraceOptions& options) {
        double most = 0, likely = 0;
        for (const auto& [rays, members] : by_rays)
            most += static_cast<double>(members.size()) * rays * GatherOperator::kMostBytesPerRay;
        // Through blended surfaces a ray meets any number.
        if (!surfaces().traits().alpha && memory_needed() + most <= memory_there())
            return;
        for (const auto& [rays, members] : by_rays)
            likely += estimate_gather(members, static_cast<int>(rays), options);
        check_memory(memory_needed() + likely);
    }

    /// Bytes of the rows of all `receivers`, from some rays of some of them.
    double estimate_gather(const std::vector<std::uint32_t>& receivers, int rays, TraceOptions options) {
        const std::size_t count = std::min<std::size_t>(64, receivers.size());
        std::vector<std::uint32_t> some;
        for (std::size_t i = 0; i < count; ++i)
            some.push_back(receivers[i * receivers.size() / count]);
        GatherOperator rows(surfaces(), receivers_, channels_);
        const auto empty = static_cast<double>(rows.bytes());
        options.order = 1;
        options.rays = std::min(rays, 4096);
        Transfer unused = zero_transfer(1, 1, receivers_.receivers.size());
        trace_receivers(
            *tracer_, receivers_.receivers, some, options, unused, {{}, progress_.stop},
            [&](std::uint32_t p, std::span<const Hit> hits) { rows.set_row(p, hits, options.rays); });
        statistics().rays += count * static_cast<std::size_t>(options.rays);
        return empty + (static_cast<double>(rows.bytes()) - empty) * static_cast<double>(receivers.size()) /
                           static_cast<double>(count) * rays / options.rays;
    }

    std::span<const float> fronts_areas() const {
        return std::span(receivers_.receivers.areas).first(receivers_.fronts);
    }

    /// Direct transfer, the gather operator where there are bounces, and which receivers are inside.
    Transfer trace() {
        const Receivers& receivers = receivers_.receivers;
        const std::vector<std::uint32_t> indices = receivers_on_surfaces(receivers);
        statistics().traced = static_cast<std::size_t>(
            std::lower_bound(indices.begin(), indices.end(), receivers_.fronts) - indices.begin());
        TraceOptions options{options_.order, options_.rays, options_.seed, 0};
        std::vector<std::uint32_t> rays_of(receivers.size(), static_cast<std::uint32_t>(options_.rays));
        Transfer transfer{options_.order, 1, {}};
        const Progress progress = part_of(progress_, 0, bounces_ != 0 ? 0.85 : 0.95);
        if (options_.target_error) {
            AdaptiveResult adaptive =
                adaptive_transfer(*tracer_, receivers, neighbours(), options, *options_.target_error,
                                  bounces_ != 0 ? part_of(progress, 0, 0.5) : progress);
            transfer = std::move(adaptive.transfer);
            rays_of = std::move(adaptive.rays);
            statistics().rays += std::accumulate(rays_of.begin(), rays_of.end(), adaptive.rays_checked);
            statistics().sampling_error = adaptive.error;
            if (!adaptive.reached)
                note("the error to reach was not reached with {} rays per receiver", kMostRays);
        } else {
            transfer.vectors.resize(receivers.size() * transfer.dimension());
        }
        if (bounces_ != 0)
            trace_gather(options, rays_of, transfer, part_of(progress, options_.target_error ? 0.5 : 0, 1));
        else if (!options_.target_error) {
            trace_receivers(*tracer_, receivers, indices, options, transfer, progress);
            statistics().rays += indices.size() * static_cast<std::size_t>(options_.rays);
        }
        refill_sealed(transfer);
        if (!options_.target_error && tracer_->notes_hits())
            statistics().sampling_error =
                sampling_error(*tracer_, receivers, options, transfer, statistics().rays, progress_);
        statistics().seconds_tracing = tracer_->seconds();
        mean_rays_ = indices.empty() ? 0
                                     : static_cast<int>(std::accumulate(rays_of.begin(), rays_of.end(), 0.0) /
                                                        static_cast<double>(rays_of.size()));
        return transfer;
    }

    /// Traces closest hits, so many as each receiver has rays, into rows of the gather operator. The direct
    /// transfer is taken from the same rays: then light is neither lost nor won between the two.
    void trace_gather(TraceOptions options, std::span<const std::uint32_t> rays_of, Transfer& transfer,
                      const Progress& progress) {
        const Receivers& receivers = receivers_.receivers;
        gather_ = std::make_unique<GatherOperator>(surfaces(), receivers_, channels_);
        std::map<std::uint32_t, std::vector<std::uint32_t>> by_rays;
        std::size_t all = 0, done = 0;
        for (const std::uint32_t p : receivers_on_surfaces(receivers)) {
            by_rays[rays_of[p]].push_back(p);
            all += rays_of[p];
        }
        options.hit_stride = kHitStride;
        check_gather_memory(by_rays, options);
        for (const auto& [rays, members] : by_rays) {
            options.rays = static_cast<int>(rays);
            const std::size_t here = members.size() * rays;
            trace_receivers(*tracer_, receivers, members, options, transfer,
                            part_of(progress, static_cast<double>(done) / static_cast<double>(all),
                                    static_cast<double>(done + here) / static_cast<double>(all)),
                            [&, count = options.rays](std::uint32_t p, std::span<const Hit> hits) {
                                gather_->set_row(p, hits, count);
                            });
            done += here;
        }
        statistics().rays += all;
        statistics().gather_entries = gather_->entries();
        statistics().gather_bytes = gather_->bytes();
        if (statistics().gather_entries == 0) {
            gather_.reset();
            note("no bounces: no ray from a receiver meets a surface that scatters");
        }
    }

    const MeshNeighbours& neighbours() {
        if (!neighbours_)
            neighbours_.emplace(surfaces(), receivers_.receivers, receivers_.fronts);
        return *neighbours_;
    }

    /// Receivers that are sealed in take the light of their neighbours.
    void refill_sealed(const Transfer& transfer) {
        // Depth maps do not resolve the last hundredth.
        const SealedOptions options{tracer_->notes_hits() ? 0 : 0.01, options_.seed};
        const Sealed sealed = find_sealed(traced_, receivers_.receivers, transfer, options, progress_.stop);
        statistics().rays += sealed.rays;
        const auto& marked = sealed.receivers;
        statistics().sealed = static_cast<std::size_t>(std::count(
            marked.begin(), marked.begin() + static_cast<std::ptrdiff_t>(receivers_.fronts), true));
        if (statistics().sealed == 0)
            return;
        if (options_.inside == Inside::refill)
            operators_.refill = Refill(neighbours(), marked);
        statistics().refilled = operators_.refill.size();
        note("{} receivers are sealed in by backs of faces; {} of them take the light of their neighbours{}",
             statistics().sealed, statistics().refilled,
             statistics().refilled < statistics().sealed ? ", the others stay dark" : "");
    }

    /// Exit transfer of the scene's receivers, all bounces and subsurface scattering in it.
    Transfer propagated(Transfer direct) {
        Transfer transfer = std::move(direct);
        if (channels_ == 3) { // the direct light is white
            Transfer wide{transfer.order, 3, std::vector<float>(3 * transfer.vectors.size())};
            for (std::size_t p = 0; p < transfer.receivers(); ++p)
                for (std::size_t c = 0; c < 3; ++c)
                    std::copy(transfer.vector(p).begin(), transfer.vector(p).end(),
                              wide.vector(p).begin() + static_cast<std::ptrdiff_t>(c * transfer.dimension()));
            transfer = std::move(wide);
        }
        operators_.diffusion = std::move(diffusion_);
        operators_.gather = gather_.get();
        const BounceResult bounced =
            propagate(transfer, operators_, bounces_, options_.threads, part_of(progress_, 0.95, 1));
        result_.baked.record.bounces = bounced.bounces;
        statistics().remaining_energy = bounced.remaining;
        if (!bounced.converged)
            note("the sum over all bounces still changes by {:.2g} after {} steps", bounced.remaining,
                 bounced.bounces);
        if (surfaces().traits().transmission)
            add_transmission(transfer, surfaces(), receivers_);
        transfer.vectors.resize(receivers_.fronts * transfer.dimension());
        return transfer;
    }

    void finish(Transfer transfer) {
        BakedTransfer& baked = result_.baked;
        statistics().rounding_error = half_rounding_error(transfer, fronts_areas());
        const bool small = statistics().rounding_error < 0.1 * statistics().sampling_error;
        const bool half =
            options_.storage == Storage::float16 || (options_.storage == Storage::automatic && small);
        baked.storage = half ? TransferStorage::float16 : TransferStorage::float32;
        if (half && options_.storage == Storage::automatic)
            note(
                "stored as float16: its rounding, {:.2g} %, is below a tenth of the sampling error, {:.2g} %",
                100 * statistics().rounding_error, 100 * statistics().sampling_error);
        BakeRecord& record = baked.record;
        record.rays = mean_rays_;
        record.seed = options_.seed;
        record.method = tracer_->method();
        record.backend = tracer_->backend();
        record.receivers = receivers_id(scene_);
        record.sampling_error = statistics().sampling_error;
        baked.transfer = std::move(transfer);
    }

    const Scene& scene_;
    const BakeOptions& options_;
    Progress progress_;
    std::vector<std::optional<Medium>> media_; ///< [materials]
    TraceScene traced_;
    TransportReceivers receivers_;
    int bounces_ = 0, channels_ = 1, mean_rays_ = 0;
    std::unique_ptr<Tracer> tracer_;
    std::optional<MeshNeighbours> neighbours_;
    std::vector<DiffusionOperator> diffusion_;
    std::unique_ptr<GatherOperator> gather_;
    TransportOperators operators_;
    BakeResult result_;
};

} // namespace

BakeResult bake(const Scene& scene, const BakeOptions& options, const Progress& progress) {
    check_options(options);
    return Baker(scene, options, progress).run();
}

} // namespace prt
