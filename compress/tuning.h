#pragma once

// The numbers of the compressor that were chosen and not derived: unit, origin, and the command that measures
// what another value does. Change one, build, and compare over the four demo scenes and what you ship:
//
//   [sweep]   prt evaluate BAKED.glb --sweep --json REPORT.json     lit_rms at equal bytes, equal components
//   [preset]  prt compress BAKED.glb -o OUT.glb --preset u32 --json REPORT.json     lit_rms, seconds
//   [budget]  prt compress BAKED.glb -o OUT.glb --bytes-per-vertex 9 (or --max-error 0.01) --json REPORT.json
//                                                                    lit_rms, bytes, trials, seconds
//   [trace]   any of the latter with --trace TRACE.jsonl             rounds, splits, merges, trials
//   [seams]   prt evaluate BAKED.glb OUT.glb --json REPORT.json      seam, lit_max
//
// "Measured" is: when it was chosen, on the scenes named. "By hand": a round value that nothing was found to
// depend on. Tolerances of floating point stand where they are used, with their derivation.

#include <cstddef>

namespace prt::tuning {

/// Shares of time at which stages of compression end, for progress. Measured on the example scenes (tree u64,
/// room u32, knot u32): the three agree within 0.03.
inline constexpr double kClustersFoundAt = 0.84, kClustersCodedAt = 0.94; ///< of `compress`
inline constexpr double kSeedsAt = 0.12, kComponentsGrownAt = 0.72,
                        kImprovedAt = 0.97;                    ///< of finding clusters
inline constexpr double kFirstRoundsAt = 0.5, kMovesAt = 0.85; ///< of improving them
inline constexpr double kAlternatedAt = 0.45;                  ///< of coding

// metric/

/// Natural light: power of a coefficient of band l >= 1 over that of band 0, p / l^f, of whole light and of
/// skies without suns; and of one of any band of suns. Fitted to means over 15 photographs: docs/math.md,
/// section 4. `prt project --suns auto`
inline constexpr double kWholePower = 0.28, kWholeFall = 0.6, kSkyPower = 0.24, kSkyFall = 0.85,
                        kSunPower = 0.1;
/// Daylight: a sun's irradiance over all light of sky and ground, times the turbidity, before the air takes
/// what it does: exp(-extinction / sine of the elevation). Of the photographs' suns. `prt project --suns
/// auto`
inline constexpr double kSunOverSky = 3.1, kAirExtinction = 0.08;
/// Of grass, soil and concrete: 0.1 to 0.3.
inline constexpr double kGroundAlbedo = 0.2;
/// What skies have beside the analytic ones, p / l^f as above. Of the photographs. `prt project`
inline constexpr double kTextureOutdoors = 0.1, kTextureFallOutdoors = 1.5;
/// Rooms: band 1 along +Y over band 0, the light of a lamp or window over that of the rest, and what else
/// there is, p / l^f. [preset] with --metric indoor, under the photographs' rooms
inline constexpr double kRoomFromAbove = 0.5, kLampOverRoom = 0.4, kTextureIndoors = 0.1,
                        kTextureFallIndoors = 1;
/// Share of the power that natural lighting has in the metric of given lights, so that no error is free. By
/// hand. [preset] with --lights
inline constexpr double kNaturalShare = 0.01;
/// A receiver is an outlier whose vector is so many times as long as the median: near it float has no digits
/// for the others. By hand; HardCase.AHugeOutlierIsKeptAndSpoilsNothing.
inline constexpr float kOutlierLength = 100;

/// What the squared contrast error of lamps counts, their mean, against the squared relative error under the
/// sky. [preset] on a room with seven lamps.
inline constexpr double kLampsShare = 1;
/// What their squared error relative to all of their light counts beside contrast: next to a lamp contrast
/// alone leaves its brightest spots to chance. [preset] likewise.
inline constexpr double kSpotsShare = 0.25;
/// Share that contrast errors under skies have in what an error costs; the rest counts the error itself.
/// [preset] on room, knot, terrain and tree under photographs: with 0.3 lit_rms stays within 1 %, and 95 % of
/// the area has a tenth less contrast error.
inline constexpr double kSkyContrastShare = 0.3;
/// Share of a lamp's contrast below which a colour has no axis. By hand.
inline constexpr double kLeastColor = 1e-7;

// The frame: squared errors relative to the mean squared exit radiance, as lit_rms².

/// Error that axes may drop at first, for up to kFewBits bits of weights and beyond. By hand: a hundredth of
/// what a word and two words leave on the demo scenes. [preset] with u32, u64
inline constexpr double kDroppedOfFewBits = 1e-6, kDroppedOfManyBits = 1e-7;
inline constexpr int kFewBits = 48;
/// Of probes, whose many numbers are mostly noise.
inline constexpr double kDroppedOfOutputs = 1e-4;
/// Where the axes dropped more than this share of the error found, the frame is made anew with the other
/// share of it, or with all axes where the error is below kExactError (float rounding). By hand.
inline constexpr double kTooMuchDropped = 0.04, kDroppedAgain = 0.01, kLeastDropped = 1e-13,
                        kExactError = 1e-11;
/// Points of so many receivers are rounded to 16 bits: half of the memory. The error that this may add, over
/// what axes may drop at first; later, as a share of the error. By hand. On a grid of 1.5 million vertices
/// lit_rms is 5.865 % with this and stretches of seams, and 5.861 % without. [preset]
inline constexpr std::size_t kManyReceivers = 65536;
inline constexpr double kRoundingOverDropped = 0.1, kPointsRoundingShare = 0.001;
/// Shares of the error that leaving out axes and rounding them may add in a file. By hand. [sweep]
inline constexpr double kAxesShare = 0.01, kAxisRoundingShare = 0.02;
/// So many times that where a receiver has several outputs, whose axes are long. By hand.
inline constexpr double kSharesOfOutputs = 4;
/// Share of the error that rounding the bases may add: bytes of bases against error, measured on small
/// meshes. [sweep]
inline constexpr double kBasisShare = 0.1;
/// Mean square of a weight, for the step of the bases. Measured on the demo scenes. [preset]
inline constexpr double kMeanSquareWeight = 0.2;

// clusters/

/// Variance of guides, whose own is 1 over all receivers, below which a cluster learns little from them.
/// Below 1e-5 slopes of small clusters make the rounding of all rows coarse; above 1e-3 flat ones learn
/// nothing. Measured on five scenes. [preset]
inline constexpr double kGuideRidge = 1e-4;
/// Variance of guides within clusters that their unit is made for at least: they hardly differ there. By
/// hand.
inline constexpr double kLeastGuideVariance = 1e-6;

/// Lloyd's iteration for the start: most iterations, and the fall of the error that ends it. By hand.
/// [preset]
inline constexpr int kMostLloydIterations = 50;
inline constexpr double kLloydTolerance = 1e-3;
/// Rounds for each component while they come one at a time, and after each sweep of moves. By hand. [trace]
inline constexpr int kRoundsPerComponent = 2, kRoundsAfterMoves = 2;
/// Most rounds of clustered PCA, and the fall of the cost that ends them. By hand. [trace]
inline constexpr int kMostRounds = 200;
inline constexpr double kRoundTolerance = 1e-3;
/// Most sweeps of split-and-merge moves. Later ones are seldom kept. [trace]
inline constexpr int kMostMoveSweeps = 8;
/// The same of drafts. [budget]
inline constexpr double kDraftTolerance = 1e-2;
inline constexpr int kDraftMoveSweeps = 1;
/// A split must gain so many times what its merge loses: neighbours adapt in the rounds that follow, so that
/// a split gains more and a merge loses less than is known before. Measured on four scenes: 0.7 finds what
/// there is to find; the sum has the last word. [trace]
inline constexpr double kSplitOverMerge = 0.7;
/// Nearest clusters that a merge is tried with. By hand. [trace]
inline constexpr std::size_t kMergePartners = 4;
/// Clusters that a point looks among in a round, where there are more than twice as many. By hand. [preset]
inline constexpr std::size_t kNeighbours = 32;
/// The same when points are coded: by then most have their cluster. By hand. [preset]
inline constexpr std::size_t kNeighboursOfCodes = 16;
/// Clusters whose means are looked at for each neighbour that is kept. By hand. [preset]
inline constexpr std::size_t kMeansPerNeighbour = 4;
/// How far weights reach along a direction, in standard deviations. By hand. [preset]
inline constexpr float kReach = 3;
/// Bits of one more row in a file whose bases count. Measured on five scenes: [budget], bytes_bases over
/// rows.
inline constexpr double kBitsPerRow = 64;
/// Share of the error, times the components, that a bit more for a receiver's weights takes away: the fall of
/// an optimal quantiser is log 4 = 1.39 per bit (docs/math.md, eq. 24).
inline constexpr double kGainPerBit = 1.4;
/// Rounds in which the price of a component and the points settle. By hand. [budget] with --shader-ops
inline constexpr int kPriceRounds = 12;

// coding/

/// Rounds of codes and clusters in turn, and the first with rounded bases. The best is kept. By hand. [trace]
inline constexpr int kCodingRounds = 6, kRoundedFrom = 2;
/// Rounds in which clusters that were found among logarithms of lamps settle among their light, and the fall
/// of the error that ends them. A room with seven lamps, u64: 0.041 before, 0.0070 after 6, 0.00064 after 21.
/// [preset]
inline constexpr int kSettlingRounds = 30, kSettlingRoundsOfDrafts = 6;
inline constexpr double kSettled = 0.02;
/// Share of a cluster's error that a split is taken to save, at most what another loses by being merged. By
/// hand. [preset] on a room with seven lamps.
inline constexpr double kSplitGain = 0.5;
/// Fits of clusters to codes from nothing: each leaves a share of kRefitRidge of the one before. By hand.
inline constexpr int kRoundsFromNothing = 2;
/// Variance of weights and guides, in units of a weight's most, below which refitting leaves their rows as
/// they are. At 1e-9, clusters of nine points on 2 478 had slopes of 34, and 1.32 instead of 0.43 %. [preset]
inline constexpr double kRefitRidge = 1e-4;
/// Lengths of rows that are tried, as shares of the largest coordinate: 1 to 0.3. By hand. [preset]
inline constexpr int kMostLengthTenths = 10, kLeastLengthTenths = 3;
/// Conjugate gradients of the seams: most steps, and the fall of the squared residual that ends them: weights
/// are rounded afterwards, to steps far larger. By hand. [seams]
inline constexpr int kMostSolverSteps = 30;
inline constexpr double kSolverTolerance = 1e-6;
/// Receivers whose weights are solved for together, so that the solver takes no memory to speak of. Of a grid
/// of 1.5 million vertices jumps are the same to a thousandth. [seams]
inline constexpr std::size_t kSolvedTogether = 65536;
/// Sweeps over the receivers that choose clusters at seams, and the share of changes below which they end. By
/// hand. [seams]
inline constexpr int kMostSeamSweeps = 10;
inline constexpr std::size_t kReceiversPerSeamChange = 200;
/// Cuts of lightmaps: what a squared jump costs against the mean squared error of a receiver, what a receiver
/// in another cluster costs that is read beside this one, over the mean squared error, and the sweeps in
/// which they settle. On a room of 196 572 texels with 8 bytes each, under a sunny street, radiance times 0.8
/// in sRGB, 99 % of places jump by at most 0.5 of 255 shades, 1.6 without, and 99.9 % by 0.9 instead of 2.4;
/// lit_rms grows by 1.9 %. With 20 and 50, 0.4, 0.7 and 3.1 %; with 20 and 0, 0.7, 1.3 and 1.8 %. [preset]
inline constexpr double kJumpPrice = 16, kJumpBorder = 5;
inline constexpr int kJumpSweeps = 6;
/// Share by which another code must be cheaper, against moves to and fro by rounding.
inline constexpr double kLeastSeamGain = 1e-6;

// search/

/// Tries start from the clusters of others that are at most so many times as many, or as few. So few clusters
/// are found from nothing as soon. On a head, 27 of 10 clusters have 1.44 %, from nothing 1.37 %; on the
/// bunny, 148 have 0.98 and 0.99 %. [trace]
inline constexpr double kFarStart = 4;
inline constexpr int kAlwaysFresh = 48;
/// Error of a finished try over that of its draft: 0.96 to 0.98 on the bunny, 0.89 to 0.97 on a head. [trace]
inline constexpr double kFinishedOverDraft = 0.97;
/// Meshes of so few receivers are searched all ways, in seconds; of so few, without drafts. [budget]
inline constexpr double kFewReceivers = 1500, kAlwaysFinished = 600;
/// A line is left that promises no less than this multiple of the best cost, by rules of thumb.
/// [budget]
inline constexpr double kHopeless = 1.02;
/// Shares of the error that rounding bases may add, tried over the format's; the most. [budget]
inline constexpr double kOtherShares[] = {0.3, 3};
inline constexpr double kMostShare = 0.9;

/// Steps that may make it worse before a search turns back. By hand. [budget]
inline constexpr int kPatience = 2;
/// Tries on one line of the search: to fill bytes, to reach an error. By hand. [budget]
inline constexpr int kBytesTries = 6, kErrorTries = 6;
/// Bases of a preset take at most so many times the bytes of the weights, or so many bytes: a prop of some
/// hundred vertices needs them. By hand, over meshes of 232 to 3 000 vertices. [preset]
inline constexpr double kBasesOverWeights = 2, kAlwaysForBases = 4096;
/// With fewer receivers a cluster, tables outweigh weights; so many clusters may be tried always. [budget]
inline constexpr std::size_t kReceiversPerCluster = 12, kAlwaysClusters = 64;
/// Clusters where operations alone are given, and nothing else limits them. [budget] --shader-ops
inline constexpr std::size_t kMostClustersOfOperations = 512;
/// Share of the bytes that ends a line; of a preset that does not fit, whose bytes are a rule of thumb, a
/// tenth is not worth a try. By hand. [budget]
inline constexpr double kLeastFilled = 0.975, kLeastFilledOfPreset = 0.9;
/// Bytes over those of the weights above which rows are tried both as paying for their bytes and as not. A
/// preset's ways differ only where there are so few vertices that bases take more than their share: 2 478 of
/// them had 0.479 and 0.506 %, and 0.069 and 0.074 %. [budget]
inline constexpr double kBothWays = 2, kBothWaysOfPreset = 1.02 * (1 + kBasesOverWeights);
/// Bytes of the bases of a cluster for each number of a transfer vector, before the first try: splits from
/// too few clusters cost less than a start with too many. Least bytes of a cluster after a try. [budget]
inline constexpr double kBytesPerClusterAndNumber = 12, kLeastBytesPerCluster = 4;
/// Clusters of the first try for an error. [budget]
inline constexpr double kFirstClusters = 64;
/// Share of an allowed error that ends a line, and of drafts. By hand. [budget]
inline constexpr double kNearEnough = 0.98, kNearEnoughOfDrafts = 0.95;
/// Numbers of clusters between which nothing is looked for: one misses and one reaches. By hand. [budget]
inline constexpr double kNearClusters = 1.03;
/// log error falls by so much per log clusters, as a rule, and within what two tries are believed. Measured
/// on the demo scenes. [budget]
inline constexpr double kErrorExponent = 0.4, kErrorExponentDown = 0.28, kLeastErrorExponent = 0.15,
                        kMostErrorExponent = 2;
/// Logarithm of a ratio of clusters that tells how errors fall. By hand. [budget]
inline constexpr double kTellingRatio = 0.15;
/// Bytes of bases with a word more, of as many clusters; and how many times as many bytes send a search to
/// another payload at once. [budget]
inline constexpr double kBasesOfAWordMore = 1.5, kClearlyMore = 1.1;
/// Factors of clusters from one try to the next: when more are needed than the last, a larger payload is the
/// way; the most up at once. By hand. [budget]
inline constexpr double kHopelessFactor = 64, kMostFactor = 4;
/// Bits beyond which nothing is lost to speak of: of the cluster and of each component. [budget] --shader-ops
inline constexpr double kEnoughClusterBits = 16, kEnoughWeightBits = 12;
/// Where a search of payloads begins, bytes: as given by an error, four for a hundredth and kBytesPerHalving
/// more for every half of it; or a share of the bytes given, less where components are few. Measured on
/// meshes of 10 000 to 40 000 vertices. [budget]
inline constexpr double kFirstBytes = 4, kFirstBytesError = 0.01, kBytesPerHalving = 1.1;
inline constexpr double kWeightsShare = 0.6, kWeightsShareOfFewComponents = 0.4;

} // namespace prt::tuning
