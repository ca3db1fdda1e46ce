/* The C interface, from C: c_test shipped.glb sky.exr */

#include "prt/prt.h"

#include <limits.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static int failures = 0;

static void expect(int condition, const char* what, int line) {
    if (!condition) {
        fprintf(stderr, "line %d: %s\n", line, what);
        ++failures;
    }
}
#define EXPECT(condition) expect((condition), #condition, __LINE__)

static void* contents(const char* path, size_t* size) {
    FILE* file = fopen(path, "rb");
    if (!file)
        exit(2);
    fseek(file, 0, SEEK_END);
    *size = (size_t)ftell(file);
    rewind(file);
    void* bytes = malloc(*size);
    if (fread(bytes, 1, *size, file) != *size)
        exit(2);
    fclose(file);
    return bytes;
}

static void test_sh(void) {
    float basis[9], product[9], rotated[9];
    const float up[3] = {0, 0, 1};
    prt_message message;
    EXPECT(prt_sh_evaluate(3, up, basis, &message) == PRT_OK);
    EXPECT(fabsf(basis[0] - 0.2820948f) < 1e-6f && fabsf(basis[2] - 0.4886025f) < 1e-6f);
    EXPECT(message.text[0] == 0);
    const float one[9] = {3.5449077f};
    EXPECT(prt_sh_multiply(3, basis, one, product, NULL) == PRT_OK);
    for (int i = 0; i < 9; ++i)
        EXPECT(fabsf(product[i] - basis[i]) < 1e-5f);
    const float quarter_about_y[9] = {0, 0, -1, 0, 1, 0, 1, 0, 0}; /* z goes to x */
    const float x[3] = {1, 0, 0};
    float at_x[9];
    EXPECT(prt_sh_rotate(3, quarter_about_y, basis, rotated, NULL) == PRT_OK);
    prt_sh_evaluate(3, x, at_x, NULL);
    for (int i = 0; i < 9; ++i)
        EXPECT(fabsf(rotated[i] - at_x[i]) < 1e-6f);
    const float mirror[9] = {-1, 0, 0, 0, 1, 0, 0, 0, 1};
    EXPECT(prt_sh_rotate(3, mirror, basis, rotated, &message) == PRT_BAD_ARGUMENT);
    EXPECT(strstr(message.text, "mirror") != NULL);
    const float no_directions[3][3] = {{0, 0, 0}, {NAN, 0, 1}, {0, INFINITY, 0}};
    for (int i = 0; i < 3; ++i)
        EXPECT(prt_sh_evaluate(3, no_directions[i], basis, &message) == PRT_BAD_ARGUMENT);
    EXPECT(strstr(message.text, "direction") != NULL);
    EXPECT(prt_sh_evaluate(11, up, basis, &message) == PRT_BAD_ARGUMENT);
    EXPECT(prt_sh_evaluate(3, NULL, basis, NULL) == PRT_BAD_ARGUMENT);
}

