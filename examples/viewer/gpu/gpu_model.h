#pragma once

// A model on the GPU, with all that it can be lit by.

#include "core/model.h"
#include "core/settings.h"

#include "prt/gl_scene.h"
#include "prt/gl_transfer.h"

#include <map>
#include <memory>
#include <optional>

namespace viewer {

/// What one drawing of the geometry needs beside the model.
struct GeometryPass {
    glm::mat4 view_projection{1};
    glm::vec3 eye{0};
    bool gbuffer = false;
    bool culling = true, textured = true, dithered = true;
};

class GpuModel {
public:
    /// `most_receivers`: of raw transfer that one dispatch takes, a multiple of 256.
    explicit GpuModel(std::shared_ptr<const Model> model, std::size_t most_receivers = 1u << 21);
    const Model& model() const { return *model_; }

    void set_raw(const prt::Transfer& transfer);
    void drop_raw();
    void set_compressed(const prt::ClusteredTransfer& transfer);
    void set_occlusion(std::span<const float> occlusion);
    void set_numbers(PictureKind kind, std::span<const glm::vec3> colors);
    /// Of as many bands as the transfers have, and three at least.
    void set_light(const prt::Light& light);
    bool can_draw(PictureKind kind) const;
    /// Seconds that the constants of the compressed transfer took, forming and uploading.
    double seconds_constants() const { return seconds_constants_; }

    void draw_opaque(PictureKind kind, const GeometryPass& pass);
    /// Always forward.
    void draw_blended(PictureKind kind, const GeometryPass& pass);
    /// Edges of all triangles.
    void draw_wires(const GeometryPass& pass, const glm::vec3& color);
    /// The first nine coefficients of exit radiance by normal: irradiance.glsl.
    const glm::vec3* irradiance() const { return irradiance_; }
    std::size_t drawn_triangles() const { return drawn_triangles_; } ///< of the last opaque drawing
    std::size_t geometry_bytes() const { return scene_.bytes(); }

private:
    enum class Source { normals, raw, compressed, numbers };
    static Source source_of(PictureKind kind);
    struct Raw {
        int order, channels;
        std::size_t receivers;
        prt::GlObject vectors, light, program;
    };
    void form_raw(const prt::Light& light);
    const prt::GlObject& program(Source source, bool gbuffer);
    const prt::GlObject& use(PictureKind kind, const GeometryPass& pass);
    const prt::GlVertexArrays& arrays(Source source) const;

    std::shared_ptr<const Model> model_;
    std::size_t most_receivers_;
    prt::GlScene scene_;
    std::optional<prt::Light> light_;
    std::optional<Raw> raw_;
    std::optional<prt::GlTransfer> compressed_;
    prt::GlVertexArrays plain_, raw_arrays_, compressed_arrays_, number_arrays_;
    prt::GlObject occlusion_, radiance_;
    bool has_occlusion_ = false;
    std::map<PictureKind, prt::GlObject> numbers_;
    std::map<std::pair<Source, bool>, prt::GlObject> programs_;
    prt::GlObject wires_;
    glm::vec3 irradiance_[9] = {};
    double seconds_constants_ = 0;
    std::size_t drawn_triangles_ = 0;
};

} // namespace viewer
