// Sampler: conditions in, D predictions out; every Euler step of every draw in one run, Sec. 3.6.
#pragma once

#include <array>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "evidence/mask_field.hpp"
#include "evidence/visible_points.hpp"
#include "flowdlo/centerline.hpp"
#include "flowdlo/frame.hpp"
#include "flowdlo/result.hpp"
#include "ops/program.hpp"
#include "prior/prior.hpp"
#include "weights/weights.hpp"

namespace flowdlo::flow {

/// Sizes for which a program sets memory aside.
struct Capacity {
  int cloud_points = 0;
  int field_texels = 0;
  int image_pixels = 0;  ///< of the depth image; used by 8 local channels alone
};

struct SamplerConfig {
  int draws = 4;           ///< 1..64
  int steps = 10;          ///< K, 1..64
  std::uint64_t seed = 0;  ///< of the sources x_0
  Capacity capacity;
};

/// One frame's conditions, Eq. (3.11). `draw_priors` holds one prior for each draw.
struct SampleInput {
  const Frame& frame;
  const evidence::Cloud& cloud;
  const evidence::MaskField& field;
  std::span<const prior::Prior> draw_priors;
  /// Of the cloud, where the caller knows them already.
  const evidence::VisiblePoints* visible = nullptr;
};

struct Prediction {
  std::vector<Centerline> draws;                   ///< [D, 64, 3] camera frame, metres
  std::vector<std::array<float, kNodes>> sigma_m;  ///< [D, 64]; empty without the fourth head
  evidence::VisiblePoints visible;                 ///< P_obs as the back end used it
};

/// Makes empty programs on the back end of choice.
using ProgramFactory = std::function<std::unique_ptr<ops::Program>()>;

/// The model, asked for whenever a program is made, always the same; programs keep copies of their
/// own.
using WeightsSource = std::function<std::shared_ptr<const weights::Weights>()>;

class Sampler {
 public:
  /// Records, compiles and warms up. Fails with kDeviceLost or kNoDevice.
  [[nodiscard]] static Result<Sampler> create(WeightsSource weights, ProgramFactory factory,
                                              const SamplerConfig& config);
  /// The same of weights that stay in memory.
  [[nodiscard]] static Result<Sampler> create(std::shared_ptr<const weights::Weights> weights,
                                              ProgramFactory factory, const SamplerConfig& config);

  /// Recorded, compiled and warmed up by the first frame that asks for it, and fails there.
  [[nodiscard]] static Sampler later(WeightsSource weights, ProgramFactory factory,
                                     const SamplerConfig& config);

  /// One run. A frame beyond the capacity makes the program anew, once, with more; where that fails
  /// the next frame tries again.
  [[nodiscard]] Result<Prediction> sample(const SampleInput& input);

  /// x_0 [D, 64, 4], normalised space; column 3 is zero.
  [[nodiscard]] const std::vector<float>& source() const { return source_; }

  /// Of the last run, by stage; empty before the first.
  [[nodiscard]] std::vector<std::pair<std::string, double>> stage_times_ms() const {
    return built_ ? program_->stage_times_ms() : std::vector<std::pair<std::string, double>>();
  }

 private:
  struct Handles {
    std::optional<ops::Tensor> cloud;  ///< where the back end samples it
    ops::Tensor params;
    ops::Tensor field;
    std::optional<ops::Tensor> depth;
    ops::Tensor draw_prior;
    ops::Tensor source;
    ops::Tensor visible;  ///< an output, or an input where the host samples the cloud
    ops::Tensor norm;
    ops::Tensor prediction;
  };

  Sampler(WeightsSource weights, ProgramFactory factory, const SamplerConfig& config);
  [[nodiscard]] Result<void> build();
  [[nodiscard]] bool fits(const Capacity& need) const;
  [[nodiscard]] Result<void> ensure_capacity(const SampleInput& input);
  ops::Tensor declare_visible();
  void write(const SampleInput& input);
  void write_cloud(const evidence::Cloud& cloud);
  void write_visible(const evidence::VisiblePoints& visible);
  [[nodiscard]] Prediction read(int point_count) const;

  WeightsSource weights_;
  weights::Variant variant_;
  ProgramFactory factory_;
  SamplerConfig config_;
  std::vector<float> source_;
  std::unique_ptr<ops::Program> program_;
  bool built_ = false;  // else the program is none, or half of one
  Handles handles_;
  std::vector<float> staging_;       // reused by every call
  evidence::VisiblePoints visible_;  // the last, where the host samples them
};

}  // namespace flowdlo::flow
