#pragma once

// The numbers of the compressor that were chosen rather than derived: unit, origin, and the command that
// measures the effect of another value. To change one: edit, build, and compare over the four demo scenes and
// the scenes that you ship:
//
//   [sweep]   prt evaluate BAKED.glb --measure sweep --json REPORT.json
//                                                                    lit_rms at equal bytes, equal components
//   [preset]  prt compress BAKED.glb -o OUT.glb --preset u32 --json REPORT.json     lit_rms, seconds
//   [budget]  prt compress BAKED.glb -o OUT.glb --bytes-per-vertex 9 (or --max-error 0.01) --json REPORT.json
//                                                                    lit_rms, bytes, trials, seconds
//   [trace]   any of the latter with --trace TRACE.jsonl             rounds, splits, merges, trials
//   [seams]   prt evaluate BAKED.glb OUT.glb --json REPORT.json      seam, lit_max
//
// "Measured": measured on the named scenes when the value was chosen. "By hand": a round value; no result was
// found to depend on it. Tolerances of floating point are defined where they are used, with their derivation.

#include <cstddef>

namespace prt::tuning {

/// Fractions of time at which stages of compression end, for progress. Measured on the example scenes (tree
/// u64, room u32, knot u32): the three agree within 0.03.
inline constexpr double kClustersFoundAt = 0.84, kClustersCodedAt = 0.94; ///< stages of `compress`
/// Stages of finding clusters.
inline constexpr double kSeedsAt = 0.12, kComponentsGrownAt = 0.72, kImprovedAt = 0.97;
inline constexpr double kFirstRoundsAt = 0.5, kMovesAt = 0.85; ///< stages of improving them
inline constexpr double kAlternatedAt = 0.45;                  ///< stages of coding

// metric/

/// Natural light: power of a coefficient of band l >= 1 relative to band 0, p / l^f, of combined light and of
/// skies without suns; and power of one coefficient of any band of suns. Fitted to means over 15 photographs:
/// docs/math.md, section 4. `prt project --suns auto`
inline constexpr double kWholePower = 0.28, kWholeFall = 0.6, kSkyPower = 0.24, kSkyFall = 0.85,
                        kSunPower = 0.1;
/// Daylight: a sun's irradiance relative to all light of sky and ground, times the turbidity, before the
/// extinction of the air: exp(-extinction / sine of the elevation). From the suns of the photographs. `prt
/// project --suns auto`
inline constexpr double kSunOverSky = 3.1, kAirExtinction = 0.08;
/// Albedo of grass, soil and concrete: 0.1 to 0.3.
inline constexpr double kGroundAlbedo = 0.2;
/// Power of real skies in addition to the analytic ones, p / l^f as above. From the photographs. `prt
/// project`
inline constexpr double kTextureOutdoors = 0.1, kTextureFallOutdoors = 1.5;
/// Rooms: band 1 along +Y relative to band 0, light of a lamp or window relative to the rest, and the
/// remaining power, p / l^f. [preset] with --lights indoor, under the photographs' rooms
inline constexpr double kRoomFromAbove = 0.5, kLampOverRoom = 0.4, kTextureIndoors = 0.1,
                        kTextureFallIndoors = 1;
/// Fraction of the power that natural lighting has in the metric of given lights, so that no error is free.
/// By hand. [preset] with --lights
inline constexpr double kNaturalShare = 0.01;
/// A receiver is an outlier if its vector is longer than the median by this factor: near it, float has no
/// precision for the others. By hand; HardCase.HugeOutliersAreKeptWithoutHarm.
inline constexpr float kOutlierLength = 100;

/// Weight of the mean squared contrast error of lamps relative to the squared relative error under the sky.
/// [preset] on a room with seven lamps.
inline constexpr double kLampsShare = 1;
/// Weight of the squared error of lamps relative to all of their light, in addition to contrast: close to a
/// lamp, contrast alone hardly constrains the brightest spots. [preset] on a room with seven lamps.
inline constexpr double kSpotsShare = 0.25;
/// Fraction of contrast errors under skies in the cost of an error; the rest is the relative error itself.
/// [preset] on room, knot, terrain and tree under photographs: with 0.3 lit_rms stays within 1 %, and 95 % of
/// the area has a tenth less contrast error.
inline constexpr double kSkyContrastShare = 0.3;
/// Fraction of a lamp's contrast below which a color gets no axis. By hand.
inline constexpr double kMinColor = 1e-7;

// The frame: squared errors relative to the mean squared exit radiance, like lit_rms².

/// Error that dropping axes may cause initially, for up to kFewBits bits of weights and above. By hand: a
/// hundredth of the error with one word and two words on the demo scenes. [preset] with u32, u64
inline constexpr double kDroppedOfFewBits = 1e-6, kDroppedOfManyBits = 1e-7;
inline constexpr int kFewBits = 48;
/// Initial dropping error for probes, whose many coefficients are mostly noise.
inline constexpr double kDroppedOfOutputs = 1e-4;
/// If the dropped axes caused more than this fraction of the error, the frame is built again with the second
/// fraction of it, or with all axes if the error is below kExactError (float rounding). By hand.
inline constexpr double kTooMuchDropped = 0.04, kDroppedAgain = 0.01, kMinDropped = 1e-13,
                        kExactError = 1e-11;
/// Number of receivers above which points are rounded to 16 bits: half of the memory. The error that this may
/// add, relative to the error of axes dropped initially; later, as a fraction of the error. By hand. On a
/// grid of 1.5 million vertices lit_rms is 5.865 % with this and blockwise seams, and 5.861 % without.
/// [preset]
inline constexpr std::size_t kManyReceivers = 65536;
inline constexpr double kRoundingOverDropped = 0.1, kPointsRoundingShare = 0.001;
/// Fractions of the error that dropping axes and rounding them may add in a file. By hand. [sweep]
inline constexpr double kAxesShare = 0.01, kAxisRoundingShare = 0.02;
/// Factor on these fractions if a receiver has several outputs, whose axes are long. By hand.
inline constexpr double kSharesOfOutputs = 4;
/// Fraction of the error that rounding the bases may add: trade-off between bytes of bases and error,
/// measured on small meshes. [sweep]
inline constexpr double kBasisShare = 0.1;
/// Mean square of a weight, for the step of the bases. Measured on the demo scenes. [preset]
inline constexpr double kMeanSquareWeight = 0.2;

// clusters/

/// Variance of predictors (1 over all receivers) below which a cluster learns little from them. Below 1e-5,
/// slopes of small clusters make the rounding of all rows coarse; above 1e-3, flat clusters learn nothing.
/// Measured on five scenes. [preset]
inline constexpr double kPredictorRidge = 1e-4;
/// Minimum variance of predictors within clusters for the choice of their unit, because they hardly vary
/// there. By hand.
inline constexpr double kMinPredictorVariance = 1e-6;

/// Lloyd's iteration for the start: maximum number of iterations, and the relative decrease of the error that
/// ends it. By hand. [preset]
inline constexpr int kMaxLloydIterations = 50;
inline constexpr double kLloydTolerance = 1e-3;
/// Rounds per component while components are added one by one, and after each sweep of moves. By hand.
/// [trace]
inline constexpr int kRoundsPerComponent = 2, kRoundsAfterMoves = 2;
/// Maximum number of rounds of clustered PCA, and the relative decrease of the cost that ends them. By hand.
/// [trace]
inline constexpr int kMaxRounds = 200;
inline constexpr double kRoundTolerance = 1e-3;
/// Maximum number of sweeps of split-and-merge moves. Later sweeps are rarely kept. [trace]
inline constexpr int kMaxMoveSweeps = 8;
/// Tolerance of rounds and maximum number of move sweeps for drafts. [budget]
inline constexpr double kDraftTolerance = 1e-2;
inline constexpr int kDraftMoveSweeps = 1;
/// Minimum ratio of a split's gain to its merge's loss. Neighbours adapt in the following rounds, so that a
/// split gains more and a merge loses less than estimated. Measured on four scenes: 0.7 finds all useful
/// moves; the total cost decides. [trace]
inline constexpr double kSplitOverMerge = 0.7;
/// Number of nearest clusters tried for a merge. By hand. [trace]
inline constexpr std::size_t kMergePartners = 4;
/// Number of clusters that a point is compared with in a round, if there are more than twice this number. By
/// hand. [preset]
inline constexpr std::size_t kNeighbours = 32;
/// Number of clusters that a point is compared with during coding; by then most points have their final
/// cluster. By hand. [preset]
inline constexpr std::size_t kNeighboursOfCodes = 16;
/// Number of cluster means examined per neighbour that is kept. By hand. [preset]
inline constexpr std::size_t kMeansPerNeighbour = 4;
/// Range of weights along a direction, in standard deviations. By hand. [preset]
inline constexpr float kReach = 3;
/// Bits of one additional row in a file whose bases count. Measured on five scenes: [budget], bytes_bases
/// over rows.
inline constexpr double kBitsPerRow = 64;
/// Fraction of the error, times the number of components, that an additional bit for a receiver's weights
/// removes: an optimal quantiser gains log 4 = 1.39 per bit (docs/math.md, eq. 24).
inline constexpr double kGainPerBit = 1.4;
/// Rounds in which the multiplier of a component and the points converge. By hand. [budget] with --shader-ops
inline constexpr int kMultiplierRounds = 12;

// coding/

/// Rounds of alternation between codes and clusters, and the first with rounded bases. The best is kept. By
/// hand. [trace]
inline constexpr int kCodingRounds = 6, kRoundedFrom = 2;
/// Rounds in which clusters that were found among logarithms of lamps converge among their light, and the
/// relative decrease of the error that ends them. A room with seven lamps, u64: 0.041 before, 0.0070 after 6,
/// 0.00064 after 21. [preset]
inline constexpr int kSettlingRounds = 30, kSettlingRoundsOfDrafts = 6;
inline constexpr double kSettled = 0.02;
/// Fraction of a cluster's error that a split is assumed to save; also the maximum that a merge may lose. By
/// hand. [preset] on a room with seven lamps.
inline constexpr double kSplitGain = 0.5;
/// Fits of clusters to codes from scratch: each leaves a fraction kRefitRidge of the previous error. By hand.
inline constexpr int kRoundsFromNothing = 2;
/// Variance of weights and predictors, relative to the maximum weight, below which refitting keeps their
/// rows. At 1e-9, clusters of nine points on 2 478 had slopes of 34, and 1.32 instead of 0.43 %. [preset]
inline constexpr double kRefitRidge = 1e-4;
/// Lengths of rows that are tried, as fractions of the largest coordinate: 1 to 0.3. By hand. [preset]
inline constexpr int kMaxLengthTenths = 10, kMinLengthTenths = 3;
/// Conjugate gradients of the seams: maximum number of steps, and the relative decrease of the squared
/// residual that ends them. Weights are rounded afterwards, to much larger steps. By hand. [seams]
inline constexpr int kMaxSolverSteps = 30;
inline constexpr double kSolverTolerance = 1e-6;
/// Number of receivers whose weights are solved for together, which limits the memory of the solver. On a
/// grid of 1.5 million vertices jumps are equal to a thousandth. [seams]
inline constexpr std::size_t kSolvedTogether = 65536;
/// Sweeps over the receivers that choose clusters at seams, and the fraction of changes below which they end.
/// By hand. [seams]
inline constexpr int kMaxSeamSweeps = 10;
inline constexpr std::size_t kReceiversPerSeamChange = 200;
/// UV seams of lightmaps: cost of a squared jump relative to the mean squared error of a receiver, cost of an
/// adjacent receiver in another cluster relative to the mean squared error, and the number of sweeps until
/// convergence. On a room of 196 572 texels with 8 bytes each, under a sunny street, radiance times 0.8 in
/// sRGB: 99 % of positions jump by at most 0.5 of 255 shades (1.6 without), and 99.9 % by 0.9 instead of 2.4;
/// lit_rms grows by 1.9 %. With 20 and 50: 0.4, 0.7 and 3.1 %; with 20 and 0: 0.7, 1.3 and 1.8 %. [preset]
inline constexpr double kJumpMultiplier = 16, kJumpBorder = 5;
inline constexpr int kJumpSweeps = 6;
/// Minimum relative saving of another code, which prevents oscillation by rounding.
inline constexpr double kMinSeamGain = 1e-6;

// search/

/// Maximum ratio of cluster numbers for which a trial starts from the clusters of another; and the number up
/// to which clusters are found from scratch, which is then as fast. On a head, 27 clusters started from 10
/// have 1.44 %, from scratch 1.37 %; on the bunny, 148 clusters have 0.98 and 0.99 %. [trace]
inline constexpr double kFarStart = 4;
inline constexpr int kAlwaysFresh = 48;
/// Error of a complete trial relative to its draft: 0.96 to 0.98 on the bunny, 0.89 to 0.97 on a head.
/// [trace]
inline constexpr double kFinishedOverDraft = 0.97;
/// Number of receivers up to which all combinations are searched, in seconds; and up to which no drafts are
/// used. [budget]
inline constexpr double kFewReceivers = 1500, kAlwaysFinished = 600;
/// Stop searching a configuration when its estimated cost exceeds this multiple of the best. [budget]
inline constexpr double kHopeless = 1.02;
/// Fractions of the error that rounding bases may add, tried relative to the format's; and the maximum.
/// [budget]
inline constexpr double kOtherShares[] = {0.3, 3};
inline constexpr double kMaxShare = 0.9;

/// Number of steps without improvement before a search reverses. By hand. [budget]
inline constexpr int kPatience = 2;
/// Trials on one configuration of the search: to fill bytes, to reach an error. By hand. [budget]
inline constexpr int kBytesTries = 6, kErrorTries = 6;
/// Maximum size of a preset's bases relative to the weights, and size in bytes that is always allowed: a prop
/// of a few hundred vertices needs it. By hand, over meshes of 232 to 3 000 vertices. [preset]
inline constexpr double kBasesOverWeights = 2, kAlwaysForBases = 4096;
/// Receivers per cluster below which tables outweigh weights; number of clusters that may always be tried.
/// [budget]
inline constexpr std::size_t kReceiversPerCluster = 12, kAlwaysClusters = 64;
/// Maximum number of clusters if only operations are limited. [budget] --shader-ops
inline constexpr std::size_t kMaxClustersOfOperations = 512;
/// Fraction of the bytes that ends a configuration. For a preset that does not fit, whose limit is a rule of
/// thumb, the last tenth is not worth a trial. By hand. [budget]
inline constexpr double kMinFilled = 0.975, kMinFilledOfPreset = 0.9;
/// Ratio of total bytes to weight bytes above which both settings of `bases_count` are tried. A preset's
/// settings differ only if the bases exceed their share because of few vertices: 2 478 vertices had 0.479 and
/// 0.506 %, and 0.069 and 0.074 %. [budget]
inline constexpr double kBothWays = 2, kBothWaysOfPreset = 1.02 * (1 + kBasesOverWeights);
/// Bytes of the bases of a cluster per coefficient of a transfer vector, before the first trial: splits from
/// too few clusters cost less than a start with too many. Minimum bytes of a cluster after a trial. [budget]
inline constexpr double kBytesPerClusterAndNumber = 12, kMinBytesPerCluster = 4;
/// Clusters of the first trial for an error. [budget]
inline constexpr double kFirstClusters = 64;
/// Fraction of an allowed error that ends a configuration, for complete trials and drafts. By hand. [budget]
inline constexpr double kNearEnough = 0.98, kNearEnoughOfDrafts = 0.95;
/// Ratio between a number of clusters that misses and one that reaches the target at which the search ends.
/// By hand. [budget]
inline constexpr double kNearClusters = 1.03;
/// Decrease of log error per log clusters: typical value, value for fewer clusters, and limits of estimates
/// from two trials. Measured on the demo scenes. [budget]
inline constexpr double kErrorExponent = 0.4, kErrorExponentDown = 0.28, kMinErrorExponent = 0.15,
                        kMaxErrorExponent = 2;
/// Minimum logarithm of a ratio of clusters for an estimate of that exponent. By hand. [budget]
inline constexpr double kTellingRatio = 0.15;
/// Ratio of basis bytes with an additional word for the same number of clusters; and the ratio of bytes at
/// which a search changes the payload at once. [budget]
inline constexpr double kBasesOfAWordMore = 1.5, kClearlyMore = 1.1;
/// Factors of clusters from one trial to the next: above the first, a larger payload is needed; the second is
/// the maximum increase per trial. By hand. [budget]
inline constexpr double kHopelessFactor = 64, kMaxGrowth = 4;
/// Bits above which the loss is negligible: of the cluster and of each component. [budget] --shader-ops
inline constexpr double kEnoughClusterBits = 16, kEnoughWeightBits = 12;
/// Start of a search over payloads, in bytes. For an error: kFirstBytes for one percent, and kBytesPerHalving
/// more for every halving. For a size: a fraction of the bytes, smaller if components are few. Measured on
/// meshes of 10 000 to 40 000 vertices. [budget]
inline constexpr double kFirstBytes = 4, kFirstBytesError = 0.01, kBytesPerHalving = 1.1;
inline constexpr double kWeightsShare = 0.6, kWeightsShareOfFewComponents = 0.4;

} // namespace prt::tuning
