// Traces the samples of texels layer by layer, some texels at a time.

#include "bake/products/lightmaps/texel_light.h"

#include "bake/pipeline/light_transport.h"
#include "bake/pipeline/trace_gather.h"
#include "bake/plan/transfer_terms.h"
#include "bake/trace/scrambles.h"
#include "bake/trace/sealed.h"
#include "bake/trace/trace_receivers.h"
#include "prt/core/sh_basis.h"

#include <glm/vec3.hpp>

#include <algorithm>
#include <bit>
#include <optional>

namespace prt {
namespace {

constexpr std::size_t kTexelsAtOnce = 1 << 18, kMediaTexelsAtOnce = 1 << 14;

/// The samples of a texel, one after the other.
struct TexelGroup {
    std::uint32_t texel;
    std::span<const TexelSample> samples;
};

std::vector<TexelGroup> by_texel(std::span<const TexelSample> samples) {
    std::vector<TexelGroup> groups;
    for (std::size_t begin = 0; begin < samples.size();) {
        std::size_t end = begin;
        while (end < samples.size() && samples[end].texel == samples[begin].texel)
            ++end;
        groups.push_back({samples[begin].texel, samples.subspan(begin, end - begin)});
        begin = end;
    }
    return groups;
}

/// One sample of each of several texels.
struct Layer {
    Receivers receivers;                ///< the fronts of all texels, then backs
    std::vector<std::uint32_t> indices; ///< indices of the fronts that exist
    std::vector<std::uint32_t> back;    ///< [texels] receiver on the back of a sheet; kNoReceiver: none
};

/// Whether a texel is sealed in, determined by its first dark sample; its other samples are equal in this.
enum class Verdict : std::uint8_t { unknown, sealed, dark };

/// Distance between tested texels in a row of dark ones; texels between two equal verdicts take theirs.
constexpr std::size_t kAskedInRow = 12;

/// Numbers of direct light per texel.
std::size_t direct_stride(const TexelTask& task) {
    return static_cast<std::size_t>((task.plan ? task.plan->direct_channels() : 1) *
                                    coefficient_count(task.options.order));
}

class TexelTracer {
public:
    explicit TexelTracer(const TexelTask& task)
        : task_(task), options_(task.options),
          stride_(static_cast<std::size_t>(coefficient_count(task.options.order))),
          direct_stride_(direct_stride(task)) {
        options_.rays = std::max(1, options_.rays / static_cast<int>(kSamplesOfTexel));
        if (task.transport && task.transport->bounces())
            options_.hit_stride = kHitStride;
    }

    std::size_t texels_at_once() const {
        if (!task_.transport || !task_.transport->bounces())
            return kTexelsAtOnce;
        return task_.plan->scene.surfaces().traits().transmission ? task_.transport->rows() / 2
                                                                  : task_.transport->rows();
    }

    /// Adds up light of the samples of each texel, and counts in `lit` those that are not sealed in.
    void trace(std::span<const TexelGroup> groups, std::span<int> lit, TexelLight& light,
               const Progress& progress) {
        std::vector<Verdict> verdicts(groups.size(), Verdict::unknown);
        for (std::size_t k = 0; k < kSamplesOfTexel; ++k) {
            const Progress part = progress.range(static_cast<double>(k) / kSamplesOfTexel,
                                                 static_cast<double>(k + 1) / kSamplesOfTexel);
            trace_layer(groups, k, {lit, verdicts}, light, part);
        }
    }

