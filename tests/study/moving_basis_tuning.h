#pragma once

// The numbers of the moving basis that were chosen and not derived, measured by
//
//   compression_study BAKED.glb --json REPORT.json     lit_rms at equal bytes, equal components
//
// on the knot and the room, with four to six components in a word.

namespace prt::tuning {

/// Cost of differences between neighbouring nodes, in addition to the error, if all nodes together weigh 1:
/// with 1e-3 the error is a quarter larger, with 1e-6 rows need 7 % more bytes.
inline constexpr float kSmoothness = 3e-5f;
/// Cost of the length of a node's basis while weights have variance 1: about the loss of 5 bits of a weight.
/// With 3e-3 the error is 3 % larger; without it, bases that cancel each other need 6 % more bytes.
inline constexpr float kRowRidge = 1e-3f;
/// Cost of a squared weight, as a fraction of the squared error. Without it a few weights, at short bases,
/// are a hundred times as long as the others and take their bits: 13 % more error on the bunny, with eight
/// components in a word.
inline constexpr double kWeightMultiplier = 0.05;
/// Share of the basis's length that is added where weights are solved for, against float rounding.
inline constexpr float kWeightRidge = 1e-6f;

/// Rounds of rows and weights in alternation, on the last grid and on the coarser ones. 100 rounds have 2 %
/// less error than 40.
inline constexpr int kRoundsOfGrid = 40, kRoundsOfCoarseGrid = 4;
/// Steps of conjugate gradients per round: 2 steps have 2 % more error after an equal number of rounds, 8
/// steps have 1 % less.
inline constexpr int kRowSteps = 4;
/// Rounds after which weights are made uncorrelated again, so that the ridge knows their size.
inline constexpr int kRoundsBetweenNorms = 10;
/// Steps per round of rows for rounded weights, and number of these rounds. Chosen by hand.
inline constexpr int kRowStepsOfCode = 8, kCodeRounds = 3;
/// From one reach of weights that is tried to the next. By hand.
inline constexpr float kReachFactor = 0.9f;
/// Sweeps over rounded weights that better one at a time. By hand.
inline constexpr int kWeightSweeps = 2;

/// Fraction of the squared error that rounding rows may add if the size is limited: 0.1 has 3 % less error
/// with 2 % more bytes, which a finer grid turns into 5 %. Otherwise, an invisible fraction.
inline constexpr double kRowShare = 0.2, kRowShareOfNodes = 0.01;
/// Fraction of the squared error for omitting axes, and for rounding them.
inline constexpr double kShareOfAxes = 0.04, kShareOfRoundedAxes = 0.03;
/// Squared error that axes may drop at first, for one word of weights; for n words the n²th part.
inline constexpr double kDroppedOfWord = 3e-5;
/// Bits of a number of a row before the first trial; maximum number of trials; rounds of the first, which
/// only estimates the size; fraction of the size that is sufficient; and factor on the bits after a trial
/// that was too large. Chosen by hand.
inline constexpr double kBitsOfNumber = 7;
inline constexpr int kGridTries = 4, kRoundsOfTry = 6;
inline constexpr double kGridFilled = 0.9, kAfterTooMuch = 1.03;

} // namespace prt::tuning
