#include "reference/program.hpp"

#include <algorithm>
#include <cassert>
#include <cstring>

#include "reference/aligned_floats.hpp"
#include "reference/block_image.hpp"
#include "reference/convolution.hpp"
#include "reference/farthest_points.hpp"
#include "reference/flow_step.hpp"
#include "reference/kernels.hpp"
#include "reference/layer.hpp"
#include "reference/mask_features.hpp"
#include "reference/normalization.hpp"
#include "reference/schedule.hpp"

namespace flowdlo::reference {
namespace {

constexpr int kBlockRows = ops::kRowsPerDraw;
constexpr int kRowParts = 4;  // of a block's rows, where an operation goes row by row
constexpr int kOwnBlock = 4;  // column of an image's map

std::ptrdiff_t floats(int rows, int columns) {
  return static_cast<std::ptrdiff_t>(rows) * static_cast<std::ptrdiff_t>(columns);
}

/// Rows of a piece whose parts are rows.
struct Rows {
  explicit Rows(const Piece& piece)
      : count(piece.blocks * kBlockRows / piece.parts),
        first(piece.block * kBlockRows + piece.part * count) {}
  int count;
  int first;
};

class Program final : public ops::Program {
 public:
  Program(int threads, const Kernels& kernels) : crew_(threads), kernels_(kernels) {}

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
    std::copy(values.begin(), values.end(), tensors_[tensor.id].data());
    return tensor;
  }
  ops::LinearLayer layer(std::string_view name, int out, int in, std::span<const float> weight,
                         std::span<const float> bias) override;

  ops::ConvolutionLayer convolution(std::string_view name, int out, int taps, int in,
                                    std::span<const float> weight,
                                    std::span<const float> bias) override;

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
  void record(const ops::Convolution& op) override;
  void record(const ops::MaxPool& op) override;
  void record(const ops::AddUpsampled& op) override;
  void record(const ops::Copy& op) override;
  void stage(std::string_view name) override { schedule_.stage(name); }

  bool host_samples_points() const override { return true; }  // this is the host

  Result<void> build() override {
    schedule_.settle(crew_);
    return {};
  }
  void write(ops::Tensor input, std::span<const float> values) override {
    assert(values.size() <= tensors_[input.id].size());
    std::copy(values.begin(), values.end(), tensors_[input.id].data());
  }
  Result<void> run() override {
    schedule_.run(crew_);
    return {};
  }
  void read(ops::Tensor output, std::span<float> values) const override {
    assert(values.size() <= tensors_[output.id].size());
    std::copy_n(tensors_[output.id].data(), values.size(), values.begin());
  }
  std::vector<std::pair<std::string, double>> stage_times_ms() const override {
    return schedule_.times_ms();
  }

 private:
  ops::Tensor allocate(int rows, int columns) {
    tensors_.emplace_back(static_cast<std::size_t>(floats(rows, columns)));
    return {static_cast<std::uint32_t>(tensors_.size() - 1), rows, columns};
  }
  // A tensor's memory never moves; ids stay valid while the vector grows.
  float* data(ops::Tensor tensor) { return tensors_[tensor.id].data(); }
  std::span<float> span(ops::Tensor tensor) { return tensors_[tensor.id].span(); }
  /// The piece's rows of a tensor.
  std::span<float> span(ops::Tensor tensor, const Rows& rows) {
    return span(tensor).subspan(static_cast<std::size_t>(floats(rows.first, tensor.columns)),
                                static_cast<std::size_t>(floats(rows.count, tensor.columns)));
  }
  AddendBlock addend(const std::optional<ops::Addend>& addend) {
    if (!addend) return {};
    return {data(addend->table), addend->period, addend->offset};
  }
  /// A step on the blocks of an image that are in use: work(the first, how many), at most
  /// `together` of them at once.
  void add_image(ops::Tensor map, ops::Tensor writes, std::vector<std::uint32_t> reads_beyond,
                 int together, std::function<void(int, int)> work) {
    reads_beyond.push_back(map.id);
    const auto groups = [this, map, together, work = std::move(work)](const Piece& piece) {
      for (int group = piece.block; group < piece.block + piece.blocks; ++group) {
        const int first = group * together;
        int blocks = std::min(together, map.rows - first);
        while (blocks > 0 && data(map)[floats(first + blocks - 1, map.columns) + kOwnBlock] < 0) {
          --blocks;  // those that are not in use come last
        }
        if (blocks > 0) work(first, blocks);
      }
    };
    schedule_.add({.blocks = (map.rows + together - 1) / together,
                   .work = groups,
                   .reads_beyond = std::move(reads_beyond),
                   .writes = writes.id});
  }
  /// A step on the whole of its tensors.
  void add_whole(ops::Tensor writes, std::function<void()> work) {
    schedule_.add({.work = [work = std::move(work)](const Piece&) { work(); },
                   .reads_beyond = {},
                   .writes = writes.id});
  }

