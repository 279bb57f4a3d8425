#include "peers/flowdlo_peer.hpp"

#include <cstdio>
#include <cstring>

#include "flow/velocity_model.hpp"
#include "reference/program.hpp"

namespace flowdlo::peers {
namespace {

class FlowdloPeer final : public Peer {
 public:
  explicit FlowdloPeer(const Problem& problem)
      : program_(reference::create_program(problem.threads)) {
    ops::Program& program = *program_;
    const int rows = problem.rows();
    const auto input = [&](const char* name, int columns, const std::vector<float>& values) {
      return program.input(name, static_cast<int>(values.size()) / columns, columns);
    };
    constexpr int kParams = sizeof(ops::FrameParams) / sizeof(float);
    std::vector<float> params(kParams);
    std::memcpy(params.data(), &problem.params, sizeof(problem.params));
    const auto source = input("source", 4, problem.source);
    flow::Conditions conditions{.visible = input("visible", 4, problem.visible),
                                .draw_prior = input("draw_prior", 4, problem.prior),
                                .params = input("params", kParams, params),
                                .field = input("field", 4, problem.field),
                                .depth = {},
                                .norm = program.input("norm", 1, 4)};
    if (!problem.depth.empty()) conditions.depth = input("depth", 1, problem.depth);
    state_ = program.output("state", rows, 4);

    flow::VelocityModel model(program, problem.weights, problem.draws, problem.steps);
    model.record_conditions(conditions);
    program.record(ops::Copy{.from = source, .to = state_});
    for (int k = 0; k < problem.steps; ++k) model.record_step(conditions, state_, k);
    if (const auto built = program.build(); !built) {
      std::fprintf(stderr, "%s\n", built.error().message.c_str());
    }
    program.write(source, problem.source);
    program.write(conditions.visible, problem.visible);
    program.write(conditions.draw_prior, problem.prior);
    program.write(conditions.params, params);
    program.write(conditions.field, problem.field);
    if (conditions.depth) program.write(*conditions.depth, problem.depth);
    program.write(conditions.norm, problem.norm);
  }

  [[nodiscard]] std::string name() const override { return "FlowDLO, CPU back end"; }

  void sample(std::vector<float>& state) override {
    if (!program_->run()) return;
    program_->read(state_, state);
  }

 private:
  std::unique_ptr<ops::Program> program_;
  ops::Tensor state_;
};

}  // namespace

std::unique_ptr<Peer> flowdlo_peer(const Problem& problem) {
  return std::make_unique<FlowdloPeer>(problem);
}

}  // namespace flowdlo::peers
