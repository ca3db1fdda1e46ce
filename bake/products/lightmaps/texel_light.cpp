// Traces the samples of texels layer by layer, some texels at a time.

#include "bake/products/lightmaps/texel_light.h"

#include "bake/pipeline/trace_gather.h"
#include "bake/trace/scrambles.h"
#include "bake/trace/sealed.h"
#include "bake/trace/trace_receivers.h"
#include "prt/core/sh_basis.h"

#include <algorithm>
#include <bit>

namespace prt {
namespace {

constexpr std::size_t kTexelsAtOnce = 1 << 18;

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
    Receivers receivers;
    std::vector<std::uint32_t> indices; ///< indices of the receivers that exist
};

/// Whether a texel is sealed in, determined by its first dark sample; its other samples are equal in this.
enum class Verdict : std::uint8_t { unknown, sealed, dark };

/// Distance between tested texels in a row of dark ones; texels between two equal verdicts take theirs.
constexpr std::size_t kAskedInRow = 12;

class TexelTracer {
public:
    explicit TexelTracer(const TexelTask& task)
        : task_(task), options_(task.options),
          stride_(static_cast<std::size_t>(coefficient_count(task.options.order))) {
        options_.rays = std::max(1, options_.rays / static_cast<int>(kSamplesOfTexel));
        if (task.transport && task.transport->bounces())
            options_.hit_stride = kHitStride;
    }

    std::size_t texels_at_once() const {
        return task_.transport && task_.transport->bounces() ? task_.transport->rows() : kTexelsAtOnce;
    }

    void trace(std::span<const TexelGroup> groups, TexelLight& light, const Progress& progress) {
        std::vector<int> lit(groups.size());
        std::vector<Verdict> verdicts(groups.size(), Verdict::unknown);
        for (std::size_t k = 0; k < kSamplesOfTexel; ++k) {
            const Progress part = progress.range(static_cast<double>(k) / kSamplesOfTexel,
                                                 static_cast<double>(k + 1) / kSamplesOfTexel);
            trace_layer(groups, k, {lit, verdicts}, light, part);
        }
        for (std::size_t g = 0; g < groups.size(); ++g)
            divide(groups[g].texel, lit[g], light);
    }

private:
    /// Sums over `count` samples that are not sealed in become means.
    void divide(std::uint32_t texel, int count, TexelLight& light) const {
        light.lit[texel] = count > 0;
        const auto of = [&](std::vector<float>& values, std::size_t stride, float factor) {
            for (std::size_t c = 0; c < stride; ++c)
                values[texel * stride + c] *= factor;
        };
        const float mean = count > 0 ? 1 / static_cast<float>(count) : 0,
                    paired = count == static_cast<int>(kSamplesOfTexel) ? mean : 0;
        of(light.direct, stride_, mean);
        of(light.noise.sky, light.noise.representative.size(), paired);
        if (!task_.transport)
            return;
        const std::size_t lamps = task_.transport->lamp_stride();
        of(light.sky, task_.transport->sky_stride(), mean);
        of(light.lamps, lamps, mean);
        of(light.bounced_lamps, lamps, mean);
        of(light.noise.lamps, light.noise.lamps.empty() ? 0 : lamps, paired);
    }

    /// Returns the k-th sample of every texel that has it: one receiver per texel, so that a texel's samples
    /// share a net.
    Layer layer(std::span<const TexelGroup> groups, std::size_t k) const {
        Layer layer;
        for (const TexelGroup& group : groups) {
            const bool there = k < group.samples.size();
            task_.positions.append(group.samples[there ? k : 0], there ? 1.0f : 0.0f, layer.receivers);
        }
        layer.indices = receivers_on_surfaces(layer.receivers);
        return layer;
    }

    /// Results per texel, over all layers.
    struct Found {
        std::vector<int>& lit; ///< samples that are not sealed in
        std::vector<Verdict>& verdicts;
    };

