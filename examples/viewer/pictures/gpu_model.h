#pragma once

// A model on the GPU with all its transfer.

#include "pictures/contact_shadows.h"
#include "pictures/gpu_instances.h"
#include "pictures/gpu_lightmap.h"
#include "pictures/lamps.h"
#include "pictures/model.h"
#include "pictures/raw_transfer.h"
#include "pictures/settings.h"

#include "runtime/render/gl/gl_scene.h"
#include "runtime/render/gl/gl_transfer.h"
#include "runtime/render/gl/sun_shadows.h"

#include <array>
#include <map>
#include <memory>
#include <optional>
#include <variant>

namespace viewer {

/// Parameters of one drawing of the geometry.
struct GeometryPass {
    glm::mat4 view_projection{1};
    glm::vec3 eye{0};
    bool gbuffer = false;
    bool culling = true, textured = true, dithered = true;
    const OccluderPass* occluders = nullptr; ///< null: no occluders are near
};

class GpuModel {
public:
    /// `max_receivers`: maximum number of raw receivers per dispatch, a multiple of 256.
    explicit GpuModel(std::shared_ptr<const Model> model, std::size_t max_receivers = 1u << 21);
    const Model& model() const { return *model_; }

    void set_raw(const prt::Transfer& transfer);
    void drop_raw() { raw_.reset(); }
    void set_compressed(const prt::ClusteredTransfer& transfer);
    /// Sets transfer of texels. A model has transfer of its vertices or of texels, not both.
    void set_raw(std::shared_ptr<const prt::BakedLightmap> lightmap);
    void set_compressed(std::shared_ptr<const prt::CompressedLightmap> lightmap);
    /// Sets compressed transfer that instances share. All pictures then draw the instances, lit by it or not.
    void set_instanced(std::shared_ptr<const prt::InstancedModel> instanced);
    void set_occlusion(std::span<const float> occlusion);
    /// `colors` are [receivers], or [texels of all maps] if the model has a lightmap.
    void set_numbers(PictureKind kind, std::span<const glm::vec3> colors);
    /// The light must have the maximum order of the transfers, at least three bands. `suns` are shadowed per
    /// pixel if the picture's transfer has a separate direct term, and in pictures without transfer. `lamps`
    /// are matched by name with those of each transfer, and also scale emission; `lighting` needs no lamps.
    void set_lighting(const prt::Lighting& lighting, std::span<const prt::Sun> suns,
                      const LampSettings& lamps = {});
    /// Sets a sky only: no lamp is on.
    void set_light(const prt::Light& light) { set_lighting({light}, {}, {.on = false}); }
    /// True if there are separate suns, but the transfer of this picture has no separate direct term, so that
    /// it is lit by sky and suns together. Requires `can_draw`.
    bool takes_suns_as_sky(PictureKind kind) const;
    bool can_draw(PictureKind kind) const;
    /// Seconds to compute and upload the constants of the compressed transfer.
    double seconds_constants() const { return measured_.seconds_constants; }
    /// null: no instances share transfer.
    const GpuInstances* instances() const { return instances_ ? &*instances_ : nullptr; }

    /// Draws shadow maps for the view if `kind` needs them. Call it before drawing the picture.
    void draw_shadows(PictureKind kind, const prt::SunShadows::View& view) { draw_shadows(kind, view, {}); }
    /// Draws shadow maps including moving objects, which are lit by suns in every picture.
    void draw_shadows(PictureKind kind, const prt::SunShadows::View& view,
                      const prt::SunShadows::Moving& moving);
    /// Binds the shadow maps drawn last, if there are any.
    void use_shadows() const;
    void draw_opaque(PictureKind kind, const GeometryPass& pass);
    /// Always uses forward shading.
    void draw_blended(PictureKind kind, const GeometryPass& pass);
    /// Draws the edges of all triangles.
    void draw_wires(const GeometryPass& pass, const glm::vec3& color);
    /// Draws the borders of the lightmap's texels, if there is one; `samples` per pixel along each axis.
    void draw_texel_grid(const GeometryPass& pass, const glm::vec3& color, int samples);
    /// The first nine coefficients of unshadowed exit radiance by normal: irradiance.glsl.
    const std::array<glm::vec3, 9>& irradiance() const { return lit_.irradiance; }
    std::size_t drawn_triangles() const { return measured_.drawn_triangles; } ///< in the last opaque drawing

private:
    enum class Source { normals, raw, compressed, numbers };
    static Source source_of(PictureKind kind);
    struct Surface { ///< key of a program that draws surfaces
        Source source;
        bool gbuffer, suns, instanced;
        std::string occluders; ///< defines

        friend auto operator<=>(const Surface&, const Surface&) = default;
    };
    struct Raw {
        std::variant<RawTransfer, RawLightmap> transfer;
        prt::GlVertexArrays arrays;
        prt::TransferLayout layout;
    };
    struct Compressed {
        std::variant<prt::GlTransfer, LitLightmap> transfer;
        prt::GlVertexArrays arrays;
        prt::TransferLayout layout;
    };
    /// The light on all drawn surfaces.
    struct Lit {
        std::optional<prt::Lighting> lighting;
        std::array<glm::vec3, 9> irradiance{}; ///< irradiance of the sky
        std::vector<prt::Sun> suns;
        LampSettings lamps;
    };
    struct Numbers {
        std::map<PictureKind, prt::GlObject> colors;
        std::map<PictureKind, std::vector<prt::GlObject>> maps; ///< used instead of `colors` for texels
        prt::GlVertexArrays arrays;
    };
    struct Programs {
        std::map<Surface, prt::GlObject> surfaces;
        prt::GlObject wires, texel_grid;
    };
    void take_raw(Raw raw);
    void take_compressed(Compressed compressed);
    void light_raw();
    void light_compressed();
    void light_instances();
    bool lights(const prt::TransferLayout& layout) const;
    prt::Lighting lighting_of(const prt::TransferLayout& layout) const;
    /// Returns the layout with the lamps of such a picture; null if no transfer is used.
    const prt::TransferLayout* layout_of(Source source) const;
    /// Returns the lightmap of a picture; without a layout if the picture uses none.
    prt::GlLightmapTextures lightmap_of(PictureKind kind) const;
    prt::GlLightmapTextures any_lightmap() const;
    std::string defines_of(const Surface& surface) const;
    std::vector<glm::vec3> emission_of(Source source) const;
    const prt::TransferLayout* layout_shown(PictureKind kind) const;
    bool shows_suns(PictureKind kind) const;
    const prt::GlObject& program(const Surface& surface);
    const prt::GlObject& use(PictureKind kind, const GeometryPass& pass);
    const prt::GlVertexArrays& arrays(Source source) const;
    void draw_instances(PictureKind kind, const GeometryPass& pass);
    /// Returns the instances of a picture; null if it draws all vertices individually.
    GpuInstances* instances_of(PictureKind kind);

    std::shared_ptr<const Model> model_;
    std::size_t max_receivers_;
    prt::GlScene scene_;
    struct Plain {
        prt::GlVertexArrays arrays;
        std::optional<prt::GlObject> occlusion; ///< available after it is computed
    };
    Plain plain_;
    std::optional<prt::SunShadows> shadows_; ///< created with the first suns
    Lit lit_;
    std::optional<Raw> raw_;
    std::optional<Compressed> compressed_;
    std::optional<GpuInstances> instances_; ///< replaces `compressed_` for instances
    Numbers numbers_;
    Programs programs_;
    struct Measured {
        std::size_t drawn_triangles = 0;
        double seconds_constants = 0;
    };
    Measured measured_;
};

} // namespace viewer
