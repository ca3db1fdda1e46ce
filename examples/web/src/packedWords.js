/** 32-bit words of packed weights that a vertex, texel or probe has: those of the cluster with most bits. */
export const wordsOf = ({ widths, clusterBits }) =>
  Math.max(1, ...widths.map((own) => Math.ceil(own.reduce((sum, width) => sum + width, clusterBits) / 32)));
