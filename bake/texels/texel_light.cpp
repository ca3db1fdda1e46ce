// Traces the samples of texels layer by layer, some texels at a time.

#include "texels/texel_light.h"

#include "prt/sh_basis.h"
#include "prt/trace_receivers.h"
#include "scene/sealed.h"

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

class TexelTracer {
public:
    TexelTracer(Tracer& tracer, const TraceScene& scene, const TexelPlaces& places,
                const TraceOptions& options)
        : tracer_(tracer), scene_(scene), places_(places), options_(options),
          stride_(static_cast<std::size_t>(coefficient_count(options.order))) {
        options_.rays = std::max(1, options.rays / static_cast<int>(kSamplesOfTexel));
    }

    void trace(std::span<const TexelGroup> groups, TexelLight& light, const Progress& progress) {
        std::vector<int> lit(groups.size());
        for (std::size_t k = 0; k < kSamplesOfTexel; ++k) {
            const Progress part = progress.part(static_cast<double>(k) / kSamplesOfTexel,
                                                static_cast<double>(k + 1) / kSamplesOfTexel);
            trace_layer(groups, k, lit, light, part);
        }
        for (std::size_t g = 0; g < groups.size(); ++g) {
            const std::uint32_t texel = groups[g].texel;
            light.lit[texel] = lit[g] > 0;
            for (std::size_t c = 0; lit[g] > 0 && c < stride_; ++c)
                light.vectors[texel * stride_ + c] /= static_cast<float>(lit[g]);
        }
    }

private:
    /// The k-th sample of every texel that has so many: a receiver each, so that a texel's samples share a
    /// net.
    Receivers layer(std::span<const TexelGroup> groups, std::size_t k) const {
        Receivers receivers;
        for (const TexelGroup& group : groups) {
            const bool there = k < group.samples.size();
            places_.append(group.samples[there ? k : 0], there ? 1.0f : 0.0f, receivers);
        }
        return receivers;
    }

    void trace_layer(std::span<const TexelGroup> groups, std::size_t k, std::vector<int>& lit,
                     TexelLight& light, const Progress& progress) {
        const Receivers receivers = layer(groups, k);
        const std::vector<std::uint32_t> indices = receivers_on_surfaces(receivers);
        TraceOptions options = options_;
        options.first_ray =
            static_cast<std::uint32_t>(k) * std::bit_ceil(static_cast<std::uint32_t>(options.rays));
        Transfer traced = zero_transfer(options.order, 1, receivers.size());
        trace_receivers(tracer_, receivers, indices, options, traced, progress);
        light.rays += indices.size() * static_cast<std::size_t>(options.rays);
        std::vector<std::uint32_t> dark;
        std::ranges::copy_if(indices, std::back_inserter(dark),
                             [&](std::uint32_t g) { return traced.vector(g)[0] <= 0; });
        const Sealed sealed =
            find_sealed(tracer_, scene_, receivers, std::move(dark), options.seed, progress.stop);
        light.rays += sealed.rays;
        for (const std::uint32_t g : indices) {
            if (sealed.receivers[g])
                continue;
            ++lit[g];
            const std::uint32_t texel = groups[g].texel;
            for (std::size_t c = 0; c < stride_; ++c)
                light.vectors[texel * stride_ + c] += traced.vector(g)[c];
        }
    }

    Tracer& tracer_;
    const TraceScene& scene_;
    const TexelPlaces& places_;
    TraceOptions options_;
    std::size_t stride_;
};

} // namespace

TexelLight trace_texels(Tracer& tracer, const TraceScene& scene, const TexelPlaces& places,
                        const Atlas& atlas, std::span<const TexelSample> samples, const TraceOptions& options,
                        const Progress& progress) {
    const std::vector<TexelGroup> groups = by_texel(samples);
    TexelLight light{
        std::vector<float>(atlas.texels() * static_cast<std::size_t>(coefficient_count(options.order))),
        std::vector<bool>(atlas.texels())};
    light.measured = groups.size();
    TexelTracer texels(tracer, scene, places, options);
    for (std::size_t first = 0; first < groups.size(); first += kTexelsAtOnce) {
        const std::size_t count = std::min(kTexelsAtOnce, groups.size() - first);
        const auto share = [&](std::size_t done) {
            return static_cast<double>(done) / static_cast<double>(groups.size());
        };
        texels.trace(std::span(groups).subspan(first, count), light,
                     progress.part(share(first), share(first + count)));
    }
    return light;
}

} // namespace prt