static void test_lights(void) {
    float light[27], other[27];
    const float white[3] = {1, 1, 1}, up[3] = {0, 1, 0}, down[3] = {0, -1, 0}, far_up[3] = {0, 4, 0},
                none[3] = {0, 0, 0};
    prt_message message;
    EXPECT(prt_light_constant(3, white, light, NULL) == PRT_OK);
    EXPECT(fabsf(light[0] - 3.5449077f) < 1e-5f);
    EXPECT(prt_light_directional(3, up, white, light, NULL) == PRT_OK);
    EXPECT(prt_light_hemisphere(3, up, white, none, light, NULL) == PRT_OK);
    EXPECT(prt_light_cone(3, up, 0.5f, white, light, NULL) == PRT_OK);
    EXPECT(prt_light_sphere(3, far_up, 4 * sinf(0.5f), white, other, NULL) == PRT_OK);
    for (int i = 0; i < 27; ++i)
        EXPECT(fabsf(light[i] - other[i]) < 1e-5f);
    EXPECT(prt_light_disc(3, far_up, down, 4 * tanf(0.5f), white, other, NULL) == PRT_OK);
    for (int i = 0; i < 27; ++i)
        EXPECT(fabsf(light[i] - other[i]) < 1e-5f);
    const float half_about_x[9] = {1, 0, 0, 0, -1, 0, 0, 0, -1};
    EXPECT(prt_light_rotate(3, half_about_x, other, NULL) == PRT_OK);
    prt_light_cone(3, down, 0.5f, white, light, NULL);
    for (int i = 0; i < 27; ++i)
        EXPECT(fabsf(light[i] - other[i]) < 1e-5f);
    EXPECT(prt_light_dering(3, light, NULL) == PRT_OK);
    EXPECT(prt_light_sphere(3, up, 2, white, light, &message) == PRT_BAD_ARGUMENT);
    EXPECT(strstr(message.text, "inside") != NULL);
    EXPECT(prt_light_directional(3, none, white, light, &message) == PRT_BAD_ARGUMENT);
    float pixels[6] = {1, 1, 1, 1, 1, 1};
    const prt_image image = {2, 1, pixels}, empty = {0, 1, pixels};
    EXPECT(prt_light_from_lat_long(3, &image, PRT_CENTER_Z, 1, light, NULL) == PRT_OK);
    EXPECT(fabsf(light[0] - 3.5449077f) < 1e-5f);
    EXPECT(prt_light_from_lat_long(3, &image, 7, 1, light, &message) == PRT_BAD_ARGUMENT);
    for (int i = 0; i < 3; ++i)
        pixels[i] = 0; /* the left half */
    EXPECT(prt_light_from_lat_long(3, &image, PRT_CENTER_Z, 1, light, NULL) == PRT_OK);
    EXPECT(prt_light_from_lat_long(3, &image, PRT_CENTER_X, 1, other, NULL) == PRT_OK);
    EXPECT(light[9] > 0.5f && fabsf(light[6]) < 1e-5f); /* from -X, which is a positive coefficient */
    EXPECT(other[6] > 0.5f && fabsf(other[9]) < 1e-5f); /* from +Z */
    const float angles[4] = {NAN, -1, 4, 90};
    for (int i = 0; i < 4; ++i)
        EXPECT(prt_light_cone(3, up, angles[i], white, light, &message) == PRT_BAD_ARGUMENT);
    const float no_rotation[9] = {NAN, 0, 0, 0, 1, 0, 0, 0, 1};
    EXPECT(prt_light_rotate(3, no_rotation, light, &message) == PRT_BAD_ARGUMENT);
    pixels[4] = NAN;
    EXPECT(prt_light_from_lat_long(3, &image, PRT_CENTER_Z, 1, light, &message) == PRT_BAD_ARGUMENT);
    EXPECT(strstr(message.text, "--") == NULL); /* options of a program that is not there */
    EXPECT(prt_light_from_lat_long(3, &empty, PRT_CENTER_Z, 1, light, &message) == PRT_BAD_ARGUMENT);
    EXPECT(prt_light_from_file(3, "no such file.exr", PRT_CENTER_Z, light, &message) == PRT_BAD_FILE);
    EXPECT(strstr(message.text, "no such file.exr") != NULL);
}

/* A sky of radiance 0.5, red, and two suns: a point at the zenith, and a hemisphere, which is a light of its
 * own. */
