// Limits: how much of a mask is read at most, so that time and memory have a bound whatever it
// holds. An ordinary frame reaches none of them.
#pragma once

namespace flowdlo::path {

/// Pixels of the mask's bounding box that are traced as they are, whatever the mask holds; what is
/// left of a larger box when it is halved has still more than 640 x 480 px, at which all that reads
/// masks was fitted. 1920 x 1080.
inline constexpr int kAlwaysTracedPixels = 1 << 21;

/// The same of a mask of thin strokes; a larger box is traced at a half, a third, ... of its size.
/// 1920 x 1080 at twice its width and height.
inline constexpr int kMostTracedPixels = 1 << 23;

/// Width in pixels from which ropes gain nothing from twice as many of them.
inline constexpr float kThickPx = 8.0F;

/// Length of a mask's strokes, in sums of the image's two sides. Over a hundred `wide` scenes and
/// all readings of them the most is 2.9.
inline constexpr int kMostStrokeSides = 8;

/// The same of several ropes: 20 cables from edge to edge of 640 x 480 px. Of the hostile masks
/// that one rope's limit refuses a board of 33 x 33 squares alone has less.
inline constexpr int kMostRopesSides = 12;

/// Segments of a graph. A rope that crosses itself n times has 2 n + 1; over a hundred `wide`
/// scenes the most is 57, and 176 in a further reading.
inline constexpr int kMostSegments = 256;

/// Strands of a first reading that is followed by others, each of which takes as long again. A rope
/// that crosses itself 20 times has 41; over a hundred `wide` scenes the most is 31.
inline constexpr int kMostRereadStrands = 41;

/// Length of a first reading's path, in sums of the image's two sides, that is followed by others:
/// each lifts paths as long. Over a hundred `wide` scenes the most is 1.8.
inline constexpr int kMostRereadSides = 3;

}  // namespace flowdlo::path
