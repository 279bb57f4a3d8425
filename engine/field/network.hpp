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
#include "threads/pool.hpp"
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

  /// From the first failure on, but for want of memory, programs are the spare's.
  void fall_back_on(ProgramFactory spare) { spare_ = std::move(spare); }

  /// Whether a program has failed and the spare makes them now.
  [[nodiscard]] bool on_spare() const { return on_spare_; }

  /// Gives the planes of a block, [kBlock_px, kBlock_px]; called from any thread.
  using PlanesOf = std::function<void(const image::Point& block, PlanesOfPixel* to)>;

  /// What the network says of blocks of a region of `size`, elsewhere nothing. Centre, tip, under,
  /// rope and edge lie between 0 and 1. `pool` as threads::share_out has it. Fails with
  /// kDeviceLost.
  [[nodiscard]] Result<Channels> see(const image::Size& size,
                                     std::shared_ptr<const BlockMap> blocks,
                                     const PlanesOf& planes_of, threads::Pool* pool = nullptr);
  [[nodiscard]] Result<Channels> see(const Planes& input, const BlockMap& blocks);

  /// What links the strands that it shows; null where its file has none.
  [[nodiscard]] std::shared_ptr<const weights::LinkWeights> links() const {
    return weights_->links
               ? std::shared_ptr<const weights::LinkWeights>(weights_, &*weights_->links)
               : nullptr;
  }

  /// Milliseconds of the last program that ran, by stage.
  [[nodiscard]] std::vector<std::pair<std::string, double>> stage_times_ms() const {
    return program_->stage_times_ms();
  }

 private:
  Network(std::shared_ptr<const weights::FieldWeights> weights, ProgramFactory make_program)
      : weights_(std::move(weights)), make_program_(std::move(make_program)) {}

  [[nodiscard]] Result<void> build(int capacity);
  /// What is looked at: all blocks, and what they are given and say.
  struct Look {
    const BlockMap& blocks;
    const PlanesOf& planes_of;
    threads::Pool* pool;
    Channels output;
  };

  /// The blocks of one run; what it says goes to the output for those that `keep` holds.
  [[nodiscard]] Result<void> run(Look& look, const BlockMap& blocks, const image::Rect& keep);
  [[nodiscard]] Result<void> run_once(Look& look, const BlockMap& blocks, const image::Rect& keep);
  [[nodiscard]] Result<void> run_parts(Look& look, const image::Rect& keep);

  std::shared_ptr<const weights::FieldWeights> weights_;
  ProgramFactory make_program_;
  ProgramFactory spare_;
  bool on_spare_ = false;
  std::unique_ptr<ops::Program> program_;
  int capacity_ = 0;
  ops::Tensor map_;
  ops::Tensor input_;
  ops::Tensor output_;
  std::vector<float> map_values_;
  std::vector<float> values_;
};

}  // namespace flowdlo::field