static void test_light_files(void) {
    const char* path = "c_test_light.json";
    FILE* file = fopen(path, "w");
    if (!file)
        exit(2);
    fputs("{\"prtkit_light\": 1, \"order\": 2, \"coefficients\": {\"red\": [1.7724539, 0, 0, 0], "
          "\"green\": [0, 0, 0, 0], \"blue\": [0, 0, 0, 0]}, \"suns\": ["
          "{\"towards\": [0, 2, 0], \"irradiance\": [3, 2, 1], \"half_angle_radians\": 0}, "
          "{\"towards\": [0, 0, 1], \"irradiance\": [3.1415927, 0, 0], \"half_angle_radians\": 1.5707963}]}",
          file);
    fclose(file);
    float sky[12], light[12], other[12], half[12];
    prt_sun suns[2];
    prt_message message;
    size_t count = 0;
    EXPECT(prt_light_from_light_file(2, path, sky, NULL, &count, &message) == PRT_TOO_SMALL);
    EXPECT(count == 2);
    EXPECT(prt_light_from_light_file(2, path, sky, suns, &count, &message) == PRT_OK);
    EXPECT(count == 2 && fabsf(sky[0] - 1.7724539f) < 1e-6f && sky[1] == 0 && sky[3] == 0);
    EXPECT(suns[0].towards[1] == 1 && suns[0].irradiance[2] == 1 && suns[0].half_angle == 0);
    const float up[3] = {0, 1, 0}, z[3] = {0, 0, 1}, colors[3] = {3, 2, 1}, red[3] = {1, 0, 0};
    EXPECT(prt_light_suns(2, suns, 1, light, NULL) == PRT_OK);
    EXPECT(prt_light_directional(2, up, colors, other, NULL) == PRT_OK);
    for (int i = 0; i < 12; ++i)
        EXPECT(fabsf(light[i] - other[i]) < 1e-5f);
    EXPECT(prt_light_suns(2, suns, 2, light, NULL) == PRT_OK); /* a hemisphere of radiance 1 gives pi */
    EXPECT(prt_light_cone(2, z, 1.5707963f, red, half, NULL) == PRT_OK);
    for (int i = 0; i < 12; ++i)
        EXPECT(fabsf(light[i] - other[i] - half[i]) < 1e-5f);
    EXPECT(prt_light_suns(2, NULL, 0, light, NULL) == PRT_OK && light[0] == 0);
    EXPECT(prt_light_suns(2, NULL, 1, light, &message) == PRT_BAD_ARGUMENT);
    suns[0].towards[1] = 0;
    EXPECT(prt_light_suns(2, suns, 1, light, &message) == PRT_BAD_ARGUMENT);
    EXPECT(strstr(message.text, "direction") != NULL);
    count = 2;
    EXPECT(prt_light_from_light_file(3, path, sky, suns, &count, &message) == PRT_BAD_FILE);
    EXPECT(strstr(message.text, "order 3 is needed") != NULL);
    EXPECT(prt_light_from_light_file(2, "no such light.json", sky, suns, &count, &message) == PRT_BAD_FILE);
    EXPECT(prt_light_from_light_file(11, path, sky, suns, &count, &message) == PRT_BAD_ARGUMENT);
    remove(path);
}

static void test_light_that_is_not_finite(void) {
    float light[27];
    const float white[3] = {1, 1, 1}, up[3] = {0, 1, 0}, down[3] = {0, -1, 0}, far_up[3] = {0, 4, 0};
    const float bad[2][3] = {{1, NAN, 1}, {INFINITY, 1, 1}};
    prt_message message;
    for (int i = 0; i < 2; ++i) {
        EXPECT(prt_light_constant(3, bad[i], light, &message) == PRT_BAD_ARGUMENT);
        EXPECT(strstr(message.text, "finite") != NULL);
        EXPECT(prt_light_directional(3, up, bad[i], light, NULL) == PRT_BAD_ARGUMENT);
        EXPECT(prt_light_cone(3, up, 0.5f, bad[i], light, NULL) == PRT_BAD_ARGUMENT);
        EXPECT(prt_light_sphere(3, far_up, 1, bad[i], light, NULL) == PRT_BAD_ARGUMENT);
        EXPECT(prt_light_disc(3, far_up, down, 1, bad[i], light, NULL) == PRT_BAD_ARGUMENT);
        EXPECT(prt_light_hemisphere(3, up, bad[i], white, light, NULL) == PRT_BAD_ARGUMENT);
        EXPECT(prt_light_hemisphere(3, up, white, bad[i], light, NULL) == PRT_BAD_ARGUMENT);
        prt_light_constant(3, white, light, NULL);
        light[26] = bad[i][1 - i];
        EXPECT(prt_light_dering(3, light, &message) == PRT_BAD_ARGUMENT);
        EXPECT(strstr(message.text, "finite") != NULL);
    }
    const prt_image huge = {INT_MAX, INT_MAX, white};
    EXPECT(prt_light_from_lat_long(6, &huge, PRT_CENTER_Z, 1, light, &message) == PRT_BAD_ARGUMENT);
    EXPECT(strstr(message.text, "2147483647 x 2147483647") != NULL);
}

