#include "train/batch.hpp"

#include <cstring>

namespace flowdlo::train {
namespace {

using torch::Tensor;

ModelInput moved(const ModelInput& input, torch::Device device) {
  const auto move = [&](const Tensor& tensor) {
    return tensor.defined() ? tensor.to(device) : tensor;
  };
  return {move(input.state),  move(input.time),  move(input.prior),   move(input.support),
          move(input.points), move(input.valid), move(input.features)};
}

}  // namespace

Batch Batch::to(torch::Device device) const {
  return {moved(input, device),
          {target.state.to(device), target.time.to(device), target.prior.to(device),
           target.truth.to(device), target.source.to(device), target.norm.to(device)}};
}

Tensor stacked(std::span<const RecordView> views,
               std::span<const float> (RecordView::*rows)() const, std::int64_t columns) {
  constexpr std::int64_t kColumns = 4;
  const auto count = static_cast<std::int64_t>((views.front().*rows)().size()) / kColumns;
  Tensor all = torch::empty({static_cast<std::int64_t>(views.size()), count, kColumns});
  float* place = all.data_ptr<float>();
  for (const RecordView& view : views) {
    const auto values = (view.*rows)();
    std::memcpy(place, values.data(), values.size_bytes());
    place += values.size();
  }
  return all.narrow(2, 0, columns).contiguous();
}

ModelInput conditions_of(std::span<const RecordView> views) {
  const Tensor prior = stacked(views, &RecordView::prior, 4);
  const Tensor points = stacked(views, &RecordView::points, 4);
  ModelInput input;
  input.prior = prior.narrow(2, 0, 3).contiguous();
  input.support = prior.narrow(2, 3, 1).contiguous();
  input.points = points.narrow(2, 0, 3).contiguous();
  input.valid = points.select(2, 3).contiguous();
  return input;
}

Tensor features_of(std::span<const RecordView> views, const Tensor& state, int channels) {
  const auto batch = static_cast<std::int64_t>(views.size());
  Tensor rows = torch::zeros({batch, kNodes, 4});
  rows.narrow(2, 0, 3).copy_(state);
  Tensor features = torch::empty({batch, kNodes, static_cast<std::int64_t>(kFeatureColumns)});
  constexpr std::size_t kIn = kNodes * 4;
  constexpr std::size_t kOut = kNodes * kFeatureColumns;
  for (std::size_t i = 0; i < views.size(); ++i) {
    views[i].features({rows.data_ptr<float>() + i * kIn, kIn},
                      {features.data_ptr<float>() + i * kOut, kOut});
  }
  return features.narrow(2, 0, channels).contiguous();
}

Batch make_batch(std::span<const Record> records, const SamplePlan& plan, const ViewConfig& view,
                 std::uint64_t step, int size, int local_channels) {
  const torch::NoGradGuard no_gradients;
  std::vector<RecordView> views;
  views.reserve(static_cast<std::size_t>(size));
  Tensor source = torch::empty({size, kNodes, 4});
  Tensor time = torch::empty({size});
  Tensor to_prior = torch::empty({size});
  for (int slot = 0; slot < size; ++slot) {
    const Choice choice = plan.choose(step, slot, size);
    views.emplace_back(records[choice.record], choice.prior, choice.turn, view);
    plan.source(choice, {source.data_ptr<float>() + static_cast<std::ptrdiff_t>(slot) * kNodes * 4,
                         static_cast<std::size_t>(kNodes) * 4});
    time.data_ptr<float>()[slot] = choice.t;
    to_prior.data_ptr<float>()[slot] = choice.on_prior_path ? 1.0F : 0.0F;
  }

  Batch batch;
  batch.input = conditions_of(views);
  batch.input.time = time;
  batch.target.source = source.narrow(2, 0, 3).contiguous();
  batch.target.truth = stacked(views, &RecordView::truth, 3);
  const Tensor t = time.view({-1, 1, 1});
  const Tensor end =
      torch::where(to_prior.view({-1, 1, 1}) > 0, batch.input.prior, batch.target.truth);
  batch.input.state = (1 - t) * batch.target.source + t * end;  // Eq. (2.4)
  batch.input.features = features_of(views, batch.input.state, local_channels);
  batch.target.state = batch.input.state;
  batch.target.time = time;
  batch.target.prior = batch.input.prior;
  batch.target.norm = stacked(views, &RecordView::norm, 4).squeeze(1);
  return batch;
}

}  // namespace flowdlo::train
