#include <cstdio>

#include "peers/field_peers.hpp"

namespace flowdlo::peers {
namespace {

class FlowdloFieldPeer final : public FieldPeer {
 public:
  FlowdloFieldPeer(const FieldProblem& problem, std::string device, field::Network network)
      : problem_(problem), device_(std::move(device)), network_(std::move(network)) {}

  [[nodiscard]] std::string name() const override { return "FlowDLO, " + device_; }

  void see(std::vector<float>* said) override {
    const auto channels = network_.see(problem_.input, problem_.blocks);
    if (!channels) {
      std::fprintf(stderr, "%s\n", channels.error().message.c_str());
      return;
    }
    if (said == nullptr) return;
    said->clear();
    const auto whole = channels->whole();
    for (std::size_t c = 0; c < field::kChannels; ++c) {
      for (std::size_t i = 0; i < whole.total(); ++i) said->push_back(whole.data()[i][c]);
    }
  }

 private:
  const FieldProblem& problem_;
  std::string device_;
  field::Network network_;
};

}  // namespace

Result<std::unique_ptr<FieldPeer>> flowdlo_field_peer(const FieldProblem& problem,
                                                      const std::string& device,
                                                      const field::ProgramFactory& make_program) {
  auto network = field::Network::create(problem.weights, make_program);
  if (!network) return network.error();
  return std::unique_ptr<FieldPeer>(
      std::make_unique<FlowdloFieldPeer>(problem, device, *std::move(network)));
}

}  // namespace flowdlo::peers
