#include "pictures/gpu_instances.h"

#include "pictures/triangle_clusters.h"

#include "prt/instance_shader.h"
#include "prt/support/stopwatch.h"
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
    const glm::mat4 turned(glm::transpose(matrix));
    return {turned[0], turned[1], turned[2]};
}

/// Throws `Error` where weights leave no attributes to instances.
std::string lit_defines(const prt::ClusteredTransfer& transfer, const prt::GlTransfer& uploaded) {
    prt::instance_defines(transfer);
    return uploaded.defines() + "#define PRT_INSTANCES\n";
}

/// Round all that a node of `scene` draws, in its own frame.
prt::InstanceBox box_of(const prt::Scene& scene, const std::vector<std::size_t>& primitives) {
    std::vector<glm::vec3> positions;
    for (const std::size_t p : primitives) {
        const auto& of_array = scene.vertex_arrays[scene.primitives[p].vertices].positions;
        positions.insert(positions.end(), of_array.begin(), of_array.end());
    }
    return prt::box_round(positions);
}

/// What is drawn once, as an instance that nothing stands round.
prt::FormedInstance drawn_once(const prt::InstancedModel& model, const prt::InstanceBox& box,
                               const std::vector<std::size_t>& primitives) {
    prt::FormedInstance one{{prt::open_factors(), glm::dmat3(1), box}, {}};
    for (const std::size_t p : primitives) {
        const prt::VertexArray& vertices = model.stored.vertex_arrays[model.stored.primitives[p].vertices];
        one.rows = prt::joined(
            one.rows, prt::rows_of(model.compressed->transfer, vertices.first_receiver, vertices.size()));
    }
    return one;
}

glm::vec4 sphere_round(const prt::InstanceBox& box, const glm::dmat4& world) {
    const glm::vec3 middle(world * glm::dvec4(glm::dvec3(box.middle), 1));
    const double scale = glm::length(glm::dvec3(world[0]));
    return {middle, static_cast<float>(scale) * glm::length(box.half)};
}

} // namespace

GpuInstances::GpuInstances(std::shared_ptr<const prt::InstancedModel> model,
                           std::span<const prt::Texture> textures, const glm::dvec3& origin)
    : model_(std::move(model)), scene_(model_->stored, textures), transfer_(model_->compressed->transfer),
      former_(model_->compressed->transfer, add_groups(origin)), plain_(scene_.make_vertex_arrays()),
      lit_(scene_.make_vertex_arrays()), defines_(lit_defines(model_->compressed->transfer, transfer_)) {
    for (std::size_t i = 0; i < lit_.size(); ++i)
        transfer_.attach(lit_[i].name(), model_->stored.vertex_arrays[i].first_receiver);
    const std::vector<glm::vec4> table = former_.table();
    std::size_t next = 0;
    for (Group& group : groups_)
        for (Row& row : group.rows) {
            row.table = {table[next], table[next + 1]};
            next += 2;
        }
    instances_ = next / 2;
    constants_.formed.resize(former_.size());
    constants_.buffer = prt::make_buffer(std::span<const glm::vec4>(constants_.formed));
    rows_ = prt::make_buffer(std::span<const Row>(std::vector<Row>(instances_)));
    attach(plain_);
    attach(lit_);
}

/// Returns what constants are formed for, group by group.
std::vector<prt::FormedInstance> GpuInstances::add_groups(const glm::dvec3& origin) {
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
    const std::vector<prt::FormedInstance> formed = prt::formed_instances(*model_);
    std::vector<std::vector<std::size_t>> of_groups(groups_.size());
    for (std::size_t i = 0; i < model_->instances.size(); ++i)
        for (std::size_t g = 0; g < groups_.size(); ++g)
            if (stored.primitives[groups_[g].primitives.front()].vertices ==
                model_->instances[i].stored_arrays.front())
                of_groups[g].push_back(i);
    std::vector<prt::FormedInstance> result;
    const glm::dmat4 from_stored = glm::translate(glm::dmat4(1), stored.origin),
                     to_shown = glm::translate(glm::dmat4(1), -origin);
    for (std::size_t g = 0; g < groups_.size(); ++g) {
        Group& group = groups_[g];
        const auto add = [&](const prt::FormedInstance& one, const glm::dmat4& world) {
            const glm::dmat4 matrix = to_shown * world * from_stored;
            group.rows.push_back({rows_of(matrix), {}});
            group.spheres.push_back(sphere_round(one.placed.box, matrix));
            result.push_back(one);
        };
        for (const std::size_t i : of_groups[g])
            add(formed[i], model_->instances[i].world);
        if (of_groups[g].empty())
            add(drawn_once(*model_, box_of(stored, group.primitives), group.primitives), glm::dmat4(1));
    }
    return result;
}

void GpuInstances::attach(const prt::GlVertexArrays& arrays) const {
    constexpr GLuint kFirst = PRT_LOCATION_INSTANCE_X;
    static_assert(PRT_LOCATION_INSTANCE_1 == kFirst + 4);
    for (const prt::GlObject& array : arrays) {
        glVertexArrayBindingDivisor(array.name(), kRowBinding, 1);
        for (GLuint i = 0; i < 5; ++i) {
            glEnableVertexArrayAttrib(array.name(), kFirst + i);
            glVertexArrayAttribFormat(array.name(), kFirst + i, 4, GL_FLOAT, GL_FALSE,
                                      static_cast<GLuint>(i * sizeof(glm::vec4)));
            glVertexArrayAttribBinding(array.name(), kFirst + i, kRowBinding);
        }
    }
}

void GpuInstances::set_light(const prt::Lighting& lighting) {
    const prt::Stopwatch stopwatch;
    former_.form(lighting, constants_.formed);
    constants_.seconds = stopwatch.seconds();
    glNamedBufferSubData(constants_.buffer.name(), 0,
                         static_cast<GLsizeiptr>(constants_.formed.size() * sizeof(glm::vec4)),
                         constants_.formed.data());
}

InstanceFigures GpuInstances::figures() const {
    const std::size_t shared = model_->instances.size(), once = instances_ - shared;
    return {.instances = shared,
            .meshes = groups_.size() - once,
            .bytes_in_file = prt::kInstanceNumbers,
            .bytes_of_constants = static_cast<double>(constants_.formed.size() * sizeof(glm::vec4)) /
                                  static_cast<double>(instances_),
            .milliseconds_formed = 1e3 * constants_.seconds};
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
    const prt::GlVertexArrays& arrays = lit ? lit_ : plain_;
    if (lit) {
        transfer_.use();
        prt::bind_storage(PRT_BINDING_CONSTANTS, constants_.buffer);
    }
    std::size_t triangles = 0;
    for (const Group& group : groups_)
        for (const std::size_t p : group.primitives) {
            const prt::Primitive& primitive = model_->stored.primitives[p];
            if (group.count == 0 || scene_.is_blended(primitive) != blended)
                continue;
            glVertexArrayVertexBuffer(arrays[primitive.vertices].name(), kRowBinding, rows_.name(),
                                      static_cast<GLintptr>(group.first * sizeof(Row)), sizeof(Row));
            scene_.draw_instances(program, arrays, p, group.count);
            triangles += group.count * primitive.triangles.size();
        }
    return triangles;
}

} // namespace viewer
