// Sets of PRTKIT_transfer in test models.
import { clustersOf } from "../src/clusteredPca.js";
import { setsOf } from "../src/wholeExtension.js";

/** Returns the extensions of a file with these sets. */
export const transferOf = (...sets) => ({ PRTKIT_transfer: { version: 6, sets } });

/** Returns the set of these receivers in `json`, to be changed. */
export const setIn = (json, receivers) => json.extensions.PRTKIT_transfer.sets.find((set) => set.receivers === receivers);

/** Adds a set to `json`. */
export const addSet = (json, set) => json.extensions.PRTKIT_transfer.sets.push(set);

/** Validates and decodes a set of vertices, as the plug-in does. */
export const decodedSet = (set, view) => clustersOf(setsOf({ extensions: transferOf(set) }).vertices, view);
