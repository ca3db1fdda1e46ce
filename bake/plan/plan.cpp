// Plans a bake: media, textures, bounces, channels and lamps of a scene.

#include "bake/plan/plan.h"

#include "bake/scene/material_notices.h"
#include "bake/scene/small_objects.h"
#include "prt/core/error.h"
#include "runtime/load/light_passing.h"

#include <fmt/core.h>

#include <algorithm>
#include <map>

namespace prt {
namespace {

TextureNeeds texture_needs(const BakeOptions& options) {
    if (options.bounces != 0)
        return TextureNeeds::all;
    return options.lamps.mode == LampMode::none ? TextureNeeds::shadows : TextureNeeds::visibility;
}

/// One operator for each medium of each node.
std::vector<DiffusionOperator> make_diffusion(const Scene& scene, const Media& media,
                                              const Receivers& receivers) {
    struct Body {
        std::size_t material;
        std::vector<glm::uvec3> triangles;
    };
    std::vector<Body> bodies;
    const std::vector<std::optional<std::size_t>> body_of = bodies_of(scene, media);
    for (std::size_t p = 0; p < scene.primitives.size(); ++p) {
        const Primitive& primitive = scene.primitives[p];
        if (!body_of[p])
            continue;
        if (*body_of[p] == bodies.size())
            bodies.push_back({primitive.material, {}});
        const auto first = static_cast<unsigned>(scene.vertex_arrays[primitive.vertices].first_receiver);
        for (const glm::uvec3& t : primitive.triangles)
            bodies[*body_of[p]].triangles.push_back(t + first);
    }
    std::vector<DiffusionOperator> diffusion;
    for (Body& body : bodies)
        diffusion.emplace_back(receivers, std::move(body.triangles), *media[body.material]);
    return diffusion;
}

void check_medium(const Medium& medium, const std::string& material) {
    for (int c = 0; c < 3; ++c)
        if (!(medium.scattering[c] >= kMinScattering && medium.scattering[c] <= kMaxCoefficient &&
              medium.absorption[c] >= 0 && medium.absorption[c] <= kMaxCoefficient))
            throw Error(
                fmt::format("the medium of material '{}' scatters {:.3g} and absorbs {:.3g} per unit: "
                            "scattering must be in {:.0e}..{:.0e}, absorption in 0..{:.0e}",
                            material, medium.scattering[c], medium.absorption[c], kMinScattering,
                            kMaxCoefficient, kMaxCoefficient));
}

} // namespace

int BakePlan::direct_channels() const {
    return scene.surfaces().traits().transmission ? channels : 1;
}

int BakePlan::lamp_channels() const {
    return channels == 3 || !are_white(traced().scene.surfaces(), lamps) ? 3 : 1;
}

GatherOperator BakePlan::gather_rows(std::size_t rows) const {
    return {traced().scene.surfaces(), *traced().transport, rows, channels};
}

std::size_t BakePlan::numbers() const {
    const bool rest = bounces != 0 || !diffusion.empty();
    const int of_sky = direct_channels() + (rest ? channels : 0);
    return static_cast<std::size_t>(of_sky * coefficient_count(options.order)) +
           lamps.size() * static_cast<std::size_t>(lamp_channels());
}

Media choose_media(const Scene& scene, const BakeOptions& options, const Scene* other) {
    Media media;
    for (const Material& material : scene.materials)
        media.push_back(medium_of(material));
    for (const MediumChoice& choice : options.subsurface.media) {
        bool found = false;
        for (std::size_t m = 0; m < scene.materials.size(); ++m)
            if (choice.material.empty() || scene.materials[m].name == choice.material) {
                media[m] = choice.medium;
                found = true;
            }
        if (!found && !(other && std::ranges::count(other->materials, choice.material, &Material::name) > 0))
            throw Error(fmt::format("no material has the name '{}'", choice.material));
    }
    for (std::size_t m = 0; m < media.size(); ++m)
        if (auto& medium = media[m]) {
            medium->scattering *= options.subsurface.metres_per_unit;
            medium->absorption *= options.subsurface.metres_per_unit;
            check_medium(*medium, scene.materials[m].name);
        }
    return media;
}

std::vector<std::string> added_media(const Scene& scene, const Media& media) {
    std::vector<std::string> names;
    for (std::size_t m = 0; m < media.size(); ++m)
        if (media[m] && !has_medium(scene.materials[m]))
            names.push_back(lamp_name(scene, m));
    return names;
}

TraceScene trace_scene(const Scene& scene, const Media& media, const BakeOptions& options,
                       const TraceScene* same_images) {
    TraceSceneOptions settings{.threads = options.threads};
    for (const auto& medium : media)
        settings.solid.push_back(medium.has_value());
    if (same_images)
        return TraceScene::sharing(*same_images, scene, settings);
    return TraceScene(scene, load_textures(scene, options.repairs.bad_textures, texture_needs(options)),
                      settings);
}

std::vector<std::optional<std::size_t>> bodies_of(const Scene& scene, const Media& media) {
    std::map<std::pair<std::size_t, int>, std::size_t> bodies;
    std::vector<std::optional<std::size_t>> body_of;
    for (const Primitive& primitive : scene.primitives) {
        body_of.emplace_back();
        if (media[primitive.material])
            body_of.back() =
                bodies.try_emplace({primitive.material, primitive.node}, bodies.size()).first->second;
    }
    return body_of;
}

std::vector<std::string> scene_notices(const TraceScene& scene, const BakeOptions& options) {
    std::vector<std::string> notices;
    for (const auto& [image, encoding] : needed_images(scene.scene(), texture_needs(options)))
        if (scene.textures()[static_cast<std::size_t>(image)].levels.empty())
            notices.push_back(fmt::format("image {} is missing or damaged; its materials use their factors "
                                          "without it, and emission with it is black",
                                          image));
    for (std::string& notice : material_notices(scene.scene(), options.bounces != 0))
        notices.push_back(std::move(notice));
    if (auto notice = small_object_notice(scene.scene()))
        notices.push_back(std::move(*notice));
    return notices;
}

BakePlan plan_bake(const TraceScene& scene, const Media& media, const BakeOptions& options,
                   DetailedPlan* detail) {
    const SurfaceTraits& traits = scene.surfaces().traits();
    BakePlan plan{.scene = scene,
                  .options = options,
                  .bounces = detail ? detail->plan.bounces : options.bounces,
                  .transport = {},
                  .diffusion = {},
                  .lamps = detail ? detail->plan.lamps : choose_lamps(scene.surfaces(), options.lamps),
                  .notices = scene_notices(scene, options)};
    if (detail)
        plan.detail = &detail->plan;
    else if (plan.bounces != 0 && !traits.scattering) {
        plan.bounces = 0;
        plan.notices.push_back("bounces are skipped: all surfaces are black");
    }
    const bool from_surfaces = (plan.bounces != 0 && !detail) || traits.transmission;
    TransportReceivers fronts = without_back_sides(vertex_receivers(scene.scene()));
    plan.transport = std::make_unique<const TransportReceivers>(measured_on(
        detail && detail->surface ? &*detail->surface : nullptr,
        from_surfaces ? with_back_sides(std::move(fronts.receivers), scene.surfaces()) : std::move(fronts)));
    plan.diffusion = make_diffusion(scene.scene(), media, plan.receivers());
    const bool grey_media =
        std::all_of(plan.diffusion.begin(), plan.diffusion.end(), [](const auto& d) { return d.is_grey(); });
    plan.channels = (traits.color && from_surfaces) || !grey_media ? 3 : 1;
    if (detail) {
        plan.channels = detail->plan.channels = std::max(plan.channels, detail->plan.channels);
        for (const std::string& notice : detail->plan.notices)
            if (std::ranges::count(plan.notices, notice) == 0)
                plan.notices.push_back(notice);
    }
    const std::string one_channel =
        fmt::format("the transfer has one channel: {}",
                    plan.bounces != 0 ? "all surfaces are grey" : "direct light is white");
    std::erase(plan.notices, one_channel);
    if (plan.channels == 1)
        plan.notices.push_back(one_channel);
    return plan;
}

DetailedPlan::DetailedPlan(const Scene& scene, const FinerModel& finer, const BakeOptions& options)
    : media(choose_media(*finer.scene, options, &scene)), traced(trace_scene(*finer.scene, media, options)),
      plan(plan_bake(traced, media, options)) {
    if (finer.reach > 0)
        surface.emplace(traced, finer.reach, scene.origin);
}

} // namespace prt
