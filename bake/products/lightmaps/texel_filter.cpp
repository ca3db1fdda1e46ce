// Treats texels as the vertices of a net over the surface.

#include "bake/products/lightmaps/texel_filter.h"

#include "prt/core/sh_basis.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

namespace prt {
namespace {

/// Maximum distance of adjacent texels in space, in sizes of the texels.
constexpr double kFarthest = 4;
/// Light differs across sharper folds.
constexpr double kMinCosine = 0.9;
/// Texels that are filtered at a time, about, and rows on either side that they bend with.
constexpr std::uint32_t kTexelsOfBand = 1 << 17, kRowsBeside = 16;

/// Noise of a mean relative to the difference of samples with opposite signs, whose rays are parts of one
/// net.
constexpr float kNoiseOfSamples = 0.75f;

/// Sets of equivalent vertices.
class VertexSets {
public:
    explicit VertexSets(std::size_t vertices) : first_(vertices) {
        std::iota(first_.begin(), first_.end(), 0u);
    }
    std::uint32_t first_of(std::uint32_t v) {
        while (first_[v] != v)
            v = first_[v] = first_[first_[v]];
        return v;
    }
    void join(std::uint32_t a, std::uint32_t b) { first_[first_of(b)] = first_of(a); }

private:
    std::vector<std::uint32_t> first_;
};

/// Joins vertices of one array at one position of the surface and of the atlas.
void join_alike(const VertexArray& vertices, int uv_set, VertexSets& sets) {
    if (vertices.texcoords.size() <= static_cast<std::size_t>(uv_set))
        return;
    const std::vector<glm::vec2>& uvs = vertices.texcoords[static_cast<std::size_t>(uv_set)];
    const auto key = [&](std::uint32_t v) {
        const glm::vec3 &p = vertices.positions[v], &n = vertices.normals[v];
        return std::array<float, 8>{p.x, p.y, p.z, n.x, n.y, n.z, uvs[v].x, uvs[v].y};
    };
    std::vector<std::uint32_t> order(vertices.positions.size());
    std::iota(order.begin(), order.end(), 0u);
    std::ranges::sort(order, {}, key);
    const auto first = static_cast<std::uint32_t>(vertices.first_receiver);
    for (std::size_t i = 1; i < order.size(); ++i)
        if (key(order[i - 1]) == key(order[i]))
            sets.join(first + order[i - 1], first + order[i]);
}

/// First vertex of the connected triangles that each triangle belongs to.
std::vector<std::uint32_t> connected_triangles(const Scene& scene, int uv_set) {
    std::size_t count = 0;
    for (const VertexArray& vertices : scene.vertex_arrays)
        count += vertices.positions.size();
    VertexSets sets(count);
    for (const VertexArray& vertices : scene.vertex_arrays)
        join_alike(vertices, uv_set, sets);
    std::vector<std::uint32_t> of_triangles;
    for (const Primitive& primitive : scene.primitives) {
        const auto first = static_cast<std::uint32_t>(scene.vertex_arrays[primitive.vertices].first_receiver);
        for (const glm::uvec3& t : primitive.triangles) {
            sets.join(first + t.x, first + t.y);
            sets.join(first + t.x, first + t.z);
            of_triangles.push_back(first + t.x);
        }
    }
    for (std::uint32_t& vertex : of_triangles)
        vertex = sets.first_of(vertex);
    return of_triangles;
}

} // namespace

TexelNet::TexelNet(const Scene& scene, const Atlas& atlas, std::span<const ChartTriangle> charts,
                   std::span<const TexelSample> samples, const TexelPositions& points,
                   const std::vector<bool>& lit)
    : width_(static_cast<std::uint32_t>(atlas.width)), height_(static_cast<std::uint32_t>(atlas.height)),
      positions_(atlas.texels()), normals_(atlas.texels()), charts_(atlas.texels(), kNoReceiver),
      sizes_(atlas.texels()) {
    const std::vector<std::uint32_t> connected = connected_triangles(scene, atlas.uv_set);
    // Triangles whose coordinates are one point may have any size.
    std::vector<float> size_of(connected.size(), 1.0f);
    for (const ChartTriangle& t : charts) {
        const glm::dvec2 ab = t.corners[1] - t.corners[0], ac = t.corners[2] - t.corners[0];
        const double texels = 0.5 * std::abs(ab.x * ac.y - ab.y * ac.x);
        if (texels > 0 && points.area(t.triangle) > 0)
            size_of[t.triangle] = static_cast<float>(std::sqrt(points.area(t.triangle) / texels));
    }
    Receivers receivers;
    for (std::size_t begin = 0, end = 0; begin < samples.size(); begin = end) {
        const std::uint32_t texel = samples[begin].texel;
        glm::dvec3 sum(0), normal(0);
        while (end < samples.size() && samples[end].texel == texel) {
            points.append(samples[end++], 1, receivers);
            sum += glm::dvec3(receivers.positions.back());
            normal += glm::dvec3(receivers.normals.back());
        }
        if (!lit[texel])
            continue;
        positions_[texel] = sum / static_cast<double>(end - begin);
        normals_[texel] = glm::length(normal) > 0 ? glm::normalize(normal) : normal;
        charts_[texel] = connected[samples[begin].triangle];
        sizes_[texel] = size_of[samples[begin].triangle];
        receivers = {};
    }
}

bool TexelNet::together(std::uint32_t a, std::uint32_t b) const {
    return charts_[a] != kNoReceiver && charts_[a] == charts_[b] &&
           glm::dot(normals_[a], normals_[b]) > kMinCosine &&
           glm::distance(positions_[a], positions_[b]) <
               kFarthest * static_cast<double>(std::max(sizes_[a], sizes_[b]));
}

FitEquations TexelNet::equations(std::uint32_t first, std::uint32_t last) const {
    FitEquations equations;
    equations.unknown_of.assign(positions_.size(), kNoReceiver);
    for (std::uint32_t texel = first * width_; texel < last * width_; ++texel)
        if (charts_[texel] != kNoReceiver) {
            const auto unknown = static_cast<std::uint32_t>(equations.unknowns++);
            equations.unknown_of[texel] = unknown;
            equations.rows.push_back(
                {{unknown, kNoReceiver, kNoReceiver}, {1, 0, 0}, sizes_[texel] * sizes_[texel]});
        }
    std::vector<FitTriangle> triangles;
    const auto add = [&](std::uint32_t a, std::uint32_t b, std::uint32_t c) {
        if (together(a, b) && together(b, c) && together(c, a))
            triangles.push_back({{equations.unknown_of[a], equations.unknown_of[b], equations.unknown_of[c]},
                                 {positions_[a], positions_[b], positions_[c]}});
    };
    for (std::uint32_t y = first; y + 1 < last; ++y)
        for (std::uint32_t x = 0; x + 1 < width_; ++x) {
            const std::uint32_t a = y * width_ + x, b = a + 1, c = a + width_, d = c + 1;
            if (together(b, c)) {
                add(a, b, c);
                add(b, d, c);
            } else {
                add(a, b, d);
                add(a, d, c);
            }
        }
    equations.second_differences = second_differences_of(triangles);
    return equations;
}

namespace {

/// Rows [begin, end) of an atlas, filtered with those of [first, last).
struct Band {
    std::uint32_t first, last, begin, end;
};

std::vector<Band> bands_of(const TexelNet& net) {
    const std::uint32_t rows = std::max(1u, kTexelsOfBand / net.width());
    std::vector<Band> bands;
    for (std::uint32_t begin = 0; begin < net.height(); begin += rows) {
        const std::uint32_t end = std::min(net.height(), begin + rows);
        bands.push_back(
            {begin - std::min(begin, kRowsBeside), std::min(net.height(), end + kRowsBeside), begin, end});
    }
    return bands;
}

/// Texels of a band that are filtered.
std::vector<std::uint32_t> texels_of(const FitEquations& equations) {
    std::vector<std::uint32_t> texels;
    for (std::uint32_t texel = 0; texel < equations.unknown_of.size(); ++texel)
        if (equations.unknown_of[texel] != kNoReceiver)
            texels.push_back(texel);
    return texels;
}

/// Filters a copy of the light, because bands read texels that other bands write.
class TexelFilter {
public:
    TexelFilter(const TexelNet& net, int threads, TexelLight& light)
        : net_(net), threads_(threads), light_(light), direct_(light.direct), sky_(light.sky),
          bounced_lamps_(light.bounced_lamps), texels_(light.lit.size()) {}

