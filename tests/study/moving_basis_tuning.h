#pragma once

// The numbers of the moving basis that were chosen and not derived, measured by
//
//   compression_study BAKED.glb --json REPORT.json     lit_rms at equal bytes, equal components
//
// on the knot and the room, with four to six components in a word.

namespace prt::tuning {

/// What differences between neighbouring nodes cost, beside the error, where all nodes together weigh 1:
/// 1e-3 has a quarter more error, with 1e-6 rows take 7 % more bytes.
inline constexpr float kSmoothness = 3e-5f;
/// What the length of a node's basis costs while weights have variance 1: about what 5 bits of a weight lose.
/// 3e-3 has 3 % more error, without it bases that cancel each other take 6 % more bytes.
inline constexpr float kRowRidge = 1e-3f;
/// What a squared weight costs, as a share of the squared error. Without it a few weights, where a basis is
/// short, are a hundred times as long as the others and take their bits: 13 % more error on the bunny, with
/// eight components in a word.
inline constexpr double kWeightPrice = 0.05;
/// Share of the basis's length that is added where weights are solved for, against float rounding.
inline constexpr float kWeightRidge = 1e-6f;

/// Rounds of rows and weights in turn, on the last grid and on those before. 100 have 2 % less error than 40.
inline constexpr int kRoundsOfGrid = 40, kRoundsOfCoarseGrid = 4;
/// Steps of conjugate gradients in a round: 2 have 2 % more error after as many rounds, 8 1 % less.
inline constexpr int kRowSteps = 4;
/// Rounds after which weights are made uncorrelated again, so that the ridge knows their size.
inline constexpr int kRoundsBetweenNorms = 10;
/// Steps of the rounds of rows, given weights that are rounded, and how many such rounds. By hand.
inline constexpr int kRowStepsOfCode = 8, kCodeRounds = 3;
/// From one reach of weights that is tried to the next. By hand.
inline constexpr float kReachFactor = 0.9f;
/// Sweeps over rounded weights that better one at a time. By hand.
inline constexpr int kWeightSweeps = 2;

/// Share of the squared error that rounding rows may add where bytes count: 0.1 has 3 % less error in 2 %
/// more bytes, which a finer grid turns into 5 %. Else, what nobody sees.
inline constexpr double kRowShare = 0.2, kRowShareOfNodes = 0.01;
/// The same of leaving out axes, and of rounding them.
inline constexpr double kShareOfAxes = 0.04, kShareOfRoundedAxes = 0.03;
/// Squared error that axes may drop at first, for one word of weights; for n words the n²th part.
inline constexpr double kDroppedOfWord = 3e-5;
/// Bits of a number of a row before the first try; most tries; rounds of the first, which only tells bytes;
/// the share of the bytes that is enough; and how many more bits are reckoned with after a try with too many.
/// By hand.
inline constexpr double kBitsOfNumber = 7;
inline constexpr int kGridTries = 4, kRoundsOfTry = 6;
inline constexpr double kGridFilled = 0.9, kAfterTooMuch = 1.03;

} // namespace prt::tuning
