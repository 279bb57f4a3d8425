#include "field/network.hpp"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

namespace flowdlo::field {
namespace {

constexpr int kFirstCapacity = 64;  // blocks; a rope across 640 x 480 px has about that many
constexpr int kMapColumns = 12;     // of ops::Convolution's map
constexpr int kPlaces = kBlockSide * kBlockSide;
constexpr int kPixelsOfPlace = kFold * kFold;
// Layers look 2 + 4 + 12 + 4 + 2 places far all together: what lies two blocks away changes
// rounding alone.
constexpr int kHalo = 2;

static_assert(kPixelsOfPlace * kPlanes <= weights::kFieldInputs);
static_assert(kPixelsOfPlace * kChannels <= weights::kFieldOutputs);

/// Declares and records the layers: a U-Net of three levels.
class Recorder {
 public:
  Recorder(ops::Program& program, const weights::FieldWeights& weights, ops::Tensor map)
      : program_(program), weights_(weights), map_(map) {}

  ops::Tensor convolve(const std::string& name, ops::Tensor x, int side, bool relu,
                       std::optional<ops::Tensor> into = std::nullopt) {
    const weights::Tensor& weight = weights_.at(name + ".weight");
    const weights::Tensor& bias = weights_.at(name + ".bias");
    const int out = weight.shape[0];
    const auto layer = program_.convolution(name, out, weight.shape[1], weight.shape[2],
                                            weight.values, bias.values);
    const ops::Tensor y = into ? *into : scratch(name, side, out);
    program_.record(ops::Convolution{x, map_, layer, y, side, relu});
    return y;
  }
  ops::Tensor square(const std::string& name, ops::Tensor x, int side) {
    return convolve(name, x, side, true);
  }
  ops::Tensor pool(const std::string& name, ops::Tensor x, int side) {
    const ops::Tensor y = scratch(name, side / 2, x.columns);
    program_.record(ops::MaxPool{x, map_, y, side});
    return y;
  }
  void add(ops::Tensor coarse, ops::Tensor fine, int side) {
    program_.record(ops::AddUpsampled{coarse, map_, fine, side});
  }

 private:
  ops::Tensor scratch(const std::string& name, int side, int columns) {
    return program_.scratch(name, map_.rows * side * side, columns);
  }

