// Every kernel that a device may be given, as RADV's compiler makes it for Radeons that are not
// there.
#include <gmock/gmock.h>

#include <algorithm>
#include <map>
#include <string>

#include "gpu_compile/absent_gpu.hpp"
#include "gpu_compile/estimate.hpp"
#include "support/forked.hpp"
#include "vulkan/gemm_candidates.hpp"
#include "weights/half.hpp"

namespace flowdlo::gpu_compile {
namespace {

constexpr int kMostSharedBytes = 32768;
constexpr int kFewestWaves = 8;
constexpr double kMostOfLimit = 2;  // times the FLOP limit, of the dense layers

struct Family {
  const char* name;
  bool has_rdna;  ///< SIMDs of 32 lanes with 1024 registers each: kFewestWaves are to be had
};

void PrintTo(const Family& family, std::ostream* out) { *out << family.name; }

/// Whether the installed RADV knows the family: asked in a child, since one that does not ends the
/// process.
bool knows(const char* family) {
  return testing::forked([&] { return open_absent_gpu(family) ? 0 : 1; }) == 0;
}

/// Why there is nothing to test here; empty where there is.
std::string absence(const char* family) {
  if (radv_library().empty()) return "RADV is not installed (mesa-vulkan-drivers)";
  return knows(family) ? std::string() : std::string("this Mesa's RADV does not know ") + family;
}

/// Noise in place of a model: weights that f16 holds, or some that it does not.
std::shared_ptr<const weights::Weights> model(const weights::Variant& variant, bool halves) {
  weights::Weights made = weights::seeded(variant, 1);
  for (weights::Tensor& tensor : made.tensors) {
    for (float& value : tensor.values) {
      const float half = weights::half_to_float(weights::float_to_half(value));
      value = halves ? half : half * 1.0001F;
    }
  }
  return std::make_shared<const weights::Weights>(std::move(made));
}

/// What each choice of the kernel for dense layers makes of models of several kinds, and of the
/// strand field.
std::vector<FrameWork> all_work(const std::shared_ptr<vulkan::Device>& device) {
  const weights::Variant thesis{};
  const weights::Variant other{.parameterization = ops::Parameterization::kPreconditioned,
                               .local_channels = 8,
                               .head_channels = 4,
                               .normalization = weights::NormalizationKind::kFrame};
  static const auto of_halves = model(thesis, true);
  static const auto of_floats = model(thesis, false);
  static const auto of_others = model(other, true);
  static const auto field =
      std::make_shared<const weights::FieldWeights>(weights::seeded_field({}, 1));
  std::vector<FrameWork> work;
  const auto add = [&](Result<FrameWork> made) {
    EXPECT_TRUE(made) << made.error().message;
    if (made) work.push_back(*std::move(made));
  };
  for (const vulkan::GemmChoice& gemm : vulkan::gemm_candidates(device->facts())) {
    add(model_work(device, gemm, of_halves, 4, 2));
    add(model_work(device, gemm, of_floats, 1, 1));
    add(model_work(device, gemm, of_others, 1, 1));
    add(field_work(device, gemm, field));
  }
  return work;
}

class EveryKernel : public ::testing::TestWithParam<Family> {
 protected:
  void SetUp() override {
    if (const std::string reason = absence(GetParam().name); !reason.empty()) {
      GTEST_SKIP() << reason;
    }
  }
};

TEST_P(EveryKernel, CompilesWithoutSpillsWithinSharedMemory) {
  for (const int lanes : {32, 64}) {
    const auto device = open_absent_gpu(GetParam().name, lanes);
    ASSERT_TRUE(device) << device.error().message;
    if ((*device)->facts().lanes != lanes) continue;  // it has the other number alone
    std::map<std::string, CompiledKernel> compiled;
    for (const FrameWork& work : all_work(*device)) {
      const auto kernels = (*device)->kernels(work.kernels);
      ASSERT_TRUE(kernels) << kernels.error().message;
      for (std::size_t i = 0; i < work.kernels.size(); ++i) {
        auto figures = figures_of(**device, work.kernels[i], *(*kernels)[i]);
        ASSERT_TRUE(figures) << figures.error().message;
        compiled.emplace(figures->name, *figures);
      }
    }
    for (const char* const shader : {"tile_gemm", "gemm", "attention", "convolution", "layer_norm",
                                     "farthest_points", "flow_step"}) {
      EXPECT_TRUE(std::any_of(
          compiled.begin(), compiled.end(),
          [&](const auto& entry) { return entry.first.starts_with(std::string(shader) + " "); }))
          << "no " << shader << " among what was compiled";
    }
    for (const auto& [name, kernel] : compiled) {
      SCOPED_TRACE(name + ", subgroups of " + std::to_string(lanes));
      EXPECT_GT(kernel.code_bytes, 0);
      EXPECT_EQ(kernel.spilled, 0);
      EXPECT_EQ(kernel.scratch_bytes, 0);
      EXPECT_LE(kernel.lds_bytes, kMostSharedBytes);
      const bool is_heavy = name.starts_with("tile_gemm") || name.starts_with("attention");
      if (is_heavy && GetParam().has_rdna) {
        EXPECT_GE(kernel.waves, kFewestWaves);
      }
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Of, EveryKernel,
                         ::testing::Values(Family{"polaris10", false}, Family{"vega10", false},
                                           Family{"navi10", true}, Family{"navi21", true},
                                           Family{"gfx1100", true}, Family{"navi31", true},
                                           Family{"gfx1200", true}),
                         [](const auto& family) { return std::string(family.param.name); });

class Cards : public ::testing::TestWithParam<Card> {};

TEST_P(Cards, RunDenseLayersWithinTwiceTheFlopLimitByTheirCompilersEstimate) {
  const Card& card = GetParam();
  if (const std::string reason = absence(card.family.c_str()); !reason.empty()) {
    GTEST_SKIP() << reason;
  }
  const auto device = open_absent_gpu(card.family);
  ASSERT_TRUE(device) << device.error().message;
  const auto seeded = model({}, true);
  for (const vulkan::GemmChoice& gemm : vulkan::gemm_candidates((*device)->facts())) {
    if (gemm.family != vulkan::GemmFamily::kTile) continue;
    SCOPED_TRACE(name_of(gemm));
    const auto work = model_work(*device, gemm, seeded, 4, 10);
    ASSERT_TRUE(work) << work.error().message;
    const auto kernels = (*device)->kernels(work->kernels);
    ASSERT_TRUE(kernels) << kernels.error().message;
    std::vector<CompiledKernel> figures;
    for (std::size_t i = 0; i < work->kernels.size(); ++i) {
      const auto asked = figures_of(**device, work->kernels[i], *(*kernels)[i]);
      ASSERT_TRUE(asked) << asked.error().message;
      figures.push_back(*asked);
    }
    const FrameEstimate estimated = estimate(*work, figures, card);
    // 256 rows, 10 steps: 6 encoder blocks of 786,432 weights, the cross-attention's 655,360 and
    // the local features' 65,536; once a frame 196,608 more. Two operations each.
    constexpr double kFlop = 2.0 * 256 * (10.0 * (6 * 786432 + 655360 + 65536) + 196608);
    EXPECT_NEAR(estimated.dense.flop / kFlop, 1, 1e-9);
    EXPECT_GT(estimated.dense.full_ms, estimated.dense.limit_ms) << "nothing beats the limit";
    EXPECT_LT(estimated.dense.full_ms, kMostOfLimit * estimated.dense.limit_ms);
  }
}

INSTANTIATE_TEST_SUITE_P(Of, Cards, ::testing::ValuesIn(cards()),
                         [](const auto& card) { return card.param.family; });

}  // namespace
}  // namespace flowdlo::gpu_compile
