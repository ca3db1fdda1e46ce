/** Returns a sphere of radius 1 as glTF text, with base color 0.8, 0.7, 0.6: it is unshadowed everywhere. */
export function ballScene(rings = 48) {
  const positions = [];
  const indices = [];
  for (let i = 0; i <= rings; ++i)
    for (let k = 0; k <= 2 * rings; ++k) {
      const [theta, phi] = [(Math.PI * i) / rings, (Math.PI * k) / rings];
      positions.push(Math.sin(theta) * Math.cos(phi), Math.cos(theta), -Math.sin(theta) * Math.sin(phi));
      if (i === rings || k === 2 * rings) continue;
      const [a, b] = [i * (2 * rings + 1) + k, (i + 1) * (2 * rings + 1) + k];
      if (i > 0) indices.push(a, b, a + 1);
      if (i < rings - 1) indices.push(a + 1, b, b + 1);
    }
  const data = Buffer.concat([Buffer.from(new Float32Array(positions).buffer), Buffer.from(new Uint32Array(indices).buffer)]);
  const [count, bytes] = [positions.length / 3, 4 * positions.length];
  const vertices = { bufferView: 0, componentType: 5126, count, type: "VEC3", min: [-1, -1, -1], max: [1, 1, 1] };
  return JSON.stringify({
    asset: { version: "2.0" },
    scene: 0,
    scenes: [{ nodes: [0] }],
    nodes: [{ mesh: 0 }],
    meshes: [{ primitives: [{ attributes: { POSITION: 0, NORMAL: 0 }, indices: 1, material: 0 }] }],
    materials: [{ pbrMetallicRoughness: { metallicFactor: 0, roughnessFactor: 1, baseColorFactor: [0.8, 0.7, 0.6, 1] } }],
    accessors: [vertices, { bufferView: 1, componentType: 5125, count: indices.length, type: "SCALAR" }],
    bufferViews: [
      { buffer: 0, byteLength: bytes },
      { buffer: 0, byteOffset: bytes, byteLength: 4 * indices.length },
    ],
    buffers: [{ byteLength: data.length, uri: `data:application/octet-stream;base64,${data.toString("base64")}` }],
  });
}
