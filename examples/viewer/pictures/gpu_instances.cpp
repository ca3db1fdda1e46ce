// Groups instances by mesh, selects the visible ones and draws them.

#include "pictures/gpu_instances.h"

#include "pictures/triangle_clusters.h"

#include "shared_layout.h"

#include <epoxy/gl.h>
#include <glm/geometric.hpp>
#include <glm/gtc/matrix_transform.hpp>
#include <glm/matrix.hpp>

#include <algorithm>
#include <numeric>

namespace viewer {
namespace {

constexpr GLuint kRowBinding = 10;

std::array<glm::vec4, 3> rows_of(const glm::dmat4& matrix) {
    const glm::mat4 rotated(glm::transpose(matrix));
    return {rotated[0], rotated[1], rotated[2]};
}

/// Returns the box around all primitives of a node of `scene`, in the node's space.
prt::InstanceBox box_of(const prt::Scene& scene, const std::vector<std::size_t>& primitives) {
    std::vector<glm::vec3> positions;
    for (const std::size_t p : primitives) {
        const auto& of_array = scene.vertex_arrays[scene.primitives[p].vertices].positions;
        positions.insert(positions.end(), of_array.begin(), of_array.end());
    }
    return prt::bounding_box(positions);
}

/// Returns a node that is drawn once, as an unoccluded instance.
prt::RelitInstance drawn_once(const prt::InstancedModel& model, const prt::InstanceBox& box,
                              const std::vector<std::size_t>& primitives) {
    prt::RelitInstance one{{prt::open_factors(), glm::dmat3(1), box}, {}};
    for (const std::size_t p : primitives) {
        const prt::VertexArray& vertices = model.stored.vertex_arrays[model.stored.primitives[p].vertices];
        one.rows = prt::joined(
            one.rows, prt::rows_of(model.compressed->transfer, vertices.first_receiver, vertices.size()));
    }
    return one;
}

std::vector<std::size_t> vertex_arrays_of(const prt::Scene& scene,
                                          const std::vector<std::size_t>& primitives) {
    std::vector<std::size_t> arrays;
    for (const std::size_t p : primitives)
        if (const std::size_t array = scene.primitives[p].vertices;
            std::ranges::find(arrays, array) == arrays.end())
            arrays.push_back(array);
    return arrays;
}

glm::vec4 sphere_round(const prt::InstanceBox& box, const glm::dmat4& world) {
    const glm::vec3 middle(world * glm::dvec4(glm::dvec3(box.middle), 1));
    const double scale = glm::length(glm::dvec3(world[0]));
    return {middle, static_cast<float>(scale) * glm::length(box.half)};
}

} // namespace

GpuInstances::GpuInstances(std::shared_ptr<const prt::InstancedModel> model,
                           std::span<const prt::Texture> textures, const glm::dvec3& origin)
    : model_(std::move(model)), scene_(model_->stored, textures), arrays_(scene_.make_vertex_arrays()) {
    const std::vector<prt::RelitInstance> computed = add_groups(origin);
    std::vector<MeshInstances> meshes;
    for (const Group& group : groups_)
        meshes.push_back({meshes.empty() ? 0 : meshes.back().first + meshes.back().count, group.rows.size(),
                          vertex_arrays_of(model_->stored, group.primitives)});
    instances_ = computed.size();
    radiance_.emplace(model_->compressed->transfer, scene_, computed, meshes);
    rows_ = prt::make_buffer(std::span<const Row>(std::vector<Row>(instances_)));
    attach(arrays_);
}

/// Returns the instances that need constants, group by group.
std::vector<prt::RelitInstance> GpuInstances::add_groups(const glm::dvec3& origin) {
    const prt::Scene& stored = model_->stored;
    for (std::size_t p = 0; p < stored.primitives.size(); ++p) {
        const int node = stored.primitives[p].node;
        auto group = std::ranges::find(groups_, node, &Group::node);
        if (group == groups_.end()) {
            group = groups_.emplace(group);
            group->node = node;
        }
        group->primitives.push_back(p);
    }
    const std::vector<prt::RelitInstance> computed = prt::relit_instances(*model_);
    std::vector<std::vector<std::size_t>> of_groups(groups_.size());
    for (std::size_t i = 0; i < model_->instances.size(); ++i)
        for (std::size_t g = 0; g < groups_.size(); ++g)
            if (stored.primitives[groups_[g].primitives.front()].vertices ==
                model_->instances[i].stored_arrays.front())
                of_groups[g].push_back(i);
    std::vector<prt::RelitInstance> result;
    const glm::dmat4 from_stored = glm::translate(glm::dmat4(1), stored.origin),
                     to_shown = glm::translate(glm::dmat4(1), -origin);
    for (std::size_t g = 0; g < groups_.size(); ++g) {
        Group& group = groups_[g];
        const auto add = [&](const prt::RelitInstance& one, const glm::dmat4& world) {
            const glm::dmat4 matrix = to_shown * world * from_stored;
            group.rows.push_back({rows_of(matrix), static_cast<std::uint32_t>(group.rows.size())});
            group.spheres.push_back(sphere_round(one.placed.box, matrix));
            result.push_back(one);
        };
        for (const std::size_t i : of_groups[g])
            add(computed[i], model_->instances[i].world);
        if (of_groups[g].empty())
            add(drawn_once(*model_, box_of(stored, group.primitives), group.primitives), glm::dmat4(1));
    }
    return result;
}

void GpuInstances::attach(const prt::GlVertexArrays& arrays) const {
    for (const prt::GlObject& array : arrays) {
        glVertexArrayBindingDivisor(array.name(), kRowBinding, 1);
        for (GLuint i = 0; i < 4; ++i) {
            const GLuint location = i < 3 ? PRT_LOCATION_INSTANCE_X + i : PRT_LOCATION_INSTANCE_0;
            glEnableVertexArrayAttrib(array.name(), location);
            glVertexArrayAttribBinding(array.name(), location, kRowBinding);
            if (i < 3)
                glVertexArrayAttribFormat(array.name(), location, 4, GL_FLOAT, GL_FALSE,
                                          static_cast<GLuint>(i * sizeof(glm::vec4)));
            else
                glVertexArrayAttribIFormat(array.name(), location, 1, GL_UNSIGNED_INT, offsetof(Row, number));
        }
    }
}

InstanceFigures GpuInstances::figures() const {
    const std::size_t shared = model_->instances.size(), once = instances_ - shared;
    const auto each = [this](std::size_t bytes) {
        return static_cast<double>(bytes) / static_cast<double>(instances_);
    };
    return {.instances = shared,
            .meshes = groups_.size() - once,
            .bytes_in_file = prt::kInstanceNumbers,
            .bytes_of_constants = each(radiance_->bytes_of_constants()),
            .bytes_of_radiance = each(radiance_->bytes()),
            .milliseconds_to_update = 1e3 * radiance_->seconds_to_update()};
}

void GpuInstances::look(const glm::mat4& view_projection, const glm::vec3& eye, bool culling) {
    const auto planes = frustum_planes(view_projection);
    std::vector<Row> chosen;
    for (Group& group : groups_) {
        std::vector<std::pair<float, std::size_t>> near_first;
        for (std::size_t i = 0; i < group.rows.size(); ++i) {
            const glm::vec3 middle(group.spheres[i]), half(group.spheres[i].w);
            if (!culling || may_be_visible(planes, {middle - half, middle + half}))
                near_first.emplace_back(glm::distance(eye, middle), i);
        }
        std::ranges::sort(near_first);
        group.first = chosen.size();
        group.count = near_first.size();
        for (const auto& [distance, i] : near_first)
            chosen.push_back(group.rows[i]);
    }
    glNamedBufferSubData(rows_.name(), 0, static_cast<GLsizeiptr>(chosen.size() * sizeof(Row)),
                         chosen.data());
}

std::size_t GpuInstances::draw(const prt::GlObject& program, bool lit, bool blended) const {
    std::size_t triangles = 0;
    for (std::size_t g = 0; g < groups_.size(); ++g)
        for (const std::size_t p : groups_[g].primitives) {
            const Group& group = groups_[g];
            const prt::Primitive& primitive = model_->stored.primitives[p];
            if (group.count == 0 || scene_.is_blended(primitive) != blended)
                continue;
            if (lit)
                radiance_->use(program, g, primitive.vertices);
            glVertexArrayVertexBuffer(arrays_[primitive.vertices].name(), kRowBinding, rows_.name(),
                                      static_cast<GLintptr>(group.first * sizeof(Row)), sizeof(Row));
            scene_.draw_instances(program, arrays_, p, group.count);
            triangles += group.count * primitive.triangles.size();
        }
    return triangles;
}

} // namespace viewer
