#include "back_sides.h"

#include "no_shadow.h"
#include "options.h"
#include "outputs.h"
#include "prt/separate_sides.h"
#include "prt/sides.h"

#include <fmt/core.h>

#include <algorithm>

namespace prt::cli {
namespace {

const std::map<std::string, BackSides> kBackSides = {{"auto", BackSides::automatic},
                                                     {"shared", BackSides::shared}};

} // namespace

void add_back_sides(CLI::App* command, BackSides& sides) {
    choice(command, "--back-sides", sides, kBackSides,
           "backs of double-sided surfaces: auto: where light reaches both sides, the file gets a "
           "single-sided surface with vertices of its own for each; shared: they show the light of the front",
           "auto");
}

bool separate_sides(const SidesRequest& request, GltfDocument& document, Scene& scene) {
    if (request.sides == BackSides::shared)
        return false;
    const std::vector<bool> triangles = sides_to_separate(scene, request.options);
    if (triangles.empty())
        return false;
    document = with_separate_sides(std::move(document), scene, triangles);
    Scene separate = extract_scene(document);
    leave_out_shadows(separate, request.no_shadow);
    separate.notices = std::move(scene.notices); // of the file that was given
    const std::string notice =
        fmt::format("light reaches both sides of {} double-sided triangles: {} vertices more hold that of "
                    "their backs (--back-sides shared leaves them out)",
                    std::ranges::count(triangles, true), separate.receivers() - scene.receivers());
    print_notices(request.path.string(), {notice});
    separate.notices.push_back(notice);
    scene = std::move(separate);
    return true;
}

} // namespace prt::cli
