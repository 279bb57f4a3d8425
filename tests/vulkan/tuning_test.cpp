#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>

#include "vulkan/device.hpp"
#include "vulkan/findings.hpp"
#include "vulkan/gemm_candidates.hpp"
#include "vulkan/trial.hpp"
#include "vulkan/tuning.hpp"

namespace flowdlo::vulkan::testing {
namespace {

namespace fs = std::filesystem;

/// A device without memories and a folder of this test's own, removed at its end.
class Tuning : public ::testing::Test {
 protected:
  Tuning()
      : folder_(fs::path(::testing::TempDir()) /
                ("flowdlo_tuning_" +
                 std::to_string(reinterpret_cast<std::uintptr_t>(this) % 1000003))) {
    fs::remove_all(folder_);
  }
  ~Tuning() override {
    std::error_code ignored;
    fs::remove_all(folder_, ignored);
  }

  static std::shared_ptr<Device> fresh_device() {
    const auto device = open_device({.wanted = report(*devices().front()).uuid});
    EXPECT_TRUE(device);
    return *device;
  }

  /// Chooses on a fresh device as a new process would, and counts the results that were looked at.
  Result<GemmChoice> choose(const std::function<bool(const GemmChoice&)>& broken = {}) {
    forget_findings();
    ProgramOptions options{.timeout_ms = 60000, .pipeline_cache = folder_};
    options.disturb = [&](const GemmChoice& choice, std::span<float> values) {
      ++looked_at_;
      if (broken && broken(choice)) values[0] += 1000.0F;
    };
    return choose_gemm(fresh_device(), options);
  }

  fs::path file() const {
    std::error_code none;
    for (const auto& entry : fs::directory_iterator(folder_, none)) {
      if (entry.path().extension() == ".gemm") return entry.path();
    }
    return {};
  }

