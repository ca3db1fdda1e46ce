// Groups lights and emissive surfaces by name.

#include "bake/trace/choose_lamps.h"

#include "prt/core/error.h"
#include "prt/core/light.h"
#include "runtime/core/support/printable.h"

#include <fmt/core.h>

#include <algorithm>
#include <map>

namespace prt {
namespace {

class Lamps {
public:
    explicit Lamps(std::vector<LampGroup> groups)
        : groups_(std::move(groups)), used_(groups_.size(), false) {}

    Lamp& called(const std::string& own) {
        std::string name = own;
        bool grouped = false;
        for (std::size_t g = 0; g < groups_.size(); ++g)
            if (matches(own, groups_[g].pattern)) {
                used_[g] = grouped = true;
                name = groups_[g].name;
                break;
            }
        const auto [at, is_new] = positions_.try_emplace(name, lamps_.size());
        if (is_new)
            lamps_.push_back({.name = name});
        Lamp& lamp = lamps_[at->second];
        if (!is_new && grouped == lamp.members.empty())
            throw Error(fmt::format("a lamp has the same name as lamp group '{}'; rename the group",
                                    printable(name)));
        if (grouped && std::find(lamp.members.begin(), lamp.members.end(), own) == lamp.members.end())
            lamp.members.push_back(own);
        return lamp;
    }

    std::vector<Lamp> finish() {
        for (std::size_t g = 0; g < groups_.size(); ++g)
            if (!used_[g])
                throw Error(fmt::format("no lamp matches '{}', or all matches are in earlier groups",
                                        printable(groups_[g].pattern)));
        if (lamps_.size() > kMaxLamps)
            throw Error(fmt::format(
                "the scene has {} lamps with different names, but at most {} can be "
                "dimmed separately; group lamps (--lamps all,group=NAME=PATTERN) or exclude them (--lamps "
                "none)",
                lamps_.size(), kMaxLamps));
        return std::move(lamps_);
    }

private:
    std::vector<LampGroup> groups_;
    std::vector<bool> used_;
    std::map<std::string, std::size_t> positions_;
    std::vector<Lamp> lamps_;
};

void add_lamps_of_scene(const Surfaces& surfaces, Lamps& lamps) {
    const Scene& scene = surfaces.scene();
    for (std::uint32_t i = 0; i < scene.lights.size(); ++i)
        lamps.called(scene.lights[i].name).lights.push_back(i);
    for (std::uint32_t t = 0; t < surfaces.triangles(); ++t)
        if (surfaces.emits(t))
            lamps.called(lamp_name(scene, scene.primitives[surfaces.primitive(t)].material))
                .triangles.push_back(t);
}

} // namespace

bool matches(const std::string& text, const std::string& pattern) {
    // On a mismatch the last * takes one more letter.
    std::size_t t = 0, p = 0, star = std::string::npos, taken = 0;
    while (t < text.size()) {
        if (p < pattern.size() && pattern[p] == '*') {
            star = p++;
            taken = t;
        } else if (p < pattern.size() && (pattern[p] == '?' || pattern[p] == text[t])) {
            ++p;
            ++t;
        } else if (star != std::string::npos) {
            p = star + 1;
            t = ++taken;
        } else {
            return false;
        }
    }
    return pattern.find_first_not_of('*', p) == std::string::npos;
}

std::vector<Lamp> choose_lamps(const Surfaces& surfaces, const LampOptions& options) {
    if (options.mode == LampMode::none)
        return {};
    Lamps lamps(options.groups);
    add_lamps_of_scene(surfaces, lamps);
    return lamps.finish();
}

bool are_white(const Surfaces& surfaces, const std::vector<Lamp>& lamps) {
    return std::all_of(lamps.begin(), lamps.end(), [&](const Lamp& lamp) {
        return std::all_of(lamp.lights.begin(), lamp.lights.end(),
                           [&](std::uint32_t i) { return is_grey(surfaces.scene().lights[i].intensity); }) &&
               std::all_of(lamp.triangles.begin(), lamp.triangles.end(), [&](std::uint32_t t) {
                   const Emission& emission = surfaces.material(t).emission;
                   return is_grey(emission.radiance) && surfaces.is_grey(emission.texture);
               });
    });
}

} // namespace prt
