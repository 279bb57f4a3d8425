#include "strand/mean.hpp"

#include <fmt/format.h>

namespace flowdlo::strand {
namespace {

weights::Tensor mean_tensor(std::span<const weights::FieldWeights> fields, std::size_t index) {
  weights::Tensor mean = fields.front().tensors[index];
  for (std::size_t i = 0; i < mean.values.size(); ++i) {
    double sum = 0;
    for (const auto& field : fields) sum += field.tensors[index].values[i];
    mean.values[i] = static_cast<float>(sum / static_cast<double>(fields.size()));
  }
  return mean;
}

}  // namespace

Result<weights::FieldWeights> mean_of(std::span<const weights::FieldWeights> fields) {
  if (fields.empty()) return Error{ErrorCode::kBadInput, "a mean of fields: expected one or more"};
  weights::FieldWeights mean;
  mean.name = fields.back().name;
  mean.training_data = fields.back().training_data;
  mean.sizes = fields.back().sizes;
  mean.notes = fmt::format("mean of {}:", fields.size());
  for (const auto& field : fields) {
    if (field.sizes != mean.sizes) {
      return Error{
          ErrorCode::kBadInput,
          fmt::format("a mean of fields: expected networks of one size; one has {}, {} and {} "
                      "channels, another {}, {} and {}",
                      field.sizes.fine, field.sizes.middle, field.sizes.coarse, mean.sizes.fine,
                      mean.sizes.middle, mean.sizes.coarse)};
    }
    mean.notes += fmt::format(" [{}]", field.notes);
  }
  for (std::size_t i = 0; i < fields.back().tensors.size(); ++i) {
    mean.tensors.push_back(mean_tensor(fields, i));
  }
  return mean;
}

}  // namespace flowdlo::strand
