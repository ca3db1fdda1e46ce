// Bakes frames of an animation and compares lobes with them.

#include "cli/pipeline/lobe_errors.h"

#include "cli/pipeline/posed_lobes.h"
#include "cli/pipeline/sky_errors.h"
#include "compress/metric/standard_skies.h"
#include "prt/core/error_measures.h"
#include "prt/core/sh.h"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace prt::pipeline {
namespace {

/// Kinds of transfer that rotate with the skin, in the order of the columns.
enum class Method { shipped, best, rest, unshadowed };
constexpr std::size_t kMethods = 4;
using ByMethod = std::array<double, kMethods>;

/// All light in the sky, and where there is a sun, the sky without it: renderers shadow suns by themselves.
std::vector<LightingUse> sky_lights(int order) {
    std::vector<LightingUse> lights;
    for (const Lighting& sky : standard_skies(order)) {
        lights.push_back({{.sky = sky.suns ? sum(sky.sky, *sky.suns) : sky.sky, .name = sky.name}});
        if (sky.suns)
            lights.push_back({{.sky = sky.sky, .name = sky.name}, true});
    }
    return lights;
}

/// A frame, and the transfer that each method has there.
class LobeFrame {
public:
    LobeFrame(const LobeErrorRequest& request, const ModelPose& pose)
        : request_(request), frames_(request.model, pose) {
        for (const VertexArray& vertices : request.model.posed(pose.nodes, glm::dmat4(1)).vertex_arrays)
            normals_.insert(normals_.end(), vertices.normals.begin(), vertices.normals.end());
    }

    Transfer transfer(Method method) const {
        const int order = request_.mean.order;
        Transfer transfer = zero_transfer(order, 1, frames_.vertices());
        std::vector<double> vector(request_.mean.coefficients());
        for (std::size_t v = 0; v < frames_.vertices(); ++v) {
            write(method, v, vector);
            std::transform(vector.begin(), vector.end(), transfer.vector(v).begin(),
                           [](double x) { return static_cast<float>(x); });
        }
        return transfer;
    }

private:
    void write(Method method, std::size_t v, std::span<double> to) const {
        const MeanTransfer& mean = request_.mean;
        if (method == Method::shipped) {
            std::vector<float> vector(to.size());
            lobe_transfer(lobes_in_pose(request_.lobes, frames_, v), mean.order, vector);
            std::copy(vector.begin(), vector.end(), to.begin());
        } else if (method == Method::unshadowed) {
            clamped_cosine_lobe(mean.order, glm::dvec3(normals_[v]), to);
        } else {
            const std::vector<double>& all = method == Method::best ? mean.vectors : mean.rest;
            frames_.to_world(mean.order, v, std::span(all).subspan(v * to.size(), to.size()), to);
        }
    }

    const LobeErrorRequest& request_;
    VertexFrames frames_;
    std::vector<glm::vec3> normals_;
};

std::vector<Column> method_columns() {
    return {{"lit_rms", "lobes", Unit::percent, 2},
            {"lit_rms_best", "best rotating transfer", Unit::percent, 2},
            {"lit_rms_rest", "rest-pose bake", Unit::percent, 2},
            {"lit_rms_unshadowed", "unshadowed", Unit::percent, 2}};
}

void add_row(std::vector<Json> row, const ByMethod& squares, double count, Table& table) {
    for (const double square : squares)
        row.emplace_back(std::sqrt(square / count));
    table.rows.push_back(std::move(row));
}

Table table_by_sky() {
    Table table{"lobe_errors", "Errors of lobes over frames, by sky", "", {}, {}};
    table.about =
        "Root mean square of lit_rms over the frames, against a separate bake of each frame, for vertices "
        "that are not inside geometry. Best rotating transfer: the mean over the fitted poses, with all "
        "coefficients, rotated with the skin; no other transfer that is constant over the poses has a "
        "smaller error.";
    table.columns = {{"sky", "sky"}, {"separate_suns", "separate suns"}};
    for (Column& column : method_columns())
        table.columns.push_back(std::move(column));
    return table;
}

Table table_by_frame() {
    Table table{"lobe_errors_by_frame", "Errors of lobes, by frame", "", {}, {}};
    table.about = "Root mean square over the skies.";
    table.columns = {{"animation", "animation"}, {"seconds", "seconds"}};
    for (Column& column : method_columns())
        table.columns.push_back(std::move(column));
    return table;
}

} // namespace

void add_lobe_errors(const LobeErrorRequest& request, const Progress& progress, Report& report) {
    const std::vector<LightingUse> lights = sky_lights(request.mean.order);
    const auto frames = static_cast<double>(request.frames.size()),
               skies = static_cast<double>(lights.size());
    std::vector<ByMethod> by_sky(lights.size(), ByMethod{});
    ByMethod all{};
    Table frame_table = table_by_frame(), sky_table = table_by_sky();
    for (std::size_t f = 0; f < request.frames.size(); ++f) {
        const ModelPose& pose = request.frames[f];
        const double from = static_cast<double>(f) / frames;
        const PoseTransfer truth =
            bake_pose(request.model, pose, request.options, progress.range(from, from + 1 / frames));
        std::vector<float> areas(truth.areas.size());
        for (const std::size_t receiver : request.figure)
            areas[receiver] = truth.areas[receiver];
        const LobeFrame frame(request, pose);
        ByMethod of_frame{};
        for (std::size_t m = 0; m < kMethods; ++m) {
            const Transfer transfer = frame.transfer(static_cast<Method>(m));
            for (std::size_t i = 0; i < lights.size(); ++i) {
                const double error =
                    lit_rms(exit_radiance(truth.transfer, lights[i].lighting, request.options.threads),
                            exit_radiance(transfer, lights[i].lighting, request.options.threads), areas);
                by_sky[i][m] += error * error;
                of_frame[m] += error * error;
                all[m] += error * error / (frames * skies);
            }
        }
        add_row({pose.animation, pose.seconds}, of_frame, skies, frame_table);
    }
    for (std::size_t i = 0; i < lights.size(); ++i)
        add_row({lights[i].lighting.name, lights[i].separate_suns}, by_sky[i], frames, sky_table);
    const std::vector<Column> columns = method_columns();
    for (std::size_t m = 0; m < columns.size(); ++m)
        add_figures(report, {{columns[m].key, std::sqrt(all[m])}});
    add_figures(report, {{"frames", request.frames.size()}});
    report.sentences.emplace_back(
        "error over {frames:#frame} under skies, against a bake of each frame: lobes {lit_rms:.2f%}; best "
        "transfer that rotates with the skin {lit_rms_best:.2f%}; rest-pose bake, rotated with the skin "
        "{lit_rms_rest:.2f%}; unshadowed {lit_rms_unshadowed:.2f%}");
    report.tables.push_back(std::move(sky_table));
    report.tables.push_back(std::move(frame_table));
}

} // namespace prt::pipeline
