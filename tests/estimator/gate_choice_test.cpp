// Which gate decides: what the config asks for, and otherwise what suits the weights.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <stdexcept>

#include "flowdlo/estimator.hpp"
#include "frame/temporary_folder.hpp"
#include "support/wave_frame.hpp"
#include "weights/calibration.hpp"
#include "weights/weights.hpp"

namespace flowdlo {
namespace {

using testing::WaveFrame;

class GateOf : public ::testing::Test {
 protected:
  /// Noise in the shape of the model that FlowDLO ships.
  void save_model(bool calibrated, weights::PriorKind prior = weights::PriorKind::kRefined) {
    auto model = weights::seeded({.parameterization = ops::Parameterization::kPreconditioned,
                                  .head_channels = 4,
                                  .normalization = weights::NormalizationKind::kFrame,
                                  .prior_kind = prior,
                                  .prior_sd = 0.01F},
                                 /*seed=*/3);
    model.metadata.trained = trained_;
    if (calibrated) model.calibration = weights::neutral_calibration();
    if (!weights::save(model, file_)) throw std::runtime_error("cannot save");
  }
  [[nodiscard]] Config config(GateChoice gate, int draws = 2) const {
    return {.weights = file_, .device = "cpu", .euler_steps = 1, .draws = draws, .gate = gate};
  }
  [[nodiscard]] Estimate estimate(const Config& config) const {
    auto estimator = Estimator::create(config);
    if (!estimator) throw std::runtime_error(estimator.error().message);
    const WaveFrame wave;
    auto estimate = estimator->estimate(wave.frame());
    if (!estimate) throw std::runtime_error(estimate.error().message);
    return *std::move(estimate);
  }
  [[nodiscard]] Estimate estimate(GateChoice gate, int draws = 2) const {
    return estimate(config(gate, draws));
  }

  bool trained_ = true;
  test::TemporaryFolder folder_;
  std::filesystem::path file_ = folder_.path() / "model.fdw";
};

TEST_F(GateOf, AModelThatBringsACalibrationIsTheCalibratedOne) {
  save_model(/*calibrated=*/true);
  const Estimate of_weights = estimate(GateChoice::kOfWeights);
  const Estimate calibrated = estimate(GateChoice::kCalibrated);
  EXPECT_TRUE(of_weights.calibrated);
  EXPECT_EQ(of_weights.confidence, 0.5F);  // which is all that a neutral one says
  EXPECT_EQ(of_weights.confidence, calibrated.confidence);
  EXPECT_EQ(of_weights.sigma_m, calibrated.sigma_m);
  EXPECT_NE(of_weights.confidence, estimate(GateChoice::kThesis).confidence);
}

TEST_F(GateOf, AModelWithoutOneIsTheThesisOne) {
  save_model(/*calibrated=*/false);
  const Estimate of_weights = estimate(GateChoice::kOfWeights);
  const Estimate thesis = estimate(GateChoice::kThesis);
  EXPECT_FALSE(of_weights.calibrated);
  EXPECT_EQ(of_weights.nodes, thesis.nodes);
  EXPECT_EQ(of_weights.confidence, thesis.confidence);
  EXPECT_EQ(of_weights.sigma_m, thesis.sigma_m);
}

TEST_F(GateOf, AnUntrainedModelIsTheThesisOneUnlessTheCalibratedIsAskedFor) {
  trained_ = false;
  save_model(/*calibrated=*/true);
  EXPECT_FALSE(estimate(GateChoice::kOfWeights).calibrated);
  EXPECT_TRUE(estimate(GateChoice::kCalibrated).calibrated);
}

TEST_F(GateOf, WithAnotherPriorThanTheFittedOneTheThesisDecides) {
  save_model(/*calibrated=*/true, weights::PriorKind::kThesis);
  EXPECT_FALSE(estimate(GateChoice::kOfWeights).calibrated);
  save_model(/*calibrated=*/true);
  Config other = config(GateChoice::kOfWeights);
  other.prior = PriorChoice::kThesis;
  EXPECT_FALSE(estimate(other).calibrated);
}

TEST_F(GateOf, ACalibratedOneThatIsAskedForHasToBeThere) {
  save_model(/*calibrated=*/false);
  const auto made = Estimator::create(config(GateChoice::kCalibrated));
  ASSERT_FALSE(made);
  EXPECT_EQ(made.error().code, ErrorCode::kBadWeights);
  EXPECT_THAT(made.error().message, ::testing::HasSubstr("gate-fit"));
  save_model(/*calibrated=*/true, weights::PriorKind::kThesis);
  EXPECT_TRUE(estimate(GateChoice::kCalibrated).calibrated);
}

TEST_F(GateOf, AnyModelStillReportsEveryDraw) {
  save_model(/*calibrated=*/true);
  EXPECT_EQ(estimate(GateChoice::kCalibrated, 3).draws.size(), 3U);
  EXPECT_EQ(estimate(GateChoice::kCalibrated, 1).draws.size(), 1U);
}

}  // namespace
}  // namespace flowdlo