    /// Adds light that leaves media, and counts the samples there in `samples`.
    void add_media(std::span<const TexelGroup> groups, std::span<int> samples, TexelLight& light,
                   const Progress& progress) const {
        struct Point {
            std::size_t group;
            int samples = 0;
            glm::dvec3 sum{0};
        };
        std::vector<std::vector<Point>> bodies(task_.media->bodies());
        for (std::size_t g = 0; g < groups.size(); ++g)
            for (const TexelSample& sample : groups[g].samples)
                if (const std::optional<std::size_t> body = task_.media->body_of(sample.triangle)) {
                    if (bodies[*body].empty() || bodies[*body].back().group != g)
                        bodies[*body].push_back({g});
                    Point& point = bodies[*body].back();
                    point.sum += glm::dvec3(task_.positions.position(sample));
                    ++point.samples;
                    ++samples[g];
                }
        for (std::size_t body = 0; body < bodies.size(); ++body)
            for (std::size_t first = 0; first < bodies[body].size(); first += kMediaTexelsAtOnce) {
                const std::span<const Point> points =
                    std::span(bodies[body])
                        .subspan(first, std::min(kMediaTexelsAtOnce, bodies[body].size() - first));
                std::vector<glm::dvec3> positions;
                for (const Point& point : points)
                    positions.push_back(point.sum / static_cast<double>(point.samples));
                progress.update(static_cast<double>(body) / static_cast<double>(bodies.size()));
                const MediaLight::Exit exit = task_.media->exit(body, positions);
                for (std::size_t i = 0; i < points.size(); ++i) {
                    const auto count = static_cast<float>(points[i].samples);
                    const std::uint32_t texel = groups[points[i].group].texel;
                    const auto add = [&](const std::vector<float>& values, std::vector<float>& to) {
                        const std::size_t stride = values.size() / points.size();
                        for (std::size_t c = 0; c < stride; ++c)
                            to[texel * stride + c] += count * values[i * stride + c];
                    };
                    add(exit.sky, light.sky);
                    add(exit.lamps, light.lamps);
                    light.visible[texel] += count * task_.media->visible();
                }
            }
    }

    /// Sums over samples become means. `traced`: number of samples with rays that are not sealed in, `media`:
    /// number of samples on media.
    void divide(std::uint32_t texel, int traced, int media, TexelLight& light) const {
        const int count = traced + media;
        light.lit[texel] = count > 0;
        light.traced[texel] = traced > 0 && media == 0;
        const auto of = [&](std::vector<float>& values, std::size_t stride, float factor) {
            for (std::size_t c = 0; c < stride; ++c)
                values[texel * stride + c] *= factor;
        };
        const float mean = count > 0 ? 1 / static_cast<float>(count) : 0,
                    paired = traced == static_cast<int>(kSamplesOfTexel) ? mean : 0;
        of(light.direct, direct_stride_, mean);
        of(light.visible, 1, mean);
        of(light.noise.sky, light.noise.representative.size(), paired);
        if (!task_.transport)
            return;
        const std::size_t lamps = task_.transport->lamp_stride();
        of(light.sky, task_.transport->sky_stride(), mean);
        of(light.lamps, lamps, mean);
        of(light.bounced_lamps, lamps, mean);
        of(light.noise.lamps, light.noise.lamps.empty() ? 0 : lamps, paired);
    }

private:
    bool on_medium(const TexelSample& sample) const {
        return task_.media && task_.media->body_of(sample.triangle);
    }
    bool on_sheet(const TexelSample& sample) const {
        return task_.plan && task_.plan->scene.surfaces().transmits(sample.triangle);
    }

    /// Returns the k-th sample of every texel that has it: one receiver per texel, so that a texel's samples
    /// share a net, and one per texel with sheets.
    Layer layer(std::span<const TexelGroup> groups, std::size_t k) const {
        Layer layer;
        const auto sample_of = [&](const TexelGroup& group) -> const TexelSample& {
            return group.samples[k < group.samples.size() ? k : 0];
        };
        const auto exists = [&](const TexelGroup& group) {
            return k < group.samples.size() && !on_medium(group.samples[k]);
        };
        for (const TexelGroup& group : groups)
            task_.positions.append(sample_of(group), exists(group) ? 1.0f : 0.0f, layer.receivers);
        layer.indices = receivers_on_surfaces(layer.receivers);
        layer.back.assign(groups.size(), kNoReceiver);
        for (std::size_t g = 0; g < groups.size(); ++g) {
            if (std::ranges::none_of(groups[g].samples,
                                     [&](const TexelSample& sample) { return on_sheet(sample); }))
                continue;
            const TexelSample& sample = sample_of(groups[g]);
            const bool there = exists(groups[g]) && on_sheet(sample);
            if (there)
                layer.back[g] = static_cast<std::uint32_t>(layer.receivers.size());
            task_.positions.append(sample, there ? 1.0f : 0.0f, layer.receivers, Side::back);
        }
        return layer;
    }

