// Traversal of the wide, quantised bounding volume hierarchy (bake/trace/gpu/wide_bvh.h).
//
// Define before including: PRT_STACK_SIZE, entries that the deepest path can need. Loops have one exit and no
// `continue`: Mesa's software rasteriser computes wrong results for those where threads diverge.

layout(std430, binding = PRT_BINDING_NODES) readonly buffer Nodes {
    WideNode nodes[];
};
layout(std430, binding = PRT_BINDING_CORNERS) readonly buffer Corners {
    vec4 corners[]; // three per triangle; w of the first: index of the triangle, as bits
};

struct BvhHit {
    uint triangle; // in the scene's order
    uint slot;     // in the order of `corners`
    float t;
    vec2 uv;
    bool back;
};

const float kFar = 3.402823e38;
const uint kLeaf = 0x80000000u;

// By Plücker coordinates about the origin: neighbours agree on the side of a shared edge, so that no ray passes
// between them.
bool hit_triangle(uint slot, vec3 origin, vec3 direction, float t_min, float t_max, out BvhHit hit) {
    precise vec3 a = corners[3u * slot].xyz - origin;
    precise vec3 b = corners[3u * slot + 1u].xyz - origin;
    precise vec3 c = corners[3u * slot + 2u].xyz - origin;
    precise vec3 ea = c - a, eb = a - b, ec = b - c;
    precise float u = dot(cross(ea, c + a), direction);
    precise float v = dot(cross(eb, a + b), direction);
    precise float w = dot(cross(ec, b + c), direction);
    bool inside = min(u, min(v, w)) >= 0.0 || max(u, max(v, w)) <= 0.0;
    vec3 normal = cross(ea, eb); // the same as cross(b - a, c - a): towards the front
    float facing = dot(normal, direction), sum = u + v + w;
    float t = dot(normal, a) / facing;
    hit.triangle = floatBitsToUint(corners[3u * slot].w);
    hit.slot = slot;
    hit.t = t;
    hit.uv = vec2(u, v) / sum;
    hit.back = facing > 0.0;
    return inside && facing != 0.0 && sum != 0.0 && t >= t_min && t < t_max;
}

// The next number above a distance: where a ray goes on behind what it met. GPUs may take smaller ones for 0.
float behind(float t) {
    return max(uintBitsToFloat(floatBitsToUint(abs(t)) + 1u), 1.17549435e-38);
}

// The nearest hit in [t_min, t_max), or with `any` the first that is found.
bool trace_ray(vec3 origin, vec3 direction, float t_min, float t_max, bool any, out BvhHit nearest) {
    vec3 safe = mix(direction, vec3(1e-20), lessThan(abs(direction), vec3(1e-20)));
    vec3 inverse = 1.0 / safe;
    uint octant = (safe.x < 0.0 ? 1u : 0u) | (safe.y < 0.0 ? 2u : 0u) | (safe.z < 0.0 ? 4u : 0u);
    nearest.triangle = 0u;
    nearest.slot = 0u;
    nearest.t = t_max;
    nearest.uv = vec2(0.0);
    nearest.back = false;
    bool found = false, running = true;

    // Entries: (node, distance), or with kLeaf a leaf: number of triangles << 29 | the first of them.
    uvec2 stack[PRT_STACK_SIZE];
    int height = 1;
    stack[0] = uvec2(0u, 0u);
    while (running) {
        --height;
        uvec2 entry = stack[height];
        bool wanted = uintBitsToFloat(entry.y) < nearest.t;
        if (wanted && (entry.x & kLeaf) != 0u) {
            uint first = entry.x & 0x1fffffffu, count = (entry.x >> 29) & 3u;
            for (uint i = 0u; i < count; ++i) {
                BvhHit hit;
                if (hit_triangle(first + i, origin, direction, t_min, nearest.t, hit)) {
                    nearest = hit;
                    found = true;
                }
            }
        } else if (wanted) {
            WideNode node = nodes[entry.x];
            vec3 step = uintBitsToFloat(
                uvec3(step_bits(node.exponents, 0u), step_bits(node.exponents, 1u), step_bits(node.exponents, 2u)));
            vec3 base = (node.origin - origin) * inverse, scale = step * inverse;
            // What rounding can do to the planes below.
            vec3 slack = 3e-7 * (abs(base) + 256.0 * abs(scale));
            for (int k = 7; k >= 0; --k) {
                uint slot = uint(k) ^ octant;
                uint meta = byte_of(node.meta, slot);
                vec3 low = base + scale * vec3(byte_of(node.low[0], slot), byte_of(node.low[1], slot),
                                               byte_of(node.low[2], slot));
                vec3 high = base + scale * vec3(byte_of(node.high[0], slot), byte_of(node.high[1], slot),
                                                byte_of(node.high[2], slot));
                vec3 enter = min(low, high) - slack, leave = max(low, high) + slack;
                float t_enter = max(max(enter.x, enter.y), max(enter.z, t_min));
                float t_leave = min(min(leave.x, leave.y), min(leave.z, nearest.t));
                if (meta != 0u && t_enter <= t_leave) {
                    uint child = PRT_IS_INNER(meta) ? node.first_child + PRT_INNER_CHILD(meta)
                                                    : kLeaf | PRT_LEAF_COUNT(meta) << 29 |
                                                          (node.first_triangle + PRT_LEAF_FIRST(meta));
                    stack[height] = uvec2(child, floatBitsToUint(max(t_enter, 0.0)));
                    ++height;
                }
            }
        }
        running = height > 0 && !(any && found);
    }
    return found;
}
