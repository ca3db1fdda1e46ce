// Traversal of the wide, quantised bounding volume hierarchy (bake/gpu/wide_bvh.h).
//
// Define before including: PRT_STACK_SIZE, entries that the deepest path can need. Loops have one exit and no
// `continue`: Mesa's software rasteriser computes wrong results for those where threads diverge.

layout(std430, binding = PRT_BINDING_NODES) readonly buffer Nodes {
    uvec4 nodes[]; // five per node
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

uint byte_of(uint lower, uint upper, uint i) {
    return bitfieldExtract(i < 4u ? lower : upper, int(i & 3u) * 8, 8);
}

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

// The nearest hit in [t_min, infinity), or with `any` the first that is found.
bool trace_ray(vec3 origin, vec3 direction, float t_min, bool any, out BvhHit nearest) {
    vec3 safe = mix(direction, vec3(1e-20), lessThan(abs(direction), vec3(1e-20)));
    vec3 inverse = 1.0 / safe;
    uint octant = (safe.x < 0.0 ? 1u : 0u) | (safe.y < 0.0 ? 2u : 0u) | (safe.z < 0.0 ? 4u : 0u);
    nearest.triangle = 0u;
    nearest.slot = 0u;
    nearest.t = kFar;
    nearest.uv = vec2(0.0);
    nearest.back = false;
    bool found = false, running = true;

    // Entries: (node, distance), or with the upper bit a leaf: number of triangles << 29 | the first of them.
    uvec2 stack[PRT_STACK_SIZE];
    int height = 1;
    stack[0] = uvec2(0u, 0u);
    while (running) {
        --height;
        uvec2 entry = stack[height];
        bool wanted = uintBitsToFloat(entry.y) < nearest.t;
        if (wanted && (entry.x & 0x80000000u) != 0u) {
            uint first = entry.x & 0x1fffffffu, count = (entry.x >> 29) & 3u;
            for (uint i = 0u; i < count; ++i) {
                BvhHit hit;
                if (hit_triangle(first + i, origin, direction, t_min, nearest.t, hit)) {
                    nearest = hit;
                    found = true;
                }
            }
        } else if (wanted) {
            uvec4 n0 = nodes[5u * entry.x], n1 = nodes[5u * entry.x + 1u], n2 = nodes[5u * entry.x + 2u],
                  n3 = nodes[5u * entry.x + 3u], n4 = nodes[5u * entry.x + 4u];
            vec3 step = uintBitsToFloat(uvec3((n0.w & 255u) << 23, ((n0.w >> 8) & 255u) << 23, ((n0.w >> 16) & 255u) << 23));
            vec3 base = (uintBitsToFloat(n0.xyz) - origin) * inverse, scale = step * inverse;
            // What rounding can do to the planes below.
            vec3 slack = 3e-7 * (abs(base) + 256.0 * abs(scale));
            for (int k = 7; k >= 0; --k) {
                uint slot = uint(k) ^ octant;
                uint meta = byte_of(n1.z, n1.w, slot);
                vec3 low = base + scale * vec3(byte_of(n2.x, n2.y, slot), byte_of(n2.z, n2.w, slot),
                                               byte_of(n3.x, n3.y, slot));
                vec3 high = base + scale * vec3(byte_of(n3.z, n3.w, slot), byte_of(n4.x, n4.y, slot),
                                                byte_of(n4.z, n4.w, slot));
                vec3 enter = min(low, high) - slack, leave = max(low, high) + slack;
                float t_enter = max(max(enter.x, enter.y), max(enter.z, t_min));
                float t_leave = min(min(leave.x, leave.y), min(leave.z, nearest.t));
                if (meta != 0u && t_enter <= t_leave) {
                    uint child = (meta & 0x80u) != 0u
                                     ? n1.x + (meta & 7u)
                                     : 0x80000000u | (meta >> 5) << 29 | (n1.y + (meta & 31u));
                    stack[height] = uvec2(child, floatBitsToUint(max(t_enter, 0.0)));
                    ++height;
                }
            }
        }
        running = height > 0 && !(any && found);
    }
    return found;
}