    void trace_layer(std::span<const TexelGroup> groups, std::size_t k, const Found& found, TexelLight& light,
                     const Progress& progress) {
        const Layer layer = this->layer(groups, k);
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
        trace_receivers(task_.tracer, layer.receivers, layer.indices, options, traced, progress.range(0, 0.9),
                        sink);
        light.rays += layer.indices.size() * static_cast<std::size_t>(options.rays);
        const std::vector<bool> sealed =
            sealed_of(groups, layer, traced, found.verdicts, light, progress.stop);
        const auto add = [&](std::span<const float> values, std::size_t stride, std::vector<float>& to) {
            for (const std::uint32_t g : layer.indices)
                for (std::size_t c = 0; !sealed[g] && c < stride; ++c)
                    to[groups[g].texel * stride + c] += values[g * stride + c];
        };
        for (const std::uint32_t g : layer.indices)
            found.lit[g] += sealed[g] ? 0 : 1;
        add(traced.vectors, stride_, light.direct);
        std::vector<float> more;
        if (task_.transport) {
            more.assign(groups.size() * task_.transport->sky_stride(), 0.0f);
            if (!more.empty())
                task_.transport->gather_sky(more);
            add(more, task_.transport->sky_stride(), light.sky);
        }
        // Opposite ones of four samples have the same sign: a linear variation over a texel is not noise.
        const float sign = k == 0 || k == 3 ? 1.0f : -1.0f;
        if (task_.notes_noise)
            add(signed_sky(traced, more, light.noise.representative, sign), light.noise.representative.size(),
                light.noise.sky);
        if (task_.transport)
            add_lamps(groups, layer, k, sign, add, light, progress);
    }

    /// Columns of all light of a sky, with a sign: [receivers][telling].
    std::vector<float> signed_sky(const Transfer& direct, std::span<const float> bounced,
                                  const RepresentativeColumns& representative, float sign) const {
        const std::size_t stride = bounced.size() / direct.receivers(),
                          middle = stride > stride_ ? stride_ : 0; // green of three channels
        std::vector<float> values;
        for (std::uint32_t g = 0; g < direct.receivers(); ++g)
            for (const std::size_t c : representative.columns)
                values.push_back(
                    sign * (direct.vector(g)[c] + (stride > 0 ? bounced[g * stride + middle + c] : 0.0f)));
        return values;
    }

    template <class Add>
    void add_lamps(std::span<const TexelGroup> groups, const Layer& layer, std::size_t k, float sign,
                   const Add& add, TexelLight& light, const Progress& progress) {
        const std::size_t stride = task_.transport->lamp_stride();
        if (stride == 0)
            return;
        std::vector<float> direct(groups.size() * stride), bounced(direct.size());
        light.rays += task_.transport->light_of_lamps(task_.tracer, layer.receivers, lamp_seed(groups, k),
                                                      direct, bounced, progress.range(0.9, 1));
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
    std::size_t stride_;
};

} // namespace

TexelLight trace_texels(const TexelTask& task, const Atlas& atlas, std::span<const TexelSample> samples,
                        const Progress& progress) {
    const std::vector<TexelGroup> groups = by_texel(samples);
    TexelLight light;
    light.direct.resize(atlas.texels() * static_cast<std::size_t>(coefficient_count(task.options.order)));
    if (task.transport) {
        light.sky.resize(atlas.texels() * task.transport->sky_stride());
        light.lamps.resize(atlas.texels() * task.transport->lamp_stride());
        light.bounced_lamps.resize(light.lamps.size());
    }
    if (task.notes_noise) {
        const bool bounces = task.transport && task.transport->bounces();
        light.noise.rays = static_cast<double>(task.options.rays) / (bounces ? kHitStride : 1);
        light.noise.representative =
            columns_of_sky(static_cast<std::size_t>(coefficient_count(task.options.order)));
        light.noise.sky.resize(atlas.texels() * light.noise.representative.size());
        light.noise.lamps.resize(light.bounced_lamps.size());
    }
    light.lit.resize(atlas.texels());
    light.measured = groups.size();
    TexelTracer texels(task);
    for (std::size_t first = 0; first < groups.size(); first += texels.texels_at_once()) {
        const std::size_t count = std::min(texels.texels_at_once(), groups.size() - first);
        const auto share = [&](std::size_t done) {
            return static_cast<double>(done) / static_cast<double>(groups.size());
        };
        texels.trace(std::span(groups).subspan(first, count), light,
                     progress.range(share(first), share(first + count)));
    }
    return light;
}

} // namespace prt
