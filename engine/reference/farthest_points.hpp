// Farthest-point sampling, Sec. 3.2: the twin that the GPU kernel must equal bit for bit.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace flowdlo::reference {

/// What sampling works in; kept from one call to the next it is allocated once.
struct FarthestPointsMemory {
  struct Position {
    float x;
    float y;
    float z;
  };
  /// Consecutive points that share a bounding box.
  struct Block {
    Position low;
    Position high;
    float farthest;  ///< largest distance of its points to the picks so far
  };

  /// For clouds of up to `points`.
  void reserve(std::size_t points);

  std::vector<float> x;
  std::vector<float> y;
  std::vector<float> z;
  std::vector<float> nearest;
  std::vector<Block> blocks;
};

/// Fills visible [256, 4]: x, y, z and validity (1 or 0) of the picks from the first `count` rows
/// of cloud_xyzw [P, 4], column 3 unused, coordinates finite. The first pick is the point farthest
/// from `centroid`, each later one the point farthest from all picks before it; ties go to the
/// lower index. Distances are ((dx*dx + dy*dy) + dz*dz) in f32, never contracted.
///
/// At most 256 points: all, in order, then repeated from the first with validity 0; none: zeros.
/// A cloud of more than 256 points with fewer than 256 distinct ones gives each of those once;
/// then every distance is 0, so that the remaining picks are all index 0, with validity 1.
void farthest_points(std::span<const float> cloud_xyzw, int count, const float centroid[3],
                     std::span<float> visible);
void farthest_points(std::span<const float> cloud_xyzw, int count, const float centroid[3],
                     std::span<float> visible, FarthestPointsMemory& memory);

}  // namespace flowdlo::reference