    /// Combines the sides of sheets in `values` [receivers][channels][coefficients], in place of the fronts.
    void mix(std::span<const TexelGroup> groups, std::size_t k, const Layer& layer, std::size_t channels,
             std::vector<float>& values) const {
        const std::size_t stride = values.size() / layer.receivers.size();
        const auto of = [&](std::uint32_t receiver) {
            return std::span(values).subspan(receiver * stride, stride);
        };
        for (std::uint32_t g = 0; g < groups.size(); ++g)
            if (layer.back[g] != kNoReceiver) {
                const TexelSample& sample = groups[g].samples[k];
                mix_sides(task_.plan->scene.surfaces(),
                          {sample.triangle, sample.uv, task_.sample_areas[sample.triangle]}, channels, of(g),
                          of(layer.back[g]));
            }
    }

    /// Results per texel, over all layers.
    struct Found {
        std::span<int> lit; ///< samples that are not sealed in
        std::vector<Verdict>& verdicts;
    };

    void trace_layer(std::span<const TexelGroup> groups, std::size_t k, const Found& found, TexelLight& light,
                     const Progress& progress) {
        const Layer layer = this->layer(groups, k);
        Transfer traced = trace_rays(layer, k, light, progress.range(0, 0.9));
        const std::vector<bool> sealed =
            sealed_of(groups, layer, traced, found.verdicts, light, progress.stop);
        const auto add = [&](std::span<const float> values, std::size_t stride, std::vector<float>& to) {
            for (const std::uint32_t g : layer.indices)
                for (std::size_t c = 0; !sealed[g] && c < stride; ++c)
                    to[groups[g].texel * stride + c] += values[g * stride + c];
        };
        for (const std::uint32_t g : layer.indices) {
            found.lit[g] += sealed[g] ? 0 : 1;
            light.visible[groups[g].texel] += sealed[g] ? 0 : traced.vector(g)[0];
        }
        if (direct_stride_ > traced.dimension())
            traced = in_color(traced);
        mix(groups, k, layer, direct_stride_ / stride_, traced.vectors);
        add(traced.vectors, direct_stride_, light.direct);
        std::vector<float> more;
        if (task_.transport && task_.transport->sky_stride() > 0) {
            more.resize(layer.receivers.size() * task_.transport->sky_stride());
            task_.transport->gather_sky(more);
            mix(groups, k, layer, task_.transport->sky_stride() / stride_, more);
            add(more, task_.transport->sky_stride(), light.sky);
        }
        // Opposite ones of four samples have the same sign: a linear variation over a texel is not noise.
        const float sign = k == 0 || k == 3 ? 1.0f : -1.0f;
        if (task_.notes_noise)
            add(signed_sky(groups.size(), traced, more, light.noise.representative, sign),
                light.noise.representative.size(), light.noise.sky);
        if (task_.transport)
            add_lamps(groups, layer, k, sign, add, light, progress);
    }

