#include "reference/program.hpp"

#include <oneapi/tbb/parallel_for.h>
#include <oneapi/tbb/task_arena.h>

#include <algorithm>
#include <cassert>
#include <chrono>
#include <cstring>
#include <functional>

#include "reference/farthest_points.hpp"
#include "reference/flow_step.hpp"
#include "reference/kernels.hpp"
#include "reference/mask_features.hpp"
#include "reference/normalization.hpp"

namespace flowdlo::reference {
namespace {

constexpr int kBlockRows = ops::kRowsPerDraw;
constexpr int kBlockColumns = 128;  // of a linear layer's result

struct Layer {
  std::vector<float> weight;  // [out, in]
  std::vector<float> bias;
};

class Program final : public ops::Program {
 public:
  explicit Program(int threads)
      : arena_(threads > 0 ? threads : tbb::task_arena::automatic),
        kernels_(kernels_of_this_cpu()) {}

  ops::Tensor input(std::string_view, int rows, int columns) override {
    return allocate(rows, columns);
  }
  ops::Tensor output(std::string_view, int rows, int columns) override {
    return allocate(rows, columns);
  }
  ops::Tensor scratch(std::string_view, int rows, int columns) override {
    return allocate(rows, columns);
  }
  ops::Tensor constant(std::string_view, int rows, int columns,
                       std::span<const float> values) override {
    const ops::Tensor tensor = allocate(rows, columns);
    assert(values.size() == tensors_[tensor.id].size());
    std::copy(values.begin(), values.end(), tensors_[tensor.id].begin());
    return tensor;
  }
  ops::LinearLayer layer(std::string_view, int out, int in, std::span<const float> weight,
                         std::span<const float> bias) override {
    layers_.push_back({{weight.begin(), weight.end()}, {bias.begin(), bias.end()}});
    return {static_cast<std::uint32_t>(layers_.size() - 1), in, out};
  }

  void record(const ops::Linear& op) override;
  void record(const ops::Narrow& op) override;
  void record(const ops::LayerNorm& op) override;
  void record(const ops::Attention& op) override;
  void record(const ops::FarthestPoints& op) override;
  void record(const ops::FrameNormalization& op) override;
  void record(const ops::Normalize& op) override;
  void record(const ops::Denormalize& op) override;
  void record(const ops::MaskFeatures& op) override;
  void record(const ops::FlowStep& op) override;
  void record(const ops::Copy& op) override;
  void stage(std::string_view name) override;

  Result<void> build() override { return {}; }
  void write(ops::Tensor input, std::span<const float> values) override {
    assert(values.size() <= tensors_[input.id].size());
    std::copy(values.begin(), values.end(), tensors_[input.id].begin());
  }
  Result<void> run() override;
  void read(ops::Tensor output, std::span<float> values) const override {
    assert(values.size() <= tensors_[output.id].size());
    std::copy_n(tensors_[output.id].begin(), values.size(), values.begin());
  }
  std::vector<std::pair<std::string, double>> stage_times_ms() const override {
    return stage_times_ms_;
  }

 private:
  struct Step {
    std::size_t stage;
    std::function<void()> work;
  };

  ops::Tensor allocate(int rows, int columns) {
    tensors_.emplace_back(static_cast<std::size_t>(rows) * static_cast<std::size_t>(columns), 0.0F);
    return {static_cast<std::uint32_t>(tensors_.size() - 1), rows, columns};
  }
  // Tensors never move once recording has begun to run; ids stay valid while the vector grows.
  float* data(ops::Tensor tensor) { return tensors_[tensor.id].data(); }
  std::span<float> span(ops::Tensor tensor) { return tensors_[tensor.id]; }
  void add(std::function<void()> work) { steps_.push_back({stage_, std::move(work)}); }

  /// work(block) for every block, on the arena's threads.
  template <class Work>
  void for_blocks(int blocks, const Work& work) {
    tbb::parallel_for(0, blocks, work, tbb::simple_partitioner());
  }

