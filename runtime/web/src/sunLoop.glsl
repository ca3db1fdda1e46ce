// Shades three's directional lights with the model of the material where they are visible; diffusely through thin
// sheets (docs/math.md, eq. 38). Included into the fragment shader of three's materials, after its own lights; prtFace:
// the unit normal of the triangle, on the visible side.
#if defined(PRT_SUNS) && NUM_DIR_LIGHTS > 0

if (prtSeparateSuns) {
  vec3 worldFace = prtFace * mat3(viewMatrix);
  vec3 prtDirect;
  float prtCosine, towardsSun;
#pragma unroll_loop_start
  for (int i = 0; i < NUM_DIR_LIGHTS; i++) {

    directLight.direction = directionalLights[i].direction;
    directLight.color = directionalLights[i].color;
    directLight.visible = true;
    prtCosine = dot(geometryNormal, directLight.direction);
    towardsSun = sign(dot(prtFace, directLight.direction));
    // The side that faces away from the sun is in the triangle's shadow.
    if (prtCosine * towardsSun > 0.0 && (prtCosine > 0.0 || prtTransmission.a > 0.0)) {
#if defined(USE_SHADOWMAP) && (UNROLLED_LOOP_INDEX < NUM_DIR_LIGHT_SHADOWS)
      if (receiveShadow)
        directLight.color *= PRT_VISIBILITY(UNROLLED_LOOP_INDEX);
#endif
      prtDirect = reflectedLight.directDiffuse;
      if (prtCosine > 0.0)
        RE_Direct(directLight, geometryPosition, geometryNormal, geometryViewDir, geometryClearcoatNormal, material,
                  reflectedLight);
      reflectedLight.directDiffuse = mix(reflectedLight.directDiffuse, prtDirect, prtTransmission.a);
      if (prtCosine < 0.0)
        reflectedLight.directDiffuse -=
            directLight.color * prtTransmission.rgb * (prtTransmission.a * RECIPROCAL_PI * prtCosine);
    }
  }
#pragma unroll_loop_end
}

#endif
