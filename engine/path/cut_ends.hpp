// Cut ends: where a cut between two strands that lie beside each other may begin and end.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "path/graph.hpp"
#include "path/stations.hpp"

namespace flowdlo::path {

/// Borrows the graph and the mask it is of. `width_px` is one strand's where the rope usually is.
class CutEnds {
 public:
  CutEnds(const Graph& graph, const image::Mask& mask, float width_px)
      : graph_(graph), mask_(mask), size_px_(width_px) {}

  /// Ends the cut `points` at its back, near side `side` of `segment`, where the strands part: at
  /// the mask's edge between them, or beside the step where one stops, or midway between the
  /// branches of the fork there, or, where both turn into each other, a width short of the tip.
  /// False when none of these is near. `after` is what follows on the segment's line.
  [[nodiscard]] bool find(std::vector<Eigen::Vector2f>& points, const Segment& segment, int side,
                          const Line& after) const;

  /// Where the line goes on as one strand, soon and for long enough; null where it does not.
  [[nodiscard]] const Station* step(const Line& after, float width_px) const;

  /// How many stations beyond a stretch `find` and `step` look at, at most.
  [[nodiscard]] int looks_px() const;

  bool turns = true;   ///< whether a strand may turn back at a round tip
  bool clear = false;  ///< whether the stretch is too wide for one strand whatever its noise

 private:
  using Points = std::vector<Eigen::Vector2f>;

  [[nodiscard]] bool single(const Station& station) const;
  [[nodiscard]] bool beside_step(Points& points, const Line& after, const Station& station,
                                 const Eigen::Vector2f& direction, float width_px) const;
  [[nodiscard]] bool at_edge(Points& points, const Line& after, bool tip) const;
  [[nodiscard]] bool between_branches(Points& points, const Segment& segment, int side) const;
  [[nodiscard]] const Eigen::Vector2f* along_branch(int end, std::size_t i) const;
  [[nodiscard]] float aside_at(const Points& points, const Line& after, const Station& station,
                               const Eigen::Vector2f& left, float width_px) const;
  [[nodiscard]] bool round(const Eigen::Vector2f& edge, const Eigen::Vector2f& direction,
                           float width_px) const;

  const Graph& graph_;
  const image::Mask& mask_;
  float size_px_;
};

}  // namespace flowdlo::path