    /// Traces the rays of a layer. Returns direct light, and sets the rows that gather bounces.
    Transfer trace_rays(const Layer& layer, std::size_t k, TexelLight& light, const Progress& progress) {
        TraceOptions options = options_;
        options.first_ray =
            static_cast<std::uint32_t>(k) * std::bit_ceil(static_cast<std::uint32_t>(options.rays));
        Transfer traced = zero_transfer(options.order, 1, layer.receivers.size());
        ReceiverSink sink;
        if (task_.transport && task_.transport->bounces()) {
            task_.transport->clear();
            sink = [&](std::uint32_t g, std::span<const Hit> hits) {
                task_.transport->set_row(g, layer.receivers, hits, options);
            };
        }
        const std::vector<std::uint32_t> indices = receivers_on_surfaces(layer.receivers);
        trace_receivers(task_.tracer, layer.receivers, indices, options, traced, progress, sink);
        light.rays += indices.size() * static_cast<std::size_t>(options.rays);
        return traced;
    }

    /// Columns of all light of a sky at the first `count` receivers, with a sign: [receivers][telling].
    std::vector<float> signed_sky(std::size_t count, const Transfer& direct, std::span<const float> bounced,
                                  const RepresentativeColumns& representative, float sign) const {
        const std::size_t stride = bounced.size() / direct.receivers(),
                          middle = std::max(stride, direct_stride_) > stride_ ? stride_ : 0; // green of three
        std::vector<float> values;
        for (std::uint32_t g = 0; g < count; ++g)
            for (const std::size_t c : representative.columns)
                values.push_back(sign * (direct.vector(g)[(middle + c) % direct_stride_] +
                                         (stride > 0 ? bounced[g * stride + middle + c] : 0.0f)));
        return values;
    }

    template <class Add>
    void add_lamps(std::span<const TexelGroup> groups, const Layer& layer, std::size_t k, float sign,
                   const Add& add, TexelLight& light, const Progress& progress) {
        const std::size_t stride = task_.transport->lamp_stride();
        if (stride == 0)
            return;
        std::vector<float> direct(layer.receivers.size() * stride), bounced(direct.size());
        light.rays += task_.transport->light_of_lamps(task_.tracer, layer.receivers, lamp_seed(groups, k),
                                                      direct, bounced, progress.range(0.9, 1));
        const auto channels = static_cast<std::size_t>(task_.transport->lamp_layout().channels());
        mix(groups, k, layer, channels, direct);
        mix(groups, k, layer, channels, bounced);
        add(direct, stride, light.lamps);
        add(bounced, stride, light.bounced_lamps);
        if (!task_.notes_noise)
            return;
        for (float& value : bounced)
            value *= sign;
        add(bounced, stride, light.noise.lamps);
    }

    /// Seed of lamp samples, different for each sample of a texel and for texels that are traced one after
    /// another.
    std::uint64_t lamp_seed(std::span<const TexelGroup> groups, std::size_t k) const {
        return options_.seed + 7 * kSecondScramble + groups.front().texel * kSamplesOfTexel + k;
    }

    std::vector<bool> sealed_of(std::span<const TexelGroup> groups, const Layer& layer,
                                const Transfer& traced, std::vector<Verdict>& verdicts, TexelLight& light,
                                const std::stop_token& stop) {
        std::vector<bool> is_sealed(layer.receivers.size());
        if (task_.inside == Inside::keep)
            return is_sealed;
        std::vector<std::uint32_t> dark, unknown;
        for (const std::uint32_t g : layer.indices)
            if (static_cast<double>(traced.vector(g)[0]) <= max_dark(task_.tracer))
                dark.push_back(g);
        std::ranges::copy_if(dark, std::back_inserter(unknown),
                             [&](std::uint32_t g) { return verdicts[g] == Verdict::unknown; });
        const auto ask = [&](std::vector<std::uint32_t> asked) {
            const Sealed sealed =
                find_sealed(task_.tracer, task_.scene, layer.receivers, asked, options_.seed, stop);
            light.rays += sealed.rays;
            for (const std::uint32_t g : asked)
                verdicts[g] = sealed.receivers[g] ? Verdict::sealed : Verdict::dark;
        };
        // Some in each row, then those between two that differ.
        const std::vector<std::size_t> posts = posts_of(groups, unknown);
        std::vector<std::uint32_t> asked;
        for (const std::size_t post : posts)
            asked.push_back(unknown[post]);
        ask(std::move(asked));
        asked.clear();
        for (std::size_t k = 0; k + 1 < posts.size(); ++k)
            for (std::size_t i = posts[k] + 1; i < posts[k + 1]; ++i)
                if (verdicts[unknown[posts[k]]] == verdicts[unknown[posts[k + 1]]])
                    verdicts[unknown[i]] = verdicts[unknown[posts[k]]];
                else
                    asked.push_back(unknown[i]);
        ask(std::move(asked));
        for (const std::uint32_t g : dark)
            is_sealed[g] = verdicts[g] == Verdict::sealed;
        return is_sealed;
    }

