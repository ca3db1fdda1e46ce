// Rays by the device's own traversal, whose candidates are triangles that may not stop all light.

layout(binding = PRT_BINDING_NODES) uniform accelerationStructureEXT structure;
layout(constant_id = PRT_CONSTANT_OPAQUE) const uint kOpaque = 0u; // triangles, which come before the others

#define PRT_SLOT(query, committed)                                                                                     \
    (uint(rayQueryGetIntersectionPrimitiveIndexEXT(query, committed)) +                                                \
     (kAlpha && rayQueryGetIntersectionGeometryIndexEXT(query, committed) > 0 ? kOpaque : 0u))

// The nearest triangle in [t_min, t_max) that stops some light.
bool nearest(TracedRay ray, float t_min, float t_max, out RayHit hit) {
    rayQueryEXT query;
    rayQueryInitializeEXT(query, structure, kAlpha ? gl_RayFlagsNoneEXT : gl_RayFlagsOpaqueEXT, 0xff, ray.origin, t_min,
                          ray.direction, t_max);
    while (rayQueryProceedEXT(query))
        if (kAlpha) {
            uint slot = PRT_SLOT(query, false);
            if (covered_at(ray, slot, rayQueryGetIntersectionTEXT(query, false),
                           rayQueryGetIntersectionBarycentricsEXT(query, false)) > 0.0)
                rayQueryConfirmIntersectionEXT(query);
        }
    bool found = rayQueryGetIntersectionTypeEXT(query, true) != gl_RayQueryCommittedIntersectionNoneEXT;
    if (found) {
        hit.slot = PRT_SLOT(query, true);
        hit.t = rayQueryGetIntersectionTEXT(query, true);
        hit.uv = rayQueryGetIntersectionBarycentricsEXT(query, true);
        hit.facing = dot(area_vector(hit.slot), ray.direction);
        hit.covered = covered_at(ray, hit.slot, hit.t, hit.uv);
    }
    return found;
}

// Share of light that passes as far as t_max; less than `least` is nothing.
float transmittance(TracedRay ray, float t_max, float least) {
    float left = 1.0;
    rayQueryEXT query;
    rayQueryInitializeEXT(query, structure,
                          gl_RayFlagsTerminateOnFirstHitEXT | (kAlpha ? gl_RayFlagsNoneEXT : gl_RayFlagsOpaqueEXT),
                          0xff, ray.origin, 0.0, ray.direction, t_max);
    while (rayQueryProceedEXT(query))
        if (kAlpha) {
            left *= 1.0 - covered_at(ray, PRT_SLOT(query, false), rayQueryGetIntersectionTEXT(query, false),
                                     rayQueryGetIntersectionBarycentricsEXT(query, false));
            if (left < least)
                rayQueryConfirmIntersectionEXT(query);
        }
    return rayQueryGetIntersectionTypeEXT(query, true) != gl_RayQueryCommittedIntersectionNoneEXT ? 0.0 : left;
}