  ops::Program& program_;
  const weights::FieldWeights& weights_;
  ops::Tensor map_;
};

float likely(float logit) { return 1 / (1 + std::exp(-logit)); }

/// What a block's places say, pixel by pixel.
void put(const float* places, std::array<float, kChannels>* output) {
  for (int y = 0; y < kBlock_px; ++y) {
    for (int x = 0; x < kBlock_px; ++x) {
      auto& to = output[y * kBlock_px + x];
      const float* from = places + (y / kFold * kBlockSide + x / kFold) * weights::kFieldOutputs +
                          y % kFold * kFold + x % kFold;
      for (int c = 0; c < kChannels; ++c) to[c] = from[c * kPixelsOfPlace];
      for (const int c : {kCentre, kTip, kUnder, kRope, kEdge}) to[c] = likely(to[c]);
    }
  }
}

/// What a block's places are given: the planes of 2 x 2 pixels each, and 0 in what is left over.
void take(const PlanesOfPixel* input, float* places) {
  for (int place = 0; place < kPlaces; ++place) {
    const auto* const corner =
        input + kFold * (place / kBlockSide * kBlock_px + place % kBlockSide);
    float* const to = places + place * weights::kFieldInputs;
    for (int i = 0; i < kPixelsOfPlace; ++i) {
      const auto& from = corner[i / kFold * kBlock_px + i % kFold];
      for (int c = 0; c < kPlanes; ++c) to[c * kPixelsOfPlace + i] = from[c];
    }
    std::fill(to + kPlanes * kPixelsOfPlace, to + weights::kFieldInputs, 0.0F);
  }
}

}  // namespace

Result<void> Network::build(int capacity) {
  auto program = make_program_();
  const int side = kBlockSide;
  map_ = program->input("field map", capacity, kMapColumns);
  input_ = program->input("field input", capacity * kPlaces, weights::kFieldInputs);
  output_ = program->output("field output", capacity * kPlaces, weights::kFieldOutputs);
  Recorder record(*program, *weights_, map_);
  program->stage("field");
  const auto fine = record.square("down_fine.1", record.square("down_fine.0", input_, side), side);
  const auto middle_in = record.pool("middle_in", fine, side);
  const auto middle =
      record.square("down_middle.1", record.square("down_middle.0", middle_in, side / 2), side / 2);
  auto coarse = record.pool("coarse_in", middle, side / 2);
  for (const char* name : {"coarse.0", "coarse.1", "coarse.2"}) {
    coarse = record.square(name, coarse, side / 4);
  }
  record.add(record.convolve("to_middle", coarse, side / 4, false), middle, side / 2);
  const auto half =
      record.square("up_middle.1", record.square("up_middle.0", middle, side / 2), side / 2);
  record.add(record.convolve("to_fine", half, side / 2, false), fine, side);
  const auto whole = record.square("up_fine.1", record.square("up_fine.0", fine, side), side);
  record.convolve("head", whole, side, false, output_);
  if (auto built = program->build(); !built) return built;
  program_ = std::move(program);
  capacity_ = capacity;
  const auto floats = [&](int columns) {
    return static_cast<std::size_t>(capacity) * static_cast<std::size_t>(columns);
  };
  map_values_.resize(floats(kMapColumns));
  values_.resize(floats(kPlaces * std::max(weights::kFieldInputs, weights::kFieldOutputs)));
  return {};
}

Result<Network> Network::create(std::shared_ptr<const weights::FieldWeights> weights,
                                ProgramFactory make_program) {
  Network network(std::move(weights), std::move(make_program));
  if (auto built = network.build(kFirstCapacity); !built) return built.error();
  return network;
}

Result<void> Network::run(Look& look, const BlockMap& blocks, const image::Rect& keep) {
  auto done = run_once(look, blocks, keep);
  if (done || !spare_ || done.error().code == ErrorCode::kOutOfMemory) return done;
  make_program_ = std::exchange(spare_, {});
  on_spare_ = true;
  if (auto built = build(std::max(capacity_, kFirstCapacity)); !built) return built;
  return run_once(look, blocks, keep);
}

Result<void> Network::run_once(Look& look, const BlockMap& blocks, const image::Rect& keep) {
  const auto count = static_cast<int>(blocks.blocks.size());
  if (count > capacity_) {
    int capacity = capacity_;
    while (capacity < count) capacity *= 2;
    if (auto built = build(capacity); !built) return built;
  }
  std::fill(map_values_.begin(), map_values_.end(), 0.0F);
  for (int i = 0; i < capacity_; ++i) {
    float* const row = map_values_.data() + static_cast<std::ptrdiff_t>(i) * kMapColumns;
    if (i >= count) {
      std::fill(row, row + 9, -1.0F);
      continue;
    }
    const auto around = blocks.around(static_cast<std::size_t>(i));
    std::copy(around.begin(), around.end(), row);
  }
  program_->write(map_, map_values_);
  const auto used = [&](int columns) {
    return std::span(values_).first(static_cast<std::size_t>(count * kPlaces * columns));
  };
  const auto in = used(weights::kFieldInputs);
  threads::share_out(look.pool, count, [&](int i) {
    std::array<PlanesOfPixel, kBlock_px * kBlock_px> planes;  // all of them are given
    look.planes_of(blocks.blocks[static_cast<std::size_t>(i)], planes.data());
    take(planes.data(),
         in.data() + static_cast<std::ptrdiff_t>(i) * kPlaces * weights::kFieldInputs);
  });
  program_->write(input_, in);
  if (auto done = program_->run(); !done) return done;
  const auto out = used(weights::kFieldOutputs);
  program_->read(output_, out);
  threads::share_out(look.pool, count, [&](int i) {
    const image::Point& block = blocks.blocks[static_cast<std::size_t>(i)];
    if (!keep.contains(block)) return;
    const int to = look.blocks.number_of(block);
    put(out.data() + static_cast<std::ptrdiff_t>(i) * kPlaces * weights::kFieldOutputs,
        look.output.block(static_cast<std::size_t>(to)));
  });
  return {};
}

Result<void> Network::run_parts(Look& look, const image::Rect& keep) {
  const BlockMap part = cut(look.blocks, image::grown(keep, kHalo));
  const bool whole = part.blocks.size() <= static_cast<std::size_t>(kMostBlocks);
  if (whole) return part.blocks.empty() ? Result<void>{} : run(look, part, keep);
  image::Rect first = keep;
  image::Rect second = keep;
  if (keep.width >= keep.height) {
    first.width /= 2;
    second.x += first.width;
    second.width -= first.width;
  } else {
    first.height /= 2;
    second.y += first.height;
    second.height -= first.height;
  }
  if (auto done = run_parts(look, first); !done) return done;
  return run_parts(look, second);
}

Result<Channels> Network::see(const image::Size& size, std::shared_ptr<const BlockMap> blocks,
                              const PlanesOf& planes_of, threads::Pool* pool) {
  const image::Rect everything{0, 0, blocks->columns, blocks->rows};
  Look look{*blocks, planes_of, pool, Channels::over(size, blocks)};
  if (auto done = run_parts(look, everything); !done) return done.error();
  return look.output;
}

Result<Channels> Network::see(const Planes& input, const BlockMap& blocks) {
  const auto planes_of = [&](const image::Point& block, PlanesOfPixel* to) {
    std::fill_n(to, kBlock_px * kBlock_px, PlanesOfPixel{});
    const image::Rect part = pixels_of(block) & image::all_of(input.size());
    for (int v = 0; v < part.height; ++v) {
      std::copy_n(input.row(part.y + v) + part.x, part.width, to + v * kBlock_px);
    }
  };
  return see(input.size(), std::make_shared<const BlockMap>(blocks), planes_of);
}

}  // namespace flowdlo::field
