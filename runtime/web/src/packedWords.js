/**
 * Returns the number of 32-bit words of packed weights per vertex, texel or probe: the number of the cluster with the
 * most bits.
 */
export const wordsOf = ({ widths, clusterBits }) =>
  Math.max(1, ...widths.map((own) => Math.ceil(own.reduce((sum, width) => sum + width, clusterBits) / 32)));