    /// Returns indices in `unknown` of the texels to test: the ends of each row of adjacent texels, and some
    /// between.
    static std::vector<std::size_t> posts_of(std::span<const TexelGroup> groups,
                                             std::span<const std::uint32_t> unknown) {
        std::vector<std::size_t> posts;
        for (std::size_t i = 0, first = 0; i < unknown.size(); ++i) {
            const auto follows = [&](std::size_t next) {
                return next < unknown.size() &&
                       groups[unknown[next]].texel == groups[unknown[next - 1]].texel + 1;
            };
            first = i > 0 && follows(i) ? first : i;
            if ((i - first) % kAskedInRow == 0 || !follows(i + 1))
                posts.push_back(i);
        }
        return posts;
    }

    const TexelTask& task_;
    TraceOptions options_;
    std::size_t stride_, direct_stride_; ///< of one channel, and of all channels of direct light
};

} // namespace

TexelLight trace_texels(const TexelTask& task, const Atlas& atlas, std::span<const TexelSample> samples,
                        const Progress& progress) {
    const std::vector<TexelGroup> groups = by_texel(samples);
    TexelLight light;
    light.direct.resize(atlas.texels() * direct_stride(task));
    light.visible.resize(atlas.texels());
    if (task.transport) {
        light.sky.resize(atlas.texels() * task.transport->sky_stride());
        light.lamps.resize(atlas.texels() * task.transport->lamp_stride());
        light.bounced_lamps.resize(light.lamps.size());
    }
    if (task.notes_noise) {
        const bool bounces = task.transport && task.transport->bounces();
        light.noise.rays = static_cast<double>(task.options.rays) / (bounces ? kHitStride : 1);
        light.noise.columns = static_cast<std::size_t>(coefficient_count(task.options.order));
        light.noise.representative = columns_of_sky(light.noise.columns);
        light.noise.sky.resize(atlas.texels() * light.noise.representative.size());
        light.noise.lamps.resize(light.bounced_lamps.size());
    }
    light.lit.resize(atlas.texels());
    light.traced.resize(atlas.texels());
    light.measured = groups.size();
    TexelTracer texels(task);
    const double share_of_rays = task.media ? 0.7 : 1;
    std::vector<int> traced(groups.size()), media(groups.size());
    for (std::size_t first = 0; first < groups.size(); first += texels.texels_at_once()) {
        const std::size_t count = std::min(texels.texels_at_once(), groups.size() - first);
        const auto share = [&](std::size_t done) {
            return share_of_rays * static_cast<double>(done) / static_cast<double>(groups.size());
        };
        texels.trace(std::span(groups).subspan(first, count), std::span(traced).subspan(first, count), light,
                     progress.range(share(first), share(first + count)));
    }
    if (task.media)
        texels.add_media(groups, media, light, progress.range(share_of_rays, 1));
    for (std::size_t g = 0; g < groups.size(); ++g)
        texels.divide(groups[g].texel, traced[g], media[g], light);
    return light;
}

} // namespace prt