static void test_sky(const char* path) {
    float light[27];
    EXPECT(prt_light_from_file(3, path, PRT_CENTER_Z, light, NULL) == PRT_OK);
    EXPECT(light[0] > 0 && light[2] > light[0]); /* day: blue above red */
}

static prt_model* load(const char* path) {
    prt_message message;
    prt_model* model = NULL;
    EXPECT(prt_model_load("no such file.glb", &model, &message) == PRT_BAD_FILE);
    EXPECT(model == NULL && message.text[0] != 0);
    EXPECT(prt_model_load_memory("glTF", 4, &model, &message) == PRT_BAD_FILE);
    EXPECT(model == NULL);
    if (prt_model_load(path, &model, &message) != PRT_OK) {
        fprintf(stderr, "%s\n", message.text);
        exit(2);
    }
    return model;
}

static void test_loading(const prt_model* model, const char* path) {
    prt_message message;
    size_t size = 0;
    void* bytes = contents(path, &size);
    prt_model* again = NULL;
    EXPECT(prt_model_load_memory(bytes, size, &again, &message) == PRT_OK);
    free(bytes);
    prt_model_info info, info_again;
    EXPECT(prt_model_get_info(model, &info, NULL) == PRT_OK &&
           prt_model_get_info(again, &info_again, NULL) == PRT_OK);
    EXPECT(info.receivers == info_again.receivers && info.rows == info_again.rows);
    EXPECT(memcmp(info.weights, info_again.weights, info.receivers * info.stride) == 0);
    EXPECT(prt_model_get_info(NULL, &info_again, &message) == PRT_BAD_ARGUMENT);
    prt_model_destroy(again);
    prt_model_destroy(NULL);
}

static void test_meshes(const prt_model* model, const prt_model_info* info) {
    size_t vertices = 0;
    for (size_t m = 0; m < info->meshes; ++m) {
        prt_mesh mesh;
        EXPECT(prt_model_get_mesh(model, m, &mesh, NULL) == PRT_OK);
        EXPECT(mesh.first_receiver + mesh.vertices <= info->receivers);
        for (size_t i = 0; i < mesh.indices; ++i)
            EXPECT(mesh.index[i] < mesh.vertices);
        vertices += mesh.vertices;
    }
    EXPECT(vertices >= info->receivers);
    prt_mesh none;
    prt_message message;
    EXPECT(prt_model_get_mesh(model, info->meshes, &none, &message) == PRT_BAD_ARGUMENT);
}

/* Under white light an open scene is about as bright as it is open: between 0 and 1. */
static void test_relighting(const prt_model* model, const prt_model_info* info) {
    const float white[3] = {1, 1, 1};
    float* light = malloc(3 * sizeof(float) * (size_t)(info->order * info->order));
    float* constants = malloc(4 * sizeof(float) * info->rows);
    float* radiance = malloc(3 * sizeof(float) * info->receivers);
    EXPECT(prt_light_constant(info->order, white, light, NULL) == PRT_OK);
    EXPECT(prt_model_update_constants(model, info->order, light, constants, NULL) == PRT_OK);
    EXPECT(prt_model_evaluate(model, constants, radiance, NULL) == PRT_OK);
    double mean = 0;
    for (size_t p = 0; p < info->receivers; ++p)
        mean += radiance[3 * p] / (double)info->receivers;
    EXPECT(mean > 0.1 && mean < 1.1);
    prt_message message;
    EXPECT(prt_model_update_constants(model, info->order - 1, light, constants, &message) ==
           PRT_BAD_ARGUMENT);
    free(radiance);
    free(constants);
    free(light);
}

