// Compares interpolated light of a volume with path tracing.

#include "cli/pipeline/volume_errors.h"

#include "bake/reference/incident_reference.h"
#include "cli/pipeline/no_shadow.h"
#include "cli/pipeline/sky_occlusion.h"
#include "prt/core/error.h"
#include "prt/core/sh.h"

#include <fmt/core.h>
#include <glm/geometric.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <numbers>
#include <utility>

namespace prt::pipeline {
namespace {

constexpr std::size_t kPositions = 1000;
/// Upper limits of the distance classes, metres.
constexpr std::array<float, 4> kDistances = {0.05f, 0.2f, 0.5f, HUGE_VALF};

/// Sum of the products of differences from both halves of a reference, and of the radiance they are relative
/// to.
struct ErrorSum {
    double error = 0, norm = 0;

    double relative() const { return norm > 0 ? std::sqrt(std::max(0.0, error) / norm) : 0; }
};

struct VolumeErrors {
    ErrorSum all;
    std::array<ErrorSum, kDistances.size()> by_distance;
    ErrorSum irradiance; ///< irradiance on surfaces of all orientations
};

/// Even over the sphere (a spiral of equal areas).
std::vector<glm::vec3> normals_all_round() {
    constexpr int kNormals = 32;
    std::vector<glm::vec3> normals;
    for (int i = 0; i < kNormals; ++i) {
        const double y = 1 - (2 * i + 1.0) / kNormals,
                     rotation = 2 * std::numbers::pi * i / std::numbers::phi;
        const double radius = std::sqrt(1 - y * y);
        normals.emplace_back(radius * std::cos(rotation), y, radius * std::sin(rotation));
    }
    return normals;
}

/// Returns irradiance over pi; negative if the coefficients produce negative values.
glm::dvec3 unclamped_irradiance(std::span<const glm::vec3> light, std::span<const float> basis) {
    constexpr std::array<double, 4> kCosine = {1, 2.0 / 3, 0.25, 0};
    glm::dvec3 sum(0);
    for (std::size_t o = 0; o < light.size(); ++o)
        sum += kCosine[static_cast<std::size_t>(std::sqrt(static_cast<double>(o)))] *
               static_cast<double>(basis[o]) * glm::dvec3(light[o]);
    return sum;
}

/// Returns the error of the irradiance `found(position, normal)`.
ErrorSum irradiance_error(const FreePositions& points, const std::array<std::vector<glm::vec3>, 2>& truth,
                          const std::function<glm::vec3(std::size_t, const glm::vec3&)>& found) {
    const std::size_t coefficients = truth[0].size() / points.positions.size();
    const int order = static_cast<int>(std::lround(std::sqrt(static_cast<double>(coefficients))));
    std::vector<float> basis(coefficients);
    ErrorSum sum;
    for (const glm::vec3& normal : normals_all_round()) {
        evaluate_sh(order, normal, basis);
        for (std::size_t p = 0; p < points.positions.size(); ++p) {
            const auto half = [&](std::size_t h) {
                return unclamped_irradiance(std::span(truth[h]).subspan(p * coefficients, coefficients),
                                            basis);
            };
            const glm::dvec3 a = half(0), b = half(1), x(found(p, normal));
            sum.error += glm::dot(a - x, b - x);
            sum.norm += glm::dot(a, b);
        }
    }
    return sum;
}

/// Returns the errors of incident light at probes: [probes][coefficients].
VolumeErrors errors_of(const VolumeLookup& lookup, std::span<const glm::vec3> incident,
                       const FreePositions& points, const std::array<std::vector<glm::vec3>, 2>& truth) {
    const std::size_t coefficients = truth[0].size() / points.positions.size();
    std::vector<glm::vec3> light(coefficients);
    VolumeErrors errors;
    for (std::size_t p = 0; p < points.positions.size(); ++p) {
        mix_incident(lookup.find(points.positions[p]), incident, light);
        ErrorSum here;
        for (std::size_t o = 0; o < coefficients; ++o) {
            const glm::dvec3 a(truth[0][p * coefficients + o]), b(truth[1][p * coefficients + o]),
                x(light[o]);
            here.error += glm::dot(a - x, b - x);
            here.norm += glm::dot(a, b);
        }
        const auto bin = static_cast<std::size_t>(std::ranges::upper_bound(kDistances, points.distances[p]) -
                                                  kDistances.begin());
        for (ErrorSum* sum : {&errors.all, &errors.by_distance[std::min(bin, kDistances.size() - 1)]}) {
            sum->error += here.error;
            sum->norm += here.norm;
        }
    }
    errors.irradiance = irradiance_error(points, truth, [&](std::size_t p, const glm::vec3& normal) {
        mix_incident(lookup.find(points.positions[p]), incident, light);
        return irradiance_of(light, normal);
    });
    return errors;
}

std::string distance_title(std::size_t i) {
    if (i == 0)
        return fmt::format("within {:g} m", kDistances[0]);
    return std::isinf(kDistances[i]) ? fmt::format("beyond {:g} m", kDistances[i - 1])
                                     : fmt::format("up to {:g} m", kDistances[i]);
}

Table empty_table() {
    Table table{"volume_errors", "Errors of the volume in free space", "", {}, {}};
    table.about = fmt::format(
        "Relative L2 of the coefficients of incident light at {} positions in free space, by their distance "
        "from surfaces, against path tracing under the complete light. Separate suns are shadowed by the "
        "renderer. Lamps are off under skies; the row 'lamps' has no sky and lamps at the strengths of the "
        "scene. Irradiance: error on surfaces of all orientations, over all positions. Sky occlusion: data "
        "that other engines store at the same probes, the fraction of a grey sky that arrives, times the "
        "irradiance of the sky.",
        kPositions);
    table.columns = {{"light", "light"}, {"volume", "volume"}, {"error", "error", Unit::percent, 2}};
    for (std::size_t i = 0; i < kDistances.size(); ++i)
        table.columns.push_back({fmt::format("error_{}", i), distance_title(i), Unit::percent, 2});
    table.columns.push_back({"irradiance_error", "irradiance", Unit::percent, 2});
    return table;
}

std::vector<Json> row_of(const std::string& light, const char* volume, const VolumeErrors& errors) {
    std::vector<Json> row = {light, volume, errors.all.relative()};
    for (const ErrorSum& sum : errors.by_distance)
        row.push_back(sum.norm > 0 ? Json(sum.relative()) : Json());
    row.emplace_back(errors.irradiance.relative());
    return row;
}

/// Root mean square over lights, column by column.
std::vector<Json> mean_row(const char* volume, std::span<const VolumeErrors> all) {
    VolumeErrors mean;
    const auto add = [&](ErrorSum& to, const ErrorSum& from) {
        const double relative = from.relative();
        to.error += relative * relative;
        to.norm += from.norm > 0 ? 1 : 0;
    };
    for (const VolumeErrors& one : all) {
        add(mean.all, one.all);
        add(mean.irradiance, one.irradiance);
        for (std::size_t i = 0; i < kDistances.size(); ++i)
            add(mean.by_distance[i], one.by_distance[i]);
    }
    return row_of("root mean square", volume, mean);
}

/// The volume of the shipped file, if there is one; that belongs to `volume`.
std::optional<CompressedVolume> shipped_volume(const BudgetRequest& request, const BakedVolume& volume) {
    if (request.shipped.empty())
        return std::nullopt;
    SceneFile shipped = load_scene_file(request.shipped, request.reading);
    std::optional<CompressedVolume>& small = shipped.compressed_volume;
    if (!small)
        throw Error(request.shipped.string() +
                    ": contains no compressed volume; run prt compress on a bake with a volume");
    if (small->grid != volume.grid || small->order != volume.order ||
        small->compressed.record.receivers != volume.baked.record.receivers)
        throw Error(request.shipped.string() + ": its volume was not made from the volume of " +
                    request.baked.string());
    return std::move(small);
}

/// Returns the sky light at positions that no sky light reaches: leaks through walls.
Table leak_table(const BakedVolume& volume, const VolumeLookup& lookup, const FreePositions& points) {
    const std::size_t coefficients = volume.coefficients();
    double sum = 0, largest = 0;
    std::size_t shut = 0;
    for (std::size_t p = 0; p < points.positions.size(); ++p) {
        if (!points.shut[p])
            continue;
        const VolumeCorners corners = lookup.find(points.positions[p]);
        double sky = 0; // light of a uniform sky of radiance 1, without bounces
        for (std::size_t i = 0; i < corners.probes.size(); ++i)
            sky += static_cast<double>(corners.weights[i] *
                                       volume.baked.transfer.vector(corners.probes[i] * coefficients)[0]);
        ++shut;
        sum += std::abs(sky);
        largest = std::max(largest, std::abs(sky));
    }
    Table table{"volume_leaks", "Leaks of the volume through walls", "", {}, {}};
    table.about = fmt::format(
        "Direct light of a uniform sky in the volume, at those of the {} positions in free "
        "space from which no ray reaches the sky; 0 means no leak, 1 as much light as under the open sky.",
        points.positions.size());
    table.columns = {{"positions", "positions without sky"},
                     {"mean", "mean", Unit::plain, 4},
                     {"max", "max", Unit::plain, 3}};
    table.rows = {
        {shut, shut > 0 ? Json(sum / static_cast<double>(shut)) : Json(), shut > 0 ? Json(largest) : Json()}};
    return table;
}

/// Returns a black sky, for the light of lamps.
ReferenceLight dark() {
    const Light black = constant_light(kMaxOrder, glm::vec3(0));
    return {DistantLight({}), {}, {}, black, black, "lamps"};
}

/// Returns the lighting of the volume under `light`, with all lamps on or off.
Lighting lighting_of(const ReferenceLight& light, const TransferLayout& layout, bool lamps) {
    Lighting lighting = light.lighting(layout.order);
    if (!lamps)
        lighting.lamps.assign(layout.lamps(), glm::vec3(0));
    return lighting;
}

/// Adds rows for the same light from probe data of other engines; they contain irradiance only.
void add_sky_occlusion(const Lighting& lighting, const SkyOcclusion& occlusion, const VolumeLookup& lookup,
                       const FreePositions& points, const std::array<std::vector<glm::vec3>, 2>& truth,
                       Table& table) {
    using Kind = SkyOcclusionKind;
    for (const auto& row_kind :
         {std::pair(Kind::number, "sky occlusion, 1 coefficient"),
          std::pair(Kind::linear, "sky occlusion, 4 coefficients"),
          std::pair(Kind::directed, "sky occlusion, 4 coefficients and a direction")}) {
        const ErrorSum sum = irradiance_error(points, truth, [&](std::size_t p, const glm::vec3& normal) {
            return occlusion.irradiance(lookup.find(points.positions[p]), normal, lighting.sky,
                                        row_kind.first);
        });
        std::vector<Json> row(table.columns.size());
        row.front() = lighting.name;
        row[1] = row_kind.second;
        row.back() = sum.relative();
        table.rows.push_back(std::move(row));
    }
}

/// Root mean squares over all lights, where there are several.
void add_means(std::span<const VolumeErrors> of_baked, std::span<const VolumeErrors> of_small, Table& table) {
    if (of_baked.size() < 2)
        return;
    table.rows.push_back(mean_row("baked", of_baked));
    if (!of_small.empty())
        table.rows.push_back(mean_row("shipped", of_small));
}

void check_request(const BudgetRequest& request, SceneFile& baked) {
    if (!baked.volume)
        throw Error(request.baked.string() +
                    ": contains no uncompressed volume; run prt bake --volume first");
    about(request.baked, [&] { leave_out_shadows(baked.scene, request.no_shadow); });
}

} // namespace

void add_volume_errors(BudgetRequest request, SceneFile& baked, Report& report, const Host& host) {
    check_request(request, baked);
    const BakedVolume& volume = *baked.volume;
    const std::optional<CompressedVolume> small = shipped_volume(request, volume);
    BudgetLightOptions& options = request.lights;
    options.order = volume.baked.transfer.layout.order;
    options.separate = volume.baked.transfer.layout.has(TermKind::direct);
    const Stage stage = host.stages("measuring the volume");
    const Progress progress = stage.progress;
    const TraceScene traced(
        baked.scene,
        about(request.baked, [&] { return load_textures(baked.scene, request.reading.bad_textures); }),
        {.threads = options.threads});
    const FreePositions points = free_positions_in(traced, volume.grid, kPositions, 1);
    const VolumeLookup lookup(volume.grid, volume.visibility);
    const TransferLayout layout = volume.baked.transfer.layout.of_one_output();
    std::vector<ReferenceLight> lights = budget_lights(options);
    const std::size_t skies = lights.size();
    const SceneLamps lamps(traced, layout.lamp_terms(), std::vector<glm::vec3>(layout.lamps(), glm::vec3(1)));
    if (lamps.has_lights() || lamps.has_surfaces())
        lights.push_back(dark());
    const SkyOcclusion occlusion(volume, options.threads);
    Table table = empty_table();
    std::vector<VolumeErrors> of_baked, of_small;
    const auto share = [&](std::size_t i) {
        return static_cast<double>(i) / static_cast<double>(lights.size());
    };
    for (std::size_t i = 0; i < lights.size(); ++i) {
        const bool by_lamps = i == skies; // after the skies
        const auto truth =
            incident_reference(traced, points.positions, volume.order, lights[i],
                               {.lamps = by_lamps ? &lamps : nullptr, .threads = options.threads},
                               progress.range(share(i), share(i + 1)));
        const Lighting lighting = lighting_of(lights[i], layout, by_lamps);
        of_baked.push_back(errors_of(lookup, exit_radiance(volume.baked.transfer, lighting, options.threads),
                                     points, truth));
        table.rows.push_back(row_of(lights[i].name, "baked", of_baked.back()));
        if (!by_lamps && layout.order >= 3)
            add_sky_occlusion(lighting, occlusion, lookup, points, truth, table);
        if (!small)
            continue;
        of_small.push_back(
            errors_of(lookup, incident_light(*small, lighting, options.threads), points, truth));
        table.rows.push_back(row_of(lights[i].name, "shipped", of_small.back()));
    }
    add_means(of_baked, of_small, table);
    report.tables.insert(report.tables.begin(), {std::move(table), leak_table(volume, lookup, points)});
}

} // namespace prt::pipeline
