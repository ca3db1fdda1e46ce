// Compares interpolated transfer with light that is traced again at points between vertices.

#include "bake/pipeline/error_check.h"

#include "bake/pipeline/lamps_of_plan.h"
#include "bake/pipeline/trace_gather.h"
#include "bake/reference/back_reach.h"
#include "bake/surface_fit/varied_samples.h"
#include "bake/trace/scrambles.h"
#include "bake/trace/sealed.h"
#include "bake/trace/trace_receivers.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numeric>

namespace prt {
namespace {

/// Number of points: one per kReceiversPerPoint receivers, clamped to these limits. Each half traces the
/// number of rays of a receiver. With a quarter of these rays the estimate varied by 20 % between seeds, with
/// all of them by 6 %.
constexpr std::size_t kReceiversPerPoint = 64, kMinPoints = 288, kMaxPoints = 2048;
/// Limits the cost in small scenes with many rays: a half of the check traces at most this share of the rays
/// of the bake, unless that is less than kMinCapped rays per point.
constexpr double kMaxShareOfRays = 0.5, kMinCapped = 1024;
/// Candidates per point, each traced with 1 / kShareOfLook of a receiver's rays before points are chosen.
constexpr std::size_t kLooks = 16;
constexpr int kShareOfLook = 64;
/// Multiples of kSecondScramble, added to the seed; no other part of a bake uses them.
constexpr std::uint64_t kFirstHalf = 7, kSecondHalf = 8, kLookScramble = 9;

/// Repeats values of one channel for all `channels`; copies values that already have all channels.
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

/// Returns (baked - first) · (baked - second): the squared error without the noise of the halves.
double squared_error(std::span<const float> baked, std::span<const float> first,
                     std::span<const float> second) {
    return product(difference(baked, first), difference(baked, second));
}

} // namespace

ErrorCheck::ErrorCheck(const BakePlan& plan, Tracer& tracer, const Measured& measured,
                       const std::stop_token& stop)
    : plan_(plan) {
    Tracer& rays = tracer.rays(); // they do not have the error of depth maps
    choose_points(rays, measured, stop);
    add_backs();
    trace(rays, static_cast<double>(std::max(1, measured.direct.mean_rays)), stop);
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
        const SamplePosition& position = many.positions[s];
        const glm::uvec3 corners =
            corner_receivers(plan_.scene.surfaces(), *plan_.transport, position.triangle, false);
        double off = -static_cast<double>(seen.vector(s)[0]);
        for (int i = 0; i < 3; ++i)
            if (corners[i] != kNoReceiver)
                off += static_cast<double>(position.shares()[static_cast<std::size_t>(i)] *
                                           sky.vector(corners[i])[0]);
        squares[s] = static_cast<double>(many.receivers.areas[s]) * off * off;
        sum += squares[s];
    }
    const double mean = sum / static_cast<double>(many.size());
    for (double& square : squares) // half of the points ignore the traced light
        square += mean + std::numeric_limits<double>::min();
    return pick_samples(many, squares, count);
}

void ErrorCheck::choose_points(Tracer& tracer, const Measured& measured, const std::stop_token& stop) {
    const Surfaces& surfaces = plan_.scene.surfaces();
    const Transfer &sky = measured.direct.transfer, &lit = measured.lamps.light.transfer;
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
        const SamplePosition& position = some.positions[s];
        const glm::uvec3 corners = corner_receivers(surfaces, *plan_.transport, position.triangle, false);
        bool known = !surfaces.has_lobes(position.triangle);
        for (int i = 0; i < 3; ++i)
            known = known && corners[i] != kNoReceiver && !in_medium[corners[i]];
        const float seen = surfaces.coverage({position.triangle, position.uv, 0});
        if (!known || !(seen > 0))
            continue;
        points_.push_back({.position = position,
                           .area = static_cast<double>(seen * some.receivers.areas[s]),
                           .front = static_cast<std::uint32_t>(rows_.size()),
                           .back = {}});
        rows_.append(some.receivers, s);
    }
}

/// Adds back sides in nodes whose backs light reaches; other back sides are never visible. Thin sheets that
/// transmit light need both sides.
void ErrorCheck::add_backs() {
    std::vector<Point*> two_sided;
    std::vector<std::uint32_t> triangles;
    for (Point& point : points_)
        if (plan_.scene.surfaces().two_sided(point.position.triangle)) {
            two_sided.push_back(&point);
            triangles.push_back(point.position.triangle);
        }
    if (two_sided.empty())
        return;
    // Light of a detailed model reaches the backs of its own surfaces: all are measured.
    const std::vector<float> reach =
        plan_.detail ? std::vector<float>(triangles.size(), 1.0f)
                     : BackReach(plan_.scene, plan_.lamps, plan_.options.seed).means(triangles);
    std::map<int, double> of_nodes, areas;
    for (std::size_t i = 0; i < two_sided.size(); ++i) {
        of_nodes[node_of(*two_sided[i])] += two_sided[i]->area * static_cast<double>(reach[i]);
        areas[node_of(*two_sided[i])] += two_sided[i]->area;
    }
    for (Point* const point : two_sided) {
        const int node = node_of(*point);
        const bool reached = of_nodes[node] > kMinReach * areas[node];
        if (!reached && !plan_.scene.surfaces().transmits(point->position.triangle))
            continue;
        point->back = static_cast<std::uint32_t>(rows_.size());
        rows_.positions.push_back(rows_.positions[point->front]);
        rows_.normals.push_back(-rows_.normals[point->front]);
        rows_.areas.push_back(rows_.areas[point->front]);
        rows_.starts.push_back(-rows_.starts[point->front]);
    }
}

