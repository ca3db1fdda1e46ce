// Traces rays through our own hierarchy (bake/trace_gpu/wide_bvh.h) like its authors: the stack contains
// groups of children of one node that the ray hits, one bit per child. Loops have one exit and no `continue`:
// Mesa's software rasteriser computes wrong results for them where threads diverge.

layout(constant_id = PRT_CONSTANT_STACK) const int kStack = 64; // number of groups: the levels of the hierarchy

layout(std430, binding = PRT_BINDING_NODES) readonly buffer Nodes {
    WideNode nodes[];
};

struct BvhHit {
    uint slot; // index in the order of `corners`
    float t;
    vec2 uv;
    float facing; // above 0: hit from behind
    float covered;
};

// Tests a triangle with Plücker coordinates about the origin: adjacent triangles agree on the side of a
// shared edge, so that no ray passes between them.
bool hit_triangle(TracedRay ray, uint slot, float t_min, float t_max, out BvhHit hit) {
    precise vec3 a = corners[3u * slot].xyz - ray.origin;
    precise vec3 b = corners[3u * slot + 1u].xyz - ray.origin;
    precise vec3 c = corners[3u * slot + 2u].xyz - ray.origin;
    precise vec3 ea = c - a, eb = a - b, ec = b - c;
    precise float u = dot(cross(ea, c + a), ray.direction);
    precise float v = dot(cross(eb, a + b), ray.direction);
    precise float w = dot(cross(ec, b + c), ray.direction);
    bool inside = min(u, min(v, w)) >= 0.0 || max(u, max(v, w)) <= 0.0;
    vec3 normal = cross(ea, eb); // equal to cross(b - a, c - a): towards the front
    float sum = u + v + w;
    hit.slot = slot;
    hit.facing = dot(normal, ray.direction);
    hit.t = dot(normal, a) / hit.facing;
    hit.uv = vec2(u, v) / sum;
    return inside && hit.facing != 0.0 && sum != 0.0 && hit.t >= t_min && hit.t < t_max;
}

// Returns the children of a node that a ray hits. x: one bit per triangle from first_triangle on. y: the
// upper eight bits have one bit per inner child that is hit, the highest one for the child to visit first;
// the lower bits mark slots with inner children.
uvec2 hit_children(WideNode node, TracedRay ray, vec3 inverse, uint last_slot, float t_min, float t_max) {
    vec3 step = uintBitsToFloat(
        uvec3(step_bits(node.exponents, 0u), step_bits(node.exponents, 1u), step_bits(node.exponents, 2u)));
    vec3 base = (node.origin - ray.origin) * inverse, scale = step * inverse;
    // Bounds the rounding of the planes below.
    vec3 slack = 3e-7 * (abs(base) + 256.0 * abs(scale));
    vec3 nearer = base - slack, farther = base + slack;
    bvec3 negative = lessThan(inverse, vec3(0.0));
    uvec2 hits = uvec2(0u);
    for (uint half_of = 0u; half_of < 2u; ++half_of) {
        bool second = half_of == 1u;
        uint meta = second ? node.meta.y : node.meta.x;
        uvec3 low = second ? uvec3(node.low[0].y, node.low[1].y, node.low[2].y)
                           : uvec3(node.low[0].x, node.low[1].x, node.low[2].x);
        uvec3 high = second ? uvec3(node.high[0].y, node.high[1].y, node.high[2].y)
                            : uvec3(node.high[0].x, node.high[1].x, node.high[2].x);
        uvec3 near = mix(low, high, negative), far = mix(high, low, negative);
        for (uint i = 0u; i < 4u; ++i) {
            uint shift = 8u * i, slot = 4u * half_of + i, child = meta >> shift & 255u;
            vec3 enter = nearer + scale * vec3(near >> shift & 255u),
                 leave = farther + scale * vec3(far >> shift & 255u);
            bool hit =
                max(max(enter.x, enter.y), max(enter.z, t_min)) <= min(min(leave.x, leave.y), min(leave.z, t_max));
            bool inner = PRT_IS_INNER(child);
            hits.x |= hit && !inner ? (1u << PRT_LEAF_COUNT(child)) - 1u << PRT_LEAF_FIRST(child) : 0u;
            hits.y |= inner ? (1u << slot) | (hit ? 1u << (24u + (slot ^ last_slot)) : 0u) : 0u;
        }
    }
    return hits;
}

// If `any`: multiplies `left` by the share of light that passes [t_min, t_max), and returns whether it is
// less than `least`. Otherwise returns whether there is a nearest triangle that stops some light.
bool trace_ray(TracedRay ray, float t_min, float t_max, bool any, float least, inout float left, out BvhHit nearest) {
    vec3 inverse = 1.0 / mix(ray.direction, vec3(1e-20), lessThan(abs(ray.direction), vec3(1e-20)));
    uint last_slot = (inverse.x < 0.0 ? 0u : 1u) | (inverse.y < 0.0 ? 0u : 2u) | (inverse.z < 0.0 ? 0u : 4u);
    nearest.t = t_max;
    bool found = false, running = true;
    uvec2 stack[kStack];
    int height = 0;
    uvec2 nodes_left = uvec2(0u, 1u << (24u + last_slot) | 1u); // first child and bits of hit_children: the root
    while (running) {
        uint position = uint(findMSB(nodes_left.y)), slot = position - 24u ^ last_slot;
        nodes_left.y &= ~(1u << position);
        WideNode node = nodes[nodes_left.x + uint(bitCount(nodes_left.y & (1u << slot) - 1u & 255u))];
        if (nodes_left.y >= 1u << 24) {
            stack[height] = nodes_left;
            ++height;
        }
        uvec2 hits = hit_children(node, ray, inverse, last_slot, t_min, nearest.t);
        nodes_left = uvec2(node.first_child, hits.y);
        while (hits.x != 0u) {
            uint i = uint(findLSB(hits.x));
            hits.x &= hits.x - 1u;
            BvhHit hit;
            if (hit_triangle(ray, node.first_triangle + i, t_min, nearest.t, hit)) {
                hit.covered = covered_at(ray, hit.slot, hit.t, hit.uv, ray.direction);
                left *= 1.0 - hit.covered;
                if (any ? left < least : hit.covered > 0.0) {
                    nearest = hit;
                    found = true;
                    hits.x = any ? 0u : hits.x;
                }
            }
        }
        cut_short = cut_short || hits.x != 0u;
        if (nodes_left.y < 1u << 24) {
            running = height > 0;
            if (running) {
                --height;
                nodes_left = stack[height];
            }
        }
        running = running && !(any && found);
    }
    cut_short = cut_short || running;
    return found;
}

// Finds the nearest triangle in [t_min, t_max) that stops some light.
bool nearest(TracedRay ray, float t_min, float t_max, out RayHit hit) {
    BvhHit met;
    float left = 1.0;
    bool found = trace_ray(ray, t_min, t_max, false, 0.0, left, met);
    if (found) {
        hit.triangle = floatBitsToUint(corners[3u * met.slot].w);
        hit.t = met.t;
        hit.uv = met.uv;
        hit.back = met.facing > 0.0;
        hit.covered = met.covered;
        hit.footprint = kTextured ? footprint_of(ray, met.slot, met.t, ray.direction) : 0.0;
    }
    return found;
}

// Share of light that passes up to t_max; less than `least` counts as zero.
float transmittance(TracedRay ray, float t_max, float least) {
    BvhHit hit;
    float left = 1.0;
    return trace_ray(ray, 0.0, t_max, true, least, left, hit) ? 0.0 : left;
}
