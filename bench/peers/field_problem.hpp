// FieldProblem: a region as the strand field's network is given it, and what a peer is.
#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "field/block_map.hpp"
#include "field/sight.hpp"
#include "flowdlo/result.hpp"
#include "weights/field_weights.hpp"

namespace flowdlo::peers {

/// Planes of a region, whole blocks of them.
struct FieldProblem {
  std::shared_ptr<const weights::FieldWeights> weights;
  field::Planes input;
  field::BlockMap blocks;     ///< that FlowDLO computes
  std::vector<float> planes;  ///< the input once more, [kPlanes, height, width]
  int threads = 1;

  [[nodiscard]] int width() const { return input.width(); }
  [[nodiscard]] int height() const { return input.height(); }
};

/// The region of the frame in a folder, with the blocks near its mask. Fails as load_frame_folder
/// and path::trace do.
[[nodiscard]] Result<FieldProblem> region_problem(std::shared_ptr<const weights::FieldWeights> of,
                                                  const std::filesystem::path& frame, int threads);

/// The middle of that region, `side` pixels each way, with all of its blocks.
[[nodiscard]] FieldProblem dense_problem(const FieldProblem& region, int side);

/// One way to do it.
class FieldPeer {
 public:
  virtual ~FieldPeer() = default;
  [[nodiscard]] virtual std::string name() const = 0;
  /// [kChannels, height, width] as field::Network::see has them, or where `said` is null only
  /// computed.
  virtual void see(std::vector<float>* said) = 0;
};

}  // namespace flowdlo::peers
