#pragma once

// Sources of the error of a picture, under each of several lights.

#include "bake/studies/error_budget.h"
#include "cli/pipeline/budget_lights.h"
#include "cli/pipeline/model.h"
#include "prt/core/progress.h"
#include "prt/render/texture.h"

#include <vector>

namespace prt::pipeline {

struct BudgetEffort {
    std::size_t points = 1024;
    double noise = 5e-5; ///< noise of squared errors (`SurfaceRadianceOptions`)
    double seconds = 0;  ///< for each light, about; 0: any
    std::uint64_t seed = 0x9e3779b97f4a7c15;
    BadTextures bad_textures = BadTextures::error;
    int threads = 0;
};

/// A scene, points on it, and their path-traced radiance under each light. Its address must not change.
class BudgetReference {
public:
    /// Keeps references to `scene` and `lights`. Throws `Error` where no surface can be seen.
    BudgetReference(const Scene& scene, const std::vector<ReferenceLight>& lights, const BudgetEffort& effort,
                    const Progress& progress);

    const std::vector<ReferenceLight>& lights() const { return lights_; }
    const SurfacePoints& points() const { return points_; }
    const TraceScene& scene() const { return scene_; }
    const SurfaceRadiance& of(std::size_t light) const { return radiance_[light]; }

    /// Returns the truncation of a bake of this order and number of bounces under a light.
    BandTruncation cut(std::size_t light, int order, int bounces) const {
        return {order, bounces, lights_[light].factors(order)};
    }
    /// Return squared relative errors, as means over all lights: of truncating to `order` bands, with all
    /// bounces; and of the bounces after the first `bounces`.
    double light_error(int order) const;
    double bounces_error(int bounces) const;

private:
    const std::vector<ReferenceLight>& lights_;
    TraceScene scene_;
    SurfacePoints points_;
    std::vector<SurfaceRadiance> radiance_; ///< [lights]
};

/// Transfer of the stages: as baked, baked again with another seed, and as shipped.
struct BudgetStages {
    const Transfer& baked;
    const Transfer& repeated;
    const Transfer* shipped = nullptr; ///< null: not compressed
    int bounces = 0;                   ///< or kEndlessBounces
    bool alike = true;                 ///< both bakes have the same number of rays
    /// Null: their receivers are vertices, and their values are interpolated; else texels, which are
    /// filtered.
    const LightmapOfFile* lightmap = nullptr;
};

/// Error budgets by two measures, [lights].
struct Budgets {
    std::vector<ErrorBudget> relative, visible;
};
Budgets budgets(const BudgetReference& reference, const BudgetStages& stages, int threads);

} // namespace prt::pipeline
