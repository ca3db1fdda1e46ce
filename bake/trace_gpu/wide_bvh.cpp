// Quantises the boxes of a hierarchy that Embree builds, and writes its nodes in the layout of the shader
// (Ylitie, Karras and Laine 2017).

#include "bake/trace_gpu/wide_bvh.h"

#include "prt/core/error.h"
#include "runtime/core/support/parallel.h"

#include <embree3/rtcore.h>
#include <glm/common.hpp>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <memory>
#include <string>

namespace prt {
namespace {

using gpu::WideNode;

constexpr unsigned kWidth = 8, kMaxLeafTriangles = 3;

struct Box {
    glm::vec3 low, high;
};

/// A node that Embree builds, with up to eight children, or a leaf with up to three triangles.
struct BuildNode {
    std::array<BuildNode*, kWidth> children{};
    std::array<Box, kWidth> boxes{};
    std::array<std::uint32_t, kMaxLeafTriangles> triangles{};
    unsigned child_count = 0, triangle_count = 0;
};

void* create_node(RTCThreadLocalAllocator allocator, unsigned, void*) {
    return new (rtcThreadLocalAlloc(allocator, sizeof(BuildNode), 16)) BuildNode;
}

void set_children(void* node, void** children, unsigned count, void*) {
    auto& n = *static_cast<BuildNode*>(node);
    n.child_count = count;
    for (unsigned i = 0; i < count; ++i)
        n.children[i] = static_cast<BuildNode*>(children[i]);
}

void set_bounds(void* node, const RTCBounds** bounds, unsigned count, void*) {
    auto& n = *static_cast<BuildNode*>(node);
    for (unsigned i = 0; i < count; ++i)
        n.boxes[i] = {{bounds[i]->lower_x, bounds[i]->lower_y, bounds[i]->lower_z},
                      {bounds[i]->upper_x, bounds[i]->upper_y, bounds[i]->upper_z}};
}

void* create_leaf(RTCThreadLocalAllocator allocator, const RTCBuildPrimitive* primitives, size_t count,
                  void*) {
    auto* n = new (rtcThreadLocalAlloc(allocator, sizeof(BuildNode), 16)) BuildNode;
    n->triangle_count = static_cast<unsigned>(count);
    for (size_t i = 0; i < count; ++i)
        n->triangles[i] = primitives[i].primID;
    return n;
}

/// Assigns children to slots so that each is in the slot of its octant as far as possible.
std::array<int, kWidth> octant_slots(const BuildNode& node, const glm::vec3& middle) {
    std::array<int, kWidth> slots;
    std::array<bool, kWidth> taken{};
    slots.fill(-1);
    struct Choice {
        float score;
        unsigned child, slot;
    };
    std::vector<Choice> choices;
    for (unsigned c = 0; c < node.child_count; ++c)
        for (unsigned s = 0; s < kWidth; ++s) {
            const glm::vec3 from_middle = 0.5f * (node.boxes[c].low + node.boxes[c].high) - middle;
            float score = 0;
            for (int axis = 0; axis < 3; ++axis)
                score += (s >> axis & 1 ? 1.0f : -1.0f) * from_middle[axis];
            choices.push_back({score, c, s});
        }
    std::stable_sort(choices.begin(), choices.end(),
                     [](const Choice& a, const Choice& b) { return a.score > b.score; });
    for (const Choice& choice : choices)
        if (slots[choice.child] < 0 && !taken[choice.slot]) {
            slots[choice.child] = static_cast<int>(choice.slot);
            taken[choice.slot] = true;
        }
    return slots;
}

/// Returns the smallest exponent for which a grid of 256 steps from `low` reaches `high`, in floats as in the
/// shader.
std::uint32_t grid_exponent(float low, float high) {
    int exponent = 1;
    if (high > low)
        exponent = std::clamp(std::ilogb((high - low) / 255) + 127, 1, 254);
    while (exponent < 254 && low + 255 * std::ldexp(1.0f, exponent - 127) < high)
        ++exponent;
    return static_cast<std::uint32_t>(exponent);
}

class Converter {
public:
    WideBvh convert(BuildNode* root) {
        BuildNode single; // a scene of one leaf still has a node
        if (root->child_count == 0) {
            single.child_count = 1;
            single.children[0] = root;
            single.boxes[0] = whole;
            root = &single;
        }
        bvh_.nodes.emplace_back();
        fill(0, *root, 1);
        return std::move(bvh_);
    }
    Box whole; ///< bounding box of all triangles

private:
    void fill(std::size_t index, const BuildNode& node, int depth) {
        bvh_.depth = std::max(bvh_.depth, depth);
        Box box = node.boxes[0];
        for (unsigned c = 1; c < node.child_count; ++c) {
            box.low = glm::min(box.low, node.boxes[c].low);
            box.high = glm::max(box.high, node.boxes[c].high);
        }
        WideNode wide{};
        wide.origin = box.low;
        for (int axis = 0; axis < 3; ++axis)
            wide.exponents |= grid_exponent(box.low[axis], box.high[axis]) << 8 * axis;
        wide.first_child = static_cast<std::uint32_t>(bvh_.nodes.size());
        wide.first_triangle = static_cast<std::uint32_t>(bvh_.triangles.size());
        const std::vector<const BuildNode*> inner = fill_slots(wide, node, 0.5f * (box.low + box.high));
        bvh_.nodes.resize(bvh_.nodes.size() + inner.size());
        bvh_.nodes[index] = wide;
        for (std::size_t i = 0; i < inner.size(); ++i)
            fill(wide.first_child + i, *inner[i], depth + 1);
    }

