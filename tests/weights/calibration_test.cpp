// The section "calibration": in a .fdw, in a strand field's .safetensors, and from one to the
// other.
#include "weights/calibration.hpp"

#include <gmock/gmock.h>

#include <algorithm>

#include "flowdlo/weights.hpp"
#include "weights/fdw.hpp"
#include "weights/field_weights.hpp"
#include "weights_folder.hpp"

namespace flowdlo::weights {
namespace {

using test::bytes_of;
using testing::HasSubstr;

/// All values different, and exact in f32.
Calibration counted() {
  Calibration calibration = neutral_calibration();
  calibration.notes = "of a test, \"quoted\"";
  float next = 0;
  for (Tensor& tensor : calibration.tensors) {
    for (float& value : tensor.values) value = (next += 0.125F);
  }
  return calibration;
}

void expect_same(const std::optional<Calibration>& got, const Calibration& want) {
  ASSERT_TRUE(got);
  EXPECT_EQ(got->notes, want.notes);
  ASSERT_EQ(got->tensors.size(), want.tensors.size());
  for (std::size_t i = 0; i < want.tensors.size(); ++i) {
    EXPECT_EQ(got->tensors[i].name, want.tensors[i].name);
    EXPECT_EQ(got->tensors[i].shape, want.tensors[i].shape);
    EXPECT_EQ(got->tensors[i].values, want.tensors[i].values);
  }
}

class CalibrationFile : public testing::Test {
 protected:
  Weights model() const {
    Weights model = seeded({}, 4);
    model.calibration = counted();
    return model;
  }
  FieldWeights field() const {
    FieldWeights field = seeded_field({16, 32, 48}, 9);
    field.calibration = counted();
    return field;
  }
  /// The error of loading the field's file after `from` in it has become `to`, of one length.
  std::string fault_after(const std::string& from, const std::string& to) const {
    std::string bytes = bytes_of(field_);
    const auto at = bytes.find(from);
    EXPECT_NE(at, std::string::npos);
    bytes.replace(at, from.size(), to);
    test::write_bytes(field_, bytes);
    const auto loaded = load_field(field_);
    return loaded ? "" : loaded.error().message;
  }

  test::WeightsFolder folder_;
  std::filesystem::path fdw_ = folder_ / "model.fdw";
  std::filesystem::path field_ = folder_ / "field.safetensors";
};

TEST_F(CalibrationFile, OfAModelComesBackExactlyBesideItsTensors) {
  ASSERT_TRUE(save(model(), fdw_));
  const auto loaded = load(fdw_);
  ASSERT_TRUE(loaded) << loaded.error().message;
  expect_same(loaded->calibration, counted());
  EXPECT_EQ(loaded->tensors.size(), model().tensors.size());
}

TEST_F(CalibrationFile, OfAFieldComesBackExactlyBesideItsTensors) {
  FieldWeights weights = field();
  weights.refine = seeded_refine(3);
  ASSERT_TRUE(save_field(weights, field_));
  const auto loaded = load_field(field_);
  ASSERT_TRUE(loaded) << loaded.error().message;
  expect_same(loaded->calibration, counted());
  EXPECT_TRUE(loaded->refine);
}

TEST_F(CalibrationFile, AModelsDigestIsOfItsOwnTensors) {
  ASSERT_TRUE(save(seeded({}, 4), fdw_));
  const auto without = inspect_weights(fdw_);
  ASSERT_TRUE(save(model(), fdw_));
  const auto with = inspect_weights(fdw_);
  ASSERT_TRUE(without && with);
  EXPECT_EQ(with->sha256, without->sha256);
  EXPECT_EQ(without->metadata.count("calibration"), 0U);
  EXPECT_EQ(with->metadata.at("calibration"), "1");
  EXPECT_EQ(with->metadata.at("calibration_notes"), counted().notes);
}

TEST_F(CalibrationFile, GoesToSafetensorsAndBack) {
  ASSERT_TRUE(save(model(), fdw_));
  const auto between = folder_ / "model.safetensors";
  ASSERT_TRUE(export_safetensors(fdw_, between));
  const auto back = folder_ / "back.fdw";
  const auto imported = import_safetensors(between, back);
  ASSERT_TRUE(imported) << imported.error().message;
  EXPECT_EQ(bytes_of(back), bytes_of(fdw_));
}

TEST_F(CalibrationFile, StaysWhereTheFastQualityIsSet) {
  ASSERT_TRUE(save(model(), fdw_));
  ASSERT_TRUE(set_fast_quality(fdw_, 1, 1, fdw_));
  const auto loaded = load(fdw_);
  ASSERT_TRUE(loaded);
  expect_same(loaded->calibration, counted());
}

TEST_F(CalibrationFile, WithATensorMissingIsNotWritten) {
  Weights weights = model();
  weights.calibration->tensors.pop_back();
  const auto saved = save(weights, fdw_);
  ASSERT_FALSE(saved);
  EXPECT_THAT(saved.error().message, HasSubstr("calibration.sigma_share"));
  EXPECT_FALSE(std::filesystem::exists(fdw_));
  FieldWeights of_field = field();
  of_field.calibration->tensors.front().values.front() = std::numeric_limits<float>::infinity();
  EXPECT_FALSE(save_field(of_field, field_));
}

TEST_F(CalibrationFile, OfAnotherVersionIsRefused) {
  ASSERT_TRUE(save_field(field(), field_));
  EXPECT_THAT(fault_after("\"calibration\":\"1\"", "\"calibration\":\"2\""),
              HasSubstr("section calibration: expected version \"1\", got \"2\""));
}

TEST_F(CalibrationFile, WithoutItsVersionItsTensorsBelongNowhere) {
  ASSERT_TRUE(save_field(field(), field_));
  EXPECT_THAT(fault_after("\"calibration\":", "\"calibratio_\":"), HasSubstr("calibration.draw"));
}

TEST_F(CalibrationFile, ChangedUnderItsDigestIsRefused) {
  ASSERT_TRUE(save_field(field(), field_));
  std::string bytes = bytes_of(field_);
  bytes.back() = static_cast<char>(bytes.back() ^ 1);
  test::write_bytes(field_, bytes);
  const auto loaded = load_field(field_);
  ASSERT_FALSE(loaded);
  EXPECT_THAT(loaded.error().message, HasSubstr("section calibration: expected SHA-256"));
}

}  // namespace
}  // namespace flowdlo::weights
