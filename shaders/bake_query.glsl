// Traces rays with ray queries of the device; candidates are triangles that may not stop all light.

layout(binding = PRT_BINDING_NODES) uniform accelerationStructureEXT structure;
layout(constant_id = PRT_CONSTANT_OPAQUE) const uint kOpaque = 0u; // number of opaque triangles, which come first

layout(std430, binding = PRT_BINDING_INSTANCES) readonly buffer Instances {
    uvec2 instances[]; // first slot, and the offset of its triangle indices from those in `corners`
};

#define PRT_INSTANCE(query, committed) instances[rayQueryGetIntersectionInstanceIdEXT(query, committed)]
// In instances that have both, opaque triangles come before the others.
#define PRT_SLOT(query, committed)                                                                                     \
    (PRT_INSTANCE(query, committed).x + uint(rayQueryGetIntersectionPrimitiveIndexEXT(query, committed)) +             \
     (kAlpha && rayQueryGetIntersectionGeometryIndexEXT(query, committed) > 0 ? kOpaque : 0u))
// Share of light that the triangle stops.
#define PRT_COVERED(query, committed)                                                                                  \
    covered_at(ray, PRT_SLOT(query, committed), rayQueryGetIntersectionTEXT(query, committed),                         \
               rayQueryGetIntersectionBarycentricsEXT(query, committed),                                               \
               rayQueryGetIntersectionObjectRayDirectionEXT(query, committed))

// Finds the nearest triangle in [t_min, t_max) that stops some light.
bool nearest(TracedRay ray, float t_min, float t_max, out RayHit hit) {
    rayQueryEXT query;
    rayQueryInitializeEXT(query, structure, kAlpha ? gl_RayFlagsNoneEXT : gl_RayFlagsOpaqueEXT, 0xff, ray.origin, t_min,
                          ray.direction, t_max);
    while (rayQueryProceedEXT(query))
        if (kAlpha && PRT_COVERED(query, false) > 0.0)
            rayQueryConfirmIntersectionEXT(query);
    bool found = rayQueryGetIntersectionTypeEXT(query, true) != gl_RayQueryCommittedIntersectionNoneEXT;
    if (found) {
        uint slot = PRT_SLOT(query, true);
        vec3 direction = rayQueryGetIntersectionObjectRayDirectionEXT(query, true);
        hit.triangle = floatBitsToUint(corners[3u * slot].w) + PRT_INSTANCE(query, true).y;
        hit.t = rayQueryGetIntersectionTEXT(query, true);
        hit.uv = rayQueryGetIntersectionBarycentricsEXT(query, true);
        hit.back = dot(area_vector(slot), direction) > 0.0;
        hit.covered = PRT_COVERED(query, true);
        hit.footprint = kTextured ? footprint_of(ray, slot, hit.t, direction) : 0.0;
    }
    return found;
}

// Share of light that passes up to t_max; less than `least` counts as zero.
float transmittance(TracedRay ray, float t_max, float least) {
    float left = 1.0;
    rayQueryEXT query;
    rayQueryInitializeEXT(query, structure,
                          gl_RayFlagsTerminateOnFirstHitEXT | (kAlpha ? gl_RayFlagsNoneEXT : gl_RayFlagsOpaqueEXT),
                          0xff, ray.origin, 0.0, ray.direction, t_max);
    while (rayQueryProceedEXT(query))
        if (kAlpha) {
            left *= 1.0 - PRT_COVERED(query, false);
            if (left < least)
                rayQueryConfirmIntersectionEXT(query);
        }
    return rayQueryGetIntersectionTypeEXT(query, true) != gl_RayQueryCommittedIntersectionNoneEXT ? 0.0 : left;
}