  fs::path folder_;
  int looked_at_ = 0;
};

TEST_F(Tuning, IsRememberedBetweenProcesses) {
  FLOWDLO_NEEDS_DEVICE();
  const auto first = choose();
  ASSERT_TRUE(first) << first.error().message;
  EXPECT_GT(looked_at_, 0);
  looked_at_ = 0;
  const auto second = choose();
  ASSERT_TRUE(second);
  EXPECT_EQ(*second, *first);
  EXPECT_EQ(looked_at_, 0) << "nothing is tried again";
}

TEST_F(Tuning, IsRememberedByTheDeviceWithoutAFolder) {
  FLOWDLO_NEEDS_DEVICE();
  const auto device = fresh_device();
  const auto first = choose_gemm(device, {.timeout_ms = 60000, .pipeline_cache = {}});
  ASSERT_TRUE(first);
  const std::uint64_t submits = submit_count(*device);
  const auto second = choose_gemm(device, {.timeout_ms = 60000, .pipeline_cache = {}});
  ASSERT_TRUE(second);
  EXPECT_EQ(*second, *first);
  EXPECT_EQ(submit_count(*device), submits);
  EXPECT_EQ(gemm_name(*device), name_of(*first));
}

TEST_F(Tuning, IsRememberedByTheProcessWhereItsFolderIsGone) {
  FLOWDLO_NEEDS_DEVICE();
  const auto first = choose();
  ASSERT_TRUE(first);
  fs::remove_all(folder_);
  const auto device = fresh_device();
  const auto second = choose_gemm(device, {.timeout_ms = 60000, .pipeline_cache = folder_});
  ASSERT_TRUE(second);
  EXPECT_EQ(*second, *first);
  EXPECT_EQ(submit_count(*device), 0U) << "nothing is tried again";
}

TEST_F(Tuning, StepsDownFromAFamilyThatReturnsWrongNumbers) {
  FLOWDLO_NEEDS_DEVICE();
  const GemmFamily first = gemm_candidates(devices().front()->facts()).front().family;
  const auto choice = choose([&](const GemmChoice& tried) { return tried.family == first; });
  ASSERT_TRUE(choice) << choice.error().message;
  EXPECT_NE(choice->family, first);
  const auto remembered = choose();
  ASSERT_TRUE(remembered);
  EXPECT_EQ(*remembered, *choice) << "the step down is remembered";
}

TEST_F(Tuning, TriesTheTilesOfACpuDriverWhereTheBestIsRemembered) {
  FLOWDLO_NEEDS_DEVICE();
  const PhysicalDevice& facts = devices().front()->facts();
  if (facts.report.kind != DeviceKind::kCpu) GTEST_SKIP() << "the first device is a GPU";
  std::vector<GemmChoice> tried;
  ProgramOptions options{.timeout_ms = 60000, .pipeline_cache = folder_};
  options.disturb = [&](const GemmChoice& choice, std::span<float> /*values*/) {
    if (tried.empty() || !(tried.back() == choice)) tried.push_back(choice);
  };
  const auto remembered = choose_gemm(fresh_device(), options);
  ASSERT_TRUE(remembered);
  ASSERT_GE(tried.size(), 2U);
  for (const GemmChoice& choice : tried) EXPECT_EQ(choice.family, GemmFamily::kSimd);
  EXPECT_NE(std::find(tried.begin(), tried.end(), *remembered), tried.end());

  tried.clear();
  options.pipeline_cache.clear();
  const auto forgotten = choose_gemm(fresh_device(), options);
  ASSERT_TRUE(forgotten);
  ASSERT_EQ(tried.size(), 1U) << "its compiler's time is not spent again and again";
  EXPECT_EQ(tried.front(), gemm_candidates(facts).front());
}

TEST_F(Tuning, WithoutAnyRightFamilyIsAnErrorThatBuildReports) {
  FLOWDLO_NEEDS_DEVICE();
  ProgramOptions options{.timeout_ms = 60000, .pipeline_cache = folder_};
  options.disturb = [](const GemmChoice&, std::span<float> values) { values[0] = NAN; };
  Trial trial(create_program(fresh_device(), options));
  const auto x = trial->input("x", 64, 256);
  const auto y = trial->output("y", 64, 256);
  trial->record(ops::Linear{.x = x, .layer = trial.layer(256, 256, 1), .y = y, .residual = {}});
  const auto built = trial->build();
  ASSERT_FALSE(built);
  EXPECT_EQ(built.error().code, ErrorCode::kNoDevice);
  EXPECT_NE(built.error().message.find("right numbers"), std::string::npos);
  EXPECT_NE(built.error().message.find("tile 32 x 32 x 16"), std::string::npos)
      << built.error().message;
  EXPECT_TRUE(file().empty()) << "no choice is stored";
}

TEST_F(Tuning, IgnoresDamagedAndForeignFiles) {
  FLOWDLO_NEEDS_DEVICE();
  const auto first = choose();
  ASSERT_TRUE(first);
  const fs::path stored = file();
  ASSERT_FALSE(stored.empty());
  std::string whole;
  {
    std::ifstream in(stored, std::ios::binary);
    whole.assign(std::istreambuf_iterator<char>(in), {});
  }
  const auto spoil = [&](std::size_t at) {
    std::string text = whole;
    text[at] = static_cast<char>(text[at] ^ 1);
    return text;
  };
  constexpr std::size_t kDriver = 56;  // in the header: the driver's UUID, versions, shaders
  constexpr std::size_t kVersion = 88;
  constexpr std::size_t kShaders = 104;
  for (const std::string& text : {whole.substr(0, whole.size() - 1), spoil(kDriver),
                                  spoil(kVersion), spoil(kShaders), spoil(whole.size() - 1)}) {
    std::ofstream(stored, std::ios::binary | std::ios::trunc) << text;
    looked_at_ = 0;
    const auto again = choose();
    ASSERT_TRUE(again);
    EXPECT_EQ(again->family, first->family) << "which of two even tiles wins may change";
    EXPECT_GT(looked_at_, 0) << "tried anew";
    EXPECT_EQ(fs::file_size(file()), whole.size()) << "written anew";
  }
}

}  // namespace
}  // namespace flowdlo::vulkan::testing
