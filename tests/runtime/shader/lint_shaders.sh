#!/usr/bin/env bash
# lint_shaders.sh FOLDER: compiles every shader of a folder, with the defines of its variants, by Khronos'
# reference compiler, because drivers accept more than the language allows. Shaders for games have separate
# tests, in all languages.
set -euo pipefail
cd "$1"
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT

# expand FILE: prints the file with each include inserted once, as prt::shader_source does.
expand() {
    awk 'function put(name, line, part) {
            if (seen[name]++) return
            while ((getline line < name) > 0)
                if (line ~ /^#include "/) { split(line, part, "\""); put(part[2]) } else print line
        }
        BEGIN { put(ARGV[1]); exit }' "$1"
}

# compiles FILE [DEFINE]... : a name, or a name and its value
compiles() {
    local source=$folder/$1
    {
        echo "#version 450 core"
        for define in "${@:2}"; do echo "#define $define"; done
        expand "$1"
    } >"$source"
    glslangValidator "$source" >"$folder/log" || {
        echo "$*" && cat "$folder/log" && return 1
    }
}

packed=(PRT_COMPRESSED PRT_CONSTANTS_BUFFER "PRT_PACKED_WORDS 5" "PRT_CLUSTER_BITS 8")
predictors=(PRT_PREDICTOR_NORMAL PRT_PREDICTOR_POSITION "PRT_PREDICTOR_ORIGIN vec3(1.0, 2.0, 3.0)")
volume=("PRT_VOLUME_ORDER 3" PRT_VOLUME_LINEAR "PRT_VOLUME_ORIGIN vec3(1.0)" "PRT_VOLUME_SPACING 0.5" "PRT_VOLUME_SIZE ivec3(2)"
    "PRT_VOLUME_FIRST ivec4(0)" "PRT_VOLUME_BRICKS ivec3(2)")
equal_clusters=("PRT_CLUSTER_ROWS 3" "PRT_SAME_WEIGHTS PRT_ADD(0u, PRT_BITS(8u, 16u)) PRT_ADD(1u, PRT_BITS(24u, 9u))")
for file in *.vert *.frag *.comp; do
    case $file in
        bake_accumulate.comp | bake_blocked.comp | bake_energy.comp | bake_gather.comp | bake_lamps.comp | bake_trace.comp) ;; # the build compiles them
        bake_raster.*)
            for defines in PRT_OPAQUE PRT_ALPHA "PRT_ALPHA PRT_PEEL"; do
                # shellcheck disable=SC2086
                compiles "$file" "PRT_ORDER 6" $defines
            done
            ;;
        prt_instances.vert | viewer_lit_instances.vert)
            compiles "$file" "${packed[@]}" "${predictors[@]}" PRT_INSTANCES
            compiles "$file" PRT_CONSTANTS_BUFFER "PRT_WEIGHT_VECTORS 2" PRT_INSTANCES
            ;;
        prt_texels.comp)
            for outputs in 1 4 9 16; do
                compiles "$file" "${packed[@]}" "PRT_OUTPUTS $outputs"
            done
            compiles "$file" "${packed[@]}" "${equal_clusters[@]}" "PRT_OUTPUTS 9" "PRT_TEXEL_FORMAT rgba32f"
            compiles "$file" "${packed[@]}" "${equal_clusters[@]}" "PRT_TEXEL_FORMAT r11f_g11f_b10f"
            ;;
        *.comp)
            compiles "$file" "PRT_ROWS 40" "PRT_NUMBERS 144" "PRT_FIRST_CHANNELS 1" "PRT_COEFFICIENTS 36"
            compiles "$file" "PRT_ROWS 40" "PRT_NUMBERS 144" "PRT_FIRST_CHANNELS 3" "PRT_COEFFICIENTS 36"
            compiles "$file" "PRT_ROWS 40" "PRT_NUMBERS 144" "PRT_FIRST_CHANNELS 1" "PRT_SECOND_CHANNELS 3" "PRT_COEFFICIENTS 36"
            ;;
        prt_relight.vert)
            compiles "$file" "${packed[@]}"
            compiles "$file" "${packed[@]}" "${predictors[@]}"
            compiles "$file" "${packed[@]}" "${equal_clusters[@]}"
            ;;
        prt_lightmap.frag)
            compiles "$file" "${packed[@]}"
            compiles "$file" "${packed[@]}" "${equal_clusters[@]}"
            compiles "$file" PRT_NORMALIZED_WORDS PRT_CONSTANTS_TEXTURE "PRT_TEXTURE_WIDTH 256" "PRT_PACKED_WORDS 1" "PRT_CLUSTER_BITS 8"
            ;;
        viewer_moving.* | viewer_probes.*)
            for defines in PRT_VOLUME "PRT_VOLUME PRT_SUNS"; do
                # shellcheck disable=SC2086
                compiles "$file" "${volume[@]}" $defines
            done
            if [[ $file == viewer_moving.* ]]; then
                compiles "$file" PRT_SUNS
                compiles "$file" PRT_LOBED "PRT_LOBES 2" "PRT_LOBE_ORDER 3"
                compiles "$file" "${volume[@]}" PRT_VOLUME PRT_SUNS PRT_LOBED "PRT_LOBES 3"
            fi
            ;;
        sun_caster.vert)
            compiles "$file"
            compiles "$file" PRT_SKINNED
            ;;
        scene.vert | viewer_*)
            compiles "$file"
            compiles "$file" PRT_LIGHTMAP
            compiles "$file" "${packed[@]}"
            compiles "$file" PRT_COMPRESSED "PRT_WEIGHT_VECTORS 8"
            compiles "$file" PRT_VERTEX_RADIANCE PRT_RADIANCE_GIVEN
            compiles "$file" "${packed[@]}" PRT_SUNS
            compiles "$file" "${packed[@]}" "${predictors[@]}" PRT_SUNS
            compiles "$file" PRT_COMPRESSED "PRT_WEIGHT_VECTORS 11" PRT_PREDICTOR_NORMAL
            compiles "$file" PRT_VERTEX_RADIANCE PRT_OCCLUDED
            compiles "$file" PRT_INSTANCED
            compiles "$file" PRT_VERTEX_RADIANCE PRT_INSTANCED PRT_SUNS
            compiles "$file" "${packed[@]}" PRT_OCCLUDED PRT_SUNS PRT_VOLUME "${volume[@]}"
            ;;
        scene.frag | sun_caster.frag)
            compiles "$file"
            compiles "$file" PRT_LIGHTMAP
            compiles "$file" PRT_SUNS PRT_PARTLY
            ;;
        *) compiles "$file" ;;
    esac
done
