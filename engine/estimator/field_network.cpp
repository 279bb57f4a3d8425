#include "estimator/field_network.hpp"

#include <memory>
#include <utility>

#include "estimator/device_choice.hpp"
#include "estimator/weights_location.hpp"
#include "weights/field_weights.hpp"

namespace flowdlo::estimator {

Result<std::optional<field::Network>> open_field(const Config& config,
                                                 const std::filesystem::path& weights) {
  if (config.field == FieldChoice::kOff) return std::optional<field::Network>();
  const auto file = config.field_weights.empty() ? field_beside(weights) : config.field_weights;
  if (file.empty()) return std::optional<field::Network>();
  auto loaded = weights::load_field(file);
  if (!loaded) return loaded.error();
  const auto cpu = cpu_back_end(1);
  auto network = field::Network::create(
      std::make_shared<const weights::FieldWeights>(*std::move(loaded)), cpu.make_program);
  if (!network) return network.error();
  return std::optional(*std::move(network));
}

}  // namespace flowdlo::estimator
