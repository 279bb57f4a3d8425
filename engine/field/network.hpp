// Network: what the strand field's network makes of a region, on any back end.
#pragma once

#include <functional>
#include <memory>
#include <optional>

#include "field/block_map.hpp"
#include "field/channel.hpp"
#include "field/sight.hpp"
#include "flowdlo/result.hpp"
#include "ops/program.hpp"
#include "weights/field_weights.hpp"

namespace flowdlo::field {

using ProgramFactory = std::function<std::unique_ptr<ops::Program>()>;

/// Blocks that are computed in one run. A larger region is computed in parts that overlap, so that
/// memory has a bound: 0.3 MB a block, of every layer's activations.
inline constexpr int kMostBlocks = 256;

class Network {
 public:
  /// Builds a program for a few blocks; a region of more makes it grow once. Fails as
  /// ops::Program::build does.
  [[nodiscard]] static Result<Network> create(std::shared_ptr<const weights::FieldWeights> weights,
                                              ProgramFactory make_program);

  /// What the network says of an input within `blocks`, elsewhere no rope. Centre, tip, under, rope
  /// and edge lie between 0 and 1. Fails with kDeviceLost.
  [[nodiscard]] Result<Channels> see(const Planes& input, const BlockMap& blocks);

  /// Milliseconds of the last program that ran, by stage.
  [[nodiscard]] std::vector<std::pair<std::string, double>> stage_times_ms() const {
    return program_->stage_times_ms();
  }

 private:
  Network(std::shared_ptr<const weights::FieldWeights> weights, ProgramFactory make_program)
      : weights_(std::move(weights)), make_program_(std::move(make_program)) {}

  [[nodiscard]] Result<void> build(int capacity);
  /// The blocks of one run; what it says goes to `output` for those that `keep` holds.
  [[nodiscard]] Result<void> run(const Planes& input, const BlockMap& blocks,
                                 const image::Rect& keep, Channels& output);
  [[nodiscard]] Result<void> run_parts(const Planes& input, const BlockMap& blocks,
                                       const image::Rect& keep, Channels& output);

  std::shared_ptr<const weights::FieldWeights> weights_;
  ProgramFactory make_program_;
  std::unique_ptr<ops::Program> program_;
  int capacity_ = 0;
  ops::Tensor map_;
  ops::Tensor input_;
  ops::Tensor output_;
  std::vector<float> map_values_;
  std::vector<float> values_;
};

}  // namespace flowdlo::field
