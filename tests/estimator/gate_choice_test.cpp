// Which gate decides: what the config asks for, and otherwise what suits the weights.
#include <gtest/gtest.h>

#include <stdexcept>

#include "flowdlo/estimator.hpp"
#include "frame/temporary_folder.hpp"
#include "support/wave_frame.hpp"
#include "weights/weights.hpp"

namespace flowdlo {
namespace {

using testing::WaveFrame;

class GateOf : public ::testing::Test {
 protected:
  /// Noise in the shape of the model that FlowDLO ships.
  void save_model(bool trained, int head_channels = 4) {
    auto model = weights::seeded({.parameterization = ops::Parameterization::kPreconditioned,
                                  .head_channels = head_channels,
                                  .normalization = weights::NormalizationKind::kFrame,
                                  .prior_kind = weights::PriorKind::kRefined,
                                  .prior_sd = 0.01F},
                                 /*seed=*/3);
    model.metadata.trained = trained;
    if (!weights::save(model, file_)) throw std::runtime_error("cannot save");
  }
  [[nodiscard]] Estimate estimate(GateChoice gate, int draws = 2) const {
    auto estimator = Estimator::create(
        {.weights = file_, .device = "cpu", .euler_steps = 1, .draws = draws, .gate = gate});
    if (!estimator) throw std::runtime_error(estimator.error().message);
    const WaveFrame wave;
    auto estimate = estimator->estimate(wave.frame());
    if (!estimate) throw std::runtime_error(estimate.error().message);
    return *std::move(estimate);
  }

  test::TemporaryFolder folder_;
  std::filesystem::path file_ = folder_.path() / "model.fdw";
};

TEST_F(GateOf, ATrainedModelWithSigmaIsTheCalibratedOne) {
  save_model(/*trained=*/true);
  const Estimate of_weights = estimate(GateChoice::kOfWeights);
  const Estimate calibrated = estimate(GateChoice::kCalibrated);
  EXPECT_EQ(of_weights.confidence, calibrated.confidence);
  EXPECT_EQ(of_weights.sigma_m, calibrated.sigma_m);
  EXPECT_NE(of_weights.confidence, estimate(GateChoice::kThesis).confidence);
}

TEST_F(GateOf, AnUntrainedModelIsTheThesisOne) {
  save_model(/*trained=*/false);
  const Estimate of_weights = estimate(GateChoice::kOfWeights);
  const Estimate thesis = estimate(GateChoice::kThesis);
  EXPECT_EQ(of_weights.nodes, thesis.nodes);
  EXPECT_EQ(of_weights.confidence, thesis.confidence);
  EXPECT_EQ(of_weights.sigma_m, thesis.sigma_m);
}

TEST_F(GateOf, AModelWithoutSigmaIsTheThesisOne) {
  save_model(/*trained=*/true, /*head_channels=*/3);
  EXPECT_EQ(estimate(GateChoice::kOfWeights).confidence, estimate(GateChoice::kThesis).confidence);
}

TEST_F(GateOf, AnyModelIsTheCalibratedOneWhereAskedFor) {
  save_model(/*trained=*/false, /*head_channels=*/3);
  EXPECT_NE(estimate(GateChoice::kCalibrated).confidence, estimate(GateChoice::kThesis).confidence);
}

TEST_F(GateOf, AnyModelStillReportsEveryDraw) {
  save_model(/*trained=*/true);
  EXPECT_EQ(estimate(GateChoice::kCalibrated, 3).draws.size(), 3U);
  EXPECT_EQ(estimate(GateChoice::kCalibrated, 1).draws.size(), 1U);
}

}  // namespace
}  // namespace flowdlo
