#include "refine/network.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <string>
#include <utility>

namespace flowdlo::refine {
namespace {

constexpr int kSide = kStationsOfNode;  // of a block: as many nodes as each has stations
constexpr int kBlocks = kNodes / kSide;
constexpr int kPlaces = kSide * kSide;
constexpr int kMapColumns = 12;  // of ops::Convolution's map

static_assert(kNodes % kSide == 0);

/// Row of a tensor that holds station `j`.
std::size_t row_of(std::size_t j) {
  const std::size_t node = j / kStationsOfNode;
  return node / kSide * kPlaces + j % kStationsOfNode * kSide + node % kSide;
}

/// Blocks in one row, each beside the next.
std::vector<float> map_of_blocks() {
  std::vector<float> map(static_cast<std::size_t>(kBlocks) * kMapColumns, 0.0F);
  for (int i = 0; i < kBlocks; ++i) {
    float* const row = map.data() + static_cast<std::ptrdiff_t>(i) * kMapColumns;
    std::fill(row, row + 9, -1.0F);
    for (const int beside : {-1, 0, 1}) {
      const int other = i + beside;
      if (other >= 0 && other < kBlocks) row[4 + beside] = static_cast<float>(other);
    }
  }
  return map;
}

}  // namespace

Result<Network> Network::create(const weights::RefineWeights& weights,
                                const ProgramFactory& make_program,
                                const std::optional<weights::TipWeights>& tips) {
  Network network;
  if (tips) network.tips_ = std::make_unique<const TipNetwork>(*tips);
  auto program = make_program();
  network.map_ = program->input("refine map", kBlocks, kMapColumns);
  network.input_ = program->input("refine input", kStations, weights::kRefineInputs);
  network.output_ = program->output("refine output", kStations, weights::kRefineOutputs);
  program->stage("refine");
  const auto convolve = [&](const std::string& name, ops::Tensor x, ops::Tensor y, bool relu) {
    const weights::Tensor& weight = weights.at(name + ".weight");
    const auto layer =
        program->convolution("refine " + name, weight.shape[0], weight.shape[1], weight.shape[2],
                             weight.values, weights.at(name + ".bias").values);
    program->record(ops::Convolution{x, network.map_, layer, y, kSide, relu});
  };
  auto x = program->scratch("refine stem", kStations, weights::kRefineStem);
  convolve("stem", network.input_, x, true);
  for (int i = 0; i < weights::kRefineSquares; ++i) {
    const std::string name = "square." + std::to_string(i);
    const auto y = program->scratch("refine " + name, kStations, weights::kRefineWidth);
    convolve(name, x, y, true);
    x = y;
  }
  convolve("head", x, network.output_, false);
  if (auto built = program->build(); !built) return built.error();
  network.program_ = std::move(program);
  network.map_values_ = map_of_blocks();
  network.values_.resize(static_cast<std::size_t>(kStations) * weights::kRefineInputs);
  return network;
}

Result<std::array<Offset, kNodes>> Network::see(const Strip& strip) {
  for (std::size_t j = 0; j < kStations; ++j) {
    std::copy_n(strip.values.begin() + static_cast<std::ptrdiff_t>(j * weights::kRefineInputs),
                weights::kRefineInputs,
                values_.begin() + static_cast<std::ptrdiff_t>(row_of(j) * weights::kRefineInputs));
  }
  program_->write(map_, map_values_);
  program_->write(input_, values_);
  if (auto done = program_->run(); !done) return done.error();
  std::vector<float> said(static_cast<std::size_t>(kStations) * weights::kRefineOutputs);
  program_->read(output_, said);
  std::array<Offset, kNodes> offsets{};
  for (std::size_t j = 0; j < kStations; ++j) {
    const float* const of_station = said.data() + row_of(j) * weights::kRefineOutputs;
    Offset& offset = offsets[j / kStationsOfNode];
    offset.deep += of_station[0] / kStationsOfNode;
    offset.aside += of_station[1] / kStationsOfNode;
    offset.laid += of_station[2] / kStationsOfNode;
  }
  std::array<float, kNodes> log_odds{};
  for (std::size_t i = 0; i < kNodes; ++i) log_odds[i] = offsets[i].laid;
  for (std::size_t i = 0; i < kNodes; ++i) {
    const std::size_t first = i - std::min<std::size_t>(i, weights::kRefineAlike);
    const std::size_t last = std::min<std::size_t>(i + weights::kRefineAlike, kNodes - 1);
    float sum = 0;
    for (std::size_t k = first; k <= last; ++k) sum += log_odds[k];
    offsets[i].laid = 1 / (1 + std::exp(-sum / static_cast<float>(last - first + 1)));
  }
  return offsets;
}

}  // namespace flowdlo::refine
