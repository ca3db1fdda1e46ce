// Compares interpolated transfer with light that is traced anew at points between vertices.

#include "error_check.h"

#include "prt/trace_receivers.h"
#include "scene/interpolated.h"
#include "scene/sealed.h"
#include "surface/varied_samples.h"
#include "trace/embree_tracer.h"
#include "trace/scrambles.h"
#include "trace_gather.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numeric>

namespace prt {
namespace {

/// One receiver of so many has a point, within these bounds. A half has as many rays as a receiver: of fewer
/// the noise hides what is sought (rays of a quarter: the estimate varies by 20 % between seeds, not by 6 %).
constexpr std::size_t kReceiversPerPoint = 64, kMinPoints = 320, kMaxPoints = 2048;
/// Points that are looked at first for each that is traced, by one ray of so many.
constexpr std::size_t kLooks = 4;
constexpr int kShareOfLook = 16;
/// Seeds of rays to points, in scrambles: no other part of a bake takes them.
constexpr std::uint64_t kFirstHalf = 7, kSecondHalf = 8, kLookScramble = 9;

/// A relative error from squared differences and squared norms at points, with its standard error.
class SquareSums {
public:
    void add(double error, double norm) {
        errors_.push_back(error);
        norms_.push_back(norm);
    }
    std::size_t points() const { return errors_.size(); }
    double norm() const { return std::accumulate(norms_.begin(), norms_.end(), 0.0); }
    BakeErrors::Error relative() const {
        const double all = norm();
        if (!(all > 0) || points() < 2)
            return {};
        const double ratio = std::accumulate(errors_.begin(), errors_.end(), 0.0) / all;
        double squares = 0;
        for (std::size_t i = 0; i < errors_.size(); ++i) {
            const double off = errors_[i] - ratio * norms_[i];
            squares += off * off;
        }
        const double spread = std::sqrt(squares) / all, root = std::sqrt(std::max(ratio, 0.0));
        // Of the root, from that of its square: half as much relative to it, but where it is nearly nothing.
        return {root, std::min(spread / std::max(2 * root, 1e-12), std::sqrt(spread))};
    }

private:
    std::vector<double> errors_, norms_;
};

/// One value for each of `channels`, of what has one or as many.
std::vector<float> in_channels(std::span<const float> values, std::size_t channels, std::size_t columns) {
    std::vector<float> wide;
    for (std::size_t c = 0; c < channels; ++c) {
        const std::span<const float> from =
            values.subspan(values.size() == columns ? 0 : c * columns, columns);
        wide.insert(wide.end(), from.begin(), from.end());
    }
    return wide;
}

void add_to(std::span<float> sum, std::span<const float> values) {
    for (std::size_t i = 0; i < values.size(); ++i)
        sum[i] += values[i];
}

std::vector<float> difference(std::span<const float> a, std::span<const float> b) {
    std::vector<float> result(a.begin(), a.end());
    for (std::size_t i = 0; i < b.size(); ++i)
        result[i] -= b[i];
    return result;
}

/// The product of what `baked` has more than each half.
double squared_error(std::span<const float> baked, std::span<const float> first,
                     std::span<const float> second) {
    return product(difference(baked, first), difference(baked, second));
}

} // namespace

ErrorCheck::ErrorCheck(const BakePlan& plan, Tracer& tracer, const Measured& measured,
                       const MeasuredLamps& lamps, const std::stop_token& stop)
    : plan_(plan) {
    std::optional<EmbreeTracer> other; // where depth maps are: their own error is to be seen
    Tracer& rays = tracer.notes_hits() ? tracer : static_cast<Tracer&>(other.emplace(plan.scene));
    choose_points(rays, measured, lamps, stop);
    add_backs();
    trace(rays, static_cast<std::uint32_t>(std::max(1, measured.direct.mean_rays)), stop);
    leave_out_sealed(rays, stop);
}

SurfaceSamples ErrorCheck::look(Tracer& tracer, const Transfer& sky, const SurfaceSamples& many,
                                std::size_t count, const std::stop_token& stop) {
    std::vector<std::uint32_t> indices(many.size());
    std::iota(indices.begin(), indices.end(), 0u);
    const TraceOptions options{.order = 1,
                               .rays = std::max(1, plan_.options.rays / kShareOfLook),
                               .seed = plan_.options.seed + kLookScramble * kSecondScramble};
    Transfer seen = zero_transfer(1, 1, many.size());
    trace_receivers(tracer, many.receivers, indices, options, seen, {{}, stop});
    rays_ += indices.size() * static_cast<std::size_t>(options.rays);
    std::vector<double> squares(many.size());
    double sum = 0;
    for (std::size_t s = 0; s < many.size(); ++s) {
        const SamplePlace& place = many.places[s];
        const glm::uvec3 corners =
            corner_receivers(plan_.scene.surfaces(), *plan_.transport, place.triangle, false);
        double off = -static_cast<double>(seen.vector(s)[0]);
        for (int i = 0; i < 3; ++i)
            if (corners[i] != kNoReceiver)
                off += static_cast<double>(place.shares()[static_cast<std::size_t>(i)] *
                                           sky.vector(corners[i])[0]);
        squares[s] = static_cast<double>(many.receivers.areas[s]) * off * off;
        sum += squares[s];
    }
    const double mean = sum / static_cast<double>(many.size());
    for (double& square : squares) // half of them as they are
        square += mean + std::numeric_limits<double>::min();
    return pick_samples(many, squares, count);
}

void ErrorCheck::choose_points(Tracer& tracer, const Measured& measured, const MeasuredLamps& lamps,
                               const std::stop_token& stop) {
    const Surfaces& surfaces = plan_.scene.surfaces();
    const Transfer &sky = measured.direct.transfer, &lit = lamps.light.transfer;
    const std::size_t columns = 1 + plan_.lamps.size(),
                      stride = lit.dimension() / static_cast<std::size_t>(lit.layout.channels());
    std::vector<float> light(plan_.receivers().size() * columns);
    for (std::size_t p = 0; p < plan_.receivers().size(); ++p) {
        light[p * columns] = sky.vector(p)[0];
        for (std::size_t k = 0; k < plan_.lamps.size(); ++k)
            for (std::size_t from = k; from < lit.dimension(); from += stride)
                light[p * columns + 1 + k] += lit.vector(p)[from];
    }
    const std::size_t count =
        std::clamp(plan_.receivers().size() / kReceiversPerPoint, kMinPoints, kMaxPoints);
    const SurfaceSamples some =
        look(tracer, sky,
             sample_varied(
                 surfaces, *plan_.transport, {light, columns},
                 {.count = kLooks * count, .seed = plan_.options.seed + 2, .backs = false, .by_node = true}),
             count, stop);

    std::vector<bool> in_medium(plan_.receivers().size());
    for (const DiffusionOperator& body : plan_.diffusion)
        for (const std::uint32_t p : body.members())
            in_medium[p] = true;
    for (std::size_t s = 0; s < some.size(); ++s) {
        const SamplePlace& place = some.places[s];
        const glm::uvec3 corners = corner_receivers(surfaces, *plan_.transport, place.triangle, false);
        bool known = true;
        for (int i = 0; i < 3; ++i)
            known = known && corners[i] != kNoReceiver && !in_medium[corners[i]];
        const float seen = surfaces.coverage({place.triangle, place.uv, 0});
        if (!known || !(seen > 0))
            continue;
        points_.push_back({.triangle = place.triangle,
                           .uv = place.uv,
                           .area = static_cast<double>(seen * some.receivers.areas[s]),
                           .front = static_cast<std::uint32_t>(rows_.size()),
                           .back = {}});
        rows_.append(some.receivers, s);
    }
}

void ErrorCheck::add_backs() {
    for (Point& point : points_) {
        if (!plan_.scene.surfaces().two_sided(point.triangle))
            continue;
        point.back = static_cast<std::uint32_t>(rows_.size());
        rows_.positions.push_back(rows_.positions[point.front]);
        rows_.normals.push_back(-rows_.normals[point.front]);
        rows_.areas.push_back(rows_.areas[point.front]);
        rows_.starts.push_back(-rows_.starts[point.front]);
    }
}

void ErrorCheck::trace(Tracer& tracer, std::uint32_t rays, const std::stop_token& stop) {
    const std::size_t rows = rows_.size();
    std::vector<std::uint32_t> indices(rows);
    std::iota(indices.begin(), indices.end(), 0u);
    TraceOptions options = gather_options(plan_, rays);
    if (plan_.bounces != 0)
        gather_.emplace(plan_.scene.surfaces(), *plan_.transport, 2 * rows, plan_.channels);
    for (std::size_t h = 0; h < 2; ++h) {
        options.seed = plan_.options.seed + (h == 0 ? kFirstHalf : kSecondHalf) * kSecondScramble;
        ReceiverSink sink;
        if (gather_)
            sink = [&](std::uint32_t row, std::span<const Hit> hits) {
                gather_->set_row(h * rows + row, hits, options.rays);
            };
        sky_[h] = zero_transfer(options.order, 1, rows);
        trace_receivers(tracer, rows_, indices, options, sky_[h], {{}, stop}, sink);
        rays_ += rows * static_cast<std::size_t>(options.rays);
        LampLight lit = tracer.lamp_light({.scene = plan_.scene,
                                           .receivers = rows_,
                                           .lamps = plan_.lamps,
                                           .options = plan_.options.lamps,
                                           .channels = plan_.lamp_channels(),
                                           .seed = options.seed,
                                           .threads = plan_.options.threads},
                                          {{}, stop});
        rays_ += lit.rays;
        lamps_[h] = std::move(lit.transfer);
    }
    if (gather_ && gather_->entries() == 0)
        gather_.reset();
}

void ErrorCheck::leave_out_sealed(Tracer& tracer, const std::stop_token& stop) {
    std::vector<std::uint32_t> dark;
    for (const Point& point : points_)
        if (sky_[0].vector(point.front)[0] <= 0 && sky_[1].vector(point.front)[0] <= 0)
            dark.push_back(point.front);
    const Sealed sealed = find_sealed(tracer, plan_.scene, rows_, std::move(dark), plan_.options.seed, stop);
    rays_ += sealed.rays;
    std::erase_if(points_, [&](const Point& point) { return sealed.receivers[point.front]; });
}

ErrorCheck::Light ErrorCheck::light(const Point& point, bool back, std::size_t half,
                                    const Transfer& unbounced, std::span<const float> bounced,
                                    std::size_t channels) const {
    const std::size_t columns = unbounced.dimension() / static_cast<std::size_t>(unbounced.layout.channels());
    const auto of_side = [&](std::uint32_t row) {
        Light side{in_channels(unbounced.vector(row), channels, columns), {}};
        side.all = side.unbounced;
        if (!bounced.empty())
            add_to(side.all,
                   bounced.subspan((half * rows_.size() + row) * channels * columns, channels * columns));
        return side;
    };
    Light here = of_side(back ? *point.back : point.front);
    const Surfaces& surfaces = plan_.scene.surfaces();
    if (surfaces.transmits(point.triangle) && point.back) {
        const Light there = of_side(back ? point.front : *point.back);
        const SurfacePoint at{point.triangle, point.uv, static_cast<float>(point.area)};
        mix_sides(surfaces, at, channels, here.unbounced, there.unbounced);
        mix_sides(surfaces, at, channels, here.all, there.all);
    }
    return here;
}

std::vector<float> ErrorCheck::interpolated(const Point& point, const Transfer& baked) const {
    const glm::uvec3& corners = plan_.scene.surfaces().corners(point.triangle);
    const std::array<float, 3> shares{1 - point.uv.x - point.uv.y, point.uv.x, point.uv.y};
    std::vector<float> sum(baked.dimension());
    for (std::size_t i = 0; i < 3; ++i) {
        const std::span<const float> corner = baked.vector(corners[static_cast<glm::length_t>(i)]);
        for (std::size_t k = 0; k < sum.size(); ++k)
            sum[k] += shares[i] * corner[k];
    }
    return sum;
}

double ErrorCheck::sampling_error() const {
    double noise = 0, norm = 0;
    for (const Point& point : points_) {
        const std::span<const float> first = sky_[0].vector(point.front),
                                     second = sky_[1].vector(point.front);
        noise += point.area * squared_distance(first, second) / 2; // both have it
        norm += point.area * product(first, second);
    }
    return norm > 0 ? std::sqrt(noise / norm) : 0;
}

BakeErrors ErrorCheck::compare(const Transfer& baked, const Bounced& bounced) const {
    const auto channels = static_cast<std::size_t>(plan_.channels);
    const auto columns = static_cast<std::size_t>(coefficient_count(plan_.options.order));
    const auto lamp_channels = static_cast<std::size_t>(plan_.lamp_channels());
    const bool bounces_alone = plan_.options.lamps.mode == LampMode::indirect;
    SquareSums distant, direct, indirect, all_lamps, backs;
    std::vector<SquareSums> lamps(plan_.lamps.size());
    std::map<int, std::array<SquareSums, 2>> nodes; // under the sky, under lamps
    for (const Point& point : points_) {
        const std::vector<float> x = interpolated(point, baked);
        std::vector<float> x_direct(channels * columns), x_indirect(channels * columns), x_lamps;
        std::size_t first = 0;
        for (const TransferPart& part : baked.layout.parts) {
            const std::size_t numbers = baked.layout.numbers_of(part);
            const std::span<const float> here = std::span(x).subspan(first, numbers);
            first += numbers;
            if (part.kind == PartKind::lamp) {
                const std::vector<float> wide = in_channels(here, lamp_channels, 1);
                x_lamps.insert(x_lamps.end(), wide.begin(), wide.end());
            } else {
                (part.kind == PartKind::indirect ? x_indirect : x_direct) =
                    in_channels(here, channels, columns);
            }
        }
        std::vector<float> x_all = x_direct;
        add_to(x_all, x_indirect);

        const int node =
            plan_.scene.scene().primitives[plan_.scene.surfaces().primitive(point.triangle)].node;
        std::array<SquareSums, 2>& of_node = nodes[node];
        const auto add = [&](SquareSums& sums, double error, double norm) {
            sums.add(point.area * error, point.area * norm);
        };
        const Light sky[2] = {light(point, false, 0, sky_[0], bounced.sky, channels),
                              light(point, false, 1, sky_[1], bounced.sky, channels)};
        const double norm = product(sky[0].all, sky[1].all),
                     error = squared_error(x_all, sky[0].all, sky[1].all);
        add(distant, error, norm);
        add(of_node[0], error, norm);
        add(direct, squared_error(x_direct, sky[0].unbounced, sky[1].unbounced), norm);
        add(indirect,
            squared_error(x_indirect, difference(sky[0].all, sky[0].unbounced),
                          difference(sky[1].all, sky[1].unbounced)),
            norm);
        if (point.back) {
            const Light behind[2] = {light(point, true, 0, sky_[0], bounced.sky, channels),
                                     light(point, true, 1, sky_[1], bounced.sky, channels)};
            if (behind[0].all[0] > 0 && behind[1].all[0] > 0)
                add(backs, squared_error(x_all, behind[0].all, behind[1].all),
                    product(behind[0].all, behind[1].all));
        }
        if (lamps.empty())
            continue;
        const Light lit[2] = {light(point, false, 0, lamps_[0], bounced.lamps, lamp_channels),
                              light(point, false, 1, lamps_[1], bounced.lamps, lamp_channels)};
        const std::size_t stride = lit[0].all.size() / lamp_channels;
        double lamp_error = 0, lamp_norm = 0;
        for (std::size_t k = 0; k < lamps.size(); ++k) {
            double e = 0, n = 0;
            for (std::size_t c = 0; c < lamp_channels; ++c) {
                const std::size_t i = c * stride + k;
                const auto truth = [&](const Light& half) {
                    return static_cast<double>(half.all[i] - (bounces_alone ? half.unbounced[i] : 0));
                };
                const auto here = static_cast<double>(x_lamps[k * lamp_channels + c]);
                e += (here - truth(lit[0])) * (here - truth(lit[1]));
                n += truth(lit[0]) * truth(lit[1]);
            }
            add(lamps[k], e, n);
            lamp_error += e;
            lamp_norm += n;
        }
        add(all_lamps, lamp_error, lamp_norm);
        add(of_node[1], lamp_error, lamp_norm);
    }

    BakeErrors errors{.points = points_.size(),
                      .distant = distant.relative(),
                      .direct = direct.relative(),
                      .indirect = indirect.relative(),
                      .all_lamps = all_lamps.relative(),
                      .backs = backs.relative(),
                      .lamps = {},
                      .nodes = {}};
    for (std::size_t k = 0; k < lamps.size(); ++k)
        errors.lamps.push_back({plan_.lamps[k].name, lamps[k].relative()});
    for (const Primitive& primitive : plan_.scene.scene().primitives) {
        const auto found = nodes.find(primitive.node);
        if (found == nodes.end())
            continue;
        const auto& [sky, lit] = found->second;
        errors.nodes.push_back({primitive.node_name, sky.relative(), lit.relative(), sky.points()});
        nodes.erase(found);
    }
    return errors;
}

} // namespace prt