void ErrorCheck::trace(Tracer& tracer, double rays, const std::stop_token& stop) {
    const std::size_t rows = rows_.size();
    std::vector<std::uint32_t> indices(rows);
    std::iota(indices.begin(), indices.end(), 0u);
    const double share = kMaxShareOfRays * static_cast<double>(plan_.receivers().size()) /
                         static_cast<double>(std::max<std::size_t>(rows, 1));
    const double half = std::min(rays, std::max(share * rays, kMinCapped));
    half_share_ = half / rays;
    TraceOptions options = gather_options(plan_, static_cast<std::uint32_t>(half));
    if (plan_.bounces != 0)
        gather_.emplace(plan_.gather_rows(2 * rows));
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
        LampLight lit = light_of_lamps(plan_, tracer, rows_, {.seed = options.seed}, {{}, stop});
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
    const Sealed sealed =
        find_sealed(tracer, plan_.traced().scene, rows_, std::move(dark), plan_.options.seed, stop);
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
    if (surfaces.transmits(point.position.triangle) && point.back) {
        const Light there = of_side(back ? point.front : *point.back);
        const SurfacePoint at{point.position.triangle, point.position.uv, static_cast<float>(point.area)};
        mix_sides(surfaces, at, channels, here.unbounced, there.unbounced);
        mix_sides(surfaces, at, channels, here.all, there.all);
    }
    return here;
}

ErrorCheck::Halves ErrorCheck::halves(const Point& point, bool back, const std::array<Transfer, 2>& unbounced,
                                      std::span<const float> bounced, int channels) const {
    const auto half = [&](std::size_t h) {
        return light(point, back, h, unbounced[h], bounced, static_cast<std::size_t>(channels));
    };
    return {half(0), half(1)};
}

int ErrorCheck::node_of(const Point& point) const {
    return plan_.scene.scene().primitives[plan_.scene.surfaces().primitive(point.position.triangle)].node;
}

double ErrorCheck::sampling_error() const {
    double noise = 0, norm = 0;
    for (const Point& point : points_) {
        const std::span<const float> first = sky_[0].vector(point.front),
                                     second = sky_[1].vector(point.front);
        noise += point.area * squared_distance(first, second) / 2; // both halves have this noise
        norm += point.area * product(first, second);
    }
    // The squared noise of nets of n rays falls as n^-1.5.
    return norm > 0 ? std::sqrt(noise * std::pow(half_share_, 1.5) / norm) : 0;
}

ErrorCheck::Value ErrorCheck::interpolated(const Point& point, const Transfer& baked) const {
    const std::vector<float> sum =
        prt::interpolated(baked, plan_.scene.surfaces().corners(point.position.triangle), point.position);
    const auto channels = static_cast<std::size_t>(plan_.channels),
               lamp_channels = static_cast<std::size_t>(plan_.lamp_channels()),
               columns = static_cast<std::size_t>(coefficient_count(plan_.options.order));
    Value value{std::vector<float>(channels * columns), std::vector<float>(channels * columns), {}, {}};
    std::size_t first = 0;
    for (const TransferTerm& term : baked.layout.terms) {
        const std::size_t numbers = baked.layout.numbers_of(term);
        const std::span<const float> here = std::span(sum).subspan(first, numbers);
        first += numbers;
        if (term.kind == TermKind::lamp) {
            const std::vector<float> wide = in_channels(here, lamp_channels, 1);
            value.lamps.insert(value.lamps.end(), wide.begin(), wide.end());
        } else {
            (term.kind == TermKind::indirect ? value.indirect : value.direct) =
                in_channels(here, channels, columns);
        }
    }
    value.sky = value.direct;
    add_to(value.sky, value.indirect);
    return value;
}

