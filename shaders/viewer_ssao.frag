// Screen-space ambient occlusion: points about the pixel's place are held against the depth buffer (M. Mittring,
// "Finding Next Gen: CryEngine 2", SIGGRAPH 2007 course). With normals only those above the surface count, by their
// cosine (D. Filion and R. McNaughton, "StarCraft II: Effects and Techniques", SIGGRAPH 2008 course).

#include "viewer_gbuffer.glsl"

uniform mat4 view_projection, inverse_view_projection;
uniform vec3 eye, forward;
uniform float radius;    // metres
uniform float bias;      // of the radius
uniform float intensity; // exponent
uniform int pairs;       // of opposite points
uniform bool use_normals;

out float result;

vec3 place(vec2 uv, float depth) {
    vec4 p = inverse_view_projection * vec4(vec3(uv, depth) * 2.0 - 1.0, 1.0);
    return p.xyz / p.w;
}

// Point i of `pairs` in the ball, one of each opposite two: a spiral of equal areas, radii of equal volumes.
vec3 kernel(int i) {
    float share = (float(i) + 0.5) / float(pairs);
    float z = share, angle = 2.39996323 * float(i);
    float shell = fract(0.7548776662 * float(i) + 0.5);
    return vec3(sqrt(1.0 - z * z) * vec2(cos(angle), sin(angle)), z) * pow(shell, 1.0 / 3.0);
}

// 1 where the point is hidden behind something near it.
float hidden(vec3 point, float center_depth) {
    vec4 clip = view_projection * vec4(point, 1.0);
    vec2 uv = clip.xy / clip.w * 0.5 + 0.5;
    bool inside = clip.w > 0.0 && all(greaterThanEqual(uv, vec2(0.0))) && all(lessThan(uv, vec2(1.0)));
    ivec2 size = textureSize(gbuffer_depth, 0);
    vec2 at = inside ? uv : vec2(0.5);
    float depth = texelFetch(gbuffer_depth, ivec2(at * vec2(size)), 0).r;
    float surface = dot(place(at, depth) - eye, forward);
    float behind = dot(point - eye, forward) - surface;
    // What lies far in front hides nothing: it would make haloes.
    float near = smoothstep(0.0, 1.0, radius / max(abs(center_depth - surface), 1e-6 * radius));
    return inside && depth < 1.0 && behind > bias * radius ? near : 0.0;
}

void main() {
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    vec2 size = vec2(textureSize(gbuffer_depth, 0));
    float depth = texelFetch(gbuffer_depth, pixel, 0).r;
    if (depth == 1.0) {
        result = 1.0;
        return;
    }
    vec3 p = place((vec2(pixel) + 0.5) / size, depth);
    float center_depth = dot(p - eye, forward);
    vec3 n = gbuffer_normal_at(pixel);
    // A mirror of the kernel for each pixel of 4 x 4, which the blur averages.
    int tile = (pixel.x & 3) + 4 * (pixel.y & 3);
    float mirror_z = (float((tile * 7) & 15) + 0.5) / 8.0 - 1.0, mirror_angle = 2.39996323 * float(tile);
    vec3 mirror = vec3(sqrt(1.0 - mirror_z * mirror_z) * vec2(cos(mirror_angle), sin(mirror_angle)), mirror_z);
    float blocked = 0.0, all_weights = 0.0;
    for (int i = 0; i < pairs; ++i) {
        vec3 offset = reflect(kernel(i), mirror) * radius;
        if (use_normals) {
            float cosine = dot(normalize(offset), n);
            vec3 above = cosine >= 0.0 ? offset : -offset;
            blocked += abs(cosine) * hidden(p + above, center_depth);
            all_weights += abs(cosine);
        } else {
            blocked += 0.5 * (hidden(p + offset, center_depth) + hidden(p - offset, center_depth));
            all_weights += 1.0;
        }
    }
    float visible = 1.0 - blocked / all_weights;
    // Half of the ball lies below a plane: an open plane counts as open.
    if (!use_normals)
        visible = min(1.0, 2.0 * visible);
    result = pow(clamp(visible, 0.0, 1.0), intensity);
}