  Crew crew_;
  Kernels kernels_;
  std::vector<AlignedFloats> tensors_;
  std::vector<Layer> layers_;
  FarthestPointsMemory farthest_points_;
  Schedule schedule_;
};

ops::LinearLayer Program::layer(std::string_view, int out, int in, std::span<const float> weight,
                                std::span<const float> bias) {
  layers_.push_back(linear_layer(kernels_, out, in, weight, bias));
  return {static_cast<std::uint32_t>(layers_.size() - 1), in, out};
}

ops::ConvolutionLayer Program::convolution(std::string_view, int out, int taps, int in,
                                           std::span<const float> weight,
                                           std::span<const float> bias) {
  Layer layer{convolution_weight(kernels_, out, taps, in, weight), AlignedFloats(bias.size())};
  std::copy(bias.begin(), bias.end(), layer.bias.data());
  layers_.push_back(std::move(layer));
  return {static_cast<std::uint32_t>(layers_.size() - 1), in, out, taps};
}

void Program::record(const ops::Linear& op) {
  assert(op.layer.in == ops::kWidth || op.layer.in == 4 * ops::kWidth);
  const auto work = [this, op](const Piece& piece) {
    const Layer& layer = layers_[op.layer.id];
    const int row = piece.block * kBlockRows;
    const int columns = op.layer.out / piece.parts;
    kernels_.linear(
        {.x = data(op.x) + floats(row, op.layer.in),
         .panels = layer.weight.data(),
         .bias = layer.bias.data(),
         .residual = op.residual ? data(*op.residual) + floats(row, op.layer.out) : nullptr,
         .y = data(op.y) + floats(row, op.layer.out),
         .rows = piece.blocks * kBlockRows,
         .in = op.layer.in,
         .out = op.layer.out,
         .column = piece.part * columns,
         .columns = columns,
         .activation = op.activation,
         .half_panels = layer.halves.data()});
  };
  schedule_.add({.blocks = op.x.rows / kBlockRows,
                 .parts = op.layer.out / kPartColumns,
                 .work = work,
                 .reads_beyond = {},
                 .writes = op.y.id});
}

void Program::record(const ops::Narrow& op) {
  std::vector<std::uint32_t> tables;
  for (const auto& addend : {op.first, op.second}) {
    const bool own_row = addend && addend->offset == 0 && addend->period >= op.x.rows;
    if (addend && !own_row) tables.push_back(addend->table.id);
  }
  const auto work = [this, op](const Piece& piece) {
    const Layer& layer = layers_[op.layer.id];
    const Rows rows(piece);
    kernels_.narrow({.x = data(op.x) + floats(rows.first, op.x.columns),
                     .columns = layer.weight.data(),
                     .bias = layer.bias.data(),
                     .y = data(op.y) + floats(rows.first, op.layer.out),
                     .first = addend(op.first),
                     .second = addend(op.second),
                     .row = rows.first,
                     .rows = rows.count,
                     .x_columns = op.x.columns,
                     .in = op.layer.in,
                     .out = op.layer.out,
                     .activation = op.activation});
  };
  schedule_.add({.blocks = op.x.rows / kBlockRows,
                 .parts = kRowParts,
                 .work = work,
                 .reads_beyond = std::move(tables),
                 .writes = op.y.id});
}

void Program::record(const ops::LayerNorm& op) {
  const auto work = [this, op](const Piece& piece) {
    const Rows rows(piece);
    const std::ptrdiff_t offset = floats(rows.first, ops::kWidth);
    kernels_.layer_norm({.x = data(op.x) + offset,
                         .gain = data(op.gain),
                         .shift = data(op.shift),
                         .y = data(op.y) + offset,
                         .rows = rows.count});
  };
  schedule_.add({.blocks = op.x.rows / kBlockRows,
                 .parts = kRowParts,
                 .work = work,
                 .reads_beyond = {op.gain.id, op.shift.id},
                 .writes = op.y.id});
}

void Program::record(const ops::Attention& op) {
  const auto head_of = [this, op](int block, int head) {
    const int row = block * kBlockRows;
    const int channel = head * ops::kHeadWidth;
    const float* memory =
        data(op.key_value) + (op.per_draw ? floats(row, op.key_value.columns) : 0);
    kernels_.attention(
        {.query = data(op.query) + floats(row, op.query.columns) + op.query_column + channel,
         .key = memory + op.key_column + channel,
         .value = memory + op.value_column + channel,
         .key_valid = op.key_valid ? data(*op.key_valid) : nullptr,
         .out = data(op.out) + floats(row, ops::kWidth) + channel,
         .query_stride = op.query.columns,
         .key_value_stride = op.key_value.columns,
         .out_stride = ops::kWidth,
         .keys = op.per_draw ? ops::kRowsPerDraw : op.key_value.rows});
  };
  const auto work = [head_of](const Piece& piece) {
    const int heads = ops::kHeads / piece.parts;
    for (int block = piece.block; block < piece.block + piece.blocks; ++block) {
      for (int head = 0; head < heads; ++head) head_of(block, piece.part * heads + head);
    }
  };
  std::vector<std::uint32_t> beyond;
  if (!op.per_draw) beyond.push_back(op.key_value.id);
  if (op.key_valid) beyond.push_back(op.key_valid->id);
  schedule_.add({.blocks = op.query.rows / kBlockRows,
                 .parts = ops::kHeads,
                 .work = work,
                 .reads_beyond = std::move(beyond),
                 .writes = op.out.id});
}

void Program::record(const ops::FarthestPoints& op) {
  farthest_points_.reserve(static_cast<std::size_t>(op.cloud.rows));
  add_whole(op.visible, [this, op] {
    ops::FrameParams params;
    std::memcpy(&params, data(op.params), sizeof(params));
    const float centroid[3] = {params.centroid_x, params.centroid_y, params.centroid_z};
    farthest_points(span(op.cloud), static_cast<int>(params.point_count), centroid,
                    span(op.visible), farthest_points_);
  });
}

void Program::record(const ops::FrameNormalization& op) {
  add_whole(op.norm, [this, op] { frame_normalization(span(op.points), span(op.norm)); });
}

void Program::record(const ops::Normalize& op) {
  add_whole(op.out, [this, op] { normalize(span(op.points), span(op.norm), span(op.out)); });
}

void Program::record(const ops::Denormalize& op) {
  add_whole(op.out, [this, op] { denormalize(span(op.state), span(op.norm), span(op.out)); });
}

void Program::record(const ops::MaskFeatures& op) {
  const auto work = [this, op](const Piece& piece) {
    ops::FrameParams params;
    std::memcpy(&params, data(op.params), sizeof(params));
    const Rows rows(piece);
    mask_features(span(op.state, rows), span(op.norm), params, span(op.field),
                  op.depth ? span(*op.depth) : std::span<float>{}, span(op.out, rows));
  };
  schedule_.add({.blocks = op.state.rows / kBlockRows,
                 .parts = kRowParts,
                 .work = work,
                 .reads_beyond = {op.norm.id, op.params.id, op.field.id},
                 .writes = op.out.id});
}

void Program::record(const ops::FlowStep& op) {
  const auto work = [this, op](const Piece& piece) {
    const Layer& head = layers_[op.head.id];
    const Rows rows(piece);
    flow_step(op, span(op.hidden, rows), head.weight.span(), head.bias.span(), span(op.prior, rows),
              span(op.state, rows));
  };
  schedule_.add({.blocks = op.state.rows / kBlockRows,
                 .parts = kRowParts,
                 .work = work,
                 .reads_beyond = {},
                 .writes = op.state.id});
}

void Program::record(const ops::Convolution& op) {
  std::vector<std::uint32_t> beyond;
  if (op.layer.taps > 1) beyond.push_back(op.x.id);
  add_image(
      op.map, op.y, std::move(beyond), blocks_together(op), [this, op](int first, int blocks) {
        const Layer& layer = layers_[op.layer.id];
        convolve(kernels_, op,
                 {data(op.x), data(op.map), layer.weight.data(), layer.bias.data(), data(op.y)},
                 first, blocks);
      });
}

void Program::record(const ops::MaxPool& op) {
  add_image(op.map, op.y, {}, 1, [this, op](int block, int) {
    const int places = op.side * op.side;
    max_pool(data(op.x) + floats(block * places, op.x.columns), op.side, op.x.columns,
             data(op.y) + floats(block * places / 4, op.x.columns));
  });
}

void Program::record(const ops::AddUpsampled& op) {
  add_image(op.map, op.y, {}, 1, [this, op](int block, int) {
    const int places = op.side * op.side;
    add_upsampled(data(op.x) + floats(block * places / 4, op.x.columns), op.side, op.x.columns,
                  data(op.y) + floats(block * places, op.x.columns));
  });
}

void Program::record(const ops::Copy& op) {
  add_whole(op.to, [this, op] { std::copy_n(data(op.from), span(op.from).size(), data(op.to)); });
}

}  // namespace

std::unique_ptr<ops::Program> create_program(int threads) {
  return create_program(threads, kernels_of_this_cpu().front());
}

std::unique_ptr<ops::Program> create_program(int threads, const Kernels& kernels) {
  return std::make_unique<Program>(threads, kernels);
}

}  // namespace flowdlo::reference