void ErrorCheck::add_sky(const Point& point, const Value& x, const Halves& halves, Sums& sums) const {
    Sums::Node& node = sums.nodes[node_of(point)];
    const double norm = product(halves[0].all, halves[1].all),
                 error = squared_error(x.sky, halves[0].all, halves[1].all);
    sums.sky.add(point.area, error, norm);
    node.sky.add(point.area, error, norm);
    sums.direct.add(point.area, squared_error(x.direct, halves[0].unbounced, halves[1].unbounced), norm);
    sums.indirect.add(point.area,
                      squared_error(x.indirect, difference(halves[0].all, halves[0].unbounced),
                                    difference(halves[1].all, halves[1].unbounced)),
                      norm);
}

std::vector<ErrorCheck::Square> ErrorCheck::lamp_squares(const Value& x, const Halves& halves) const {
    const auto channels = static_cast<std::size_t>(plan_.lamp_channels());
    const std::size_t stride = halves[0].all.size() / channels;
    const bool bounces_alone = plan_.options.lamps.mode == LampMode::indirect;
    std::vector<Square> squares(plan_.lamps.size());
    for (std::size_t k = 0; k < squares.size(); ++k)
        for (std::size_t c = 0; c < channels; ++c) {
            const std::size_t i = c * stride + k;
            const auto truth = [&](const Light& half) {
                return static_cast<double>(half.all[i] - (bounces_alone ? half.unbounced[i] : 0));
            };
            const auto here = static_cast<double>(x.lamps[k * channels + c]);
            squares[k].error += (here - truth(halves[0])) * (here - truth(halves[1]));
            squares[k].norm += truth(halves[0]) * truth(halves[1]);
        }
    return squares;
}

void ErrorCheck::add_lamps(const Point& point, const Value& x, const Halves& halves, Sums& sums) const {
    Square all;
    const std::vector<Square> squares = lamp_squares(x, halves);
    for (std::size_t k = 0; k < squares.size(); ++k) {
        sums.each_lamp[k].add(point.area, squares[k].error, squares[k].norm);
        all.error += squares[k].error;
        all.norm += squares[k].norm;
    }
    sums.lamps.add(point.area, all.error, all.norm);
    sums.nodes[node_of(point)].lamps.add(point.area, all.error, all.norm);
}

/// Adds the error on a back side, only if light arrives there without a bounce: insides of solids get only
/// interpolated light.
void ErrorCheck::add_back(const Point& point, const Value& x, const Bounced& bounced, Sums& sums) const {
    Sums::Node& node = sums.nodes[node_of(point)];
    const Halves sky = halves(point, true, sky_, bounced.sky, plan_.channels);
    if (sky[0].unbounced[0] > 0 && sky[1].unbounced[0] > 0) {
        const double error = squared_error(x.sky, sky[0].all, sky[1].all),
                     norm = product(sky[0].all, sky[1].all);
        sums.backs.add(point.area, error, norm);
        node.backs.add(point.area, error, norm);
    }
    if (plan_.lamps.empty())
        return;
    const Halves lit = halves(point, true, lamps_, bounced.lamps, plan_.lamp_channels());
    if (!(product(lit[0].unbounced, lit[1].unbounced) > 0))
        return;
    Square all;
    for (const Square& square : lamp_squares(x, lit)) {
        all.error += square.error;
        all.norm += square.norm;
    }
    sums.backs_by_lamps.add(point.area, all.error, all.norm);
    node.backs_by_lamps.add(point.area, all.error, all.norm);
}

BakeErrors ErrorCheck::compare(const Transfer& baked, const Bounced& bounced) const {
    Sums sums;
    sums.each_lamp.resize(plan_.lamps.size());
    for (const Point& point : points_) {
        const Value x = interpolated(point, baked);
        add_sky(point, x, halves(point, false, sky_, bounced.sky, plan_.channels), sums);
        if (!plan_.lamps.empty())
            add_lamps(point, x, halves(point, false, lamps_, bounced.lamps, plan_.lamp_channels()), sums);
        if (point.back)
            add_back(point, x, bounced, sums);
    }
    BakeErrors errors{.points = points_.size(),
                      .sky = sums.sky.relative(),
                      .direct = sums.direct.relative(),
                      .indirect = sums.indirect.relative(),
                      .lamps = sums.lamps.relative(),
                      .backs = sums.backs.relative(sums.sky),
                      .backs_by_lamps = sums.backs_by_lamps.relative(sums.lamps)};
    for (std::size_t k = 0; k < plan_.lamps.size(); ++k)
        errors.each_lamp.push_back({plan_.lamps[k].name, sums.each_lamp[k].relative()});
    for (const Primitive& primitive : plan_.scene.scene().primitives)
        if (const auto found = sums.nodes.find(primitive.node); found != sums.nodes.end()) {
            const Sums::Node& node = found->second;
            errors.nodes.push_back({primitive.node_name, node.sky.relative(sums.sky),
                                    node.lamps.relative(sums.lamps), node.backs.relative(sums.sky),
                                    node.backs_by_lamps.relative(sums.lamps), node.sky.points()});
            sums.nodes.erase(found);
        }
    return errors;
}

} // namespace prt
