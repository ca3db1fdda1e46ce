// Reads normals of vertices from a buffer, because weights of transfer may use all attributes.

#include "shared_suns.h"

layout(std430, binding = PRT_BINDING_NORMALS) readonly buffer Normals {
    float vertex_normals[]; // [vertices][3]
};

vec3 normal_of_vertex() {
    int first = 3 * gl_VertexID;
    return vec3(vertex_normals[first], vertex_normals[first + 1], vertex_normals[first + 2]);
}