    /// Writes the children of `node` to the slots and appends the triangles of leaves. Returns the inner
    /// children.
    std::vector<const BuildNode*> fill_slots(WideNode& wide, const BuildNode& node, const glm::vec3& middle) {
        const std::array<int, kWidth> slots = octant_slots(node, middle);
        std::vector<const BuildNode*> inner;
        for (std::uint32_t slot = 0; slot < kWidth; ++slot)
            for (unsigned c = 0; c < node.child_count; ++c) {
                if (slots[c] != static_cast<int>(slot))
                    continue;
                const BuildNode& child = *node.children[c];
                quantise(wide, node.boxes[c], slot);
                if (child.child_count > 0) {
                    wide.meta = gpu::with_byte(wide.meta, slot,
                                               PRT_NODE_INNER(static_cast<std::uint32_t>(inner.size())));
                    inner.push_back(&child);
                    continue;
                }
                const auto first = static_cast<std::uint32_t>(bvh_.triangles.size()) - wide.first_triangle;
                wide.meta = gpu::with_byte(wide.meta, slot, PRT_NODE_LEAF(child.triangle_count, first));
                bvh_.triangles.insert(bvh_.triangles.end(), child.triangles.begin(),
                                      child.triangles.begin() + child.triangle_count);
            }
        return inner;
    }

    static void quantise(WideNode& wide, const Box& box, std::uint32_t slot) {
        for (std::uint32_t i = 0; i < 3; ++i) {
            const int axis = static_cast<int>(i);
            const float origin = wide.origin[axis],
                        step = std::bit_cast<float>(gpu::step_bits(wide.exponents, i));
            float low = std::clamp(std::floor((box.low[axis] - origin) / step), 0.0f, 255.0f);
            float high = std::clamp(std::ceil((box.high[axis] - origin) / step), 0.0f, 255.0f);
            while (low > 0 && origin + low * step > box.low[axis])
                --low;
            while (high < 255 && origin + high * step < box.high[axis])
                ++high;
            wide.low[i] = gpu::with_byte(wide.low[i], slot, static_cast<std::uint32_t>(low));
            wide.high[i] = gpu::with_byte(wide.high[i], slot, static_cast<std::uint32_t>(high));
        }
    }

    WideBvh bvh_;
};

} // namespace

WideBvh build_wide_bvh(const std::vector<glm::vec3>& positions, const std::vector<glm::uvec3>& corners,
                       int threads) {
    const auto release = [](RTCDevice d) { rtcReleaseDevice(d); };
    const std::unique_ptr<RTCDeviceTy, decltype(release)> device(
        rtcNewDevice(("threads=" + std::to_string(thread_count(threads))).c_str()), release);
    const auto release_bvh = [](RTCBVH b) { rtcReleaseBVH(b); };
    const std::unique_ptr<RTCBVHTy, decltype(release_bvh)> memory(rtcNewBVH(device.get()), release_bvh);
    std::vector<RTCBuildPrimitive> primitives(corners.size());
    Converter converter;
    converter.whole = {positions[corners[0].x], positions[corners[0].x]};
    for (std::uint32_t t = 0; t < corners.size(); ++t) {
        const glm::vec3 &a = positions[corners[t].x], &b = positions[corners[t].y],
                        &c = positions[corners[t].z];
        const glm::vec3 low = glm::min(a, glm::min(b, c)), high = glm::max(a, glm::max(b, c));
        primitives[t] = {low.x, low.y, low.z, 0, high.x, high.y, high.z, t};
        converter.whole = {glm::min(converter.whole.low, low), glm::max(converter.whole.high, high)};
    }
    RTCBuildArguments arguments = rtcDefaultBuildArguments();
    arguments.byteSize = sizeof arguments;
    arguments.buildQuality = RTC_BUILD_QUALITY_MEDIUM;
    arguments.maxBranchingFactor = kWidth;
    arguments.maxLeafSize = kMaxLeafTriangles;
    arguments.bvh = memory.get();
    arguments.primitives = primitives.data();
    arguments.primitiveCount = primitives.size();
    arguments.primitiveArrayCapacity = primitives.size();
    arguments.createNode = create_node;
    arguments.setNodeChildren = set_children;
    arguments.setNodeBounds = set_bounds;
    arguments.createLeaf = create_leaf;
    auto* root = static_cast<BuildNode*>(rtcBuildBVH(&arguments));
    if (!root)
        throw Error("there is not enough memory for the bounding volume hierarchy");
    return converter.convert(root);
}

} // namespace prt