/* A bake without bounces is lit by the sky alone: its suns are the renderer's. */
static void test_separate_suns(const prt_model* model, const prt_model_info* info) {
    const float white[3] = {1, 1, 1}, up[3] = {0, 1, 0};
    const size_t count = 3 * (size_t)(info->order * info->order);
    float* sky = malloc(count * sizeof(float));
    float* sun = malloc(count * sizeof(float));
    float* constants = malloc(4 * sizeof(float) * info->rows);
    float* separate = malloc(4 * sizeof(float) * info->rows);
    EXPECT(info->has_direct_term == 1);
    EXPECT(prt_light_constant(info->order, white, sky, NULL) == PRT_OK);
    EXPECT(prt_light_directional(info->order, up, white, sun, NULL) == PRT_OK);
    EXPECT(prt_model_update_constants(model, info->order, sky, constants, NULL) == PRT_OK);
    EXPECT(prt_model_update_constants_separate(model, info->order, sky, sun, NULL, separate, NULL) == PRT_OK);
    EXPECT(memcmp(constants, separate, 4 * sizeof(float) * info->rows) == 0);
    EXPECT(prt_model_update_constants_separate(model, info->order, sky, NULL, NULL, separate, NULL) ==
           PRT_OK);
    EXPECT(memcmp(constants, separate, 4 * sizeof(float) * info->rows) == 0);
    sun[0] = INFINITY;
    prt_message message;
    EXPECT(prt_model_update_constants_separate(model, info->order, sky, sun, NULL, separate, &message) ==
           PRT_BAD_ARGUMENT);
    EXPECT(prt_model_update_constants_separate(model, info->order, NULL, sky, NULL, separate, &message) ==
           PRT_BAD_ARGUMENT);
    free(separate);
    free(constants);
    free(sun);
    free(sky);
}

/* A model without lamps has no names of any. */
static void test_lamps(const prt_model* model) {
    const char* name = NULL;
    size_t lamps = 1;
    prt_message message;
    EXPECT(prt_model_count_lamps(model, &lamps, NULL) == PRT_OK && lamps == 0);
    EXPECT(prt_model_lamp_name(model, 0, &name, &message) == PRT_BAD_ARGUMENT);
    EXPECT(prt_model_lamp_name(NULL, 0, &name, &message) == PRT_BAD_ARGUMENT);
}

static void test_shader(const prt_model* model) {
    prt_message message;
    size_t size = 0;
    EXPECT(prt_model_shader(model, PRT_ESSL300, PRT_CONSTANTS_IN_TEXTURE, NULL, &size, &message) ==
           PRT_TOO_SMALL);
    char* source = malloc(size);
    EXPECT(prt_model_shader(model, PRT_ESSL300, PRT_CONSTANTS_IN_TEXTURE, source, &size, &message) == PRT_OK);
    EXPECT(strncmp(source, "#version 300 es", 15) == 0 && strlen(source) + 1 == size);
    EXPECT(prt_model_shader(model, 77, PRT_CONSTANTS_IN_BUFFER, source, &size, &message) == PRT_BAD_ARGUMENT);
    EXPECT(prt_model_shader(model, PRT_GLSL450, -1, source, &size, &message) == PRT_BAD_ARGUMENT);
    EXPECT(prt_model_shader(model, PRT_GLSL330, PRT_CONSTANTS_IN_BUFFER, source, &size, &message) ==
           PRT_BAD_ARGUMENT);
    free(source);
}

static void test_model(const char* path) {
    prt_model* model = load(path);
    prt_model_info info;
    EXPECT(prt_model_get_info(model, &info, NULL) == PRT_OK);
    test_loading(model, path);
    test_meshes(model, &info);
    test_relighting(model, &info);
    test_separate_suns(model, &info);
    test_lamps(model);
    test_shader(model);
    prt_model_destroy(model);
}

int main(int argc, char** argv) {
    if (argc != 3)
        return 2;
    test_sh();
    test_lights();
    test_light_files();
    test_light_that_is_not_finite();
    test_model(argv[1]);
    test_sky(argv[2]);
    if (failures == 0)
        puts("the C interface does what its header says");
    return failures == 0 ? 0 : 1;
}
