// Hints: what a caller knows beside the frame: ends of the rope, its length, the frame before.
#pragma once

#include <optional>
#include <variant>
#include <vector>

#include "flowdlo/centerline.hpp"

namespace flowdlo {

/// A place in the image; the centre of the top left pixel is (0, 0).
struct Pixel {
  float u = 0;  ///< column
  float v = 0;  ///< row

  friend bool operator==(const Pixel&, const Pixel&) = default;
};

/// Where an end of the rope is: a pixel of the frame, at most one image beside it, or a point of
/// the camera frame, metres, in front of the camera (z > 0).
using Place = std::variant<Pixel, Point3>;

/// A rope of the frame before: Estimate::nodes and Estimate::closed.
struct KnownRope {
  Centerline nodes{};
  bool closed = false;
};

/// All of it may be left out. Hints decide two things and no other: which way through the mask is
/// taken, and where it begins. `confidence` and `sigma_m` are what the frame alone says of that
/// way. Where hints say nothing, node 0 is the end of smaller x; of smaller y, then z, where those
/// are equal (the rule of the thesis, Sec. 3.3). That rule looks at the frame alone: where the ends
/// lie one above the other, noise exchanges them.
struct Hints {
  /// The end nearest to it is node 0: of `nodes`, and of each alternative. It says nothing of the
  /// way through the mask: a place that is an end belongs into `ends` as well.
  std::optional<Place> first_end{};

  /// Two at most. Evidence, not a rule: a way that ends elsewhere has to explain the frame that
  /// much better. With one, the other end is free.
  std::vector<Place> ends{};

  /// Of the whole rope, metres; 0: unknown. Takes the place of Config::rope_length_m.
  std::optional<double> rope_length_m{};

  /// Whether the rope is a ring without ends. Where nothing parts a ring in the image it is found
  /// to be one; where something passes over it, or it passes over itself, only this tells it from a
  /// rope whose two ends are hidden there or touch. True: ways that close are taken wherever there
  /// are any, and `ends` has to be empty. False: it has two ends, even where none shows.
  std::optional<bool> closed{};

  /// The nodes of the frame before, Estimate::nodes. The estimate keeps their order, and of ways
  /// that the frame does not tell apart the one near them is taken. One that lies elsewhere by some
  /// rope widths is no evidence, nor is one with a node that is not finite. `first_end` wins over
  /// the order. With the thesis' gate they keep the order and no more. A ring begins where it did,
  /// and runs that way round.
  std::optional<Centerline> previous{};
};

}  // namespace flowdlo
