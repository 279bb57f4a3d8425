#include "estimator/device_networks.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <string>

#include "estimator/field_trial.hpp"
#include "estimator/opening.hpp"
#include "files/checksum.hpp"

namespace flowdlo::estimator {
namespace {

/// Whether the CPU takes the place of a device that failed so. Without memory it would fail too.
bool replaceable(const Config& config, const std::string& device, const Error& error) {
  return config.device == kAuto && device != kCpu && error.code != ErrorCode::kOutOfMemory;
}

/// The field's network, and where it runs.
struct PlacedField {
  field::Network network;
  std::string device;
};

Result<PlacedField> field_on_cpu(const Wanted& wanted) {
  const BackEnd cpu = cpu_back_end(wanted.config.threads);
  auto network = field::Network::create(wanted.field, cpu.make_program);
  if (!network) return network.error();
  return PlacedField{*std::move(network), cpu.name};
}

/// By which it is remembered where this network runs: its speed is that of any of its size, but
/// not whether its values are right.
std::string name_of(const weights::FieldWeights& field) {
  std::uint64_t sum = files::checksum({});
  for (const weights::Tensor& tensor : field.tensors) {
    sum = files::checksum({reinterpret_cast<const char*>(tensor.values.data()),
                           tensor.values.size() * sizeof(tensor.values.front())},
                          sum);
  }
  return fmt::format("field-{:010x}", sum >> 24U);
}

/// As Config::field_device has it.
Result<PlacedField> placed_field(const Wanted& wanted, const BackEnd& back_end) {
  const Config& config = wanted.config;
  const bool asked = config.field_device == FieldDevice::kSame;
  const bool tried = config.field_device == FieldDevice::kFaster && back_end.gpu;
  if (back_end.name == kCpu || !(asked || tried)) return field_on_cpu(wanted);

  auto network = field::Network::create(wanted.field, back_end.make_program);
  if (!network) return network.error();
  PlacedField there{*std::move(network), back_end.name};
  if (tried) {
    const auto gets_it = back_end.settled(name_of(*wanted.field), [&]() -> Result<bool> {
      auto here = field_on_cpu(wanted);
      if (!here) return here.error();
      const auto trial = try_field(there.network, here->network);
      if (!trial) return trial.error();
      return trial->agrees() && !trial->cpu_is_faster();
    });
    if (!gets_it) return gets_it.error();
    if (!*gets_it) return field_on_cpu(wanted);
  }
  if (config.device == kAuto) {
    there.network.fall_back_on(cpu_back_end(config.threads).make_program);
  }
  return there;
}

flow::Sampler later_on(const Wanted& wanted, const BackEnd& back_end) {
  return flow::Sampler::later(wanted.model, back_end.make_program, sampler_config(wanted.config));
}

Result<flow::Sampler> sampler_on(const Wanted& wanted, const BackEnd& back_end) {
  if (wanted.model_idle) return later_on(wanted, back_end);
  return flow::Sampler::create(wanted.model, back_end.make_program, sampler_config(wanted.config));
}

Result<OnDevice> made_on(const Wanted& wanted, const BackEnd& back_end) {
  auto sampler = sampler_on(wanted, back_end);
  if (!sampler) return sampler.error();
  OnDevice made{back_end.name, *std::move(sampler)};
  if (wanted.field == nullptr) return made;
  auto field = placed_field(wanted, back_end);
  if (!field) return field.error();
  made.field = std::move(field->network);
  made.field_device = std::move(field->device);
  return made;
}

/// All on the device that "auto" takes now; nothing where that is the CPU, or where it fails.
std::optional<OnDevice> made_again(const Wanted& wanted) {
  const auto back_end = choose_back_end(wanted.config);
  if (!back_end || back_end->name == kCpu) return std::nullopt;
  auto made = made_on(wanted, *back_end);
  if (!made) return std::nullopt;
  return *std::move(made);
}

}  // namespace

Result<DeviceNetworks> DeviceNetworks::create(Wanted wanted, BackEnd back_end, Pace pace) {
  const bool comes_back = !back_end.fetch;
  auto made = made_on(wanted, back_end);
  if (made) return DeviceNetworks(std::move(wanted), pace, comes_back, *std::move(made));
  if (!replaceable(wanted.config, back_end.name, made.error())) return made.error();
  auto instead = made_on(wanted, cpu_back_end(wanted.config.threads));
  if (!instead) return instead.error();
  DeviceNetworks result(std::move(wanted), pace, comes_back, *std::move(instead));
  result.begin_comeback();
  return result;
}

void DeviceNetworks::begin_comeback() {
  if (!comes_back_) return;
  Pace pace = pace_;
  pace.first = next_;
  comeback_ = std::make_unique<Comeback>([wanted = wanted_] { return made_again(wanted); }, pace);
}

/// The model goes to the CPU; the field's network, which may be at work, goes there by itself.
void DeviceNetworks::lost() {
  const BackEnd cpu = cpu_back_end(wanted_.config.threads);
  now_.sampler = later_on(wanted_, cpu);
  now_.device = cpu.name;
  const bool again = back_since_ && Clock::now() - *back_since_ < pace_.longest;
  next_ = again ? std::min(2 * next_, pace_.longest) : pace_.first;
  begin_comeback();
}

void DeviceNetworks::begin_frame() {
  if (now_.device != kCpu && now_.field && now_.field->on_spare()) lost();
  if (!comeback_) return;
  auto found = comeback_->take();
  if (!found) return;
  now_ = *std::move(found);
  comeback_.reset();
  back_since_ = Clock::now();
}

Result<flow::Prediction> DeviceNetworks::sample(const flow::SampleInput& input) {
  auto prediction = now_.sampler.sample(input);
  if (prediction || !replaceable(wanted_.config, now_.device, prediction.error())) {
    return prediction;
  }
  lost();
  return now_.sampler.sample(input);
}

const std::string& DeviceNetworks::field_device() const {
  static const std::string cpu = kCpu;
  return now_.field && now_.field->on_spare() ? cpu : now_.field_device;
}

}  // namespace flowdlo::estimator