  tbb::task_arena arena_;
  Kernels kernels_;
  std::vector<std::vector<float>> tensors_;
  std::vector<Layer> layers_;
  std::vector<Step> steps_;
  std::size_t stage_ = 0;
  std::vector<std::pair<std::string, double>> stage_times_ms_;
};

void Program::record(const ops::Linear& op) {
  add([this, op] {
    const Layer& layer = layers_[op.layer.id];
    const int column_blocks = op.layer.out / kBlockColumns;
    for_blocks(op.x.rows / kBlockRows * column_blocks, [&](int block) {
      const std::ptrdiff_t row = block / column_blocks * kBlockRows;
      kernels_.linear({.x = data(op.x) + row * op.layer.in,
                       .weight = layer.weight.data(),
                       .bias = layer.bias.data(),
                       .residual = op.residual ? data(*op.residual) + row * op.layer.out : nullptr,
                       .y = data(op.y) + row * op.layer.out,
                       .rows = kBlockRows,
                       .in = op.layer.in,
                       .out = op.layer.out,
                       .column = block % column_blocks * kBlockColumns,
                       .columns = kBlockColumns,
                       .activation = op.activation});
    });
  });
}

void Program::record(const ops::Narrow& op) {
  add([this, op] {
    const Layer& layer = layers_[op.layer.id];
    for_blocks(op.x.rows / kBlockRows, [&](int block) {
      const std::ptrdiff_t first_row = static_cast<std::ptrdiff_t>(block) * kBlockRows;
      float* y = data(op.y) + first_row * op.layer.out;
      kernels_.narrow({.x = data(op.x) + first_row * op.x.columns,
                       .weight = layer.weight.data(),
                       .bias = layer.bias.data(),
                       .y = y,
                       .rows = kBlockRows,
                       .x_columns = op.x.columns,
                       .in = op.layer.in,
                       .out = op.layer.out,
                       .activation = op.activation});
      for (const auto& addend : {op.first, op.second}) {
        if (!addend) continue;
        for (int row = 0; row < kBlockRows; ++row) {
          const auto table_row = (first_row + row) % addend->period + addend->offset;
          const float* added = data(addend->table) + table_row * op.layer.out;
          for (int i = 0; i < op.layer.out; ++i) y[row * op.layer.out + i] += added[i];
        }
      }
    });
  });
}

void Program::record(const ops::LayerNorm& op) {
  add([this, op] {
    for_blocks(op.x.rows / kBlockRows, [&](int block) {
      const std::ptrdiff_t offset = static_cast<std::ptrdiff_t>(block) * kBlockRows * ops::kWidth;
      kernels_.layer_norm({.x = data(op.x) + offset,
                           .gain = data(op.gain),
                           .shift = data(op.shift),
                           .y = data(op.y) + offset,
                           .rows = kBlockRows});
    });
  });
}

void Program::record(const ops::Attention& op) {
  add([this, op] {
    for_blocks(op.query.rows / kBlockRows * ops::kHeads, [&](int block) {
      const std::ptrdiff_t row = block / ops::kHeads * kBlockRows;
      const int channel = block % ops::kHeads * ops::kHeadWidth;
      const float* memory = data(op.key_value) + (op.per_draw ? row * op.key_value.columns : 0);
      kernels_.attention(
          {.query = data(op.query) + row * op.query.columns + op.query_column + channel,
           .key = memory + op.key_column + channel,
           .value = memory + op.value_column + channel,
           .key_valid = op.key_valid ? data(*op.key_valid) : nullptr,
           .out = data(op.out) + row * ops::kWidth + channel,
           .query_stride = op.query.columns,
           .key_value_stride = op.key_value.columns,
           .out_stride = ops::kWidth,
           .keys = op.per_draw ? ops::kRowsPerDraw : op.key_value.rows});
    });
  });
}

void Program::record(const ops::FarthestPoints& op) {
  add([this, op] {
    ops::FrameParams params;
    std::memcpy(&params, data(op.params), sizeof(params));
    const float centroid[3] = {params.centroid_x, params.centroid_y, params.centroid_z};
    farthest_points(span(op.cloud), static_cast<int>(params.point_count), centroid,
                    span(op.visible));
  });
}

void Program::record(const ops::FrameNormalization& op) {
  add([this, op] { frame_normalization(span(op.points), span(op.norm)); });
}

void Program::record(const ops::Normalize& op) {
  add([this, op] { normalize(span(op.points), span(op.norm), span(op.out)); });
}

void Program::record(const ops::Denormalize& op) {
  add([this, op] { denormalize(span(op.state), span(op.norm), span(op.out)); });
}

void Program::record(const ops::MaskFeatures& op) {
  add([this, op] {
    ops::FrameParams params;
    std::memcpy(&params, data(op.params), sizeof(params));
    mask_features(span(op.state), span(op.norm), params, span(op.field),
                  op.depth ? span(*op.depth) : std::span<float>{}, span(op.out));
  });
}

void Program::record(const ops::FlowStep& op) {
  add([this, op] {
    const Layer& head = layers_[op.head.id];
    flow_step(op, span(op.hidden), head.weight, head.bias, span(op.prior), span(op.state));
  });
}

void Program::record(const ops::Copy& op) {
  add([this, op] { std::copy_n(data(op.from), span(op.from).size(), data(op.to)); });
}

void Program::stage(std::string_view name) {
  const auto found = std::find_if(stage_times_ms_.begin(), stage_times_ms_.end(),
                                  [&](const auto& entry) { return entry.first == name; });
  stage_ = static_cast<std::size_t>(found - stage_times_ms_.begin());
  if (found == stage_times_ms_.end()) stage_times_ms_.emplace_back(name, 0.0);
}

Result<void> Program::run() {
  using Clock = std::chrono::steady_clock;
  for (auto& entry : stage_times_ms_) entry.second = 0;
  arena_.execute([this] {
    for (const Step& step : steps_) {
      const auto begin = Clock::now();
      step.work();
      if (step.stage < stage_times_ms_.size()) {
        stage_times_ms_[step.stage].second +=
            std::chrono::duration<double, std::milli>(Clock::now() - begin).count();
      }
    }
  });
  return {};
}

}  // namespace

std::unique_ptr<ops::Program> create_program(int threads) {
  return std::make_unique<Program>(threads);
}

}  // namespace flowdlo::reference
