/* The shared library is loaded, used and unloaded, twice; once closed it is not in memory any more.
 * Arguments: the library, a compressed model. */
#include "prt/prt.h"

#include <dlfcn.h>
#include <stdio.h>
#include <string.h>

/* Whether a file called `name` is mapped into this process. */
static int is_mapped(const char* name) {
    FILE* maps = fopen("/proc/self/maps", "r");
    char line[4096];
    int found = 0;
    while (maps && fgets(line, sizeof line, maps))
        found |= strstr(line, name) != NULL;
    if (maps)
        fclose(maps);
    return found;
}

/* A function of the library; pointers to data and to functions are of one size where there is dlsym. */
static void find(void* library, const char* name, void* function) {
    void* address = dlsym(library, name);
    memcpy(function, &address, sizeof address);
}

static int use(void* library, const char* path) {
    prt_status (*load)(const char*, prt_model**, prt_message*);
    prt_status (*mesh_of)(const prt_model*, size_t, prt_mesh*, prt_message*);
    prt_status (*from_file)(int, const char*, int, float*, prt_message*);
    void (*destroy)(prt_model*);
    find(library, "prt_model_load", &load);
    find(library, "prt_model_get_mesh", &mesh_of);
    find(library, "prt_light_from_file", &from_file);
    find(library, "prt_model_destroy", &destroy);
    if (!load || !mesh_of || !from_file || !destroy)
        return 0;
    prt_model* model = NULL;
    prt_mesh mesh;
    float light[3];
    prt_message message; /* an exception is thrown and caught inside */
    const int refused = from_file(1, "no such file.exr", PRT_CENTER_Z, light, &message) == PRT_BAD_FILE;
    const int used = load(path, &model, NULL) == PRT_OK && mesh_of(model, 0, &mesh, NULL) == PRT_OK;
    destroy(model);
    return refused && used && mesh.vertices > 0;
}

int main(int count, char** arguments) {
    if (count != 3)
        return 2;
    for (int round = 0; round < 2; ++round) {
        void* library = dlopen(arguments[1], RTLD_NOW | RTLD_LOCAL);
        if (!library) {
            fprintf(stderr, "%s\n", dlerror());
            return 1;
        }
        if (!is_mapped("libprt.so") || !use(library, arguments[2])) {
            fprintf(stderr, "the library does not work when loaded for the %d. time\n", round + 1);
            return 1;
        }
        if (dlclose(library) != 0 || is_mapped("libprt.so")) {
            fprintf(stderr, "the library is still there when closed for the %d. time\n", round + 1);
            return 1;
        }
    }
    return 0;
}
