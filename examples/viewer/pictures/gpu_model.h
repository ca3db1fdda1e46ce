#pragma once

// A model on the GPU, with all that it can be lit by.

#include "pictures/contact_shadows.h"
#include "pictures/gpu_instances.h"
#include "pictures/gpu_lightmap.h"
#include "pictures/lamps.h"
#include "pictures/model.h"
#include "pictures/raw_transfer.h"
#include "pictures/settings.h"

#include "prt/gl_scene.h"
#include "prt/gl_transfer.h"
#include "prt/sun_shadows.h"

#include <array>
#include <map>
#include <memory>
#include <optional>
#include <variant>

namespace viewer {

/// What one drawing of the geometry needs beside the model.
struct GeometryPass {
    glm::mat4 view_projection{1};
    glm::vec3 eye{0};
    bool gbuffer = false;
    bool culling = true, textured = true, dithered = true;
    const OccluderPass* occluders = nullptr; ///< null: nothing moves near
};

class GpuModel {
public:
    /// `most_receivers`: of raw transfer that one dispatch takes, a multiple of 256.
    explicit GpuModel(std::shared_ptr<const Model> model, std::size_t most_receivers = 1u << 21);
    const Model& model() const { return *model_; }

    void set_raw(const prt::Transfer& transfer);
    void drop_raw() { raw_.reset(); }
    void set_compressed(const prt::ClusteredTransfer& transfer);
    /// The same of texels; a model has transfer of its vertices or of texels.
    void set_raw(std::shared_ptr<const prt::BakedLightmap> lightmap);
    void set_compressed(std::shared_ptr<const prt::CompressedLightmap> lightmap);
    /// Compressed transfer that instances share; then they are drawn as such, with and without it.
    void set_instanced(std::shared_ptr<const prt::InstancedModel> instanced);
    void set_occlusion(std::span<const float> occlusion);
    /// [receivers], or [texels of all maps] where the model has a lightmap.
    void set_numbers(PictureKind kind, std::span<const glm::vec3> colors);
    /// Of as many bands as the transfers have, and three at least. `suns` are shadowed at each pixel where
    /// the picture's transfer keeps direct light apart, and where it has none. `lamps`, by name, are those
    /// of each transfer, and what shines shows it; `lighting` needs none.
    void set_lighting(const prt::Lighting& lighting, std::span<const prt::SunDisc> suns,
                      const LampSettings& lamps = {});
    /// A sky alone: no lamp shines.
    void set_light(const prt::Light& light) { set_lighting({light}, {}, {.on = false}); }
    /// There are suns apart, but that picture's transfer keeps no direct light apart, and so is lit by sky
    /// and suns together. For pictures that `can_draw`.
    bool takes_suns_as_sky(PictureKind kind) const;
    bool can_draw(PictureKind kind) const;
    /// Seconds that the constants of the compressed transfer took, forming and uploading.
    double seconds_constants() const { return measured_.seconds_constants; }
    /// Null: none share transfer.
    const GpuInstances* instances() const { return instances_ ? &*instances_ : nullptr; }

    /// Draws shadow maps for what is seen, where `kind` needs them; before what is drawn of that.
    void draw_shadows(PictureKind kind, const prt::SunShadows::View& view) { draw_shadows(kind, view, {}); }
    /// The same with what moves, which is lit by suns whatever the picture.
    void draw_shadows(PictureKind kind, const prt::SunShadows::View& view,
                      const prt::SunShadows::Moving& moving);
    /// Binds the maps that were drawn last, where there are any.
    void use_shadows() const;
    void draw_opaque(PictureKind kind, const GeometryPass& pass);
    /// Always forward.
    void draw_blended(PictureKind kind, const GeometryPass& pass);
    /// Edges of all triangles.
    void draw_wires(const GeometryPass& pass, const glm::vec3& color);
    /// Borders of the lightmap's texels, where it has one; `samples` per pixel along each axis.
    void draw_texel_grid(const GeometryPass& pass, const glm::vec3& color, int samples);
    /// The first nine coefficients of exit radiance by normal: irradiance.glsl.
    const std::array<glm::vec3, 9>& irradiance() const { return lit_.irradiance; }
    std::size_t drawn_triangles() const { return measured_.drawn_triangles; } ///< of the last opaque drawing

private:
    enum class Source { normals, raw, compressed, numbers };
    static Source source_of(PictureKind kind);
    struct Surface { ///< that a program draws
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
    /// What all that is drawn is lit by.
    struct Lit {
        std::optional<prt::Lighting> lighting;
        std::array<glm::vec3, 9> irradiance{}; ///< of the sky
        std::vector<prt::SunDisc> suns;
        LampSettings lamps;
    };
    struct Numbers {
        std::map<PictureKind, prt::GlObject> colors;
        std::map<PictureKind, std::vector<prt::GlObject>> maps; ///< instead, of texels
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
    /// That knows the lamps of such a picture; null: none does.
    const prt::TransferLayout* layout_of(Source source) const;
    /// The lightmap that a picture looks up; without a layout where it looks up none.
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
    /// Null: a picture shows all vertices, one by one.
    GpuInstances* instances_of(PictureKind kind);

    std::shared_ptr<const Model> model_;
    std::size_t most_receivers_;
    prt::GlScene scene_;
    struct Plain {
        prt::GlVertexArrays arrays;
        std::optional<prt::GlObject> occlusion; ///< once it is found
    };
    Plain plain_;
    std::optional<prt::SunShadows> shadows_; ///< once there are suns
    Lit lit_;
    std::optional<Raw> raw_;
    std::optional<Compressed> compressed_;
    std::optional<GpuInstances> instances_; ///< with compressed transfer, instead
    Numbers numbers_;
    Programs programs_;
    struct Measured {
        std::size_t drawn_triangles = 0;
        double seconds_constants = 0;
    };
    Measured measured_;
};

} // namespace viewer
