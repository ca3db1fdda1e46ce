// Exit radiance of an unoccluded receiver of albedo 1 under the first three bands of a lighting: the method
// of games without precomputed transfer (Ramamoorthi and Hanrahan 2001).

uniform vec3 irradiance_sh[9]; // A_l / pi times the lighting's coefficients

vec3 unshadowed_radiance(vec3 n) {
    vec3 sum = 0.282094792 * irradiance_sh[0];
    sum += 0.488602512 * (-n.y * irradiance_sh[1] + n.z * irradiance_sh[2] - n.x * irradiance_sh[3]);
    sum += 1.092548431 * (n.x * n.y * irradiance_sh[4] - n.y * n.z * irradiance_sh[5] - n.x * n.z * irradiance_sh[7]);
    sum += 0.315391565 * (3.0 * n.z * n.z - 1.0) * irradiance_sh[6];
    sum += 0.546274215 * (n.x * n.x - n.y * n.y) * irradiance_sh[8];
    return max(sum, vec3(0.0));
}