    double run() {
        for (const Band& band : bands_of(net_)) {
            FitEquations equations = net_.equations(band.first, band.last);
            std::vector<std::uint32_t> texels = texels_of(equations);
            if (texels.empty())
                continue;
            const NoiseFilter filter(std::move(equations), std::move(texels), threads_);
            filter_sky(band, filter);
            filter_lamps(band, filter);
        }
        return norm_ > 0 ? noise_ / norm_ : 0;
    }

private:
    bool is_in(const Band& band, std::uint32_t texel) const {
        return texel >= band.begin * net_.width() && texel < band.end * net_.width();
    }

    void filter_sky(const Band& band, const NoiseFilter& filter) {
        const std::size_t unbounced = direct_.size() / texels_, stride = sky_.size() / texels_,
                          columns = light_.noise.columns,
                          middle = std::max(unbounced, stride) > columns ? columns : 0,
                          count = light_.noise.representative.size();
        const auto direct = [&](std::uint32_t t, std::size_t c) { return direct_[t * unbounced + c]; };
        const auto all = [&](std::uint32_t t, std::size_t c) {
            return direct(t, c % unbounced) + (stride > 0 ? sky_[t * stride + c] : 0.0f);
        };
        // Only the selected columns have noise.
        std::vector<std::size_t> position_of(columns);
        for (std::size_t i = 0; i < count; ++i)
            position_of[light_.noise.representative.columns[i]] = i;
        const auto middle_of_all = [&](std::uint32_t t, std::size_t c) { return all(t, middle + c); };
        // Shadow edges within a texel are not noise: the noise of a net falls as n^-0.75.
        const auto most = static_cast<float>(0.5 * std::pow(light_.noise.rays, -0.75));
        const auto noise = [&](std::uint32_t t, std::size_t c) {
            return std::clamp(kNoiseOfSamples * light_.noise.sky[t * count + position_of[c]], -most, most);
        };
        const FitSolver solver = filter.fit(middle_of_all, light_.noise.representative, noise);
        noise_ = std::hypot(noise_, filter.norm(solver, light_.noise.representative, noise));
        norm_ = std::hypot(norm_, filter.norm(solver, light_.noise.representative, middle_of_all));
        filter.apply(solver, unbounced, direct, [&](std::uint32_t t, std::size_t c, float value) {
            if (is_in(band, t))
                light_.direct[t * unbounced + c] = value;
        });
        filter.apply(solver, stride, all, [&](std::uint32_t t, std::size_t c, float value) {
            if (is_in(band, t))
                light_.sky[t * stride + c] = value - light_.direct[t * unbounced + c % unbounced];
        });
    }

    void filter_lamps(const Band& band, const NoiseFilter& filter) {
        const std::size_t stride = bounced_lamps_.size() / texels_;
        if (stride == 0)
            return;
        const auto bounced = [&](std::uint32_t t, std::size_t c) { return bounced_lamps_[t * stride + c]; };
        const auto share = static_cast<float>(2 / std::sqrt(light_.noise.rays));
        const auto noise = [&](std::uint32_t t, std::size_t c) {
            const float most = share * std::abs(bounced(t, c));
            return std::clamp(light_.noise.lamps[t * stride + c], -most, most);
        };
        const FitSolver solver = filter.fit(bounced, filter.brightest(bounced, stride), noise);
        filter.apply(solver, stride, bounced, [&](std::uint32_t t, std::size_t c, float value) {
            if (is_in(band, t))
                light_.bounced_lamps[t * stride + c] = value;
        });
    }

    const TexelNet& net_;
    int threads_;
    TexelLight& light_;
    const std::vector<float> direct_, sky_, bounced_lamps_;
    std::size_t texels_;
    double noise_ = 0, norm_ = 0; ///< over bands, whose edges count twice
};

} // namespace

double filter_texels(const TexelNet& net, int threads, TexelLight& light) {
    return TexelFilter(net, threads, light).run();
}

} // namespace prt
